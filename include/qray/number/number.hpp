// Number systems. One names the types of the quantities of a ray tracer and every operation between
// them that the tracer needs:
//   Length  positions, distances along a ray, radii, in scene units after the builder's move and scale
//   Unit    components of unit vectors, cosines, weights and coefficients in [0, 1]
//   Colour  linear light after the builder's exposure scale, at most Colour's range
// Products are exact (in fixed point) and are summed before one rounding: length(), unit(), colour().
// The builder keeps every point within +-world of the origin, so that differences of points, and all
// distances between them, fit Length.
#pragma once

#include <stdint.h>

#include "fixed.hpp"
#include "math.hpp"

namespace qray {

// 1/r as a number system keeps it: for fixed point, v / r = (v << shift) * mantissa >> 31.
struct FixedScale {
    int32_t mantissa;
    int32_t shift;
};

template <int LengthFrac, int UnitFrac, int ColourFrac, int Bits>
struct FixedSystem {
    static_assert(Bits == 32 && UnitFrac == 30); // as unit_vector() has; for 16 bits: q16.hpp
    static constexpr bool is_fixed = true;
    static constexpr bool is_wide = true; // products take two registers on a 32-bit machine
    using Length = Fixed<LengthFrac, Bits>;
    using Unit = Fixed<UnitFrac, Bits>;
    using Colour = Fixed<ColourFrac, Bits>;
    using Eta = Fixed<UnitFrac - 3, Bits>; // ratio of refractive indices, up to 8
    using Area = Wide<2 * LengthFrac, Bits>;
    using Moment = Wide<LengthFrac + UnitFrac, Bits>; // a Length times a Unit
    using Cosine = Wide<2 * UnitFrac, Bits>;
    using Scale = FixedScale;
    using Shine = Exponent;

    static constexpr Length length_max{INT32_MAX};
    static constexpr Length length_zero{0};
    static constexpr Unit one{int32_t{1} << UnitFrac};
    static constexpr Unit zero{0};
    static constexpr Colour black{0};
    static constexpr Length ulp{1};

    template <int F>
    QRAY_INLINE static constexpr Length length(Wide<F, Bits> w) { return round_to<Length>(w); }
    // Rounded down: 0 or more if w is.
    QRAY_INLINE static constexpr Length length_below(Moment w) { return {static_cast<int32_t>(w.raw >> UnitFrac)}; }
    template <int F>
    QRAY_INLINE static constexpr Unit unit(Wide<F, Bits> w) { return round_to<Unit>(w); }
    template <int F>
    QRAY_INLINE static constexpr Colour colour(Wide<F, Bits> w) { return round_to<Colour>(w); }

    template <int A, int B>
    QRAY_INLINE static constexpr Wide<A + B, Bits> dot(Fixed<A, Bits> ax, Fixed<A, Bits> ay, Fixed<A, Bits> az,
                                                       Fixed<B, Bits> bx, Fixed<B, Bits> by, Fixed<B, Bits> bz)
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

    // Block scale: a - b times 2^fine with one rounding, and back. fine is in [0, UnitFrac - 1]; the caller knows
    // that the difference is small enough.
    QRAY_INLINE static constexpr Length fine_sub(Moment a, Length b, int32_t fine)
    {
        const int64_t w = a.raw - (int64_t{b.raw} * (int64_t{1} << UnitFrac));
        return {rounding_shift(w, UnitFrac - fine)};
    }
    // What rounding took off: (a - b) 2^fine, rounded down, for b = length(a).
    QRAY_INLINE static constexpr Length fine_rest(Moment a, Length b, int32_t fine)
    {
        const uint32_t w = static_cast<uint32_t>(a.raw) - (static_cast<uint32_t>(b.raw) << UnitFrac);
        return {static_cast<int32_t>(w) >> (UnitFrac - fine)};
    }
    QRAY_INLINE static constexpr Length coarse(Length a, int32_t fine)
    {
        return {(a.raw + (1 << fine >> 1)) >> fine};
    }
    QRAY_INLINE static constexpr Length fine(Length a, int32_t fine) { return {shift_left(a.raw, fine)}; }
    // At least 2 ulp more than a / 2^fine.
    QRAY_INLINE static constexpr Length coarse_above(Length a, int32_t fine) { return {(a.raw >> fine) + 3}; }

