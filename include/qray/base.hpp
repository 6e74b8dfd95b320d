// qray/base.hpp: what depends on the compiler or the processor, and nothing else.
//
// Integer products wider than a register, count of leading zeros, correctly rounded square roots
// of binary32 and binary64, inlining. Every function gives the same bits on every target.
#ifndef QRAY_BASE_HPP
#define QRAY_BASE_HPP

#include <stddef.h>
#include <stdint.h>

#define QRAY_INLINE inline __attribute__((always_inline))
#define QRAY_NOINLINE __attribute__((noinline))

namespace qray {

// Leading zero bits; 32 (64) for 0.
constexpr int count_leading_zeros(uint32_t x)
{
    return x == 0 ? 32 : __builtin_clz(x);
}

constexpr int count_leading_zeros(uint64_t x)
{
    return x == 0 ? 64 : __builtin_clzll(x);
}

// Exact products.
constexpr int64_t wide_mul(int32_t a, int32_t b)
{
    return int64_t{a} * b;
}

constexpr uint64_t wide_mul(uint32_t a, uint32_t b)
{
    return uint64_t{a} * b;
}

constexpr uint32_t mul_high(uint32_t a, uint32_t b)
{
    return static_cast<uint32_t>(wide_mul(a, b) >> 32);
}

constexpr uint64_t wide_square(int32_t a)
{
    return static_cast<uint64_t>(int64_t{a} * a);
}

// Exact ax bx + ay by + az bz. The caller guarantees that the sum fits int64_t.
constexpr int64_t wide_dot(int32_t ax, int32_t ay, int32_t az, int32_t bx, int32_t by, int32_t bz)
{
    return static_cast<int64_t>(static_cast<uint64_t>(wide_mul(ax, bx))
                                + static_cast<uint64_t>(wide_mul(ay, by))
                                + static_cast<uint64_t>(wide_mul(az, bz)));
}

// Exact x^2 + y^2 + z^2: at most 3 * 2^62, so it always fits.
constexpr uint64_t wide_norm2(int32_t x, int32_t y, int32_t z)
{
    return wide_square(x) + wide_square(y) + wide_square(z);
}

namespace detail {

// Rounded to nearest, bit by bit. The significand is never exactly between two roots.
constexpr double sqrt_double_bits(double x)
{
    uint64_t bits = __builtin_bit_cast(uint64_t, x);
    if (bits - 1 >= 0x7ff0000000000000u)
        return 0.0;
    if (bits == 0x7ff0000000000000u)
        return x;
    int exponent = static_cast<int>(bits >> 52);
    uint64_t m = bits & 0xfffffffffffffu;
    if (exponent == 0) {
        int shift = count_leading_zeros(m) - 11;
        m <<= shift;
        exponent = 1 - shift;
    } else {
        m |= uint64_t{1} << 52;
    }
    exponent -= 1023;
    if (exponent & 1)
        m <<= 1;
    exponent = (exponent - (exponent & 1)) / 2;
    m <<= 1;
    uint64_t root = 0;
    uint64_t done = 0;
    for (uint64_t bit = uint64_t{1} << 53; bit != 0; bit >>= 1) {
        uint64_t trial = done + bit;
        if (trial <= m) {
            done = trial + bit;
            m -= trial;
            root += bit;
        }
        m <<= 1;
    }
    root = (root + (root & 1)) >> 1;
    return __builtin_bit_cast(double, root + (static_cast<uint64_t>(exponent + 1022) << 52));
}

constexpr float sqrt_float_bits(float x)
{
    uint32_t bits = __builtin_bit_cast(uint32_t, x);
    if (bits - 1 >= 0x7f800000u)
        return 0.0f;
    if (bits == 0x7f800000u)
        return x;
    int exponent = static_cast<int>(bits >> 23);
    uint32_t m = bits & 0x7fffffu;
    if (exponent == 0) {
        int shift = count_leading_zeros(m) - 8;
        m <<= shift;
        exponent = 1 - shift;
    } else {
        m |= uint32_t{1} << 23;
    }
    exponent -= 127;
    if (exponent & 1)
        m <<= 1;
    exponent = (exponent - (exponent & 1)) / 2;
    m <<= 1;
    uint32_t root = 0;
    uint32_t done = 0;
    for (uint32_t bit = uint32_t{1} << 24; bit != 0; bit >>= 1) {
        uint32_t trial = done + bit;
        if (trial <= m) {
            done = trial + bit;
            m -= trial;
            root += bit;
        }
        m <<= 1;
    }
    root = (root + (root & 1)) >> 1;
    return __builtin_bit_cast(float, root + (static_cast<uint32_t>(exponent + 126) << 23));
}

}  // namespace detail

// Correctly rounded square root, without errno. A negative x and a NaN give 0, infinity gives infinity.
constexpr float sqrt_float(float x)
{
    return detail::sqrt_float_bits(x);
}

constexpr double sqrt_double(double x)
{
    return detail::sqrt_double_bits(x);
}

}  // namespace qray

#endif
