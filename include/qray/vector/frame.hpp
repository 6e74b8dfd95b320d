// Where a compiled scene lies: its builder moved it by `origin` and scaled it by 2^-exponent, so that it fills a number
// system's range. A program that moves something speaks in scene units: in Coordinates, which are Q16.16 in fixed
// point, so from -32768 to 32768 in steps of 1/65536, and what the number system itself has in floating point.
#pragma once

#include "ray.hpp"

namespace qray {

template <class N>
using Coordinate = ByNumber<N, Fixed<16>, typename N::Length>;
template <class N>
using ScenePoint = Vec<Coordinate<N>>; // a point, or a vector, in scene units

// n/d, to the nearest; d > 0, and |n/d| < 2^15.
template <class N>
constexpr Coordinate<N> coordinate(int32_t n, int32_t d = 1)
{
    if constexpr (N::is_fixed)
        return {divide(n, static_cast<uint32_t>(d), 16)};
    else
        return static_cast<Coordinate<N>>(n) / static_cast<Coordinate<N>>(d);
}

// a b, to the nearest; in fixed point it must be less than 2^15.
template <class N>
constexpr Coordinate<N> times(Coordinate<N> a, Coordinate<N> b)
{
    if constexpr (N::is_fixed)
        return {rounding_shift<16>(wide_mul(a.raw, b.raw))};
    else
        return a * b;
}

namespace detail {

// v 2^by to the nearest, halves to even, as desktops round; clamped to +-(2^31 - 1).
constexpr int32_t shifted_even(int64_t v, int by)
{
    constexpr int64_t most = INT32_MAX;
    if (by < 0) {
        const int down = by < -62 ? 62 : -by;
        const int64_t half = int64_t{1} << (down - 1);
        // |v| is less than 2^62
        v = (v + half - 1 + (v >> down & 1)) >> down;
        by = 0;
    }
    // By two factors, none of which overflows after what was clamped.
    for (; by > 0 && v <= most && v >= -most; by -= by < 30 ? by : 30)
        v *= int64_t{1} << (by < 30 ? by : 30);
    return static_cast<int32_t>(v > most ? most : v < -most ? -most : v);
}

} // namespace detail

template <class N>
struct Frame;

template <class N>
    requires(N::is_fixed)
struct Frame<N> {
    ScenePoint<N> origin;
    int32_t exponent;

    // (p - origin) / 2^(exponent + shift) to the nearest, halves to even; what leaves the range of
    // Length is clamped to it.
    constexpr Point<N> point(const ScenePoint<N>& p, int shift = 0) const
    {
        return {of(int64_t{p.x.raw} - origin.x.raw, -shift), of(int64_t{p.y.raw} - origin.y.raw, -shift),
                of(int64_t{p.z.raw} - origin.z.raw, -shift)};
    }
    // Likewise of a distance, or of a vector's parts; times 2^fine.
    constexpr typename N::Length length(Coordinate<N> l, int fine = 0) const { return of(l.raw, fine); }
    constexpr Point<N> vector(const ScenePoint<N>& v) const { return {length(v.x), length(v.y), length(v.z)}; }

    // The way back.
    constexpr ScenePoint<N> place(const Point<N>& p) const
    {
        return {add(back(p.x), origin.x), add(back(p.y), origin.y), add(back(p.z), origin.z)};
    }
    constexpr Coordinate<N> back(typename N::Length l) const { return {detail::shifted_even(l.raw, -up())}; }

private:
    constexpr int up() const { return N::Length::frac - Coordinate<N>::frac - exponent; }
    constexpr typename N::Length of(int64_t v, int fine) const { return {detail::shifted_even(v, up() + fine)}; }
    static constexpr Coordinate<N> add(Coordinate<N> a, Coordinate<N> b) { return {saturating_add(a.raw, b.raw)}; }
};

template <class N>
    requires(!N::is_fixed)
struct Frame<N> {
    ScenePoint<N> origin;
    typename N::Length scale, unit; // 2^-exponent, and back

    constexpr Point<N> point(const ScenePoint<N>& p, int = 0) const { return vector(p - origin); }
    constexpr typename N::Length length(Coordinate<N> l, int = 0) const { return l * scale; }
    constexpr Point<N> vector(const ScenePoint<N>& v) const { return {v.x * scale, v.y * scale, v.z * scale}; }
    constexpr ScenePoint<N> place(const Point<N>& p) const
    {
        return ScenePoint<N>{back(p.x), back(p.y), back(p.z)} + origin;
    }
    constexpr Coordinate<N> back(typename N::Length l) const { return l * unit; }
};

// a + b, each component clamped to the range of Length.
template <class N>
constexpr Point<N> saturating_sum(const Point<N>& a, const Point<N>& b)
{
    if constexpr (N::is_fixed) {
        const auto add = [](auto u, auto v) { return decltype(u){saturating_add(u.raw, v.raw)}; };
        return {add(a.x, b.x), add(a.y, b.y), add(a.z, b.z)};
    } else {
        return a + b;
    }
}

// Does the ball of that radius lie in the world that the number system holds? Where anything is not a number, no.
template <class N>
constexpr bool ball_in_world(const Point<N>& centre, typename N::Length radius = N::length_zero)
{
    if constexpr (N::is_fixed) {
        constexpr int32_t most = 125 << (N::Length::frac - 1); // 62.5: of the builder's 62 some room for rounding
        const int32_t room = radius.raw < 0 ? -1 : most - radius.raw;
        return room >= 0 && wide_norm2(centre.x.raw, centre.y.raw, centre.z.raw) <= wide_square(room);
    } else {
        const auto room = typename N::Length(125) / 2 - radius;
        return radius >= 0 && room >= 0 && norm2<N>(centre) <= room * room;
    }
}
// Does the disc across the unit vector n?
template <class N>
constexpr bool disc_in_world(const Point<N>& centre, const Direction<N>& n, typename N::Length radius)
{
    if (!ball_in_world<N>(centre) || !ball_in_world<N>({}, radius))
        return false;
    const auto height = N::length(dot<N>(centre, n));
    const Point<N> beside = centre - along<N>(height, n);
    typename N::Length across{};
    if constexpr (N::is_fixed)
        across = {static_cast<int32_t>(
            isqrt(static_cast<int64_t>(wide_norm2(beside.x.raw, beside.y.raw, beside.z.raw))))};
    else
        across = N::sqrt(norm2<N>(beside));
    return ball_in_world<N>({height, saturating_sum<N>({across, {}, {}}, {radius, {}, {}}).x, {}});
}

} // namespace qray
