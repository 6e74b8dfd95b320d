// Adaptive sampling (scenes/README.md, section 5): a pixel is cut in four, and a quarter that stands out from the
// other three is cut in four in turn. At least 4 samples a pixel, at most 4 + 4^2 + ... + 4^levels. Only their sum
// is kept.
#pragma once

#include "sampler.hpp"

namespace qray {

constexpr int max_adaptive_levels = 6;

// Is one of four values farther than the threshold from the mean of the other three? 3 times that difference
// is 4 times the value less the sum of all. Exact in fixed point.
template <class N>
constexpr bool stands_out(typename Sample<N>::Level own, typename Sample<N>::Level sum,
                          typename N::Unit threshold)
{
    if constexpr (N::is_fixed) {
        constexpr int up = Sample<N>::frac - N::Unit::frac;
        const uint32_t limit = 3 * static_cast<uint32_t>(threshold.raw) << (up > 0 ? up : 0) >> (up > 0 ? 0 : -up);
        return (4 * own > sum ? 4 * own - sum : sum - 4 * own) > limit;
    } else {
        const auto limit = 3 * threshold;
        return 4 * own - sum > limit || sum - 4 * own > limit;
    }
}

// (x, y) is the pixel's corner, and the camera's grid 2^levels.
template <class N, Effects E, class Count>
constexpr Pixel adaptive_pixel(const Scene<N, E>& scene, int32_t x, int32_t y, Count& count)
{
    const int levels = scene.levels.value;
    SampleSum<N> sum;
    // The square that is cut: its middle is odd multiples of 2^half, half its edge, from the pixel's corner.
    int half = levels;
    int32_t u = int32_t{1} << half, v = u;
    // The quarters that wait to be cut: 4 bits for each square around this one, the smallest lowest.
    uint32_t waiting = 0;
    static_assert(4 * max_adaptive_levels <= 32);
    for (;;) {
        Sample<N> own[4]{};
        const int32_t step = int32_t{1} << half >> 1;
        for (int k = 0; k < 4; k++) {
            const int32_t j = y + (k & 2 ? v + step : v - step);
            own[k] = sample_at(scene, scene.camera.row(j), x + (k & 1 ? u + step : u - step), j, half, count);
        }
        const Sample<N> all{own[0].r + own[1].r + own[2].r + own[3].r,
                            own[0].g + own[1].g + own[2].g + own[3].g,
                            own[0].b + own[1].b + own[2].b + own[3].b};
        waiting <<= 4;
        for (int k = 0; k < 4; k++) {
            const auto threshold = scene.threshold.value;
            if (half > 1
                && (stands_out<N>(own[k].r, all.r, threshold) || stands_out<N>(own[k].g, all.g, threshold)
                    || stands_out<N>(own[k].b, all.b, threshold)))
                waiting |= uint32_t{1} << k;
            else
                sum.add(own[k], half - 1);
        }
        while ((waiting & 15) == 0) {
            if (half == levels)
                return pixel_of(sum.mean_of_fours(levels));
            waiting >>= 4;
            half++;
            u = (u >> half | 1) * (int32_t{1} << half);
            v = (v >> half | 1) * (int32_t{1} << half);
        }
        int k = 0;
        while ((waiting >> k & 1) == 0)
            k++;
        waiting &= waiting - 1;
        half--;
        u += k & 1 ? int32_t{1} << half : -(int32_t{1} << half);
        v += k & 2 ? int32_t{1} << half : -(int32_t{1} << half);
    }
}

} // namespace qray
