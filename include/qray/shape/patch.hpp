// Smooth patch: one triangle of the fan, with a normal at each corner. Its shading normal is the barycentric blend.
#pragma once

#include "corners.hpp"

namespace qray {

template <class N>
struct Patch {
    static constexpr bool has_corners = true, keeps_local = false, is_smooth = true, is_short = false, is_lean = false;

    Direction<N> normal;      // g of the triangle, unit
    Point<N> middle;          // of a ball that holds the triangle
    typename N::Length bound; // its radius
    uint32_t first, second;   // corners: first, second, second + 1; vertices and corner normals alike
    Tag tag;

    template <class P>
    QRAY_INLINE constexpr Figure<P> figure(const P* points) const
    {
        return {points + first, points + second, points + second + 1, 3};
    }
};

} // namespace qray
