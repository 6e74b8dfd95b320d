// Roots, reciprocals and quotients in integer arithmetic: no floating point, no library division, the same bits on
// every target. What cannot be represented saturates, as each function says. One table of 98 bytes serves all.
#pragma once

#include "root.hpp"
#include "wide.hpp"

namespace qray {

namespace detail {

// 1/sqrt(i/64) for i = 16..64 in Q1.15, lowered by 3/(64 i^2) so that the chords between neighbours,
// which lie above the curve, are wrong by at most 2^-12.4 either way; 4 is half a unit of Q1.12.
struct RsqrtTable {
    uint16_t value[49] = {};

    constexpr RsqrtTable()
    {
        for (uint32_t i = 16; i <= 64; i++) {
            uint64_t square = (uint64_t{1} << 60) / i;
            uint64_t root = 0;
            for (uint64_t bit = uint64_t{1} << 29; bit != 0; bit >>= 1) {
                if ((root + bit) * (root + bit) <= square)
                    root += bit;
            }
            root -= root * 3 / (64 * i * i);
            value[i - 16] = static_cast<uint16_t>((root + 2048) / 4096 + 4);
        }
    }
};

inline constexpr RsqrtTable rsqrt_table{};

// For machines of 64 bits: the entry, times 2^13, and above it how much the next one is less.
struct RsqrtSteps {
    uint64_t value[64] = {};

