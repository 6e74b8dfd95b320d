// Where a ray meets a plane: for all flat surfaces.
#pragma once

#include "shape.hpp"

namespace qray {

// t = n.(c - o) / n.d, where that is in (0, limit]. A numerator beyond limit times the denominator is
// turned away before the division, so that no quotient overflows.
template <class N>
QRAY_INLINE constexpr bool intersect_plane(typename N::Moment num, typename N::Cosine den,
                                           typename N::Length limit, typename N::Length& t)
{
    constexpr typename N::Moment zero_moment{};
    constexpr typename N::Cosine zero_cosine{};
    if constexpr (!N::is_fixed) { // 0 / 0, and infinity, are turned away below
        if (N::negative(num) != N::negative(den))
            return false;
    } else if (den > zero_cosine ? !(num > zero_moment) : !(num < zero_moment)) {
        return false;
    }
    if constexpr (N::is_fixed) {
        return N::quotient(num, den, 0, t) && t > N::length_zero && t <= limit;
    } else {
        t = num / den; // infinite is beyond the limit
        return t > N::length_zero && t <= limit;
    }
}

// Where a ray meets a polygon. Corners that are not quite in one plane let a ray almost along it meet it far
// outside the world, where differences of points would overflow: such a point is put back to the edge.
template <class N>
QRAY_INLINE constexpr Point<N> in_world(const Ray<N>& ray, typename N::Length t)
{
    const Point<N> a = along<N>(t, ray.direction), o = ray.origin;
    if constexpr (N::is_fixed) {
        using Length = typename N::Length;
        const auto sum = [](Length u, Length v) {
            constexpr Length edge{int32_t{64} << Length::frac};
            return v > edge - u ? edge : v < -edge - u ? -edge : u + v;
        };
        return {sum(o.x, a.x), sum(o.y, a.y), sum(o.z, a.z)};
    } else {
        return o + a;
    }
}

// A hit q on the plane through c: moved onto it where its error, which is that of t, is more than some ulp.
template <class N>
QRAY_INLINE constexpr Point<N> on_plane([[maybe_unused]] const Point<N>& c, [[maybe_unused]] const Direction<N>& normal,
                                        const Point<N>& q)
{
    if constexpr (!N::is_fixed)
        return q - along_normal<N>(dot_normal<N>(q - c, normal), normal);
    else if constexpr (NarrowFixed<N>)
        return q - along<N>(N::length(dot<N>(q - c, normal)), normal);
    else
        return q;
}

// Is a crossing of a plane at t before a light at `distance`, and not at it? Measured across the plane, so that a
// light that lies in it is not blocked however flat the ray.
template <class N>
QRAY_INLINE constexpr bool before_light(const Direction<N>& normal, const Ray<N>& ray, typename N::Length t,
                                        typename N::Length distance)
{
    const auto across = N::length((distance - t) * N::unit(dot<N>(ray.direction, normal)));
    return across > N::light_clearance || -across > N::light_clearance;
}

} // namespace qray
