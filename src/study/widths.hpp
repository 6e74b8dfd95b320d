// To how many bits each step of the tracer rounds, and what a number system in fixed point has of these.
#pragma once

#include <qray/picture/render.hpp>

#include "steps.hpp"

namespace qray::study {

// Doubles have so many bits behind the point where it matters: nothing is rounded.
inline constexpr int exact = 52;

// v to so many bits behind the point, to the nearest, halves up; or cut, always downward.
struct Rounding {
    double limit = 0, shift = 0, half = 0; // what is not below the limit has no more bits
    bool cuts = false;

    constexpr Rounding() = default;
    constexpr explicit Rounding(int bits, bool cut = false) : cuts(cut)
    {
        if (bits >= exact)
            return;
        half = 0.5;
        for (int i = 0; i < bits; i++)
            half /= 2;
        limit = half * 0x1p52;
        shift = limit * 3;
    }
    constexpr double operator()(double v) const
    {
        if (!(v < limit && v > -limit))
            return v;
        const double even = (v + shift) - shift;
        if (cuts)
            return even > v ? even - 2 * half : even;
        return v - even == half ? even + 2 * half : even;
    }
};

// v to so many bits from the first that `like` has.
constexpr double significant(double v, int bits, double like)
{
    const double size = like < 0 ? -like : like;
    if (bits >= exact || !(size > 0x1p-500 && size < 0x1p500))
        return v;
    const double first = __builtin_bit_cast(double, __builtin_bit_cast(uint64_t, size) >> exact << exact);
    return Rounding(bits - 1)(v / first) * first;
}

// What is measured at a time. Spheres and cones are block-scaled in fixed point; in a plain table they are not.
struct Widths {
    int bits[steps];
    bool cuts[steps] = {};          // where it does not round
    int leave = 2;                  // how far off a surface new rays start, in last bits of a hit point
    bool keeps_rest = false;        // of what rounds the centres of spheres and cones: Rounded
    const Blocks* blocks = nullptr; // of Lengths with `length` bits
    int length = 0;

    constexpr explicit Widths(int all = exact)
    {
        for (int& b : bits)
            b = all;
        cuts[static_cast<int>(Step::map)] = true;
    }
    constexpr int& operator[](Step step) { return bits[static_cast<int>(step)]; }
    constexpr int operator[](Step step) const { return bits[static_cast<int>(step)]; }
    friend constexpr bool operator==(const Widths&, const Widths&) = default;
};

// Those of a number system in fixed point, whose colours are stored divided by 2^exposure.
template <class N>
constexpr Widths widths_of(int exposure)
{
    constexpr int Length = N::Length::frac, Unit = N::Unit::frac, Eta = N::Eta::frac;
    const int Colour = N::Colour::frac - exposure;
    // Reciprocals have 16 or 32 bits. Where products have 32, the rows of textures have those of a Unit and one more;
    // texture coordinates have more bits than their rows say.
    constexpr int Quotient = ShortFixed<N> ? 15 : 31, Row = Unit + NarrowFixed<N>, Cell = exact;
    // What q24 has as q16 has it: powers, what its colours are multiplied by, which it cuts, and factors of ratio().
    constexpr bool is_mixed = NarrowFixed<N> && !ShortFixed<N>;
    constexpr int Share = is_mixed ? q16::Unit::frac : Unit, Curved = is_mixed ? q16::ratio_bits : Unit;
    Widths w;
#define QRAY_WIDTH(name, quantity, what) w[Step::name] = quantity;
    QRAY_STEPS(QRAY_WIDTH)
#undef QRAY_WIDTH
    w.cuts[static_cast<int>(Step::share)] = is_mixed;
    w.leave = N::leave(N::one).raw;
    w.keeps_rest = WideFixed<N>;
    w.blocks = &N::blocks;
    w.length = Length;
    return w;
}

inline Widths widths;
inline Rounding roundings[steps];

inline void set(const Widths& w)
{
    widths = w;
    for (int i = 0; i < steps; i++)
        roundings[i] = Rounding(w.bits[i], w.cuts[i]);
}

// In a constant expression, which a member's specialisation must allow, nothing is rounded.
template <Step S>
QRAY_INLINE constexpr double keep(double v)
{
    if (__builtin_is_constant_evaluated())
        return v;
    return roundings[static_cast<int>(S)](v);
}
template <Step S>
QRAY_INLINE constexpr Vec<double> keep(const Vec<double>& v)
{
    return {keep<S>(v.x), keep<S>(v.y), keep<S>(v.z)};
}

} // namespace qray::study