    // Square roots to the nearest; the radicand must not be negative.
    static constexpr Length sqrt(Area a) { return {static_cast<int32_t>(isqrt(static_cast<uint64_t>(a.raw)))}; }
    static constexpr Unit sqrt_unit(Cosine a) { return {static_cast<int32_t>(isqrt(static_cast<uint64_t>(a.raw)))}; }

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
        root = {static_cast<int64_t>(static_cast<uint64_t>(isqrt(static_cast<uint64_t>(d))) << drop)};
        return true;
    }
    // sqrt(a b) to 2 ulp of a Unit and a Length, or 0 and false where that is negative.
    QRAY_SHARED static constexpr bool root_of_product(Cosine a, Area b, Moment& root)
    {
        const bool real = (a.raw < 0) == (b.raw < 0);
        root = sqrt_unit({a.raw < 0 ? -a.raw : a.raw}) * sqrt({real ? b.raw < 0 ? -b.raw : b.raw : 0});
        return real;
    }
    QRAY_INLINE static constexpr bool is_small(Cosine a)
    {
        constexpr int64_t eighth = int64_t{1} << (2 * UnitFrac - 3);
        return -eighth < a.raw && eighth > a.raw;
    }

    // t = 2^k num / den, within 2 ulp. False where den is 0 or t does not fit Length.
    template <int A, int B>
    static constexpr bool quotient(Wide<A, Bits> num, Wide<B, Bits> den, int k, Length& t)
    {
        static_assert(B - A == UnitFrac - LengthFrac);
        if (den.raw == 0)
            return false;
        // Two's complement magnitudes: |den| < 2^63 by the range of its terms.
        const int64_t n =
            den.raw < 0 ? static_cast<int64_t>(0 - static_cast<uint64_t>(int64_t{num.raw})) : int64_t{num.raw};
        const uint64_t d = den.raw < 0 ? 0 - static_cast<uint64_t>(int64_t{den.raw}) : static_cast<uint64_t>(den.raw);
        const int lz = count_leading_zeros(d);
        const uint32_t top = static_cast<uint32_t>((d << lz) >> 32);
        int shift = UnitFrac - 32 + lz + k;
        int64_t m = n;
        if (shift < 0) {
            m >>= -shift;
            shift = 0;
        }
        if (shift > 32) {
            const uint64_t magnitude = m < 0 ? 0 - static_cast<uint64_t>(m) : static_cast<uint64_t>(m);
            if (count_leading_zeros(magnitude) <= shift - 32 + 1)
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
    static constexpr bool normalise(Fixed<F, Bits> x, Fixed<F, Bits> y, Fixed<F, Bits> z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise(x.raw, y.raw, z.raw, ux, uy, uz);
    }
    // The same, but cut to 31 bits before: each component within 1.81 ulp. What is shorter than 2^32 loses
    // its lowest bit.
    static constexpr bool normalise_wide(int64_t x, int64_t y, int64_t z, Unit& ux, Unit& uy, Unit& uz)
    {
        // To 31 bits: the upper words, joined by what the lower ones hold below them.
        int up = 31;
        if constexpr (sizeof(void*) == 8) {
            const int zeros =
                count_leading_zeros(static_cast<uint64_t>((x ^ (x >> 63)) | (y ^ (y >> 63)) | (z ^ (z >> 63))));
            up = zeros < 32 ? zeros - 1 : 31;
        } else {
            up = count_leading_zeros(high_magnitude(x) | high_magnitude(y) | high_magnitude(z)) - 1;
        }
        return normalise(top_word(x, up), top_word(y, up), top_word(z, up), ux, uy, uz);
    }
    template <int F>
    static constexpr bool normalise(Wide<F, Bits> x, Wide<F, Bits> y, Wide<F, Bits> z, Unit& ux, Unit& uy, Unit& uz)
    {
        return normalise_wide(x.raw, y.raw, z.raw, ux, uy, uz);
    }

    // v / r as a Unit, for |v| <= about r: one rounding.
    QRAY_INLINE static constexpr Unit ratio(Length v, Scale inverse_r)
    {
        const int64_t w = wide_mul(shift_left(v.raw, inverse_r.shift), inverse_r.mantissa);
        constexpr int down = 61 - UnitFrac;
        return {static_cast<int32_t>((w + (int64_t{1} << (down - 1))) >> down)};
    }

    // n (3 - |n|^2) / 2: makes a vector unit whose length is 1 but for 2^-15.
    QRAY_INLINE static constexpr void sharpen(Unit& x, Unit& y, Unit& z)
    {
        const Cosine excess = x * x + y * y + z * z - one * one;
        const Unit h{static_cast<int32_t>(excess.raw >> (UnitFrac + 1))};
        x = x - unit(x * h);
        y = y - unit(y * h);
        z = z - unit(z * h);
    }

    // Block scaling: the largest k with 2^k |a|, 2^k |b|, 2^k |c| all below 1.
    template <int F>
    static constexpr int headroom(Wide<F, Bits> a, Wide<F, Bits> b, Wide<F, Bits> c)
    {
        const uint64_t m = magnitude(int64_t{a.raw}) | magnitude(int64_t{b.raw}) | magnitude(int64_t{c.raw});
        return count_leading_zeros(m) - (64 - F);
    }
    template <int F>
    QRAY_INLINE static constexpr Wide<F, Bits> shifted(Wide<F, Bits> a, int k)
    {
        using Rep = typename Wide<F, Bits>::Rep;
        return {k >= 0 ? static_cast<Rep>(a.raw * (Rep{1} << k)) : static_cast<Rep>(a.raw >> -k)};
    }

    static constexpr int most_headroom = UnitFrac;

    // eta x, clamped to +-5/4: a bent direction longer than 1 is totally reflected, however long.
    QRAY_INLINE static constexpr Unit bent(Eta eta, Unit x)
    {
        using Bent = Wide<Eta::frac + UnitFrac, Bits>;
        constexpr typename Bent::Rep limit = typename Bent::Rep{5} << (Bent::frac - 2);
        const Bent w = eta * x;
        return round_to<Unit>(Bent{w.raw > limit ? limit : w.raw < -limit ? -limit : w.raw});
    }

    // Three areas of one sign (rounding may leave one beyond 0) as weights in their proportion, the largest
    // near 1. False where all are 0.
    static constexpr bool weights(Area a, Area b, Area c, Unit& wa, Unit& wb, Unit& wc)
    {
        const bool flip = magnitude(int64_t{a.raw}) > magnitude(int64_t{b.raw})
                && magnitude(int64_t{a.raw}) > magnitude(int64_t{c.raw})
            ? a.raw < 0
            : (magnitude(int64_t{b.raw}) > magnitude(int64_t{c.raw}) ? b.raw : c.raw) < 0;
        const int64_t x = flip ? -int64_t{a.raw} : int64_t{a.raw};
        const int64_t y = flip ? -int64_t{b.raw} : int64_t{b.raw};
        const int64_t z = flip ? -int64_t{c.raw} : int64_t{c.raw};
        const uint64_t ux = x < 0 ? 0 : static_cast<uint64_t>(x);
        const uint64_t uy = y < 0 ? 0 : static_cast<uint64_t>(y);
        const uint64_t uz = z < 0 ? 0 : static_cast<uint64_t>(z);
        const int lz = count_leading_zeros(ux | uy | uz);
        if (lz == 64)
            return false;
        const auto weight = [lz](uint64_t u) {
            return Unit{static_cast<int32_t>(u << lz >> (64 - UnitFrac))};
        };
        wa = weight(ux);
        wb = weight(uy);
        wc = weight(uz);
        return true;
    }

    // Is a plane with this d.n seen almost edge on? Then its equation does not tell where the ray meets it.
    QRAY_INLINE static constexpr bool nearly_zero(Cosine c)
    {
        constexpr typename Cosine::Rep limit = typename Cosine::Rep{1} << (UnitFrac + UnitFrac / 2);
        return limit > c.raw && -limit < c.raw;
    }

    // How far a new ray starts from the surface it leaves: 2 ulp along the geometric normal.
    QRAY_INLINE static constexpr Length leave(Unit g)
    {
        return {(g.raw + (1 << (UnitFrac - 2))) >> (UnitFrac - 1)};
    }

    // The same for a ray whose cosine with the normal is at least this, along the ray itself: as high, or higher.
    static constexpr Unit steep{one.raw / 16};
    QRAY_INLINE static constexpr Length leave_along(Unit d)
    {
        return {(d.raw + (1 << (UnitFrac - 6))) >> (UnitFrac - 5)};
    }

    // A hit within this of a light is a hit at the light.
    static constexpr Length light_clearance{16};

    // x^e for x in [0, 1].
    QRAY_INLINE static constexpr Unit power_whole(Unit x, Shine e)
    {
        return {static_cast<int32_t>(pow_whole(static_cast<uint32_t>(x.raw) << (30 - UnitFrac), e.whole)
                                     >> (30 - UnitFrac))};
    }
    QRAY_INLINE static constexpr Unit power(Unit x, Shine e)
    {
        return {static_cast<int32_t>(pow_unit(static_cast<uint32_t>(x.raw) << (30 - UnitFrac), e) >> (30 - UnitFrac))};
    }

    static constexpr uint32_t magnitude(int32_t v)
    {
        return v < 0 ? 0 - static_cast<uint32_t>(v) : static_cast<uint32_t>(v);
    }
    static constexpr uint64_t magnitude(int64_t v)
    {
        return v < 0 ? 0 - static_cast<uint64_t>(v) : static_cast<uint64_t>(v);
    }
    QRAY_INLINE static constexpr int32_t shift_left(int32_t v, int by)
    {
        return by >= 0 ? static_cast<int32_t>(static_cast<uint32_t>(v) << by) : v >> -by;
    }

private:
    static constexpr uint32_t high_magnitude(int64_t v)
    {
        const int32_t high = static_cast<int32_t>(v >> 32);
        return static_cast<uint32_t>(high ^ (high >> 31));
    }
    // The upper 32 bits of v 2^up, for up in [0, 31]; all below 2^31 of v if that is 31.
    static constexpr int32_t top_word(int64_t v, int up)
    {
        if constexpr (sizeof(void*) == 8)
            return static_cast<int32_t>(static_cast<uint64_t>(v) << up >> 32);
        const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(v) >> 32), low = static_cast<uint32_t>(v);
        return static_cast<int32_t>((high << up) | (low >> 1 >> (31 - up)));
    }
};

template <class F>
struct FloatSystem {
    static constexpr bool is_fixed = false;
    using Length = F;
    using Unit = F;
    using Colour = F;
    using Eta = F;
    using Area = F;
    using Moment = F;
    using Cosine = F;
    using Scale = F;
    struct Shine {
        uint32_t whole;
        F fraction;
    };

