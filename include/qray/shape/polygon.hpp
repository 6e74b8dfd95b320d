// Planar polygon, convex or concave.
#pragma once

#include "corners.hpp"

namespace qray {

template <class N>
struct Polygon {
    static constexpr bool has_corners = true, keeps_local = false, is_smooth = false, is_short = false, is_lean = false;

    Direction<N> normal;       // g, unit
    Point<N> middle;           // of a ball that holds all corners
    typename N::Length bound;  // its radius
    uint32_t first, count;     // corners, in the scene's vertices
    Tag tag;

    template <class P>
    QRAY_INLINE constexpr Figure<P> figure(const P* points) const
    {
        return {points + first, points + first + 1, points + first + 2, count};
    }
};

} // namespace qray
