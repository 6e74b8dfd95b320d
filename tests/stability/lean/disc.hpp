// The disc of a textbook in place of include/qray/shape/disc.hpp: a threshold on t, sums that may overflow, a
// shadow that ends at the light's t. lean.py beside this folder builds firmware with it.
#pragma once

#include "reject.hpp"
#include "plane.hpp"
#include "sphere.hpp"

namespace qray {

template <class N>
struct Disc {
    static constexpr bool has_corners = false, keeps_local = false, is_smooth = false, is_short = false;

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

template <bool Near = false, class N>
QRAY_INLINE constexpr bool intersect(const Disc<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>&)
{
    const Point<N> v = s.centre - ray.origin;
    if (!intersect_plane<N>(dot<N>(v, s.normal), dot<N>(ray.direction, s.normal), limit, t))
        return false;
    if (!(t > lean_threshold<N>))
        return false;
    return !(norm2<N>(along<N>(t, ray.direction) - v) > s.radius * s.radius);
}

template <bool Near = false, class N>
QRAY_INLINE constexpr int crossings(const Disc<N>& s, const Corners<N>& corners, const Ray<N>& ray,
                                    typename N::Length limit)
{
    typename N::Length t{};
    Local<N> local{};
    return intersect(s, corners, ray, limit, t, local) && t < limit;
}

template <class N>
QRAY_INLINE constexpr void surface_of(const Disc<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length t,
                                      const Local<N>&, Point<N>& point, Direction<N>& n)
{
    n = s.normal;
    point = on_plane<N>(s.centre, n, ray.origin + along<N>(t, ray.direction));
}

} // namespace qray
