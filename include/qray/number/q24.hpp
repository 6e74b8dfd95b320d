// q24, between q16 and q32: lengths of 24 bits and unit vectors of 21, for parts that multiply 32 by 32 bits to 32.
//
// Lengths are in 2^-16, unit vectors in 2^-20. Of the product of a length or a unit vector, a, and a unit vector, u,
// the upper 32 bits are kept, by two products that fit:
//   a (u >> 12) + ((a >> 5) (u & 4095) >> 7)  =  a u / 2^12 - e,  0 <= e < 32
// as what a >> 5 drops is at most 31, times less than 1, and the last shift drops less than 1. A Moment so is in 2^-24
// and wrong by less than 1/8 ulp of a Length, a Cosine in 2^-28 and wrong by less than 2^-23, always downward; a dot
// product, which shifts the lower parts of its three products together, by three times as much. With every point within
// 62.5 of the middle of the scene, in these units:
//   a difference of points  |v| <= 125 2^16; |v.d| <= 125 2^24 (1 + 2^-18) < 2^31; sums of upper parts count modulo
//                           2^32, that of the lower ones is at most (|v| / 32 + sqrt(3)) sqrt(3) 4095 < 1.82e9
//   a distance t            at most length_max, so that t d fits for |d| <= 1 + 2^-10: (130900 2^14)(1 + 2^-10) < 2^31
//   parts of a unit vector  a bent direction's are up to 5/4 each: 3 (5/4)^2 2^28 < 2^31, lower parts 3 (5/4) 2^27
//   a square                of what is block-scaled to less than 370727: a b / 2^6, by two products; its sum is less
//                           than 2^31, and that it is rounded down by less than 1 is less than what one ulp of the root
//                           is worth
//   a radius                block-scaled with its slack to 368000. What passes the coarse test is not longer than
//                           radius and slack: that test adds 21 2^-10 and is off by 20, with roundings less than 2688
//                           ulp together
//   a cone                  is q32's, 2^8 and 2^10 times lengths and unit vectors, with products of 64 bits
//   a sheared corner        |x dz - z dx| <= |v| |d| < 2^31, rounded: the same for all edges that meet in it, so that
//                           meshes have no leak; the product of two takes 64 bits
//   a colour                below 8 in 2^-13, times a share of 14 bits: less than 2^30
//   a ratio of indices      below 8 in 2^-17, as a above: a bent direction is less than 10 2^25
// The builder keeps these bounds, as for q16.
#pragma once

#include "q16.hpp"
#include "q32.hpp"

namespace qray {

namespace detail {

// The unit vector along (x, y, z) != 0, each component less than 2^31 - 2^15. Each of its components is within 1.54 ulp
// of 2^-20: 0.5 for (x, y, z) rounded to 21 bits, 0.5 for m to as many, 0.5 for the result, and 2^-5 for what products
// drop; of which its length has less than 0.5 + (0.5 + 2^-5) sqrt(3).
QRAY_SHARED constexpr bool unit_split(int32_t x, int32_t y, int32_t z, int32_t* u)
{
    // The magnitudes, those of negative numbers less one.
    const uint32_t bits = static_cast<uint32_t>((x ^ (x >> 31)) | (y ^ (y >> 31)) | (z ^ (z >> 31)));
    // The largest from 2^20 to 2^21.
    const int up = count_leading_zeros(bits | 1) - 11;
    if (up >= 0) {
        x *= 1 << up;
        y *= 1 << up;
        z *= 1 << up;
    } else {
        const int32_t half = 1 << (-up - 1);
        x = (x + half) >> -up;
        y = (y + half) >> -up;
        z = (z + half) >> -up;
    }
    const auto square = [](int32_t v) { return square_high(static_cast<uint32_t>(v < 0 ? -v : v) << 10); };
    uint32_t sum = square(x) + square(y) + square(z); // |v|^2 / 2^12, from 2^28 to 3 2^30
    if (sum == 0)
        return false;
    int down = 10;
    if (sum >> 30 == 0) {
        sum <<= 2;
        down = 9;
    }
    // 2^20 / sqrt(sum / 2^32), up to 2^21: a part is less than 2^30.
    const int32_t m = static_cast<int32_t>(((rsqrt_mantissa(sum, 0) >> 10) + 1) >> 1);
    const int32_t half = 1 << (down - 1);
    const auto part = [m, down, half](int32_t v) {
        return (v * (m >> 12) + ((v >> 5) * (m & 4095) >> 7) + half) >> down;
    };
    u[0] = part(x);
    u[1] = part(y);
    u[2] = part(z);
    return true;
}

// 8 sqrt(x), to 1 and 2^-21 of itself: as isqrt().
constexpr int32_t root_split(uint32_t x)
{
    if (x == 0)
        return 0;
    const int pairs = leading_zero_pairs(x);
    return static_cast<int32_t>(((root_of_top(x << (2 * pairs)) >> (4 + pairs)) + 1) >> 1);
}

} // namespace detail

// The products of a Length (16), a Unit (20), a Colour (13) and a ratio of indices (17).
template <int A, int B>
inline constexpr int product_frac = A == 16 && B == 16 ? 26 : A == 13 || B == 13 ? 27 : A + B - 12;
template <int A, int B>
QRAY_INLINE constexpr Wide<product_frac<A, B>, 24> operator*(Fixed<A, 24> a, Fixed<B, 24> b)
{
    const auto upper = [](int32_t u, int32_t v) { return static_cast<uint32_t>(u) * static_cast<uint32_t>(v); };
    if constexpr (A == 20 && B != 20) {
        return b * a;
    } else if constexpr (A == 16 && B == 16) {
        const auto lower = static_cast<uint32_t>(a.raw * (b.raw & 511) >> 6);
        return {static_cast<int32_t>((upper(a.raw, b.raw >> 9) << 3) + lower)};
    } else {
        static_assert(B == 20);
        if constexpr (A == 13)
            return {a.raw * (b.raw >> 6)};
        else
            return {static_cast<int32_t>(upper(a.raw, b.raw >> 12)
                                         + static_cast<uint32_t>((a.raw >> 5) * (b.raw & 4095) >> 7))};
    }
}

struct q24 : FixedNumbers<16, 20, 13, 17, 24> {
    using Span = int32_t; // a component of a direction that is not yet a unit vector
    static constexpr Length length_max{130900 << 6};
    // Cones, whose sums lose more than a step off the surface makes good, are met in q32, and keep its block scale.
    using Longer = q32;
    static constexpr Blocks blocks{2688, {-4, 7, 368000}, {8, 18, Longer::blocks.cone.size}};
    static constexpr int ratio_bits = 18;

