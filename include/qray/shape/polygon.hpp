// Planar polygon, convex or concave.
#pragma once

#include "corners.hpp"
#include "reject.hpp"

namespace qray {

template <class N>
struct Polygon {
    static constexpr bool has_corners = true, is_curved = false, is_smooth = false, is_short = false;

    Direction<N> normal;       // g, unit
    Point<N> middle;           // of a ball that holds all corners
    typename N::Length bound;  // its radius
    uint32_t first, count;     // corners, in the scene's vertices
    Tag tag;
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Polygon<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_ball(s.middle, s.bound);
}

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Polygon<N>& s, const Corners<N>& corners, const ProjectedRay& ray)
{
    return surely_beside<N>(s.count, [&](uint32_t i) -> const Point<N>& { return corners.points[s.first + i]; }, ray);
}

template <class N>
constexpr bool encloses(const Polygon<N>& s, const Corners<N>& corners, const Ray<N>& ray)
{
    const auto corner = [&](uint32_t i) { return corners.points[s.first + i] - ray.origin; };
    return encloses<N>(s.count, corner, ray.direction);
}

// t in (0, limit], or false. The polygon that the ray starts on does not count.
template <bool Enclosed, class N>
QRAY_NOINLINE constexpr bool meets(const Polygon<N>& s, const Point<N>* corners, const Ray<N>& ray,
                                   typename N::Length limit, typename N::Length& t)
{
    if (ray.from == s.tag)
        return false;
    const Point<N>* first = corners + s.first;
    const auto corner = [first, &ray](uint32_t i) { return first[i] - ray.origin; };
    return intersect_corners<Enclosed, N>(s.normal, s.count, *first, corner, ray, limit, t);
}

template <bool Near = false, class N, class C>
QRAY_INLINE constexpr bool intersect(const Polygon<N>& s, const C& corners, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>&)
{
    return meets<C::enclose>(s, corners.points, ray, limit, t);
}

// How often the ray crosses it strictly between its origin and a light at `distance`: 0 or 1.
template <bool Near = false, class N, class C>
QRAY_INLINE constexpr int crossings(const Polygon<N>& s, const C& corners, const Ray<N>& ray, typename N::Length distance)
{
    typename N::Length t{};
    return meets<C::enclose>(s, corners.points, ray, distance, t) && before_light<N>(s.normal, ray, t, distance);
}

template <class N>
QRAY_INLINE constexpr void surface_of(const Polygon<N>& s, const Corners<N>& corners, const Ray<N>& ray,
                                      typename N::Length t, const Local<N>&, Point<N>& point, Direction<N>& n)
{
    n = s.normal;
    point = on_plane<N>(corners.points[s.first], n, in_world(ray, t));
}

template <class N>
QRAY_INLINE constexpr Direction<N> normal_of(const Polygon<N>& s, const Corners<N>&)
{
    return s.normal;
}

template <class N>
constexpr bool move(const Polygon<N>& from, const Corners<N>& corners, const Motion<N>& motion, Polygon<N>& to,
                    const MovedCorners<N>& moved)
{
    const auto corner = [&from](uint32_t i) { return from.first + i; };
    return move_figure(from, from.count, corner, corners, motion, to, moved);
}

template <class N>
constexpr Box<N> box_of(const Polygon<N>& s, const Corners<N>& corners)
{
    return box_of_figure(s.count, [&s](uint32_t i) { return s.first + i; }, corners);
}

} // namespace qray
