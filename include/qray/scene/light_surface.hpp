// Surfaces that hold a light, or lie as near to it as rounding. A ray to that light meets such a surface where rounding
// decides whether before the light or not; but the same ray, sent from the light, is one that leaves the surface, and
// tells exactly how often it crosses the surface elsewhere.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct LightSurface {
    uint32_t light; // by its number in the scene's table of lights; the complement of that of a panel that lies in it
    Tag tag;
    Direction<N> normal; // unit, outward, at the light; 0 at an apex
    int32_t side;        // of the surface on which the text has the light: 1 outside, -1 inside, 0 on it
};

// The ray that comes from the light at `at` along another's way.
template <class N>
QRAY_INLINE constexpr Ray<N> from_light(const LightSurface<N>& surface, const Point<N>& at, const Ray<N>& to_light)
{
    const Direction<N> d = -to_light.direction;
    return {at, d, surface.tag, dot<N>(surface.normal, d) >= typename N::Cosine{}};
}

} // namespace qray
