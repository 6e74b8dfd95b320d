// q32: lengths of 32 bits, products of 64, for parts without a floating-point unit.
#pragma once

#include "system.hpp"

namespace qray {

struct q32 : FixedNumbers<24, 30, 28, 27, 32> {
    using Span = int64_t; // a component of a direction that is not yet a unit vector
    static_assert(Unit::frac == 30); // as unit_vector() and powers have

    static constexpr Length length_max{INT32_MAX};
    static constexpr Blocks blocks{1 << 20, {0, 10, 535193190}, {0, 10, 40 << 24}}; // 1/16, 31.9, 40
    // Rounded down: 0 or more if w is.
    QRAY_INLINE static constexpr Length length_below(Moment w) { return {static_cast<int32_t>(w.raw >> Unit::frac)}; }
    template <int A, int B>
    QRAY_INLINE static constexpr Wide<A + B, 32> dot(Fixed<A, 32> ax, Fixed<A, 32> ay, Fixed<A, 32> az,
                                                       Fixed<B, 32> bx, Fixed<B, 32> by, Fixed<B, 32> bz)
    {
        return {wide_dot(ax.raw, ay.raw, az.raw, bx.raw, by.raw, bz.raw)};
    }
    QRAY_INLINE static constexpr Area norm2(Length x, Length y, Length z)
    {
        return {static_cast<int64_t>(wide_norm2(x.raw, y.raw, z.raw))};
    }

    // a - b, clamped to the range of Length.
    QRAY_INLINE static constexpr Length saturating_sub(Length a, Length b)
    {
        return {qray::saturating_sub(a.raw, b.raw)};
    }
    // a + b >= 0, clamped.
    QRAY_INLINE static constexpr Colour saturating_add(Colour a, Colour b)
    {
        return {qray::saturating_add(a.raw, b.raw)};
    }

    // Block scale: a - b times 2^fine with one rounding, and back. fine is in [0, Unit::frac - 1]; the caller knows
    // that the difference is small enough.
    QRAY_INLINE static constexpr Length fine_sub(Moment a, Length b, int32_t fine)
    {
        const int64_t w = a.raw - (int64_t{b.raw} * (int64_t{1} << Unit::frac));
        return {rounding_shift(w, Unit::frac - fine)};
    }
    // What rounding took off: (a - b) 2^fine, rounded down, for b = length(a).
    QRAY_INLINE static constexpr Length fine_rest(Moment a, Length b, int32_t fine)
    {
        const uint32_t w = static_cast<uint32_t>(a.raw) - (static_cast<uint32_t>(b.raw) << Unit::frac);
        return {static_cast<int32_t>(w) >> (Unit::frac - fine)};
    }
    QRAY_INLINE static constexpr Length fine(Length a, int32_t fine) { return {shift_left(a.raw, fine)}; }
    // At least 2 ulp more than a / 2^fine.
    QRAY_INLINE static constexpr Length coarse_above(Length a, int32_t fine) { return {(a.raw >> fine) + 3}; }

    // Square roots to the nearest; the radicand must not be negative.
    static constexpr Length sqrt(Area a) { return {static_cast<int32_t>(isqrt(a.raw))}; }
    static constexpr Length root(Area a) { return sqrt(a); }
    static constexpr Unit sqrt_unit(Cosine a) { return {static_cast<int32_t>(isqrt(a.raw))}; }

    // sqrt(b^2 - a c) for |a| < 1/8, |b| < 2^8, |c| < 2^14, or false where that is negative. Block-scaled: b
    // to 30 bits, a and c to 61 together, the longer of them first.
    QRAY_SHARED static constexpr bool small_discriminant(Moment b, Cosine a, Area c, Moment& root)
    {
        const auto bits = [](int64_t v) { return 64 - count_leading_zeros(static_cast<uint64_t>(v < 0 ? -v : v) | 1); };
        const int in_a = bits(a.raw), in_c = bits(c.raw);
        const int of_b = bits(b.raw) - 30, half = (in_a + in_c - 60) >> 1;
        int drop = of_b > half ? of_b : half;
        drop = drop > 0 ? drop : 0;
        int of_a = (in_a - in_c + 2 * drop) / 2;
        of_a = of_a < 0 ? 0 : of_a > 2 * drop ? 2 * drop : of_a;
        const int64_t scaled = b.raw >> drop;
        const int64_t d = scaled * scaled - (a.raw >> of_a) * (c.raw >> (2 * drop - of_a));
        if (d < 0)
            return false;
        root = {static_cast<int64_t>(static_cast<uint64_t>(isqrt(d)) << drop)};
        return true;
    }
    // sqrt(a b) to 2 ulp of a Unit and a Length, or 0 and false where that is negative.
    QRAY_SHARED static constexpr bool root_of_product(Cosine a, Area b, Moment& root)
    {
        const bool real = (a.raw < 0) == (b.raw < 0);
        root = sqrt_unit({a.raw < 0 ? -a.raw : a.raw}) * sqrt({real ? b.raw < 0 ? -b.raw : b.raw : 0});
        return real;
    }
    QRAY_INLINE static constexpr bool is_small(Cosine a) { return is_below<3>(a); }

