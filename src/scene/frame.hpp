// How a description is moved and scaled to fill a number system's range.
#pragma once

#include <math.h>

#include <qray/number/system.hpp>

#include "vec3d.hpp"

namespace qray::scene {

// How far a point may lie from the origin of what is moved and scaled.
inline constexpr double world = 62;

// The move and the scale: scaled = (p - origin) * scale, scale a power of two.
struct Frame {
    Vec3d origin, centre; // centre: of the scene box, in the scene's own units
    double scale = 1, radius = 0, far = 0;
    Vec3d eye;         // where rays start
    double pushed = 0; // how far that is from where the text has it
    Vec3d point(const Vec3d& p) const { return (p - origin) * scale; }
};

// What may stand far outside: in units of 2^shift lengths.
struct FarPoint {
    Vec3d at;
    int shift;
};
template <class N>
FarPoint far_point(Vec3d at)
{
    int shift = 0;
    if constexpr (N::is_fixed)
        for (; (NarrowFixed<N> ? scene::length(at) : largest(at)) > world; at = at * 0.5)
            shift++;
    return {at, shift};
}

} // namespace qray::scene