    constexpr RsqrtSteps()
    {
        for (int i = 0; i < 48; i++)
            value[16 + i] = uint64_t{rsqrt_table.value[i]} << 13
                | static_cast<uint64_t>(rsqrt_table.value[i] - rsqrt_table.value[i + 1]) << 32;
    }
};

inline constexpr RsqrtSteps rsqrt_steps{};

// x 4^half = high 2^32 + low in [2^62, 2^64); 0 is taken for 1.
struct Normal {
    uint32_t high;
    uint32_t low;
    int half;
};

QRAY_INLINE constexpr Normal normalise_even(uint64_t x)
{
    if constexpr (sizeof(void*) == 8) {
        const int half = count_leading_zeros(x | 1) / 2;
        const uint64_t v = (x != 0 ? x : 1) << (2 * half);
        return {static_cast<uint32_t>(v >> 32), static_cast<uint32_t>(v), half};
    }
    uint32_t high = static_cast<uint32_t>(x >> 32);
    uint32_t low = static_cast<uint32_t>(x);
    int half = 0;
    if (high == 0) {
        high = low != 0 ? low : 1;
        low = 0;
        half = 16;
    }
    int pairs = leading_zero_pairs(high);
    int shift = 2 * pairs;
    return {(high << shift) + (low >> 1 >> (31 - shift)), low << shift, half + pairs};
}

// a * b / 2^16, rounded down, for |a b| < 2^47 and b < 2^15.
constexpr int32_t mul_shift_16(int32_t a, uint32_t b)
{
    if constexpr (sizeof(void*) == 8)
        return static_cast<int32_t>(int64_t{a} * b >> 16);
    if constexpr (has_wide_multiply)
        return static_cast<int32_t>(wide_mul(a, static_cast<int32_t>(b << 16)) >> 32);
    return (a >> 16) * static_cast<int32_t>(b) + static_cast<int32_t>(static_cast<uint16_t>(a) * b >> 16);
}

// 1/sqrt(v / 2^32) in Q1.12 for v in [2^30, 2^32), relative error at most 2^-12.0.
constexpr uint32_t rsqrt_seed(uint32_t v)
{
    const uint16_t* entry = rsqrt_table.value + (static_cast<int32_t>(v >> 26) - 16);
    uint32_t step = static_cast<uint32_t>(entry[0] - entry[1]);
    return ((uint32_t{entry[0]} << 13) - step * (v << 6 >> 19)) >> 16;
}

// y (1 + e/2 + 3/8 e^2 + ...) in Q1.31 for a seed y of 1/sqrt(v) and e = 1 - v y^2, |e| < 2^-10.8; v y^2 is close to
// 1 = 2^40, so that its value modulo 2^32 tells e.
QRAY_INLINE constexpr uint32_t rsqrt_refined(uint32_t y, uint32_t v_y2)
{
    int32_t e = -static_cast<int32_t>(v_y2);
    int32_t e_short = e >> 14;
    e += static_cast<int32_t>(static_cast<uint32_t>(e_short * e_short) * 3 >> 14);
    uint32_t mantissa = (y << 19) + static_cast<uint32_t>((mul_shift_16(e, y) + 32) >> 6);
    return mantissa >> 31 != 0 ? mantissa : 0xffffffffu;
}

// 1/sqrt(v / 2^64) in Q1.31 for v = high 2^32 + low in [2^62, 2^64), relative error at most 2^-31.7. 35 bits of v
// count.
QRAY_SHARED constexpr uint32_t rsqrt_mantissa(uint32_t high, uint32_t low)
{
    uint32_t y = rsqrt_seed(high);
    uint32_t upper = (high >> 16) * y * y;
    uint32_t lower = ((high << 16 >> 13) + (low >> 29)) * y;
    lower = (lower >> 13) * y >> 6;
    return rsqrt_refined(y, upper + lower);
}
// The same for machines of 64 bits.
QRAY_INLINE constexpr uint32_t rsqrt_mantissa(uint64_t v)
{
    const uint64_t entry = rsqrt_steps.value[v >> 58];
    const uint32_t y = (static_cast<uint32_t>(entry)
                        - static_cast<uint32_t>(entry >> 32) * static_cast<uint32_t>(v << 6 >> 51)) >> 16;
    const uint32_t upper = static_cast<uint32_t>(v >> 48) * y * y;
    const uint32_t lower = (static_cast<uint32_t>(v >> 29) & 0x7ffff) * y;
    return rsqrt_refined(y, upper + ((lower >> 13) * y >> 6));
}

// Of a root at most one off the one to the nearest, given the lower half of its square.
QRAY_INLINE constexpr uint32_t nearest_root(uint32_t root, uint32_t x)
{
    const int32_t rest = static_cast<int32_t>(x - root * root), r = static_cast<int32_t>(root);
    return rest > r ? root + 1 : rest <= -r ? root - 1 : root;
}

// isqrt for x < 2^58.
QRAY_SHARED constexpr uint32_t isqrt_small(uint64_t x)
{
    Normal v = normalise_even(x);
    uint32_t root = mul_high(v.high, rsqrt_mantissa(v.high, v.low));
    // This is sqrt(x) 2^(half - 1), half >= 3, error within (-2.4, 0.9): at most one off when rounded,
    // and |x - root^2| < 2^31 then tells which way.
    root = ((root >> (v.half - 2)) + 1) >> 1;
    return nearest_root(root, static_cast<uint32_t>(x));
}

// isqrt for x >= 2^58, counted up from a bound at most 9 below.
QRAY_NOINLINE constexpr uint32_t isqrt_large(uint64_t x)
{
    uint32_t root = (isqrt_small(x >> 6) << 3) - 4;
    uint64_t bound = wide_mul(root, root) + root;
    while (x > bound && root != 0xffffffffu) {
        root++;
        bound += uint64_t{root} << 1;
    }
    return root;
}

// isqrt in integers.
constexpr uint32_t isqrt_by_rsqrt(uint64_t x)
{
    return x >> 58 != 0 ? isqrt_large(x) : isqrt_small(x);
}

} // namespace detail

// The integer nearest to sqrt(x), saturating at 2^32 - 1. Faster below 2^58.
QRAY_INLINE constexpr uint32_t isqrt(uint64_t x)
{
    return detail::isqrt_by_rsqrt(x);
}
// The same for x >= 0.
QRAY_INLINE constexpr uint32_t isqrt(int64_t x)
{
    if constexpr (has_double_sqrt)
        if (!__builtin_is_constant_evaluated())
            return isqrt_by_double(x);
    return detail::isqrt_by_rsqrt(static_cast<uint64_t>(x));
}

namespace detail {

// 2^8 sqrt(v) for v in [2^30, 2^32), to 2^-21 of itself.
QRAY_INLINE constexpr uint32_t root_of_top(uint32_t v)
{
    const uint32_t y = rsqrt_seed(v), root = (v >> 16) * y >> 12;
    // One Newton step: root + (v - root^2) y / 2.
    const int32_t rest = static_cast<int32_t>(v - root * root) >> 4;
    return (root << 8) + static_cast<uint32_t>(rest * static_cast<int32_t>(y) >> 17);
}

} // namespace detail

// The integer nearest to sqrt(x); at most 2^16.
constexpr uint32_t isqrt(uint32_t x)
{
    if (x == 0)
        return 0;
    const int pairs = leading_zero_pairs(x);
    return detail::nearest_root(((detail::root_of_top(x << (2 * pairs)) >> (7 + pairs)) + 1) >> 1, x);
}

namespace detail {

// x m / 2^(32 + halve) to the nearest, for m >= 2^31 and halve 0 or 1.
constexpr int32_t scaled_component(int32_t x, uint32_t m, int halve)
{
    // As a signed number m is too small by 2^32.
    const uint64_t p = static_cast<uint64_t>(wide_mul(x, static_cast<int32_t>(m)));
    const uint32_t whole = static_cast<uint32_t>(p >> 32) + static_cast<uint32_t>(x);
    const uint32_t rest = static_cast<uint32_t>(p) >> 31 >> halve;
    return (static_cast<int32_t>(whole + static_cast<uint32_t>(halve)) >> halve) + static_cast<int32_t>(rest);
}

// By how many bits three numbers can be shifted left, so that their upper words say most; at most 31.
constexpr int top_bits(int64_t x, int64_t y, int64_t z)
{
    const auto magnitude = [](int64_t v) {
        const int32_t high = static_cast<int32_t>(v >> 32);
        return static_cast<uint32_t>(high ^ (high >> 31));
    };
    return count_leading_zeros(magnitude(x) | magnitude(y) | magnitude(z)) - 1;
}
// The upper 32 bits of v 2^up, for up in [0, 31]; all below 2^31 of v if that is 31.
constexpr int32_t top_word(int64_t v, int up)
{
    if constexpr (sizeof(void*) == 8)
        return static_cast<int32_t>(static_cast<uint64_t>(v) << up >> 32);
    const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(v) >> 32), low = static_cast<uint32_t>(v);
    return static_cast<int32_t>((high << up) | (low >> 1 >> (31 - up)));
}

// A vector with magnitudes of at most 2^31, the largest at least 2^30, to a unit vector in Q2.30.
QRAY_SHARED constexpr void make_unit(int32_t* u)
{
    const uint64_t square = wide_norm2(u[0], u[1], u[2]);
    uint32_t high = static_cast<uint32_t>(square >> 32);
    uint32_t low = static_cast<uint32_t>(square);
    int halve = 1;
    if (high >> 30 == 0) {
        high = (high << 2) + (low >> 30);
        low <<= 2;
        halve = 0;
    }
    const uint32_t m = rsqrt_mantissa(high, low);
    if constexpr (has_wide_multiply) {
        u[0] = scaled_component(u[0], m, halve);
        u[1] = scaled_component(u[1], m, halve);
        u[2] = scaled_component(u[2], m, halve);
    } else {
        for (int i = 0; i < 3; i++)
            u[i] = scaled_component(u[i], m, halve);
    }
}

} // namespace detail