    // t = 2^k num / den, within 2 ulp. False where den is 0 or t does not fit Length.
    template <int A, int B>
    static constexpr bool quotient(Wide<A, 32> num, Wide<B, 32> den, int k, Length& t)
    {
        static_assert(B - A == Unit::frac - Length::frac);
        if (den.raw == 0)
            return false;
        // Two's complement magnitudes: |den| < 2^63 by the range of its terms.
        const int64_t n =
            den.raw < 0 ? static_cast<int64_t>(0 - static_cast<uint64_t>(int64_t{num.raw})) : int64_t{num.raw};
        const uint64_t d = magnitude(den.raw);
        const int lz = count_leading_zeros(d);
        const uint32_t top = static_cast<uint32_t>((d << lz) >> 32);
        int shift = Unit::frac - 32 + lz + k;
        int64_t m = n;
        if (shift < 0) {
            m >>= -shift;
            shift = 0;
        }
        if (shift > 32) {
            if (count_leading_zeros(magnitude(m)) <= shift - 32 + 1)
                return false;
            m = static_cast<int64_t>(static_cast<uint64_t>(m) << (shift - 32));
            shift = 32;
        }
        t = Length{divide(m, top, shift)};
        return t.raw != INT32_MAX && t.raw != -INT32_MAX;
    }

    // The direction (x, y, z), of any length but 0, as a unit vector: each component within 0.81 ulp. False for 0.
    static constexpr bool normalise(int32_t x, int32_t y, int32_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        int32_t u[3]{};
        if (!unit_vector(x, y, z, u))
            return false;
        ux = {u[0]};
        uy = {u[1]};
        uz = {u[2]};
        return true;
    }
    template <int F>
    static constexpr bool normalise(Fixed<F, 32> x, Fixed<F, 32> y, Fixed<F, 32> z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise(x.raw, y.raw, z.raw, ux, uy, uz);
    }
    // The same, but cut to 31 bits before: each component within 1.81 ulp. What is shorter than 2^32 loses
    // its lowest bit. Where a product is a call, a function by itself takes less stack.
    static constexpr bool normalise(int64_t x, int64_t y, int64_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise_here(x, y, z, ux, uy, uz);
    }
    // The same in the caller: for what is done for each ray, or pixel.
    QRAY_INLINE static constexpr bool normalise_here(int64_t x, int64_t y, int64_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        if constexpr (!has_wide_multiply) {
            int32_t u[3]{};
            const bool known = unit_vector(x, y, z, u);
            ux = {u[0]};
            uy = {u[1]};
            uz = {u[2]};
            return known;
        }
        const int up = detail::top_bits(x, y, z);
        return normalise(detail::top_word(x, up), detail::top_word(y, up), detail::top_word(z, up), ux, uy, uz);
    }
    template <int F>
    static constexpr bool normalise(Wide<F, 32> x, Wide<F, 32> y, Wide<F, 32> z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise(x.raw, y.raw, z.raw, ux, uy, uz);
    }

    // v / r as a Unit, for |v| <= about r: one rounding.
    QRAY_INLINE static constexpr Unit ratio(Length v, Scale inverse_r)
    {
        const int64_t w = wide_mul(shift_left(v.raw, inverse_r.shift), inverse_r.mantissa);
        constexpr int down = 61 - Unit::frac;
        return {static_cast<int32_t>((w + (int64_t{1} << (down - 1))) >> down)};
    }

    // n (3 - |n|^2) / 2: makes a vector unit whose length is 1 but for 2^-15.
    QRAY_INLINE static constexpr void sharpen(Unit& x, Unit& y, Unit& z)
    {
        const Cosine excess = x * x + y * y + z * z - one * one;
        const Unit h{static_cast<int32_t>(excess.raw >> (Unit::frac + 1))};
        x = x - unit(x * h);
        y = y - unit(y * h);
        z = z - unit(z * h);
    }

    // Three areas of one sign (rounding may leave one beyond 0) as weights in their proportion, the largest
    // near 1. False where all are 0.
    static constexpr bool weights(Area a, Area b, Area c, Unit& wa, Unit& wb, Unit& wc)
    {
        const int64_t other = magnitude(b.raw) > magnitude(c.raw) ? b.raw : c.raw;
        const bool flip = (magnitude(a.raw) > magnitude(other) ? a.raw : other) < 0;
        const auto size = [flip](int64_t v) {
            v = flip ? -v : v;
            return v < 0 ? 0 : static_cast<uint64_t>(v);
        };
        const uint64_t x = size(a.raw), y = size(b.raw), z = size(c.raw);
        const int zeros = count_leading_zeros(x | y | z);
        if (zeros == 64)
            return false;
        const auto weight = [zeros](uint64_t v) { return Unit{static_cast<int32_t>(v << zeros >> (64 - Unit::frac))}; };
        wa = weight(x);
        wb = weight(y);
        wc = weight(z);
        return true;
    }

    // How far a new ray that goes on with a picture starts, if its cosine with the normal is at least this: along
    // itself, as high as leave() steps, or higher.
    static constexpr Unit steep{one.raw / 16};
    QRAY_INLINE static constexpr Length leave_along(Unit d)
    {
        return {(d.raw + (1 << (Unit::frac - 6))) >> (Unit::frac - 5)};
    }

    // A hit within this of a light is a hit at the light.
    static constexpr Length light_clearance{16};

    // x^e for x in [0, 1].
    QRAY_INLINE static constexpr Unit power_whole(Unit x, Shine e)
    {
        return {static_cast<int32_t>(pow_whole(static_cast<uint32_t>(x.raw), e.whole))};
    }
    QRAY_INLINE static constexpr Unit power(Unit x, Shine e)
    {
        return {static_cast<int32_t>(pow_unit(static_cast<uint32_t>(x.raw), e))};
    }

    QRAY_INLINE static constexpr int32_t shift_left(int32_t v, int by)
    {
        return by >= 0 ? static_cast<int32_t>(static_cast<uint32_t>(v) << by) : v >> -by;
    }
};

static_assert(NumberSystem<q32> && WideFixed<q32>);

} // namespace qray
