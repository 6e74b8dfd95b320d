// Windows: what the rays of each pixel may meet, from the rectangles of pixels in which the eye may see a shape, see it
// mirrored in the floor, or see its shadow there; and what the rays may meet that a sphere sends on, by octants. So most
// rays ask few shapes or none. After the item buffer of Weghorst, Hooper and Greenberg (1984), with rectangles for its
// pixels, and the ray classification of Arvo and Kirk (1987), with a sphere and an octant for its classes.
// The floor is the scene's largest disc; shapes may be on either side of it.
#pragma once

#include "../vector/ray.hpp"
#include "sight.hpp"

namespace qray {

inline constexpr uint32_t set_capacity = 10;
constexpr ShapeSet set_of(uint32_t shape) { return uint32_t{1} << 31 >> shape; }
// Beside the shapes: their bounding balls have not been asked yet.
inline constexpr ShapeSet unasked = 1;

// What a ray may meet, and what it may after a hit on the floor: three sets, unasked alike.
template <>
struct Sight<true> {
    uint32_t sets = every_shape;
    constexpr ShapeSet ahead() const { return sets; }
    constexpr bool is_empty() const { return sets >> (32 - set_capacity) == 0; }
    // From a hit on the floor: before a light, and of the mirrored ray.
    constexpr ShapeSet before_light() const { return sets << 2 * set_capacity | (sets & unasked); }
    constexpr Sight in_floor() const
    {
        constexpr uint32_t others = (0xffffffff >> set_capacity) - unasked;
        return {sets << set_capacity | others | (sets & unasked)};
    }
};

// From this column or row on, these sets hold what they did not, or no longer what they did.
struct Edge {
    uint32_t at;
    uint32_t changed;
};

struct Windows {
    const Edge* columns; // in order; the last is at UINT32_MAX
    const Edge* rows;
    // By sphere: what may be before a light that shines on its outside; and the sights of rays that leave its outside, by
    // octant.
    const ShapeSet* blockers;
    const uint32_t (*octants)[8];
    Tag floor;
};

// The signs of a direction: x in the lowest bit.
template <class N>
constexpr uint32_t octant_of(const Direction<N>& d)
{
    return uint32_t{N::negative(d.x)} | uint32_t{N::negative(d.y)} << 1 | uint32_t{N::negative(d.z)} << 2;
}

// The sights of a row of pixels: the sets of those columns and rows that have begun and not ended.
template <>
struct Sweep<true> {
    const Edge* next;
    uint32_t rows = 0, sets = 0;

    template <class S>
    constexpr Sweep(const S& scene, uint32_t j) : next(scene.windows.value.columns)
    {
        for (const Edge* edge = scene.windows.value.rows; edge->at <= j; edge++)
            rows ^= edge->changed;
    }
    constexpr Sight<true> at(uint32_t i) // no less than the last
    {
        for (; next->at <= i; next++)
            sets ^= next->changed & rows;
        return {sets};
    }
};

} // namespace qray
