// Fixed-point numbers: Fixed<Frac, Bits> is a signed number in Q-format with Frac fractional bits, kept in 32;
// Wide<Frac, Bits> holds the exact product of two of them, or a sum of such products, in 2 Bits. Where Bits is 16 a
// product's factors share the 31 bits beside its sign (q16.hpp says how); where it is 24 the product has its upper 32
// bits (q24.hpp). A chain of products is summed in Wide and rounded once, to nearest, ties upward.
//
// Nothing here checks for overflow: every caller states why its values fit, or uses saturating_*.
#pragma once

#include "wide.hpp"

namespace qray {

// The one type, or the other.
template <bool First>
struct Chosen {
    template <class A, class B>
    using Type = A;
};
template <>
struct Chosen<false> {
    template <class A, class B>
    using Type = B;
};
template <bool First, class A, class B>
using Either = typename Chosen<First>::template Type<A, B>;

template <int Frac, int Bits = 32>
struct Fixed {
    static constexpr int frac = Frac;
    int32_t raw; // value * 2^Frac

    friend constexpr Fixed operator+(Fixed a, Fixed b) { return {a.raw + b.raw}; }
    friend constexpr Fixed operator-(Fixed a, Fixed b) { return {a.raw - b.raw}; }
    constexpr Fixed operator-() const { return {-raw}; }
    constexpr Fixed& operator+=(Fixed b) { raw += b.raw; return *this; }
    friend constexpr bool operator==(Fixed a, Fixed b) { return a.raw == b.raw; }
    friend constexpr bool operator<(Fixed a, Fixed b) { return a.raw < b.raw; }
    friend constexpr bool operator>(Fixed a, Fixed b) { return a.raw > b.raw; }
    friend constexpr bool operator<=(Fixed a, Fixed b) { return a.raw <= b.raw; }
    friend constexpr bool operator>=(Fixed a, Fixed b) { return a.raw >= b.raw; }
};

template <int Frac, int Bits = 32>
struct Wide {
    static constexpr int frac = Frac;
    using Rep = Either<Bits == 32, int64_t, int32_t>;
    Rep raw; // value * 2^Frac

    friend constexpr Wide operator+(Wide a, Wide b) { return {a.raw + b.raw}; }
    friend constexpr Wide operator-(Wide a, Wide b) { return {a.raw - b.raw}; }
    constexpr Wide operator-() const { return {-raw}; }
    friend constexpr bool operator==(Wide a, Wide b) { return a.raw == b.raw; }
    friend constexpr bool operator<(Wide a, Wide b) { return a.raw < b.raw; }
    friend constexpr bool operator>(Wide a, Wide b) { return a.raw > b.raw; }
    friend constexpr bool operator<=(Wide a, Wide b) { return a.raw <= b.raw; }
    friend constexpr bool operator>=(Wide a, Wide b) { return a.raw >= b.raw; }
};

// The exact product.
template <int A, int B>
QRAY_INLINE constexpr Wide<A + B, 32> operator*(Fixed<A, 32> a, Fixed<B, 32> b)
{
    return {wide_mul(a.raw, b.raw)};
}
template <int A, int B>
QRAY_INLINE constexpr Wide<A + B, 16> operator*(Fixed<A, 16> a, Fixed<B, 16> b)
{
    return {a.raw * b.raw};
}

// The nearest To; |w| must be within To's range.
template <class To, int Frac, int Bits>
QRAY_INLINE constexpr To round_to(Wide<Frac, Bits> w)
{
    constexpr int shift = Frac - To::frac;
    static_assert(shift > 0 && shift < 63);
    if constexpr (Bits == 32)
        return {rounding_shift<shift>(w.raw)};
    else
        return {(w.raw + (int32_t{1} << (shift - 1))) >> shift};
}

// a - b and a + b; what does not fit 32 bits gives +-(2^31 - 1).
constexpr int32_t saturating_sub(int32_t a, int32_t b)
{
    int32_t r = 0;
    if (__builtin_sub_overflow(a, b, &r))
        return a < 0 ? INT32_MIN + 1 : INT32_MAX;
    return r;
}
constexpr int32_t saturating_add(int32_t a, int32_t b)
{
    int32_t r = 0;
    if (__builtin_add_overflow(a, b, &r))
        return a < 0 ? INT32_MIN + 1 : INT32_MAX;
    return r;
}

} // namespace qray
