// Smooth patch: one triangle of the fan, with a normal at each corner. Its shading normal is the barycentric blend.
#pragma once

#include "corners.hpp"
#include "reject.hpp"

namespace qray {

template <class N>
struct Patch {
    static constexpr bool has_corners = true, is_curved = false, is_smooth = true, is_short = false;

    Direction<N> normal;      // g of the triangle, unit
    Point<N> middle;          // of a ball that holds the triangle
    typename N::Length bound; // its radius
    uint32_t first, second;   // corners: first, second, second + 1; vertices and corner normals alike
    Tag tag;

    constexpr uint32_t corner(uint32_t i) const { return i == 0 ? first : second + i - 1; }
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Patch<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_ball(s.middle, s.bound);
}

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Patch<N>& s, const Corners<N>& corners, const ProjectedRay& ray)
{
    return surely_beside<N>(3, [&](uint32_t i) -> const Point<N>& { return corners.points[s.corner(i)]; }, ray);
}

template <class N>
constexpr bool encloses(const Patch<N>& s, const Corners<N>& corners, const Ray<N>& ray)
{
    const auto corner = [&](uint32_t i) { return corners.points[i == 0 ? s.first : s.second + i - 1] - ray.origin; };
    return encloses<N>(3, corner, ray.direction);
}

// t in (0, limit], or false. The triangle that the ray starts on does not count.
template <bool Enclosed, class N>
QRAY_NOINLINE constexpr bool meets(const Patch<N>& s, const Point<N>* corners, const Ray<N>& ray,
                                   typename N::Length limit, typename N::Length& t)
{
    if (ray.from == s.tag)
        return false;
    const auto corner = [&s, corners, &ray](uint32_t i) {
        return corners[i == 0 ? s.first : s.second + i - 1] - ray.origin;
    };
    return intersect_corners<Enclosed, N>(s.normal, 3, corners[s.first], corner, ray, limit, t);
}

template <bool Near = false, class N, class C>
QRAY_INLINE constexpr bool intersect(const Patch<N>& s, const C& corners, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>&)
{
    return meets<C::enclose>(s, corners.points, ray, limit, t);
}

// How often the ray crosses it strictly between its origin and a light at `distance`: 0 or 1.
template <bool Near = false, class N, class C>
QRAY_INLINE constexpr int crossings(const Patch<N>& s, const C& corners, const Ray<N>& ray, typename N::Length distance)
{
    typename N::Length t{};
    return meets<C::enclose>(s, corners.points, ray, distance, t) && before_light<N>(s.normal, ray, t, distance);
}

template <class N>
QRAY_INLINE constexpr void surface_of(const Patch<N>& s, const Corners<N>& corners, const Ray<N>& ray, typename N::Length t,
                                      const Local<N>&, Point<N>& point, Direction<N>& n)
{
    n = s.normal;
    point = on_plane<N>(corners.points[s.first], n, ray.origin + along<N>(t, ray.direction));
}

template <class N>
QRAY_INLINE constexpr Direction<N> normal_of(const Patch<N>& s, const Corners<N>&)
{
    return s.normal;
}

template <class N>
QRAY_NOINLINE constexpr Direction<N> shading_normal(const Patch<N>& s, const Corners<N>& corners, const Ray<N>& ray,
                                                    const Direction<N>& g)
{
    return blended_normal(s, corners, ray, g);
}

template <class N>
constexpr bool move(const Patch<N>& from, const Corners<N>& corners, const Motion<N>& motion, Patch<N>& to,
                    const MovedCorners<N>& moved)
{
    return move_figure(from, 3, [&from](uint32_t i) { return from.corner(i); }, corners, motion, to, moved);
}

template <class N>
constexpr Box<N> box_of(const Patch<N>& s, const Corners<N>& corners)
{
    return box_of_figure(3, [&s](uint32_t i) { return s.corner(i); }, corners);
}

} // namespace qray
