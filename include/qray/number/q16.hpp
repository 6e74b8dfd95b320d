// q16, the cheap number system: no product needs more than the 32 bits that a Cortex-M0 multiplies in one step.
//
// Of the 31 bits beside the sign that a product of a length and a unit vector has, the vector takes 14 and the length
// 17; lengths that are squared have 15. In units of 2^-10, with every point within 62.5 of the middle of the scene:
//   a coordinate            at most 64000 < 2^16
//   a difference of points  |v| <= 128000 < 2^17; |v.d| <= |v| |d| < 2^31 - 2^24, partial sums too (Cauchy-Schwarz)
//   a distance t            at most length_max, so that t d fits for |d| <= 1 + 2^-11
//   a radius                block-scaled up to 2^15, 36700 as it is: (2^15 + 5120)^2 < 2^31, past the coarse test
//   a cone's ball           block-scaled to B <= 18432: |U| <= 2.45 B < sqrt(2^31), half B + root < 2^31 (see cone.hpp)
//   a sheared corner        not rounded at all: |x dz - z dx| <= |v| |d| < 2^31; the product of two takes 64 bits
//   a colour                below 8, so that its product with 1 is less than 2^30
// The builder keeps these bounds, and refuses scenes of which too little would be left: see Limits::narrow_radius.
#pragma once

#include "system.hpp"

namespace qray {

namespace detail {

// 2^15 / sqrt(v / 2^32) for v in [2^30, 2^32): at most 2^16 - 1, relative error at most 2^-15.4.
constexpr int32_t rsqrt_short(uint32_t v)
{
    const uint32_t y = rsqrt_seed(v);
    // e = 1 - v y^2, |e| < 2^-10.9, is known from the lower bits alone, in 2^-41; then y (1 + e/2).
    const int32_t e = -static_cast<int32_t>((((v >> 14) + 1) >> 1) * y * y);
    const int32_t root = static_cast<int32_t>(y << 3) + ((static_cast<int32_t>(y) * (e >> 15) + (1 << 23)) >> 24);
    return root > 0xffff ? 0xffff : root;
}

// 2^47 / d for d in [2^31, 2^32): at most 2^16 - 1, relative error at most 2^-15.
constexpr uint32_t reciprocal_short(uint32_t d)
{
    const uint32_t y = rsqrt_seed(d);
    const uint32_t v = y * y >> 10; // Q2.14
    const int32_t e = (1 << 30) - static_cast<int32_t>((((d >> 15) + 1) >> 1) * v);
    const uint32_t r = (v << 1) + static_cast<uint32_t>((static_cast<int32_t>(v) * (e >> 4) + (1 << 24)) >> 25);
    return r > 0xffff ? 0xffff : r;
}

// The unit vector along (x, y, z) != 0, each component less than 2^31 - 2^15: within 1 ulp of 2^-Frac.
template <int Frac>
QRAY_SHARED constexpr bool unit_short(int32_t x, int32_t y, int32_t z, int32_t* u)
{
    static_assert(Frac == 14);
    // The magnitudes, those of negative numbers less one.
    const uint32_t bits = static_cast<uint32_t>((x ^ (x >> 31)) | (y ^ (y >> 31)) | (z ^ (z >> 31)));
    // The largest to 16 bits.
    const int up = count_leading_zeros(bits | 1) - 16;
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
    const int32_t hx = (x + 1) >> 1, hy = (y + 1) >> 1, hz = (z + 1) >> 1;
    uint32_t square = static_cast<uint32_t>(hx * hx) + static_cast<uint32_t>(hy * hy) + static_cast<uint32_t>(hz * hz);
    if (square == 0)
        return false;
    int halve = 3;
    if (square >> 30 == 0) {
        square <<= 2;
        halve = 2;
    }
    // 2^15 + m is 2^31 / sqrt(square); each product x m is less than 2^31.
    const int32_t m = rsqrt_short(square) - (1 << 15);
    const int32_t half = 1 << (halve - 1);
    u[0] = (x + (x * m >> 15) + half) >> halve;
    u[1] = (y + (y * m >> 15) + half) >> halve;
    u[2] = (z + (z * m >> 15) + half) >> halve;
    return true;
}

// Is v beyond +-r?
QRAY_INLINE constexpr bool is_outside(int32_t v, int32_t r)
{
    return static_cast<uint32_t>(v + r) > static_cast<uint32_t>(r) * 2;
}
QRAY_INLINE constexpr uint32_t square(int32_t v) { return static_cast<uint32_t>(v) * static_cast<uint32_t>(v); }

// t = 2^k num / den. False where den is 0, t exceeds `most`, as all do that are shifted down by less than Least, or num
// is 0 and den next to nothing. product(n, d), of numbers from 2^31 to 2^32, is 2^31 n / d.
template <int Least, class Product>
QRAY_INLINE constexpr bool quotient_by(Product product, int32_t num, int32_t den, int k, int32_t most, int32_t& t)
{
    uint32_t n = magnitude(num), d = magnitude(den);
    if (d == 0)
        return false;
    const int n_zeros = count_leading_zeros(n | 1), d_zeros = count_leading_zeros(d);
    const int down = 31 - k + n_zeros - d_zeros;
    if (down < Least)
        return false;
    const uint32_t q = product(n << n_zeros, d << d_zeros);
    n = down > 32 ? 0 : ((q >> (down - 1)) + 1) >> 1;
    if (n > static_cast<uint32_t>(most))
        return false;
    t = (num ^ den) < 0 ? -static_cast<int32_t>(n) : static_cast<int32_t>(n);
    return true;
}

} // namespace detail

struct q16 : FixedNumbers<10, 14, 13, 13, 16> {
    static constexpr Blocks blocks{8, {0, 10, 32665}, {0, 10, 18432}};
    static constexpr int ratio_bits = 15;
    using Span = int32_t; // a component of a direction that is not yet a unit vector
    static constexpr Length length_max{130900};
    template <int A, int B>
    QRAY_INLINE static constexpr Wide<A + B, 16> dot(Fixed<A, 16> ax, Fixed<A, 16> ay, Fixed<A, 16> az,
                                                     Fixed<B, 16> bx, Fixed<B, 16> by, Fixed<B, 16> bz)
    {
        return {ax.raw * bx.raw + ay.raw * by.raw + az.raw * bz.raw};
    }
    // Of a vector of at most 46340.
    QRAY_INLINE static constexpr Area norm2(Length x, Length y, Length z)
    {
        return {x.raw * x.raw + y.raw * y.raw + z.raw * z.raw};
    }
    // Is (x, y, z) longer than r? For r beyond 37800 to 4 ulp, and in doubt no.
    QRAY_INLINE static constexpr bool beyond(Length x, Length y, Length z, Length r)
    {
        using detail::is_outside, detail::square;
        if (is_outside(x.raw, r.raw) || is_outside(y.raw, r.raw) || is_outside(z.raw, r.raw))
            return true;
        if (r.raw > 37800) {
            x.raw = (x.raw + 1) >> 1;
            y.raw = (y.raw + 1) >> 1;
            z.raw = (z.raw + 1) >> 1;
            r.raw = (r.raw >> 1) + 1;
        }
        return square(x.raw) + square(y.raw) + square(z.raw) > square(r.raw);
    }

