// Planar polygon, convex or concave.
#pragma once

#include "corners.hpp"
#include "reject.hpp"

namespace qray {

template <class N>
struct Polygon {
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

// t in (0, limit], or false. The polygon that the ray starts on does not count.
template <class N>
constexpr bool intersect(const Polygon<N>& s, const Point<N>* vertices, const Ray<N>& ray, typename N::Length limit,
                         typename N::Length& t)
{
    if (ray.from == s.tag)
        return false;
    const Point<N>* first = vertices + s.first;
    const auto corner = [first, &ray](uint32_t i) { return first[i] - ray.origin; };
    return intersect_corners<N>(s.normal, s.count, corner, ray, limit, t);
}

// How often the ray crosses it strictly between its origin and a light at `distance`: 0 or 1.
template <class N>
constexpr int crossings(const Polygon<N>& s, const Point<N>* vertices, const Ray<N>& ray, typename N::Length distance)
{
    typename N::Length t{};
    return intersect(s, vertices, ray, distance, t) && before_light<N>(s.normal, ray, t, distance);
}

template <class N>
QRAY_INLINE constexpr Direction<N> normal_at(const Polygon<N>& s)
{
    return s.normal;
}

} // namespace qray
