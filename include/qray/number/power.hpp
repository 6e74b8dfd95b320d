// Powers of numbers in [0, 1], in integer arithmetic: 64 bytes of coefficients.
#pragma once

#include "wide.hpp"

namespace qray {

// whole + fraction / 2^32, whole <= 10^6.
struct Exponent {
    uint32_t whole;
    uint32_t fraction;
};

// x^whole for x in [0, 1] as Q2.30, result Q2.30. 0^0 = 1. Absolute error at most 2^-29
// (2^-29.4 is the largest seen in 12 million hard cases).
QRAY_SHARED constexpr uint32_t pow_whole(uint32_t x, uint32_t whole)
{
    constexpr uint32_t one = uint32_t{1} << 30;
    if (x >= one || whole == 0)
        return one;
    if (x == 0)
        return 0;
    // The base is 1 - m / 2^(32 + k), the result 1 - r / 2^32: near 1 the complement keeps its bits.
    uint32_t m = one - x;
    int k = count_leading_zeros(m) - 2;
    m = m << 2 << k;
    uint32_t r = 0;
    for (;;) {
        if (whole & 1) {
            uint32_t change = r == 0 ? m : mul_high(0 - r, m);
            r += k == 0 ? change : ((change >> (k - 1)) + 1) >> 1;
        }
        whole >>= 1;
        if (whole == 0)
            break;
        if (k > 0) {
            m -= ((square_high(m) >> k) + 1) >> 1;
            k--;
        } else {
            m = square_high(0 - m);
            if (m == 0)
                return 0;
            m = 0 - m;
        }
    }
    return one - (r >> 2) - ((r >> 1) & 1);
}

namespace detail {

// c[0] - x (c[1] - x (c[2] - ...)), all in Q0.32; every c is greater than the next.
QRAY_SHARED constexpr uint32_t alternating_polynomial(const uint32_t* c, int degree, uint32_t x)
{
    uint32_t sum = c[degree];
    for (int i = degree - 1; i >= 0; i--)
        sum = c[i] - mul_high(sum, x);
    return sum;
}

// Chebyshev fits on [0, 1]: (log2(1 + x) - x) / (x (1 - x)), error 2^-28.0,
// and (1 - 2^-x - x/2) / (x (1 - x)), error 2^-30.9. The factor x (1 - x) <= 1/4 then takes two bits off.
inline constexpr uint32_t log2_coefficients[10] = {
    0x71547643, 0x4755b89c, 0x33c4c5d6, 0x287930ee, 0x20b8ff0e,
    0x19d0880b, 0x11fe6bf2, 0x09ac663f, 0x035d2e87, 0x008c38fd,
};
inline constexpr uint32_t exp2_coefficients[6] = {
    0x317217f6, 0x0c0d6374, 0x022819a3, 0x004e17e0, 0x0008f372, 0x0000b5b4,
};

} // namespace detail

// x^(fraction / 2^32) for x in [0, 1] as Q2.30, result Q2.30. Absolute error at most 2^-29.
QRAY_SHARED constexpr uint32_t pow_fraction(uint32_t x, uint32_t fraction)
{
    constexpr uint32_t one = uint32_t{1} << 30;
    if (x >= one || fraction == 0)
        return one;
    if (x == 0)
        return 0;
    // x = (1 + t) / 2^n
    int n = count_leading_zeros(x) - 1;
    uint32_t t = x << n << 2;
    uint32_t curve = detail::alternating_polynomial(detail::log2_coefficients, 9, t);
    uint32_t log2 = t + mul_high(mul_high(t, 0 - t), curve);
    // -log2(x) fraction = shift + g, and 2^-g follows.
    uint64_t exponent = wide_mul(static_cast<uint32_t>(n), fraction) - mul_high(log2, fraction);
    uint32_t g = static_cast<uint32_t>(exponent);
    curve = detail::alternating_polynomial(detail::exp2_coefficients, 5, g);
    uint32_t complement = (g >> 1) + mul_high(mul_high(g, 0 - g), curve);
    return (one - (complement >> 2) - ((complement >> 1) & 1)) >> (exponent >> 32);
}

// x^e for x in [0, 1] as Q2.30, result Q2.30. Absolute error at most 2^-28; x^0 = 1.
constexpr uint32_t pow_unit(uint32_t x, Exponent e)
{
    uint32_t result = pow_whole(x, e.whole);
    if (e.fraction != 0)
        result = static_cast<uint32_t>((wide_mul(result, pow_fraction(x, e.fraction)) + (1u << 29)) >> 30);
    return result;
}

} // namespace qray
