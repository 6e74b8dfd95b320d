// Three components of one type. What a vector stands for (a point, a direction, a colour) is said by its
// component type: Length, Unit or Colour of a number system.
#pragma once

#include "../number/lanes.hpp"
#include "../number/floating.hpp"
#include "../number/q16.hpp"
#include "../number/q32.hpp"

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

// A copy part by part, which leaves the parts in registers where a copy of the whole goes through memory.
template <class T>
QRAY_INLINE constexpr Vec<T> parts_of(const Vec<T>& a)
{
    if constexpr (requires { a.lanes; })
        return a;
    else
        return {a.x, a.y, a.z};
}

// Are its vectors one register each? Then vec_lanes.hpp has the functions below.
template <class N>
inline constexpr bool in_lanes = QRAY_LANES && (N::is_fixed ? !NarrowFixed<N> : sizeof(typename N::Length) == 4);
template <class N>
concept InParts = !in_lanes<N>;

// Exact in fixed point.
template <InParts N, class A, class B>
QRAY_INLINE constexpr auto dot(const Vec<A>& a, const Vec<B>& b)
{
    return N::dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
template <InParts N>
QRAY_INLINE constexpr auto norm2(const Vec<typename N::Length>& a)
{
    return N::norm2(a.x, a.y, a.z);
}

// t d, one rounding a component.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> along(typename N::Length t, const Vec<typename N::Unit>& d)
{
    return {N::length(t * d.x), N::length(t * d.y), N::length(t * d.z)};
}
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Unit> scaled(typename N::Unit k, const Vec<typename N::Unit>& d)
{
    return {N::unit(k * d.x), N::unit(k * d.y), N::unit(k * d.z)};
}
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Colour> scaled(typename N::Unit k, const Vec<typename N::Colour>& c)
    requires N::is_fixed
{
    return {N::colour(c.x * k), N::colour(c.y * k), N::colour(c.z * k)};
}

// dot() and along() for the normal of a flat surface. In a constant table it often lies along an axis, and products with
// 0 change nothing but the sign of a floating-point 0.
template <class N, class A>
QRAY_INLINE constexpr auto dot_normal(const Vec<A>& a, const Vec<typename N::Unit>& n)
{
    if constexpr (!N::is_fixed && InParts<N>) {
        if (QRAY_KNOWN(n.x == 0) && QRAY_KNOWN(n.z == 0))
            return a.y * n.y;
        if (QRAY_KNOWN(n.x == 0) && QRAY_KNOWN(n.y == 0))
            return a.z * n.z;
        if (QRAY_KNOWN(n.y == 0) && QRAY_KNOWN(n.z == 0))
            return a.x * n.x;
    }
    return dot<N>(a, n);
}
template <class N>
QRAY_INLINE constexpr Vec<typename N::Length> along_normal(typename N::Length t, const Vec<typename N::Unit>& n)
{
    if constexpr (!N::is_fixed && InParts<N>)
        return {QRAY_KNOWN(n.x == 0) ? 0 : t * n.x, QRAY_KNOWN(n.y == 0) ? 0 : t * n.y, QRAY_KNOWN(n.z == 0) ? 0 : t * n.z};
    else
        return along<N>(t, n);
}

// The point a little off q on one side of a surface with normal g: where a ray starts that leaves it.
template <InParts N>
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
    requires(InParts<N> || sizeof(T) > 4)
QRAY_INLINE constexpr bool normalise(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    return N::normalise(v.x, v.y, v.z, u.x, u.y, u.z);
}

// Makes a vector unit whose length is 1 but for 2^-15.
template <InParts N>
QRAY_INLINE constexpr void sharpen(Vec<typename N::Unit>& n)
{
    N::sharpen(n.x, n.y, n.z);
}

// a - b, each component clamped to the range of Length.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> saturating_sub(const Vec<typename N::Length>& a,
                                                             const Vec<typename N::Length>& b)
{
    return {N::saturating_sub(a.x, b.x), N::saturating_sub(a.y, b.y), N::saturating_sub(a.z, b.z)};
}

// Adds light, whole or a part k of it, to a sum; each component, none of which is negative, clamped.
template <InParts N>
QRAY_INLINE constexpr void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light)
{
    sum.x = N::saturating_add(sum.x, light.x);
    sum.y = N::saturating_add(sum.y, light.y);
    sum.z = N::saturating_add(sum.z, light.z);
}
template <InParts N>
QRAY_INLINE constexpr void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light,
                                          typename N::Unit k)
{
    sum.x = N::saturating_add(sum.x, N::colour(light.x * k));
    sum.y = N::saturating_add(sum.y, N::colour(light.y * k));
    sum.z = N::saturating_add(sum.z, N::colour(light.z * k));
}

} // namespace qray