    // a - b, clamped to the range of Length: here it fits.
    QRAY_INLINE static constexpr Length saturating_sub(Length a, Length b) { return a - b; }
    // a + b >= 0, clamped to what is white by far.
    QRAY_INLINE static constexpr Colour saturating_add(Colour a, Colour b)
    {
        constexpr int32_t limit = int32_t{1} << 24;
        const int32_t sum = a.raw + b.raw;
        return {sum < limit ? sum : limit};
    }

    // Block scale: a - b times 2^fine with one rounding, and back. fine is in [0, 12]; the caller knows that the
    // difference is less than 2^16 ulp, and may well pass terms that are not: they count modulo 2^32.
    QRAY_INLINE static constexpr Length fine_sub(Moment a, Length b, int32_t fine)
    {
        const int32_t down = Unit::frac - fine;
        const int32_t w =
            static_cast<int32_t>(static_cast<uint32_t>(a.raw) - (static_cast<uint32_t>(b.raw) << Unit::frac));
        return {(w + (1 << (down - 1))) >> down};
    }
    QRAY_INLINE static constexpr Length fine(Length a, int32_t fine)
    {
        return {a.raw * (1 << fine)};
    }
    // At least 3 ulp more than a / 2^fine.
    QRAY_INLINE static constexpr Length coarse_above(Length a, int32_t fine)
    {
        return {(a.raw >> fine) + 4};
    }

    // Square roots to the nearest; the radicand must not be negative.
    static constexpr Length sqrt(Area a) { return {static_cast<int32_t>(isqrt(static_cast<uint32_t>(a.raw)))}; }
    static constexpr Length root(Area a) { return sqrt(a); }
    static constexpr Unit sqrt_unit(Cosine a) { return {static_cast<int32_t>(isqrt(static_cast<uint32_t>(a.raw)))}; }

