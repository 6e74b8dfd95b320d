// Integer products wider than a register, and what is done with them.
#pragma once

#include "base.hpp"

namespace qray {

// a * b, exact.
QRAY_SHARED constexpr int64_t wide_mul(int32_t a, int32_t b)
{
#if QRAY_NARROW_MULTIPLY
    // a = ah 2^16 + al, b likewise; q = ah bl + (al bl >> 16) and r = al bh + (q mod 2^16) both fit
    // 32 bits, and the upper half is ah bh + (q >> 16) + (r >> 16). The lower half is one product.
    if (!__builtin_is_constant_evaluated()) {
        int32_t low = a;
        int32_t high = b;
        int32_t al, ah, bl, t;
        __asm__(".syntax unified\n\t"
                "uxth %[al], %[a]\n\t"
                "asrs %[ah], %[a], #16\n\t"
                "muls %[a], %[b]\n\t"
                "uxth %[bl], %[b]\n\t"
                "asrs %[b], %[b], #16\n\t"
                "movs %[t], %[al]\n\t"
                "muls %[t], %[bl]\n\t"
                "lsrs %[t], %[t], #16\n\t"
                "muls %[bl], %[ah]\n\t"
                "adds %[bl], %[bl], %[t]\n\t"
                "muls %[ah], %[b]\n\t"
                "muls %[al], %[b]\n\t"
                "uxth %[b], %[bl]\n\t"
                "adds %[al], %[al], %[b]\n\t"
                "asrs %[al], %[al], #16\n\t"
                "asrs %[bl], %[bl], #16\n\t"
                "adds %[ah], %[ah], %[al]\n\t"
                "adds %[b], %[ah], %[bl]\n\t"
                : [a] "+l"(low), [b] "+l"(high), [al] "=&l"(al), [ah] "=&l"(ah), [bl] "=&l"(bl), [t] "=&l"(t)
                :
                : "cc");
        return static_cast<int64_t>(static_cast<uint64_t>(static_cast<uint32_t>(high)) << 32
                                    | static_cast<uint32_t>(low));
    }
#endif
    return int64_t{a} * b;
}

constexpr uint32_t mul_high(uint32_t a, uint32_t b);

// a * b, exact.
constexpr uint64_t wide_mul(uint32_t a, uint32_t b)
{
#if QRAY_NARROW_MULTIPLY
    if (!__builtin_is_constant_evaluated())
        return static_cast<uint64_t>(mul_high(a, b)) << 32 | a * b;
#endif
    return uint64_t{a} * b;
}

// The upper 32 bits of a * b.
constexpr uint32_t mul_high(uint32_t a, uint32_t b)
{
#if QRAY_NARROW_MULTIPLY
    if (!__builtin_is_constant_evaluated()) {
        uint32_t al, bl, t;
        __asm__(".syntax unified\n\t"
                "uxth %[al], %[a]\n\t"
                "lsrs %[a], %[a], #16\n\t"
                "uxth %[bl], %[b]\n\t"
                "lsrs %[b], %[b], #16\n\t"
                "movs %[t], %[al]\n\t"
                "muls %[t], %[bl]\n\t"
                "lsrs %[t], %[t], #16\n\t"
                "muls %[bl], %[a]\n\t"
                "adds %[bl], %[bl], %[t]\n\t"
                "muls %[a], %[b]\n\t"
                "muls %[al], %[b]\n\t"
                "uxth %[t], %[bl]\n\t"
                "adds %[al], %[al], %[t]\n\t"
                "lsrs %[al], %[al], #16\n\t"
                "lsrs %[bl], %[bl], #16\n\t"
                "adds %[a], %[a], %[al]\n\t"
                "adds %[a], %[a], %[bl]\n\t"
                : [a] "+l"(a), [b] "+l"(b), [al] "=&l"(al), [bl] "=&l"(bl), [t] "=&l"(t)
                :
                : "cc");
        return a;
    }
#endif
    return static_cast<uint32_t>(uint64_t{a} * b >> 32);
}

// The upper 32 bits of a * b, rounded down. Only where has_wide_multiply.
QRAY_INLINE constexpr int32_t signed_mul_high(int32_t a, int32_t b)
{
    return static_cast<int32_t>((int64_t{a} * b) >> 32);
}

namespace detail {

struct Magnitude128 {
    uint64_t high, low;
};

QRAY_NOINLINE constexpr Magnitude128 product_magnitude(int64_t a, int64_t b)
{
    const uint64_t x = magnitude(a), y = magnitude(b);
    const uint32_t xh = static_cast<uint32_t>(x >> 32), xl = static_cast<uint32_t>(x);
    const uint32_t yh = static_cast<uint32_t>(y >> 32), yl = static_cast<uint32_t>(y);
    const uint64_t low = wide_mul(xl, yl);
    const uint64_t left = wide_mul(xh, yl) + (low >> 32);
    const uint64_t right = wide_mul(xl, yh) + static_cast<uint32_t>(left);
    return {wide_mul(xh, yh) + (left >> 32) + (right >> 32), right << 32 | static_cast<uint32_t>(low)};
}

} // namespace detail

// The sign of a b - c d, exact: -1, 0 or 1.
QRAY_NOINLINE constexpr int compare_products(int64_t a, int64_t b, int64_t c, int64_t d)
{
    const auto sign = [](int64_t x, int64_t y) { return x == 0 || y == 0 ? 0 : (x < 0) == (y < 0) ? 1 : -1; };
    const int first = sign(a, b), second = sign(c, d);
    if (first != second)
        return first > second ? 1 : -1;
    const detail::Magnitude128 m = detail::product_magnitude(a, b), n = detail::product_magnitude(c, d);
    if (m.high != n.high)
        return m.high > n.high ? first : -first;
    return m.low == n.low ? 0 : m.low > n.low ? first : -first;
}

// x / 2^Shift to the nearest, halves up, for results that fit 32 bits.
template <int Shift>
QRAY_INLINE constexpr int32_t rounding_shift(int64_t x)
{
#if QRAY_NARROW_MULTIPLY
    if constexpr (Shift < 32) {
        if (!__builtin_is_constant_evaluated()) {
            // The last bit that the lower half's shift drops is the carry.
            uint32_t low = static_cast<uint32_t>(x);
            const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(x) >> 32) << (32 - Shift);
            __asm__(".syntax unified\n\t"
                    "lsrs %[low], %[low], %[shift]\n\t"
                    "adcs %[low], %[low], %[high]\n\t"
                    : [low] "+l"(low)
                    : [high] "l"(high), [shift] "i"(Shift)
                    : "cc");
            return static_cast<int32_t>(low);
        }
    }
#elif defined(__thumb2__)
    if constexpr (Shift < 32) {
        if (!__builtin_is_constant_evaluated()) {
            uint32_t low = static_cast<uint32_t>(x);
            const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(x) >> 32);
            __asm__("lsrs %[low], %[low], %[shift]\n\t"
                    "adc %[low], %[low], %[high], lsl %[up]\n\t"
                    : [low] "+r"(low)
                    : [high] "r"(high), [shift] "i"(Shift), [up] "i"(32 - Shift)
                    : "cc");
            return static_cast<int32_t>(low);
        }
    }
