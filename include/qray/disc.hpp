// Flat disc; and plane, which by IMAGE's definition ends at a distance `far` from the centre of the scene: it is
// the disc of radius sqrt(far^2 - h^2) around the foot of that centre, and is stored as one.
#pragma once

#include "narrow.hpp"
#include "plane.hpp"

namespace qray {

template <class N>
struct Disc {
    Point<N> centre;
    Direction<N> normal; // unit
    typename N::Length radius;
    Tag tag;
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Disc<N>& s, const NarrowRay<N>& narrow)
{
    return narrow.misses_plane(s.centre, s.normal);
}

template <class N>
QRAY_INLINE constexpr bool intersect(const Disc<N>& s, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t)
{
    if (ray.from == s.tag)
        return false;
    const Point<N> v = s.centre - ray.origin;
    if (!intersect_plane<N>(dot<N>(v, s.normal), dot<N>(ray.direction, s.normal), limit, t))
        return false;
    const Point<N> a = along<N>(t, ray.direction);
    const Point<N> w{N::saturating_sub(a.x, v.x), N::saturating_sub(a.y, v.y), N::saturating_sub(a.z, v.z)};
    const auto r = s.radius;
    if constexpr (N::is_fixed && !IsNarrow<N>) // outside the cube first: the sum of squares below then fits
        if (w.x > r || w.y > r || w.z > r || w.x < -r || w.y < -r || w.z < -r)
            return false;
    return !beyond<N>(w, r);
}

template <class N>
QRAY_INLINE constexpr int crossings(const Disc<N>& s, const Ray<N>& ray, typename N::Length limit)
{
    typename N::Length t{};
    return intersect(s, ray, limit, t) && before_light<N>(s.normal, ray, t, limit);
}

template <class N>
QRAY_INLINE constexpr Direction<N> normal_at(const Disc<N>& s)
{
    return s.normal;
}

} // namespace qray
