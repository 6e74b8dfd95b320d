// Supersampling: the mean of the samples at the centres of an n x n grid over the pixel.
#pragma once

#include "sampler.hpp"

namespace qray {

template <class N, Effects E, class Count>
constexpr Pixel grid_pixel(const Scene<N, E>& scene, int32_t x, int32_t y, Count& count)
{
    const uint32_t n = scene.camera.grid;
    SampleSum<N> sum;
    for (uint32_t k = 0; k < n; k++) {
        const Pencil<N> row = scene.camera.row(y + static_cast<int32_t>(2 * k));
        for (uint32_t i = 0; i < n; i++)
            sum.add(sample_at(scene, row, x + static_cast<int32_t>(2 * i), y + static_cast<int32_t>(2 * k), 1, count));
    }
    return pixel_of(sum.mean(n * n));
}

} // namespace qray