#endif
    if constexpr (sizeof(void*) == 4 && Shift < 32) {
        const uint32_t low = static_cast<uint32_t>(x);
        const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(x) >> 32);
        return static_cast<int32_t>((high << (32 - Shift)) + (((low >> (Shift - 1)) + 1) >> 1));
    }
    return static_cast<int32_t>((x + (int64_t{1} << (Shift - 1))) >> Shift);
}

// The same for a shift in [1, 31] that is not known before.
QRAY_INLINE constexpr int32_t rounding_shift(int64_t x, int shift)
{
    if constexpr (sizeof(void*) == 8)
        return static_cast<int32_t>((x + (int64_t{1} << (shift - 1))) >> shift);
    const uint32_t low = static_cast<uint32_t>(x);
    const uint32_t high = static_cast<uint32_t>(static_cast<uint64_t>(x) >> 32);
    return static_cast<int32_t>((high << (32 - shift)) + (((low >> (shift - 1)) + 1) >> 1));
}

// The upper 32 bits of a * a.
constexpr uint32_t square_high(uint32_t a)
{
#if QRAY_NARROW_MULTIPLY
    // (2 ah al + (al^2 >> 16)) >> 16 without its 33rd bit; the sum below is less than 2^32.
    uint32_t al = a & 0xffff;
    uint32_t ah = a >> 16;
    return ah * ah + ((ah * al + (al * al >> 17)) >> 15);
#else
    return static_cast<uint32_t>(uint64_t{a} * a >> 32);
#endif
}

