// Directional lights.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Sun {
    Direction<N> from; // unit, towards the light
    Rgb<N> colour;
};

} // namespace qray
