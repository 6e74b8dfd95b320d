// The sphere of a textbook in place of include/qray/shape/sphere.hpp: b^2 - c, a threshold on t, and a hit point
// that is whatever o + t d comes to. What does not depend on the ray is stored. lean.py beside this folder
// builds firmware with it.
#pragma once

#include "reject.hpp"

namespace qray {

// Does a ray that left a sphere outward skip it?
inline constexpr bool lean_knows_surface = false;

// Hits nearer than a thousandth are the surface that the ray leaves.
template <class N>
inline constexpr typename N::Length lean_threshold = [] {
    if constexpr (N::is_fixed)
        return typename N::Length{(1 << N::Length::frac) / 1000 + 1};
    else
        return typename N::Length(0.001);
}();

template <class N>
struct Sphere {
    static constexpr bool has_corners = false, keeps_local = true, is_smooth = false, is_short = true;

    Point<N> centre;
    typename N::Length radius, reach; // the latter for the reject
    typename N::Area square;  // of the radius
    typename N::Scale inverse_radius;
    Tag tag;
    static constexpr int32_t fine = 0;

    // From what a compiled scene gives sphere.hpp's.
    constexpr Sphere(Point<N> c, typename N::Length r, typename N::Scale inverse, int32_t up, Tag name,
                     Rounded<N>)
        : centre(c), radius(N::coarse(r, up)), reach(N::coarse_above(r, up)), square(r * r),
          inverse_radius(inverse), tag(name)
    {
        if constexpr (N::is_fixed) {
            square.raw >>= 2 * up;
            inverse_radius.shift += up;
        }
    }
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Sphere<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_ball(s.centre, s.reach);
}

// t of both meetings, and the centre as seen from the origin.
template <class N>
QRAY_INLINE constexpr bool lean_roots(const Sphere<N>& s, const Ray<N>& ray, Point<N>& v,
                                      typename N::Length& near, typename N::Length& far)
{
    if constexpr (lean_knows_surface)
        if (leaves(ray, s.tag) == Leaves::outward)
            return false;
    v = s.centre - ray.origin;
    const auto b = N::length(dot<N>(v, ray.direction));
    const auto discriminant = b * b - (norm2<N>(v) - s.square);
    if (discriminant < typename N::Area{})
        return false;
    const auto root = N::sqrt(discriminant);
    near = b - root;
    far = b + root;
    return true;
}

template <bool Near = false, class N>
QRAY_INLINE constexpr bool intersect(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>& local)
{
    typename N::Length far{};
    Point<N> v{};
    if (!lean_roots(s, ray, v, t, far))
        return false;
    if (!(t > lean_threshold<N>)) {
        t = far;
        if (!(t > lean_threshold<N>))
            return false;
    }
    local.near = -v;
    local.offset = t;
    return t <= limit;
}

template <bool Near = false, class N>
QRAY_INLINE constexpr int crossings(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray,
                                    typename N::Length distance)
{
    typename N::Length near{}, far{};
    Point<N> v{};
    if (!lean_roots(s, ray, v, near, far))
        return 0;
    return (near > lean_threshold<N> && near < distance) + (far > lean_threshold<N> && far < distance);
}

template <class N>
QRAY_INLINE constexpr void surface_of(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length,
                                      const Local<N>& local, Point<N>& point, Direction<N>& n)
{
    const Point<N> w = local.near + along<N>(local.offset, ray.direction);
    n = {N::ratio(w.x, s.inverse_radius), N::ratio(w.y, s.inverse_radius), N::ratio(w.z, s.inverse_radius)};
    point = s.centre + w;
}

} // namespace qray
