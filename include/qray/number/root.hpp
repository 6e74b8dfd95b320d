// Square roots of binary32 and binary64, correctly rounded, and of integers by them.
#pragma once

#include "base.hpp"

namespace qray {

namespace detail {

// Square root of binary32 or binary64 on the bits, digit by digit. Bits is its unsigned integer, of
// which Fraction bits hold the significand. Nearest and even never differ: no root is halfway.
template <class Bits, int Fraction>
constexpr Bits sqrt_bits(Bits x)
{
    constexpr Bits hidden = Bits{1} << Fraction;
    constexpr int bias = (1 << (static_cast<int>(sizeof(Bits)) * 8 - Fraction - 2)) - 1;
    constexpr Bits infinity = static_cast<Bits>(2 * bias + 1) << Fraction;
    if (x == 0 || x > infinity)
        return 0;
    if (x == infinity)
        return x;
    int exponent = static_cast<int>(x >> Fraction);
    Bits rest = x & (hidden - 1);
    if (exponent != 0) {
        rest |= hidden;
    } else {
        int shift = count_leading_zeros(rest) - (static_cast<int>(sizeof(Bits)) * 8 - 1 - Fraction);
        rest <<= shift;
        exponent = 1 - shift;
    }
    exponent += bias;
    rest <<= 1 + (exponent & 1);
    Bits root = 0;
    Bits twice_root = 0;
    for (Bits bit = hidden << 1; bit != 0; bit >>= 1) {
        Bits trial = twice_root + bit;
        if (rest >= trial) {
            rest -= trial;
            twice_root = trial + bit;
            root += bit;
        }
        rest <<= 1;
    }
    return ((root + 1) >> 1) + (static_cast<Bits>((exponent >> 1) - 1) << Fraction);
}

} // namespace detail

// Square roots, correctly rounded (nearest), without errno: the processor's where it has one, else in
// integers. Infinity gives infinity. Of x >= 0, but not -0.
QRAY_INLINE constexpr float root_float(float x)
{
    if (!__builtin_is_constant_evaluated()) {
        [[maybe_unused]] float root = x;
#if defined(__AVX__)
        __asm__("vsqrtss %0, %0, %0" : "+x"(root));
        return root;
#elif defined(__SSE2__)
        __asm__("sqrtss %0, %0" : "+x"(root));
        return root;
#elif defined(__aarch64__)
        __asm__("fsqrt %s0, %s0" : "+w"(root));
        return root;
#elif defined(__ARM_FP) && (__ARM_FP & 4)
        __asm__("vsqrt.f32 %0, %0" : "+t"(root));
        return root;
#elif defined(__riscv_flen) && __riscv_flen >= 32
        __asm__("fsqrt.s %0, %0" : "+f"(root));
        return root;
#endif
    }
    return __builtin_bit_cast(float, detail::sqrt_bits<uint32_t, 23>(__builtin_bit_cast(uint32_t, x)));
}
// The same; a negative x, either zero and NaN give +0, which integers find without being asked.
constexpr float sqrt_float(float x) { return root_float(!QRAY_FLOAT_SQRT || x > 0.0f ? x : 0.0f); }

constexpr double sqrt_double(double x)
{
    if (!__builtin_is_constant_evaluated()) {
        [[maybe_unused]] double root = x > 0.0 ? x : 0.0;
#if defined(__AVX__)
        __asm__("vsqrtsd %0, %0, %0" : "+x"(root));
        return root;
#elif defined(__SSE2__)
        __asm__("sqrtsd %0, %0" : "+x"(root));
        return root;
#elif defined(__aarch64__)
        __asm__("fsqrt %d0, %d0" : "+w"(root));
        return root;
#elif defined(__ARM_FP) && (__ARM_FP & 8)
        __asm__("vsqrt.f64 %P0, %P0" : "+w"(root));
        return root;
#elif defined(__riscv_flen) && __riscv_flen >= 64
        __asm__("fsqrt.d %0, %0" : "+f"(root));
        return root;
#endif
    }
    return __builtin_bit_cast(double, detail::sqrt_bits<uint64_t, 52>(__builtin_bit_cast(uint64_t, x)));
}

// The integer nearest to sqrt(x) for x >= 0. Only where has_double_sqrt. A root in binary64 is off by less than 2^-20:
// where that takes its whole part to the next one, sqrt(x) is as near to that, so that the rest still tells.
QRAY_INLINE uint32_t isqrt_by_double(int64_t x)
{
    const int64_t root = static_cast<int64_t>(sqrt_double(static_cast<double>(x)));
    return static_cast<uint32_t>(root + (x - root * root > root));
}

} // namespace qray
