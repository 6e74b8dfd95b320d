// Supersampling: the mean of the samples at the centres of an n x n grid over the pixel.
#pragma once

#include "sampler.hpp"

namespace qray {

// Sums of up to 2^24 samples.
template <class N>
struct SampleSum {
    uint64_t r = 0, g = 0, b = 0;
    constexpr void add(const Sample<N>& s)
    {
        r += s.r;
        g += s.g;
        b += s.b;
    }
    // To the nearest.
    constexpr Sample<N> mean(uint32_t n) const { return {mean(r, n), mean(g, n), mean(b, n)}; }

private:
    static constexpr uint32_t mean(uint64_t sum, uint32_t n)
    {
        return static_cast<uint32_t>(divide(static_cast<int64_t>(sum), n, 0));
    }
};
template <class N>
    requires(!N::is_fixed)
struct SampleSum<N> {
    typename N::Colour r = 0, g = 0, b = 0;
    constexpr void add(const Sample<N>& s)
    {
        r += s.r;
        g += s.g;
        b += s.b;
    }
    constexpr Sample<N> mean(uint32_t n) const
    {
        const auto k = static_cast<typename N::Colour>(n);
        return {r / k, g / k, b / k};
    }
};

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
