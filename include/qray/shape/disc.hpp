// Flat disc; and plane, which ends at a distance `far` from the centre of the scene (scenes/README.md, Planes): it is
// the disc of radius sqrt(far^2 - h^2) around the foot of that centre, h away from it, and is stored as one.
#pragma once

#include "reject.hpp"
#include "plane.hpp"

namespace qray {

template <class N>
struct Disc {
    static constexpr bool has_corners = false, keeps_local = false, is_smooth = false, is_short = false;

    Point<N> centre;
    Direction<N> normal; // unit
    typename N::Length radius;
    Tag tag;
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Disc<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_plane(s.centre, s.normal);
}

template <class N>
QRAY_INLINE constexpr bool reaches(const Disc<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length distance)
{
    const Point<N> w = saturating_sub<N>(along<N>(distance, ray.direction), s.centre - ray.origin);
    return !outside_cube<N>(w, s.radius) && !beyond<N>(w, s.radius);
}

// t in (0, limit], or false. The disc that the ray starts on does not count.
template <bool Near = false, class N>
QRAY_INLINE constexpr bool intersect(const Disc<N>& s, const Corners<N>& corners, const Ray<N>& ray,
                                     typename N::Length limit, typename N::Length& t, Local<N>&)
{
    if (ray.from == s.tag)
        return false;
    const auto height = dot_normal<N>(s.centre - ray.origin, s.normal);
    return intersect_plane<N>(height, dot_normal<N>(ray.direction, s.normal), limit, t) && reaches(s, corners, ray, t);
}

// How often the ray crosses the disc strictly between its origin and a light at `distance`: 0 or 1.
template <bool Near = false, class N>
QRAY_INLINE constexpr int crossings(const Disc<N>& s, const Corners<N>& corners, const Ray<N>& ray,
                                    typename N::Length distance)
{
    typename N::Length t{};
    Local<N> local{};
    return intersect(s, corners, ray, distance, t, local) && before_light<N>(s.normal, ray, t, distance);
}

template <class N>
QRAY_INLINE constexpr void surface_of(const Disc<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length t,
                                      const Local<N>&, Point<N>& point, Direction<N>& n)
{
    n = s.normal;
    point = on_plane<N>(s.centre, n, ray.origin + along<N>(t, ray.direction));
}

template <class N>
constexpr bool move(const Disc<N>& from, const Corners<N>&, const Motion<N>& motion, Disc<N>& to,
                    const MovedCorners<N>&)
{
    const Disc<N> s{motion(from.centre), motion.direction(from.normal), motion.length(from.radius), from.tag};
    if (!motion.valid() || !(s.radius > N::length_zero) || !disc_in_world<N>(s.centre, s.normal, s.radius))
        return false;
    to = s;
    return true;
}

template <class N>
constexpr BoundingBox<N> box_of(const Disc<N>& s, const Corners<N>&)
{
    const auto side = [&s](auto a, auto b) { // some steps more than the root's and the product's roundings
        return N::length(s.radius * N::sqrt_unit(a * a + b * b)) + N::ulp + N::ulp + N::ulp + N::ulp;
    };
    const Direction<N>& n = s.normal;
    const Point<N> half{side(n.y, n.z), side(n.z, n.x), side(n.x, n.y)};
    return {s.centre - half, s.centre + half};
}

} // namespace qray