    static constexpr F epsilon = sizeof(F) == 4 ? F(1) / F(1 << 23) : F(1) / F(int64_t{1} << 52);
    static constexpr F length_max = sizeof(F) == 4 ? F(3e38f) : F(3e38f) * F(3e38f);
    static constexpr F length_zero = 0;
    static constexpr F one = 1;
    static constexpr F zero = 0;
    static constexpr F black = 0;
    static constexpr F ulp = F(64) * epsilon; // of the longest distances, up to 124
    static constexpr F least_square =
        sizeof(F) == 4 ? F(0x1p-100f) : F(0); // a sum of squares above it has all its bits

    QRAY_INLINE static constexpr F length(F v) { return v; }
    QRAY_INLINE static constexpr F unit(F v) { return v; }
    QRAY_INLINE static constexpr F colour(F v) { return v; }
    QRAY_INLINE static constexpr F dot(F ax, F ay, F az, F bx, F by, F bz) { return ax * bx + ay * by + az * bz; }
    QRAY_INLINE static constexpr F norm2(F x, F y, F z) { return x * x + y * y + z * z; }
    QRAY_INLINE static constexpr F saturating_sub(F a, F b) { return a - b; }
    QRAY_INLINE static constexpr F saturating_add(F a, F b) { return a + b; }
    QRAY_INLINE static constexpr F fine_sub(F a, F b, int32_t) { return a - b; }
    QRAY_INLINE static constexpr F coarse(F a, int32_t) { return a; }
    QRAY_INLINE static constexpr F fine(F a, int32_t) { return a; }
    QRAY_INLINE static constexpr F coarse_above(F a, int32_t) { return a; }
    QRAY_INLINE static constexpr F sqrt(F a)
    {
        if constexpr (sizeof(F) == 4)
            return sqrt_float(a);
        else
            return sqrt_double(a);
    }
    QRAY_INLINE static constexpr F sqrt_unit(F a) { return sqrt(a); }
    // Of a >= 0, but not -0.
    QRAY_INLINE static constexpr F root(F a)
    {
        if constexpr (sizeof(F) == 4)
            return root_float(a);
        else
            return sqrt_double(a);
    }
    QRAY_INLINE static constexpr bool quotient(F num, F den, int, F& t)
    {
        if (den == 0)
            return false;
        t = num / den;
        return t < length_max && t > -length_max;
    }
    QRAY_INLINE static constexpr bool normalise(F x, F y, F z, F& ux, F& uy, F& uz)
    {
        const F l2 = norm2(x, y, z);
        if (!(l2 > 0))
            return false;
        const F inv = F(1) / sqrt(l2);
        ux = x * inv;
        uy = y * inv;
        uz = z * inv;
        return true;
    }
    QRAY_INLINE static constexpr F ratio(F v, F inverse_r) { return v * inverse_r; }
    QRAY_INLINE static constexpr void sharpen(F& x, F& y, F& z)
    {
        const F h = (norm2(x, y, z) - F(1)) / F(2);
        x = x - x * h;
        y = y - y * h;
        z = z - z * h;
    }
    QRAY_INLINE static constexpr int headroom(F, F, F) { return 0; }
    static constexpr int most_headroom = 0;
    QRAY_INLINE static constexpr F shifted(F a, int) { return a; }
    QRAY_INLINE static constexpr F bent(F eta, F x) { return eta * x; }
    static constexpr bool weights(F a, F b, F c, F& wa, F& wb, F& wc)
    {
        F sum = a + b + c;
        constexpr F least = sizeof(F) == 4 ? F(0x1p-126f) : F(0x1p-1022); // its reciprocal is finite
        if (sum < least && sum > -least)
            return false;
        sum = F(1) / sum;
        wa = a * sum > 0 ? a * sum : 0;
        wb = b * sum > 0 ? b * sum : 0;
        wc = c * sum > 0 ? c * sum : 0;
        return true;
    }
    QRAY_INLINE static constexpr bool nearly_zero(F c)
    {
        constexpr F limit = sizeof(F) == 4 ? F(1e-5) : F(1e-9);
        return c < limit && c > -limit;
    }
    QRAY_INLINE static constexpr F absolute(F v)
    {
        if constexpr (sizeof(F) == 4)
            return __builtin_fabsf(v);
        else
            return __builtin_fabs(v);
    }

