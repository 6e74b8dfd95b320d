// The disc of a textbook in place of include/qray/shape/disc.hpp: a threshold on t, sums that may overflow, a
// shadow that ends at the light's t. lean.py beside this folder builds firmware with it.
#pragma once

#include "reject.hpp"
#include "plane.hpp"
#include "sphere.hpp"

namespace qray {

template <class N>
struct Disc {
    Point<N> centre;
    Direction<N> normal;
    typename N::Length radius;
    Tag tag;
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Disc<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_plane(s.centre, s.normal);
}

template <class N>
QRAY_INLINE constexpr bool intersect(const Disc<N>& s, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t)
{
    const Point<N> v = s.centre - ray.origin;
    if (!intersect_plane<N>(dot<N>(v, s.normal), dot<N>(ray.direction, s.normal), limit, t))
        return false;
    if (!(t > lean_threshold<N>))
        return false;
    return !(norm2<N>(along<N>(t, ray.direction) - v) > s.radius * s.radius);
}

template <class N>
QRAY_INLINE constexpr int crossings(const Disc<N>& s, const Ray<N>& ray, typename N::Length limit)
{
    typename N::Length t{};
    return intersect(s, ray, limit, t) && t < limit;
}

template <class N>
QRAY_INLINE constexpr Direction<N> normal_at(const Disc<N>& s)
{
    return s.normal;
}

} // namespace qray
