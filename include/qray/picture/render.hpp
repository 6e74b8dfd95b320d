// Pictures: single pixels, rows, or the whole to a sink.
#pragma once

#include "adaptive.hpp"
#include "grid.hpp"
#include "sink.hpp"

namespace qray {

// Pixel (i, j), i from the left, j from the top.
template <class N, Effects E, class Count = NoCount>
constexpr Pixel render_pixel(const Scene<N, E>& scene, uint32_t i, uint32_t j, Count&& count = Count{})
{
    const Camera<N>& c = scene.camera;
    const int32_t n = c.grid;
    const int32_t x = 2 * n * static_cast<int32_t>(i) + 1 - n * c.width;
    const int32_t y = 2 * n * static_cast<int32_t>(j) + 1 - n * c.height;
    if constexpr (E.adaptive)
        if (!E.grid || scene.levels.value != 0)
            return adaptive_pixel(scene, x - 1, y - 1, count);
    if constexpr (E.grid)
        return grid_pixel(scene, x, y, count);
    else if constexpr (E.panel)
        return pixel_at(scene, c.row(y) + c.right * x, count, eye_sample(c, x, y, 1));
    else
        return pixel_at(scene, c.row(y) + c.right * x, count);
}

namespace detail {

// A part of row j, from pixel x on.
template <class Format, class N, Effects E, class Count>
QRAY_INLINE constexpr void render_part(const Scene<N, E>& scene, uint32_t x, uint32_t j, uint32_t width, uint8_t* out,
                                       Count& count)
{
    for (uint32_t i = 0; i < width; i++)
        Format::put(render_pixel(scene, x + i, j, count), x + i, j, out + i / Format::pixels * Format::bytes);
}
// The same of a scene whose camera is in RAM: it is read once, and in fixed point a step to the next pixel is a sum
// instead of products.
template <class Format, class N, Effects E, class Count>
    requires(E.moving && !E.grid && !E.adaptive && !E.panel)
constexpr void render_part(const Scene<N, E>& scene, uint32_t x, uint32_t j, uint32_t width, uint8_t* out, Count& count)
{
    const Camera<N>& c = scene.camera;
    const int32_t left = 2 * static_cast<int32_t>(x) + 1 - c.width, down = 2 * static_cast<int32_t>(j) + 1 - c.height;
    const Pencil<N> row = c.row(down), right = c.right, step = right * 2;
    Pencil<N> at = row + right * left;
    for (uint32_t i = 0; i < width; i++) {
        if constexpr (!N::is_fixed)
            at = row + right * (left + 2 * static_cast<int32_t>(i));
        else if (i != 0)
            at = at + step;
        Format::put(pixel_at(scene, at, count), x + i, j, out + i / Format::pixels * Format::bytes);
    }
}

} // namespace detail

// Row j into out: row_bytes<Format>(width) bytes.
template <class Format, class N, Effects E, class Count = NoCount>
constexpr void render_row(const Scene<N, E>& scene, uint32_t j, uint8_t* out, Count&& count = Count{})
{
    if constexpr (rays_ahead<N> && !E.grid && !E.adaptive && !E.panel) { // a walk that waits leaves time for the next
        const Camera<N>& c = scene.camera;
        const Pencil<N> row = c.row(2 * static_cast<int32_t>(j) + 1 - c.height);
        Ray<N> rays[2] = {eye_ray(scene, row + c.right * (1 - c.width)), {}};
        for (uint32_t i = 0; i < c.width; i++) {
            rays[~i & 1] = eye_ray(scene, row + c.right * (2 * static_cast<int32_t>(i) + 3 - c.width));
            Format::put(pixel_along(scene, rays[i & 1], count), i, j, out + i / Format::pixels * Format::bytes);
        }
        return;
    }
    detail::render_part<Format>(scene, 0, j, scene.camera.width, out, count);
}

// The rectangle with corner (x, y), which lies in the picture, into out: row_bytes<Format>(width) bytes for each of its
// rows. x is a multiple of Format::pixels.
template <class Format, class N, Effects E, class Count = NoCount>
constexpr void render_rect(const Scene<N, E>& scene, uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                           uint8_t* out, Count&& count = Count{})
{
    for (uint32_t j = 0; j < height; j++, out += row_bytes<Format>(width))
        detail::render_part<Format>(scene, x, y + j, width, out, count);
}

// All rows from the top, through the caller's buffer of `rows` rows, 1 or more, to
// sink(first_row, rows, bytes, byte_count), which returns false to stop. False if it did.
template <class Format, class N, Effects E, class Sink, class Count = NoCount>
constexpr bool render(const Scene<N, E>& scene, uint8_t* buffer, uint32_t rows, Sink&& sink, Count&& count = Count{})
{
    const uint32_t stride = row_bytes<Format>(scene.camera.width);
    for (uint32_t j = 0; j < scene.camera.height; j += rows) {
        const uint32_t block = scene.camera.height - j < rows ? scene.camera.height - j : rows;
        for (uint32_t k = 0; k < block; k++)
            render_row<Format>(scene, j + k, buffer + k * stride, count);
        if (!sink(j, block, static_cast<const uint8_t*>(buffer), block * stride))
            return false;
    }
    return true;
}

// All pixels, each once, the coarse picture first: every size-th of every size-th row, then those half as far apart and
// so on; size is a power of two. To fill(x, y, width, height, pixel), which paints that rectangle, cut at the picture's
// edge, over what was there, and returns false to stop. False if it did.
template <class N, Effects E, class Fill, class Count = NoCount>
constexpr bool render_progressively(const Scene<N, E>& scene, uint32_t size, Fill&& fill, Count&& count = Count{})
{
    const uint32_t width = scene.camera.width, height = scene.camera.height;
    for (uint32_t done = 0; size != 0; done = size, size /= 2) // pixels whose x and y are multiples of `done` are there
        for (uint32_t y = 0; y < height; y += size)
            for (uint32_t x = 0; x < width; x += size)
                if ((done == 0 || ((x | y) & (done - 1)) != 0)
                    && !fill(x, y, width - x < size ? width - x : size, height - y < size ? height - y : size,
                             render_pixel(scene, x, y, count)))
                    return false;
    return true;
}

} // namespace qray
