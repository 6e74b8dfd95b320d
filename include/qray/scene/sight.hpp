// What a ray may meet, as far as it is known beforehand: in compiled scenes with windows (windows.hpp), else nothing is.
#pragma once

#include <stdint.h>

namespace qray {

// A set of shapes, a bit for each: from the highest on spheres, cones, polygons, patches, discs.
using ShapeSet = uint32_t;
// All shapes, however many.
inline constexpr ShapeSet every_shape = 0xffffffff;

template <bool Windows>
struct Sight;
template <>
struct Sight<false> {};

// The sights of a row of pixels, from the left.
template <bool Windows>
struct Sweep;
template <>
struct Sweep<false> {
    template <class S>
    constexpr Sweep(const S&, uint32_t)
    {
    }
    constexpr Sight<false> at(uint32_t) const { return {}; }
};

} // namespace qray
