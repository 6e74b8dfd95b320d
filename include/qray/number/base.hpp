// What depends on the compiler or the processor: here inlining, and counts of leading zeros; in wide.hpp products wider
// than a register, in root.hpp square roots. Every function gives the same bits on every target, in a constant
// expression too. An argument is forbidden only where a function says so.
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __SANITIZE_ADDRESS__ // each copy would be checked, and compiled, once more: that takes twice the time
#define QRAY_INLINE inline
#else
#define QRAY_INLINE inline __attribute__((always_inline))
#endif
#define QRAY_NOINLINE __attribute__((noinline))
// One copy where flash is scarce; elsewhere the compiler decides.
#if defined(__ARM_ARCH_6M__)
#define QRAY_SHARED __attribute__((noinline))
#else
#define QRAY_SHARED
#endif

// ARMv6-M multiplies 32 by 32 bits to 32 bits only; the library's 64-bit product takes 48 instructions.
#if defined(__ARM_ARCH_6M__) && defined(__thumb__)
#define QRAY_NARROW_MULTIPLY 1
#else
#define QRAY_NARROW_MULTIPLY 0
#endif

// Without an instruction for it, the compiler calls a library function with a table of 256 bytes.
#if defined(__ARM_ARCH_6M__) || (defined(__riscv) && !defined(__riscv_zbb))
#define QRAY_SOFT_CLZ 1
#else
#define QRAY_SOFT_CLZ 0
#endif

// Square roots of binary32 in an instruction.
#if defined(__SSE2__) || defined(__aarch64__) || (defined(__ARM_FP) && (__ARM_FP & 4)) \
    || (defined(__riscv_flen) && __riscv_flen >= 32)
#define QRAY_FLOAT_SQRT 1
#else
#define QRAY_FLOAT_SQRT 0
#endif

// Square roots of binary64 in an instruction, beside 64-bit integers.
#if defined(__SSE2__) || defined(__aarch64__)
#define QRAY_DOUBLE_SQRT 1
#else
#define QRAY_DOUBLE_SQRT 0
#endif

// Before a loop over a scene's shapes: where code is cheap and the table is a constant, eight at a time, so
// that its numbers become part of the code.
#if __SIZEOF_POINTER__ == 4 && !QRAY_NARROW_MULTIPLY && !defined(__clang__)
#define QRAY_UNROLL _Pragma("GCC unroll 8")
#else
#define QRAY_UNROLL
#endif

// Does the compiler see that it is so? As it may of a constant scene.
#define QRAY_KNOWN(condition) (__builtin_constant_p(condition) && (condition))

// Of a function object that asks one shape: where a tree names the shapes, in a place or two, the ray stays
// in registers.
#if __SIZEOF_POINTER__ == 4
#define QRAY_INLINE_LAMBDA
#else
#define QRAY_INLINE_LAMBDA __attribute__((always_inline))
#endif

namespace qray {

// False where a 32 x 32 -> 64 bit product takes some 18 instructions rather than one or two.
inline constexpr bool has_wide_multiply = !QRAY_NARROW_MULTIPLY;

inline constexpr bool has_double_sqrt = QRAY_DOUBLE_SQRT && sizeof(void*) == 8;

namespace detail {

// Drops `bits` bits of x where it has more, and counts by `worth` less.
QRAY_INLINE constexpr void skip(uint32_t& x, int& n, int bits, int worth)
{
    if (const uint32_t high = x >> bits; high != 0) {
        n -= worth;
        x = high;
    }
}
// Hacker's Delight (Warren), section 5-3.
constexpr int soft_clz(uint32_t x)
{
    int n = 32;
    skip(x, n, 16, 16);
    skip(x, n, 8, 8);
    skip(x, n, 4, 4);
    skip(x, n, 2, 2);
    return x > 1 ? n - 2 : n - static_cast<int>(x);
}
constexpr int soft_zero_pairs(uint32_t x)
{
    int n = 15;
    skip(x, n, 16, 8);
    skip(x, n, 8, 4);
    skip(x, n, 4, 2);
    return x >> 2 != 0 ? n - 1 : n;
}

} // namespace detail

// Leading zero bits; 32 for 0.
constexpr int count_leading_zeros(uint32_t x)
{
#if QRAY_SOFT_CLZ
    return detail::soft_clz(x);
#else
    return x == 0 ? 32 : __builtin_clz(x);
#endif
}

// Leading zero bits; 64 for 0.
constexpr int count_leading_zeros(uint64_t x)
{
    if constexpr (sizeof(void*) == 8)
        return x == 0 ? 64 : __builtin_clzll(x);
    uint32_t top = static_cast<uint32_t>(x >> 32);
    int above = 0;
    if (top == 0) {
        top = static_cast<uint32_t>(x);
        above = 32;
    }
    return above + count_leading_zeros(top);
}

// Half the number of leading zero bits, rounded down, for x > 0.
constexpr int leading_zero_pairs(uint32_t x)
{
#if QRAY_SOFT_CLZ
    return detail::soft_zero_pairs(x);
#else
    return __builtin_clz(x) >> 1;
#endif
}

constexpr uint32_t magnitude(int32_t v) { return v < 0 ? 0 - static_cast<uint32_t>(v) : static_cast<uint32_t>(v); }
constexpr uint64_t magnitude(int64_t v) { return v < 0 ? 0 - static_cast<uint64_t>(v) : static_cast<uint64_t>(v); }

// The number of the lowest bit that is set, for x > 0.
constexpr uint32_t lowest_bit(uint32_t x)
{
    return static_cast<uint32_t>(__builtin_ctz(x));
}

} // namespace qray
