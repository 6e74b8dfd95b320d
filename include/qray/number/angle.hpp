// Angles of vectors, in turns: 2^32 steps are a whole one, so that angles wrap as unsigned numbers do. In integers for
// every number system. Each function is monotonic: where the exact angle grows, it never falls.
#pragma once

#include "math.hpp"

namespace qray {

namespace detail {

// atan(i / 128), in 2^-32 turns to the nearest, by Euler's series: all its terms are positive, and each is less
// than half of the last.
struct ArcTangents {
    uint32_t value[131];
    consteval ArcTangents() : value{}
    {
        for (uint64_t i = 0; i < 131; i++) {
            const uint64_t square = i * i, all = square + 128 * 128;
            uint64_t sum = 0, term = (i * 128 << 40) / all; // in 2^-40
            for (uint64_t n = 1; term != 0; n++) {
                sum += term;
                term = term * 2 * n * square / ((2 * n + 1) * all);
            }
            constexpr uint64_t by_two_pi = 0x28'be60'db94; // 2^40 / 2 pi
            const uint64_t high = (sum >> 20) * by_two_pi, low = (sum & 0xfffff) * by_two_pi;
            value[i] = static_cast<uint32_t>((high + (low >> 20) + (1 << 27)) >> 28);
        }
    }
};
inline constexpr ArcTangents arc_tangents;

} // namespace detail

// atan(y / x) in [0, 2^30]; 0 where both are 0. Narrow is for x and y up to 2^16: by 32-bit products alone, error at
// most 2^-17 turns. Else 2^-26.
template <bool Narrow>
constexpr uint32_t arc_tangent(uint32_t y, uint32_t x)
{
    const bool steep = y > x;
    const uint32_t low = steep ? x : y, high = steep ? y : x;
    if (high == 0)
        return 0;
    uint32_t angle = 0;
    if constexpr (Narrow) {
        const uint32_t quotient = (low << 15) / high;
        const uint32_t* const at = &detail::arc_tangents.value[quotient >> 8];
        angle = at[0] + ((at[1] - at[0]) >> 8) * (quotient & 0xff);
    } else {
        // Through three entries goes a parabola, whose slope falls by at most 1 from a step of u to the next; as it is
        // more than u, their product never does.
        const uint32_t quotient = static_cast<uint32_t>(divide(low, high, 30)), u = quotient & 0xffffff;
        const uint32_t* const at = &detail::arc_tangents.value[quotient >> 24 << 1];
        const uint32_t twice = 2 * (at[1] - at[0]), bend = twice + at[0] - at[2];
        angle = at[0] + mul_high(u, ((twice + bend) << 8) - mul_high(u, bend << 17));
    }
    return steep ? (uint32_t{1} << 30) - angle : angle;
}

// atan2(y, x): from -1/2 to 1/2 turn, both of which are 2^31. atan2(0, x) is 1/2 turn for x < 0.
template <bool Narrow>
constexpr uint32_t arc_tangent2(int32_t y, int32_t x)
{
    const uint32_t half = uint32_t{1} << 31, acute = arc_tangent<Narrow>(magnitude(y), magnitude(x));
    const uint32_t angle = x < 0 ? half - acute : acute;
    return y < 0 ? 0 - angle : angle;
}

// asin(y / r), r the length of (x, y, z), each less than 2^15 if Narrow, else up to 2^30: in [-2^30, 2^30]. The length
// across y is rounded to an integer, which is worth 2^-3 turns over the largest of them.
template <bool Narrow>
constexpr int32_t arc_sine(int32_t x, int32_t y, int32_t z)
{
    uint32_t across = 0;
    if constexpr (Narrow)
        across = isqrt(static_cast<uint32_t>(x * x + z * z));
    else
        across = isqrt(static_cast<int64_t>(wide_square(x) + wide_square(z)));
    const uint32_t angle = arc_tangent2<Narrow>(y, static_cast<int32_t>(across));
    return static_cast<int32_t>(angle);
}

} // namespace qray
