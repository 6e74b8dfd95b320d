// Sphere. With v = c - o, b = v.d and p = v - b d (the perpendicular from the ray to the centre), the ray
// meets it where |p|^2 <= r^2, at t = b -+ sqrt(r^2 - |p|^2) (Haines, Guenther, Akenine-Moeller, Ray Tracing
// Gems ch. 7): no cancellation, and an error of |d| counts only in its square.
#pragma once

#include "ray.hpp"

namespace qray {

template <class N>
struct Sphere {
    Point<N> centre;
    typename N::Length radius;        // > 0
    typename N::Scale inverse_radius; // 1 / radius
    Tag tag;
};

// The nearest t in (0, limit], or false. t is within 2 ulp of the hit of the ray as given, more where it grazes.
template <class N>
QRAY_INLINE constexpr bool intersect(const Sphere<N>& s, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward) // convex: never met again
        return false;
    const Point<N> v = s.centre - ray.origin;
    const auto b = N::length(dot<N>(v, ray.direction));
    if (leaving == Leaves::inward) { // the chord
        t = b + b;
        if (!(t > N::length_zero))
            t = N::ulp;
        return t <= limit;
    }
    if (b < -s.radius)
        return false;
    const Point<N> p = v - along<N>(b, ray.direction);
    const auto p2 = norm2<N>(p);
    const auto r2 = s.radius * s.radius;
    if (p2 > r2)
        return false;
    const auto half = N::sqrt(r2 - p2);
    t = b - half;
    if (!(t > N::length_zero))
        t = b + half;
    return t > N::length_zero && t <= limit;
}

// How often the ray crosses the sphere strictly between its origin and limit: 0, 1 or 2.
template <class N>
QRAY_INLINE constexpr int crossings(const Sphere<N>& s, const Ray<N>& ray, typename N::Length limit)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward)
        return 0;
    const Point<N> v = s.centre - ray.origin;
    const auto b = N::length(dot<N>(v, ray.direction));
    if (leaving == Leaves::inward)
        return b + b < limit;
    if (b < -s.radius)
        return 0;
    const Point<N> p = v - along<N>(b, ray.direction);
    const auto p2 = norm2<N>(p);
    const auto r2 = s.radius * s.radius;
    if (p2 > r2)
        return 0;
    const auto half = N::sqrt(r2 - p2);
    const auto near = b - half;
    const auto far = b + half;
    return (near > N::length_zero && near < limit) + (far > N::length_zero && far < limit);
}

// crossings() > 0.
template <class N>
QRAY_INLINE constexpr bool blocks(const Sphere<N>& s, const Ray<N>& ray, typename N::Length limit)
{
    return crossings(s, ray, limit) != 0;
}

// The outward unit normal at a point of the sphere.
template <class N>
QRAY_INLINE constexpr Direction<N> normal_at(const Sphere<N>& s, const Point<N>& q)
{
    Direction<N> n{N::zero, N::zero, N::one};
    normalise<N>(q - s.centre, n);
    return n;
}

} // namespace qray
