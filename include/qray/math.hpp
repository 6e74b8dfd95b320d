// qray/math.hpp: elementary functions in integer arithmetic.
//
// No floating point, no library division, the same bits on every target.
#ifndef QRAY_MATH_HPP
#define QRAY_MATH_HPP

#include <qray/base.hpp>

namespace qray {

// The integer nearest to sqrt(x), saturating at 2^32 - 1.
constexpr uint32_t isqrt(uint64_t x)
{
    uint64_t root = 0;
    for (uint64_t bit = uint64_t{1} << 62; bit != 0; bit >>= 2) {
        if (x >= root + bit) {
            x -= root + bit;
            root = (root >> 1) + bit;
        } else {
            root >>= 1;
        }
    }
    return static_cast<uint32_t>(x > root && root != 0xffffffffu ? root + 1 : root);
}

// The integer nearest to sqrt(x); at most 2^16.
constexpr uint32_t isqrt(uint32_t x)
{
    return isqrt(uint64_t{x});
}

// mantissa * 2^exponent, mantissa in [2^31, 2^32).
struct Scaled {
    uint32_t mantissa;
    int32_t exponent;
};

// 1 / sqrt(x). x = 0 gives the largest value that 1/sqrt(x) of a fraction could have: {0xffffffff, 31}.
constexpr Scaled rsqrt(uint64_t x)
{
    if (x == 0)
        return {0xffffffffu, 31};
    int shift = count_leading_zeros(x) & ~1;
    x <<= shift;
    // 1/sqrt(x) = sqrt(x)/x: quotient bit by bit.
    uint64_t den = x >> 1;
    uint64_t rem = uint64_t{isqrt(x)} << 31;
    int32_t exponent = shift / 2 - 64;
    if (x >> 31 == 0x80000000u)
        return {0x80000000u, exponent + 2};
    uint64_t q = 0;
    for (int i = 0; i < 34; i++) {
        q <<= 1;
        if (rem >= den) {
            rem -= den;
            q |= 1;
        }
        rem <<= 1;
    }
    // sqrt(x)/x * 2^32 in [1, 2]
    q = (q + 1) >> 1;
    if (q >> 32) {
        q >>= 1;
        exponent++;
    }
    return {static_cast<uint32_t>(q), exponent};
}

// 1 / x, error at most 1 ulp of the mantissa. x = 0 gives {0xffffffff, 0}.
constexpr Scaled reciprocal(uint32_t x)
{
    if (x == 0)
        return {0xffffffffu, 0};
    int shift = count_leading_zeros(x);
    uint32_t d = x << shift;
    if (d == 0x80000000u)
        return {0x80000000u, shift - 62};
    uint64_t rem = uint64_t{1} << 32;
    uint32_t q = 0;
    for (int i = 0; i < 32; i++) {
        q <<= 1;
        if (rem >= d) {
            rem -= d;
            q |= 1;
        }
        rem <<= 1;
    }
    return {q, shift - 63};
}

// num * 2^shift / den to the nearest integer, halves away from zero, shift in [0, 32].
// Saturates to +-(2^31 - 1), also for den = 0 (with the sign of num).
constexpr int32_t divide(int64_t num, uint32_t den, int shift)
{
    constexpr int32_t limit = 0x7fffffff;
    uint64_t n = num < 0 ? 0 - static_cast<uint64_t>(num) : static_cast<uint64_t>(num);
    if (n >> (63 - shift) != 0)
        return num < 0 ? -limit : limit;
    n = (n << shift) + (den >> 1);
    if ((n >> 31) >= den)
        return num < 0 ? -limit : limit;
    uint64_t d = uint64_t{den} << 30;
    uint32_t q = 0;
    for (int i = 0; i < 31; i++) {
        q <<= 1;
        if (n >= d) {
            n -= d;
            q |= 1;
        }
        n <<= 1;
    }
    return num < 0 ? -static_cast<int32_t>(q) : static_cast<int32_t>(q);
}

// whole + fraction / 2^32, whole <= 10^6.
struct Exponent {
    uint32_t whole;
    uint32_t fraction;
};

// x^whole for x in [0, 1] as Q2.30, result Q2.30. Absolute error <= 2^-28; 0^0 = 1.
constexpr uint32_t pow_whole(uint32_t x, uint32_t whole)
{
    constexpr uint32_t one = uint32_t{1} << 30;
    if (x >= one || whole == 0)
        return one;
    if (x == 0)
        return 0;
    // The base is 1 - m / 2^(32 + k), the result 1 - r / 2^32: near 1 the complement keeps its bits.
    uint32_t m = one - x;
    int k = count_leading_zeros(m);
    m <<= k;
    k -= 2;
    if (k < 0) {
        k = 0;
        m = (one - x) << 2;
    }
    uint32_t r = 0;
    for (;;) {
        if (whole & 1)
            r += (m - mul_high(r, m)) >> k;
        whole >>= 1;
        if (whole == 0)
            break;
        if (k > 0) {
            m -= mul_high(m, m) >> (k + 1);
            k--;
        } else {
            m = 0 - m;
            m = mul_high(m, m);
            if (m == 0)
                return 0;
            m = 0 - m;
        }
    }
    uint32_t result = one - (r >> 2) - ((r >> 1) & 1);
    return result;
}

// x^(fraction / 2^32) for x in [0, 1] as Q2.30, result Q2.30. Absolute error <= 2^-28.
constexpr uint32_t pow_fraction(uint32_t x, uint32_t fraction)
{
    constexpr uint32_t one = uint32_t{1} << 30;
    if (x >= one || fraction == 0)
        return one;
    if (x == 0)
        return 0;
    uint32_t root = x << 2;
    uint32_t result = 0xffffffffu;
    for (; fraction != 0; fraction <<= 1) {
        root = isqrt(uint64_t{root} << 32);
        if (fraction >> 31)
            result = mul_high(result, root);
    }
    return result >> 2;
}

// x^e for x in [0, 1] as Q2.30, result Q2.30. Absolute error <= 2^-28; x^0 = 1.
constexpr uint32_t pow_unit(uint32_t x, Exponent e)
{
    uint32_t result = pow_whole(x, e.whole);
    if (e.fraction != 0)
        result = mul_high(result << 2, pow_fraction(x, e.fraction));
    return result;
}

}  // namespace qray

#endif