// a * a, exact.
constexpr uint64_t wide_square(int32_t a)
{
#if QRAY_NARROW_MULTIPLY
    if (!__builtin_is_constant_evaluated()) {
        int32_t low = a;
        int32_t high, al, t;
        __asm__(".syntax unified\n\t"
                "uxth %[al], %[a]\n\t"
                "asrs %[h], %[a], #16\n\t"
                "muls %[a], %[a]\n\t"
                "movs %[t], %[al]\n\t"
                "muls %[t], %[h]\n\t"
                "muls %[al], %[al]\n\t"
                "lsrs %[al], %[al], #17\n\t"
                "adds %[t], %[t], %[al]\n\t"
                "asrs %[t], %[t], #15\n\t"
                "muls %[h], %[h]\n\t"
                "adds %[h], %[h], %[t]\n\t"
                : [a] "+l"(low), [h] "=&l"(high), [al] "=&l"(al), [t] "=&l"(t)
                :
                : "cc");
        return static_cast<uint64_t>(static_cast<uint32_t>(high)) << 32 | static_cast<uint32_t>(low);
    }
#endif
    return static_cast<uint64_t>(int64_t{a} * a);
}

// ax bx + ay by + az bz, exact. The caller guarantees that the sum fits int64_t (it is otherwise
// reduced modulo 2^64); the partial sums need not.
constexpr int64_t wide_dot(int32_t ax, int32_t ay, int32_t az, int32_t bx, int32_t by, int32_t bz)
{
#if defined(__thumb2__)
    if (!__builtin_is_constant_evaluated()) {
        uint32_t low, high;
        __asm__("smull %[low], %[high], %[ax], %[bx]\n\t"
                "smlal %[low], %[high], %[ay], %[by]\n\t"
                "smlal %[low], %[high], %[az], %[bz]\n\t"
                : [low] "=&r"(low), [high] "=&r"(high)
                : [ax] "r"(ax), [ay] "r"(ay), [az] "r"(az), [bx] "r"(bx), [by] "r"(by), [bz] "r"(bz));
        return static_cast<int64_t>(uint64_t{high} << 32 | low);
    }
#endif
    return static_cast<int64_t>(static_cast<uint64_t>(wide_mul(ax, bx))
                                + static_cast<uint64_t>(wide_mul(ay, by))
                                + static_cast<uint64_t>(wide_mul(az, bz)));
}

// The upper 32 bits of ax bx + ay by + az bz, which fits int64_t, up to 3 too low. Only where has_wide_multiply.
QRAY_INLINE constexpr int32_t high_dot(int32_t ax, int32_t ay, int32_t az, int32_t bx, int32_t by, int32_t bz)
{
#if defined(__riscv)
    return signed_mul_high(ax, bx) + signed_mul_high(ay, by) + signed_mul_high(az, bz);
#else
    return static_cast<int32_t>(wide_dot(ax, ay, az, bx, by, bz) >> 32);
#endif
}

// x^2 + y^2 + z^2, exact: at most 3 * 2^62, so it always fits.
constexpr uint64_t wide_norm2(int32_t x, int32_t y, int32_t z)
{
    return wide_square(x) + wide_square(y) + wide_square(z);
}

} // namespace qray
