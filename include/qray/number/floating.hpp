// Floating point as a number system: binary32 (Float) and binary64 (Double). Every quantity is of one type, exact
// products are only as exact as that, and block scales are 0.
#pragma once

#include "lanes.hpp"
#include "system.hpp"

namespace qray {

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
    using Span = F;
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

    // n/d for 0 <= n <= d.
    static consteval F fraction(int32_t n, int32_t d) { return static_cast<F>(n) / static_cast<F>(d); }

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
#if QRAY_LANES
    QRAY_INLINE static Float4 root(Float4 a) { return __builtin_ia32_sqrtps(a); }
#endif
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

    static constexpr F whole_limit = F(uint32_t{1} << 31);
    // floor(v) modulo 2^32, for |v| < whole_limit.
    QRAY_INLINE static constexpr uint32_t floor(F v)
    {
        const int32_t whole = static_cast<int32_t>(v);
        return static_cast<uint32_t>(whole) - negative(v - static_cast<F>(whole));
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

    // Of a number, or of each of several in a register.
    template <class V>
    QRAY_INLINE static constexpr V power_whole(V x, Shine e)
    {
        uint32_t n = e.whole;
        if (n == 0)
            return V{} + F(1);
        for (; (n & 1) == 0; n >>= 1)
            x *= x;
        V r = x;
        while ((n >>= 1) != 0) {
            x *= x;
            if (n & 1)
                r *= x;
        }
        return r;
    }
    static constexpr F power(F x, Shine e)
    {
        if (x == 0) // half of all highlights
            return e.whole == 0 && !(e.fraction > 0) ? F(1) : F(0);
        return e.fraction > 0 ? power_whole(x, e) * power_fraction(x, x, e.fraction) : power_whole(x, e);
    }

    // x^f for x in (0, 1], none below `least`, f in (0, 1): square roots of x, one for each bit of f that matters.
    // Where roots are slow and space is not, the last ones are found in steps of u = 2^-24 below 1: the root of
    // 1 - m u, with m < 2^12, is 1 - (m/2 + m^2 u/8 + ...) u, and all after m/2 is above 0 and less than 1/7: the next
    // m is m/2, halves up.
    template <class V>
    static constexpr V power_fraction(V x, [[maybe_unused]] F least, F f)
    {
        using Bits = decltype(bits_of(F{}));
        constexpr int bits = sizeof(F) == 4 ? 24 : 53, top = sizeof(F) * 8 - 1;
        Bits left = static_cast<Bits>(f * static_cast<F>(Bits{1} << bits)) << (top + 1 - bits);
        V r = V{} + F(1);
        int roots = bits;
        if constexpr (counts_steps) {
            // 12 + k roots of 2^-(2^k) or more are above 1 - 2^-12; so are 19 of any.
            const uint32_t below_half = 126 - (__builtin_bit_cast(uint32_t, least) >> 23);
            roots = 44 - count_leading_zeros(below_half);
        }
        for (; left != 0 && roots != 0; left <<= 1, roots--) {
            x = root(x);
            if (left >> top != 0)
                r *= x;
        }
        if constexpr (counts_steps) {
            using Steps = decltype(bits_of(x));
            const Steps of_one = __builtin_bit_cast(Steps, V{} + 1.0f);
            for (Steps m = of_one - __builtin_bit_cast(Steps, x); left != 0; left <<= 1) {
                m = (m + 1) / 2;
                if (left >> top != 0)
                    r *= __builtin_bit_cast(V, of_one - m);
            }
        }
        return r;
    }

private:
    static constexpr bool counts_steps = sizeof(F) == 4 && sizeof(void*) == 8;
    static uint32_t bits_of(float);
#if QRAY_LANES
    static Unsigned4 bits_of(Float4);
#endif
    static uint64_t bits_of(double);
};

using Float = FloatSystem<float>;
using Double = FloatSystem<double>;

static_assert(NumberSystem<Float> && NumberSystem<Double>);

} // namespace qray
