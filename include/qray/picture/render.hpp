// Pictures: single pixels, rows, or the whole to a sink.
#pragma once

#include "adaptive.hpp"
#include "grid.hpp"
#include "sink.hpp"

namespace qray {

// A pixel whose sight is known, as in a row it is from the pixel before.
template <class N, Effects E, class Count>
constexpr Pixel pixel_in_row(const Scene<N, E>& scene, uint32_t i, uint32_t j, [[maybe_unused]] Sight<E.windows> sight,
                             Count& count)
{
    const Camera<N>& c = scene.camera;
    const int32_t n = c.grid;
    const int32_t x = 2 * n * static_cast<int32_t>(i) + 1 - n * c.width;
    const int32_t y = 2 * n * static_cast<int32_t>(j) + 1 - n * c.height;
    if constexpr (E.adaptive)
        if (!E.grid || scene.levels.value != 0)
            return adaptive_pixel(scene, x - 1, y - 1, sight, count);
    if constexpr (E.grid)
        return grid_pixel(scene, x, y, sight, count);
    else if constexpr (in_lanes<N>)
        return pixel_at(scene, c.row(y) + c.right * x, count);
    else
        return pixel_of(sample(scene, c.row(y) + c.right * x, sight, count));
}

// Pixel (i, j), i from the left, j from the top.
template <class N, Effects E, class Count>
constexpr Pixel render_pixel(const Scene<N, E>& scene, uint32_t i, uint32_t j, Count& count)
{
    return pixel_in_row(scene, i, j, Sweep<E.windows>(scene, j).at(i), count);
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
    [[maybe_unused]] Sweep<E.windows> sweep(scene, j);
    for (uint32_t i = 0; i < scene.camera.width; i++)
        Format::put(pixel_in_row(scene, i, j, sweep.at(i), count), out + i * Format::bytes);
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