    template <int A>
    QRAY_INLINE static constexpr Wide<product_frac<A, 20>, 24> dot(Fixed<A, 24> ax, Fixed<A, 24> ay, Fixed<A, 24> az,
                                                                   Unit bx, Unit by, Unit bz)
    {
        const auto upper = [](int32_t a, int32_t u) {
            return static_cast<uint32_t>(a) * static_cast<uint32_t>(u >> 12);
        };
        const auto lower = [](int32_t a, int32_t u) { return (a >> 5) * (u & 4095); };
        return {static_cast<int32_t>(
            upper(ax.raw, bx.raw) + upper(ay.raw, by.raw) + upper(az.raw, bz.raw)
            + static_cast<uint32_t>((lower(ax.raw, bx.raw) + lower(ay.raw, by.raw) + lower(az.raw, bz.raw)) >> 7))};
    }
    // Of a block-scaled vector.
    QRAY_INLINE static constexpr Area norm2(Length x, Length y, Length z) { return x * x + y * y + z * z; }
    // Is (x, y, z) longer than r? For r beyond 26000 squares are in 2^14.
    QRAY_INLINE static constexpr bool beyond(Length x, Length y, Length z, Length r)
    {
        using detail::is_outside, detail::square;
        if (is_outside(x.raw, r.raw) || is_outside(y.raw, r.raw) || is_outside(z.raw, r.raw))
            return true;
        if (r.raw < 26000)
            return square(x.raw) + square(y.raw) + square(z.raw) > square(r.raw);
        return long_square(x) + long_square(y) + long_square(z) > long_square(r);
    }

    // Block scale: a - b times 2^fine with one rounding. The caller knows that the difference is less than what may be
    // squared, and may well pass terms that are not: they count modulo 2^32.
    QRAY_INLINE static constexpr Length fine_sub(Moment a, Length b, int32_t fine)
    {
        const int32_t down = Moment::frac - Length::frac - fine;
        constexpr int up = Moment::frac - Length::frac;
        const uint32_t w = static_cast<uint32_t>(a.raw) - (static_cast<uint32_t>(b.raw) << up);
        return {(static_cast<int32_t>(w) + (1 << (down - 1))) >> down};
    }
    // And back; the scale may be coarser than Length.
    QRAY_INLINE static constexpr Length fine(Length a, int32_t fine)
    {
        return {fine >= 0 ? a.raw * (1 << fine) : a.raw >> -fine};
    }
    QRAY_INLINE static constexpr Length coarse(Length a, int32_t fine)
    {
        return fine >= 0 ? FixedNumbers::coarse(a, fine) : Length{a.raw * (1 << -fine)};
    }
    QRAY_INLINE static constexpr Length coarse_below(Length a, int32_t fine)
    {
        return fine >= 0 ? FixedNumbers::coarse_below(a, fine) : coarse(a, fine);
    }
    // At least 3 ulp more than a / 2^fine, and than what is rounded to a.
    QRAY_INLINE static constexpr Length coarse_above(Length a, int32_t fine)
    {
        return {(fine >= 0 ? a.raw >> fine : (a.raw + 1) * (1 << -fine)) + 4};
    }

