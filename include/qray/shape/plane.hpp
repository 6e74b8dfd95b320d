// Where a ray meets a plane: for all flat surfaces.
#pragma once

#include "../vector/ray.hpp"

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