// The unit vector along (x, y, z), in Q2.30: each component of u within 0.81 ulp.
// False, and u untouched, where all are 0.
QRAY_SHARED constexpr bool unit_vector(int32_t x, int32_t y, int32_t z, int32_t* u)
{
    if ((x | y | z) == 0)
        return false;
    if constexpr (sizeof(void*) == 8) {
        // The same in 64-bit registers: x 2^up m / 2^(32 + halve), as below, where zeros = up + 1 - halve.
        const uint64_t square = wide_norm2(x, y, z);
        const int zeros = count_leading_zeros(square) / 2;
        const int64_t m = detail::rsqrt_mantissa(square << (2 * zeros));
        const int down = 33 - zeros;
        const int64_t half = int64_t{1} << (down - 1);
        u[0] = static_cast<int32_t>((x * m + half) >> down);
        u[1] = static_cast<int32_t>((y * m + half) >> down);
        u[2] = static_cast<int32_t>((z * m + half) >> down);
        return true;
    }
    // The magnitudes, those of negative numbers less one.
    const uint32_t bits = static_cast<uint32_t>((x ^ (x >> 31)) | (y ^ (y >> 31)) | (z ^ (z >> 31)) | 1);
    // To magnitudes of at most 2^31, the largest at least 2^30.
    const int up = count_leading_zeros(bits) - 1;
    u[0] = static_cast<int32_t>(static_cast<uint32_t>(x) << up);
    u[1] = static_cast<int32_t>(static_cast<uint32_t>(y) << up);
    u[2] = static_cast<int32_t>(static_cast<uint32_t>(z) << up);
    detail::make_unit(u);
    return true;
}

