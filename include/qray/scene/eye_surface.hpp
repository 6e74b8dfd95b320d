// The surface that the eye lies on. Rays from there leave it as those from a hit do, and do not meet it at t = 0.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct EyeSurface {
    Tag tag;
    Direction<N> normal; // unit, outward, at the eye; 0 at an apex, which every ray leaves outward
};

template <class N>
QRAY_INLINE constexpr void leave(const EyeSurface<N>& surface, Ray<N>& ray)
{
    ray.from = surface.tag;
    ray.outward = dot<N>(surface.normal, ray.direction) >= typename N::Cosine{};
}

} // namespace qray