    // The sign bit, also of 0.
    QRAY_INLINE static constexpr bool negative(F v)
    {
        if constexpr (sizeof(F) == 4)
            return __builtin_bit_cast(int32_t, v) < 0;
        else
            return __builtin_bit_cast(int64_t, v) < 0;
    }

    // How far a new ray starts from the surface it leaves, at a point that lies on it to its own rounding.
    QRAY_INLINE static constexpr F leave(F x, F y, F z)
    {
        const F ax = absolute(x), ay = absolute(y), az = absolute(z);
        const F xy = ax > ay ? ax : ay;
        return (xy > az ? xy : az) * (leave_relative * epsilon) + leave_least * epsilon;
    }
    static constexpr F leave_relative = 2, leave_least = 4;

    static constexpr F light_clearance = F(2048) * epsilon;

    QRAY_INLINE static constexpr F power_whole(F x, Shine e)
    {
        uint32_t n = e.whole;
        if (n == 0)
            return 1;
        for (; (n & 1) == 0; n >>= 1)
            x *= x;
        F r = x;
        while ((n >>= 1) != 0) {
            x *= x;
            if (n & 1)
                r *= x;
        }
        return r;
    }
    static constexpr F power(F x, Shine e)
    {
        return e.fraction > 0 ? power_whole(x, e) * power_fraction(x, e.fraction) : power_whole(x, e);
    }

    // x^f for x in [0, 1], f in (0, 1): square roots of x, one for each bit of f that matters.
    static constexpr F power_fraction(F x, F f)
    {
        F r = 1;
        for (int bit = 0; bit < (sizeof(F) == 4 ? 24 : 53) && f > 0; bit++) {
            x = sqrt(x);
            f = f + f;
            if (f >= 1) {
                r *= x;
                f -= 1;
            }
        }
        return r;
    }
};

using q32 = FixedSystem<24, 30, 28, 32>;
using Float = FloatSystem<float>;
using Double = FloatSystem<double>;

} // namespace qray