// The same of 64-bit components, cut to 31 bits before: within 1.81 ulp. What is shorter than 2^32 loses its last bit.
// As q32::normalise(), in less stack where a product is a call.
QRAY_SHARED constexpr bool unit_vector(int64_t x, int64_t y, int64_t z, int32_t* u)
{
    const int up = detail::top_bits(x, y, z);
    const int32_t a = detail::top_word(x, up), b = detail::top_word(y, up), c = detail::top_word(z, up);
    if (up == 31)
        return unit_vector(a, b, c, u);
    u[0] = a;
    u[1] = b;
    u[2] = c;
    detail::make_unit(u);
    return true;
}

namespace detail {

// 2^63 / d for d in [2^31, 2^32), saturating at 2^32 - 1; error at most 1 ulp. The seed v is the square
// of an inverse square root in Q1.14; with e = 1 - d v it is v (1 + e + e^2 + ...), |e| < 2^-11.
QRAY_SHARED constexpr uint32_t reciprocal_mantissa(uint32_t d)
{
    uint32_t y = rsqrt_seed(d);
    uint32_t v = y * y >> 10;
    int32_t e = -static_cast<int32_t>(((d >> 16) * v << 5) + ((d & 0xffff) * v >> 11));
    int32_t e_short = e >> 9;
    e += e_short * e_short >> 17;
    uint32_t mantissa = (v << 17) + static_cast<uint32_t>((mul_shift_16(e, v) + 2) >> 2);
    return mantissa >> 31 != 0 ? mantissa : 0xffffffffu;
}

// n 2^shift / den to the nearest integer, halves up, saturating at 2^31 - 1: without a division.
QRAY_SHARED constexpr uint32_t divide_by_reciprocal(uint64_t n, uint32_t den, int shift)
{
    constexpr uint32_t limit = 0x7fffffff;
    uint32_t high = static_cast<uint32_t>(n >> 32);
    uint32_t low = static_cast<uint32_t>(n);
    if (den == 0)
        return limit;
    int scale = count_leading_zeros(den);
    den <<= scale;
    scale += shift;
    if (scale >= 32) {
        if (high != 0)
            return limit;
        high = low;
        low = 0;
        scale -= 32;
    }
    if (high >> (31 - scale) != 0)
        return limit;
    high = (high << scale) + (low >> 1 >> (31 - scale));
    low <<= scale;
    uint32_t half = den >> 1;
    low += half;
    high += low < half;
    if (high >= half)
        return limit;
    // The quotient is less than 2^31; the estimate is too small, by less than 4.
    uint32_t quotient = mul_high((high << 1) + (low >> 31), reciprocal_mantissa(den) - 1);
    uint64_t rest = (uint64_t{high} << 32 | low) - wide_mul(quotient, den);
    while (rest >= den) {
        rest -= den;
        quotient++;
    }
    return quotient;
}

// The same by the division of a machine of 64 bits.
constexpr uint32_t divide_magnitude(uint64_t n, uint32_t den, int shift)
{
    if constexpr (sizeof(void*) != 8)
        return divide_by_reciprocal(n, den, shift);
    constexpr uint32_t limit = 0x7fffffff;
    if (den == 0 || n >> (63 - shift) != 0) // then the quotient is 2^31 or more
        return limit;
    const uint64_t quotient = ((n << shift) + (den >> 1)) / den;
    return quotient < limit ? static_cast<uint32_t>(quotient) : limit;
}

} // namespace detail

// num * 2^shift / den to the nearest integer, halves away from zero, shift in [0, 32].
// Saturates to +-(2^31 - 1), also for den = 0 (with the sign of num).
constexpr int32_t divide(int64_t num, uint32_t den, int shift)
{
    if (num < 0)
        return -static_cast<int32_t>(detail::divide_magnitude(0 - static_cast<uint64_t>(num), den, shift));
    return static_cast<int32_t>(detail::divide_magnitude(static_cast<uint64_t>(num), den, shift));
}

} // namespace qray