    // t = 2^k num / den for k <= most_headroom, relative error at most 2^-14. False where den is 0, t exceeds
    // length_max, or num is 0 and den next to nothing.
    template <int A, int B>
    static constexpr bool quotient(Wide<A, 16> num, Wide<B, 16> den, int k, Length& t)
    {
        static_assert(B - A == Unit::frac - Length::frac);
        return quotient(num.raw, den.raw, k, t.raw);
    }

    // The direction (x, y, z), of any length but 0, as a unit vector: each component within 1 ulp. False for 0.
    static constexpr bool normalise(int32_t x, int32_t y, int32_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        int32_t u[3];
        if (!detail::unit_short<Unit::frac>(x, y, z, u))
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

    // v / r as a Unit, for |v| <= about r, with r 2^shift in [2^14, 2^15), or r < 36700 and shift 0, and
    // mantissa = 2^(15 + Unit::frac) / (r 2^shift).
    QRAY_INLINE static constexpr Unit ratio(Length v, Scale inverse_r)
    {
        return {((v.raw << inverse_r.shift) * inverse_r.mantissa + (1 << 14)) >> 15};
    }

    // n (3 - |n|^2) / 2: makes a vector unit whose length is 1 but for 2^-7.
    QRAY_INLINE static constexpr void sharpen(Unit& x, Unit& y, Unit& z)
    {
        const Cosine excess = x * x + y * y + z * z - one * one;
        const Unit h{(excess.raw + (1 << Unit::frac)) >> (Unit::frac + 1)};
        x = x - unit(x * h);
        y = y - unit(y * h);
        z = z - unit(z * h);
    }

    // Three areas of one sign (rounding may leave one beyond 0) as weights in their proportion, the largest
    // near 1. False where all are 0.
    template <int F>
    static constexpr bool weights(Wide<F, 32> a, Wide<F, 32> b, Wide<F, 32> c, Unit& wa, Unit& wb, Unit& wc)
    {
        // To 31 bits first.
        const uint64_t all = magnitude(a.raw) | magnitude(b.raw) | magnitude(c.raw);
        const int down = count_leading_zeros(all) > 33 ? 0 : 33 - count_leading_zeros(all);
        const auto word = [down](int64_t v) { return static_cast<int32_t>(v >> down); };
        const int32_t first = word(a.raw), second = word(b.raw), third = word(c.raw);
        const int32_t larger = magnitude(first) > magnitude(second) ? first : second;
        const bool flip = (magnitude(third) > magnitude(larger) ? third : larger) < 0;
        const auto size = [flip](int32_t v) {
            v = flip ? -v : v;
            return v < 0 ? 0 : static_cast<uint32_t>(v);
        };
        const uint32_t x = size(first), y = size(second), z = size(third);
        const int up = count_leading_zeros(x | y | z);
        if (up == 32)
            return false;
        const auto weight = [up](uint32_t v) { return Unit{static_cast<int32_t>(v << up >> (32 - Unit::frac))}; };
        wa = weight(x);
        wb = weight(y);
        wc = weight(z);
        return true;
    }

    QRAY_INLINE static constexpr bool nearly_zero(Cosine c) { return is_below<4>(c); }

    // A hit within this of a light is a hit at the light.
    static constexpr Length light_clearance{4};

    // x^e for x in [0, 1]: as exact as x itself is.
    static constexpr Unit power_whole(Unit x, Shine e)
    {
        if (x >= one || e.whole == 0)
            return one;
        uint32_t base = static_cast<uint32_t>(x.raw) << (16 - Unit::frac), result = 1 << 16;
        for (uint32_t n = e.whole;;) {
            if (n & 1)
                result = (result * base + (1 << 15)) >> 16;
            n >>= 1;
            if (n == 0)
                break;
            base = (base * base + (1 << 15)) >> 16;
            if (base == 0)
                return zero;
        }
        return {static_cast<int32_t>((result + (1 << (15 - Unit::frac))) >> (16 - Unit::frac))};
    }
    static constexpr Unit power(Unit x, Shine e)
    {
        const Unit whole = power_whole(x, e);
        if (e.fraction == 0)
            return whole;
        const uint32_t rest = pow_fraction(static_cast<uint32_t>(x.raw) << (30 - Unit::frac), e.fraction);
        return unit(whole * Unit{static_cast<int32_t>(rest >> (30 - Unit::frac))});
    }

private:
    QRAY_SHARED static constexpr bool quotient(int32_t num, int32_t den, int k, int32_t& t)
    {
        const auto product = [](uint32_t n, uint32_t d) {
            return (((n >> 15) + 1) >> 1) * detail::reciprocal_short(d);
        };
        return detail::quotient_by<14>(product, num, den, Unit::frac + k, length_max.raw, t);
    }
};

static_assert(NumberSystem<q16> && NarrowFixed<q16>);

} // namespace qray
