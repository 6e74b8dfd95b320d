// Directional lights.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Sun {
    static constexpr bool has_place = false;

    Direction<N> from; // unit, towards the light
    Rgb<N> colour;
};

template <class N>
QRAY_INLINE constexpr bool towards(const Sun<N>& sun, const Point<N>&, Direction<N>& l, typename N::Length& distance)
{
    l = sun.from;
    distance = N::length_max;
    return true;
}

} // namespace qray
