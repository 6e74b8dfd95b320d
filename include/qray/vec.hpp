// Three components of one type. What a vector stands for (a point, a direction, a colour) is said by its
// component type: Length, Unit or Colour of a number system.
#pragma once

#include "number.hpp"
#include "q16.hpp"

namespace qray {

template <class T>
struct Vec {
    T x, y, z;

    friend constexpr Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    constexpr Vec operator-() const { return {-x, -y, -z}; }
    friend constexpr bool operator==(const Vec& a, const Vec& b)
    {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};

// Exact in fixed point.
template <class N, class A, class B>
QRAY_INLINE constexpr auto dot(const Vec<A>& a, const Vec<B>& b)
{
    return N::dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
template <class N>
QRAY_INLINE constexpr auto norm2(const Vec<typename N::Length>& a)
{
    return N::norm2(a.x, a.y, a.z);
}

// Is a longer than r?
template <class N>
QRAY_INLINE constexpr bool beyond(const Vec<typename N::Length>& a, typename N::Length r)
{
    if constexpr (IsNarrow<N>)
        return N::beyond(a.x, a.y, a.z, r);
    else
        return norm2<N>(a) > r * r;
}

// t d, one rounding a component.
template <class N>
QRAY_INLINE constexpr Vec<typename N::Length> along(typename N::Length t, const Vec<typename N::Unit>& d)
{
    return {N::length(t * d.x), N::length(t * d.y), N::length(t * d.z)};
}
template <class N>
QRAY_INLINE constexpr Vec<typename N::Unit> scaled(typename N::Unit k, const Vec<typename N::Unit>& d)
{
    return {N::unit(k * d.x), N::unit(k * d.y), N::unit(k * d.z)};
}
template <class N>
QRAY_INLINE constexpr Vec<typename N::Colour> scaled(typename N::Unit k, const Vec<typename N::Colour>& c)
    requires N::is_fixed
{
    return {N::colour(c.x * k), N::colour(c.y * k), N::colour(c.z * k)};
}

// The point a little off q on one side of a surface with normal g: where a ray starts that leaves it.
template <class N>
QRAY_INLINE constexpr Vec<typename N::Length> step_off(const Vec<typename N::Length>& q,
                                                       const Vec<typename N::Unit>& g, bool outward)
{
    if constexpr (N::is_fixed) {
        const auto o = outward ? g : -g;
        return {q.x + N::leave(o.x), q.y + N::leave(o.y), q.z + N::leave(o.z)};
    } else {
        const auto step = N::leave(q.x, q.y, q.z);
        const auto k = outward ? step : -step;
        return {q.x + g.x * k, q.y + g.y * k, q.z + g.z * k};
    }
}

// The unit vector along v, each component within 1 ulp (fixed point). False, and u untouched, where v is zero.
template <class N, class T>
QRAY_INLINE constexpr bool normalise(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    return N::normalise(v.x, v.y, v.z, u.x, u.y, u.z);
}

// The same of what may be so short that its square is too small for float: false there, too.
template <class N, class T>
QRAY_INLINE constexpr bool normalise_short(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    if constexpr (!N::is_fixed)
        if (!(N::norm2(v.x, v.y, v.z) > N::least_square))
            return false;
    return normalise<N>(v, u);
}

} // namespace qray
