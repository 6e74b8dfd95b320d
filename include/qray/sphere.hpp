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

// Half the chord that the ray cuts from the sphere, and the t of its middle; false where they do not meet.
template <class N>
QRAY_INLINE constexpr bool chord(const Sphere<N>& s, const Ray<N>& ray, Leaves leaving, typename N::Length& middle,
                                 typename N::Length& half)
{
    const Point<N> v = s.centre - ray.origin;
    middle = N::length(dot<N>(v, ray.direction));
    if (middle < -s.radius)
        return false;
    const Point<N> p = v - along<N>(middle, ray.direction);
    const auto p2 = norm2<N>(p);
    const auto r2 = s.radius * s.radius;
    if (p2 > r2) {
        half = N::length_zero;
        return leaving == Leaves::inward; // however short, that chord has another end
    }
    half = N::sqrt(r2 - p2);
    return true;
}

// The far end of a chord that begins at the ray's origin.
template <class N>
QRAY_INLINE constexpr typename N::Length chord_end(typename N::Length middle, typename N::Length half)
{
    const auto end = middle + half;
    return end > N::length_zero ? end : N::ulp;
}

// The nearest t in (0, limit], or false. t is within 2 ulp of the hit of the ray as given, more where it grazes.
template <class N>
QRAY_INLINE constexpr bool intersect(const Sphere<N>& s, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward) // convex: never met again
        return false;
    typename N::Length middle{}, half{};
    if (!chord(s, ray, leaving, middle, half))
        return false;
    if (leaving == Leaves::inward) {
        t = chord_end<N>(middle, half);
        return t <= limit;
    }
    t = middle - half;
    if (!(t > N::length_zero))
        t = middle + half;
    return t > N::length_zero && t <= limit;
}

// How often the ray crosses the sphere strictly between its origin and a light at `distance`: 0, 1 or 2.
template <class N>
QRAY_INLINE constexpr int crossings(const Sphere<N>& s, const Ray<N>& ray, typename N::Length distance)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward)
        return 0;
    const auto limit = distance - N::light_clearance;
    typename N::Length middle{}, half{};
    if (!chord(s, ray, leaving, middle, half))
        return 0;
    if (leaving == Leaves::inward)
        return chord_end<N>(middle, half) < limit;
    const auto near = middle - half;
    if (near >= limit)
        return 0;
    return (near > N::length_zero) + (middle + half > N::length_zero && middle + half < limit);
}

// crossings() > 0.
template <class N>
QRAY_INLINE constexpr bool blocks(const Sphere<N>& s, const Ray<N>& ray, typename N::Length distance)
{
    return crossings(s, ray, distance) != 0;
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