    // Square roots to 1 ulp, and to the nearest; the radicand must not be negative.
    static constexpr Length sqrt(Area a) { return {detail::root_split(static_cast<uint32_t>(a.raw))}; }
    static constexpr Length root(Area a) { return sqrt(a); }
    static constexpr Unit sqrt_unit(Cosine a) { return {static_cast<int32_t>(isqrt(int64_t{a.raw} * 4096))}; }

    // t = 2^k num / den for k <= most_headroom, within 1 ulp. False where den is 0, t exceeds length_max, or num is 0
    // and den next to nothing.
    template <int A, int B>
    static constexpr bool quotient(Wide<A, 24> num, Wide<B, 24> den, int k, Length& t)
    {
        return quotient(num.raw, den.raw, k + B - A + Length::frac, t.raw);
    }

    // The direction (x, y, z), of any length but 0, as a unit vector: see unit_split(). False for 0.
    static constexpr bool normalise(int32_t x, int32_t y, int32_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        int32_t u[3];
        if (!detail::unit_split(x, y, z, u))
            return false;
        ux = {u[0]};
        uy = {u[1]};
        uz = {u[2]};
        return true;
    }
    template <class T>
    static constexpr bool normalise(T x, T y, T z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise(x.raw, y.raw, z.raw, ux, uy, uz);
    }

    // v / r as a Unit, for |v| <= about r, with r 2^shift in [2^17, 2^18), or more and shift 0, and
    // mantissa = 2^32 / (r 2^shift): to 16 bits.
    QRAY_INLINE static constexpr Unit ratio(Length v, Scale inverse_r)
    {
        return {((((v.raw << inverse_r.shift) + 4) >> 3) * inverse_r.mantissa + (1 << 8)) >> 9};
    }

    // n (3 - |n|^2) / 2: makes a vector unit whose length is 1 but for 2^-7.
    QRAY_INLINE static constexpr void sharpen(Unit& x, Unit& y, Unit& z)
    {
        const int32_t excess = dot(x, y, z, x, y, z).raw - (1 << Cosine::frac), half = (excess + (1 << 8)) >> 9;
        const auto part = [half](Unit c) { return ((c.raw >> 4) * half + (1 << 15)) >> 16; };
        x.raw -= part(x);
        y.raw -= part(y);
        z.raw -= part(z);
    }

    // How far a new ray starts from the surface it leaves: 4 ulp along the geometric normal.
    QRAY_INLINE static constexpr Length leave(Unit g) { return {(g.raw + (1 << 17)) >> 18}; }

    // What 14 bits tell as well, is as in q16.
    QRAY_INLINE static constexpr Length saturating_sub(Length a, Length b) { return a - b; }
    QRAY_INLINE static constexpr Colour saturating_add(Colour a, Colour b)
    {
        return {q16::saturating_add({a.raw}, {b.raw}).raw};
    }
    template <int F>
    static constexpr bool weights(Wide<F, 32> a, Wide<F, 32> b, Wide<F, 32> c, Unit& wa, Unit& wb, Unit& wc)
    {
        q16::Unit w[3]{};
        const bool some = q16::weights(a, b, c, w[0], w[1], w[2]);
        wa = longer(w[0]);
        wb = longer(w[1]);
        wc = longer(w[2]);
        return some;
    }
    QRAY_INLINE static constexpr Unit power_whole(Unit x, Shine e) { return longer(q16::power_whole(shorter(x), e)); }
    QRAY_INLINE static constexpr Unit power(Unit x, Shine e) { return longer(q16::power(shorter(x), e)); }

    // A hit within this of a light is a hit at the light.
    static constexpr Length light_clearance{16};

private:
    QRAY_INLINE static constexpr Unit longer(q16::Unit u) { return {u.raw * 64}; }
    QRAY_INLINE static constexpr q16::Unit shorter(Unit u) { return {(u.raw + 32) >> 6}; }
    // a^2 / 2^14, up to 2 too low, for |a| <= 2^22.
    QRAY_INLINE static constexpr uint32_t long_square(Length a)
    {
        const uint32_t m = magnitude(a.raw), high = m >> 11, low = m & 2047;
        return (high * high << 8) + ((high * low + (low * low >> 12)) >> 2);
    }
    QRAY_SHARED static constexpr bool quotient(int32_t num, int32_t den, int k, int32_t& t)
    {
        const auto product = [](uint32_t n, uint32_t d) { return mul_high(n, detail::reciprocal_mantissa(d)); };
        return detail::quotient_by<7>(product, num, den, k, length_max.raw, t);
    }
};

static_assert(NumberSystem<q24> && NarrowFixed<q24>);

} // namespace qray
