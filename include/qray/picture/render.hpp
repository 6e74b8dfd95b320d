// Pictures: single pixels, rows, or the whole to a sink.
#pragma once

#include "adaptive.hpp"
#include "grid.hpp"
#include "sink.hpp"

namespace qray {

// Pixel (i, j), i from the left, j from the top.
template <class N, Effects E, class Count>
constexpr Pixel render_pixel(const Scene<N, E>& scene, uint32_t i, uint32_t j, Count& count)
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

template <class N, Effects E>
constexpr Pixel render_pixel(const Scene<N, E>& scene, uint32_t i, uint32_t j)
{
    NoCount none;
    return render_pixel(scene, i, j, none);
}

// Row j into out: width * Format::bytes bytes.
template <class Format, class N, Effects E, class Count>
constexpr void render_row(const Scene<N, E>& scene, uint32_t j, uint8_t* out, Count& count)
{
    for (uint32_t i = 0; i < scene.camera.width; i++)
        Format::put(render_pixel(scene, i, j, count), out + i * Format::bytes);
}
template <class Format, class N, Effects E>
constexpr void render_row(const Scene<N, E>& scene, uint32_t j, uint8_t* out)
{
    NoCount none;
    render_row<Format>(scene, j, out, none);
}

// All rows from the top, through the caller's buffer of `rows` rows, 1 or more, to
// sink(first_row, rows, bytes, byte_count), which returns false to stop. False if it did.
template <class Format, class N, Effects E, class Sink, class Count>
constexpr bool render(const Scene<N, E>& scene, uint8_t* buffer, uint32_t rows, Sink&& sink, Count& count)
{
    const uint32_t stride = scene.camera.width * Format::bytes;
    for (uint32_t j = 0; j < scene.camera.height; j += rows) {
        const uint32_t block = scene.camera.height - j < rows ? scene.camera.height - j : rows;
        for (uint32_t k = 0; k < block; k++)
            render_row<Format>(scene, j + k, buffer + k * stride, count);
        if (!sink(j, block, static_cast<const uint8_t*>(buffer), block * stride))
            return false;
    }
    return true;
}
template <class Format, class N, Effects E, class Sink>
constexpr bool render(const Scene<N, E>& scene, uint8_t* buffer, uint32_t rows, Sink&& sink)
{
    NoCount none;
    return render<Format>(scene, buffer, rows, static_cast<Sink&&>(sink), none);
}

} // namespace qray
