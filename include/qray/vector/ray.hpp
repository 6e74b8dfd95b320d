// A ray, and the tag by which it knows the surface it left.
#pragma once

#include "vec.hpp"

namespace qray {

template <class N>
using Point = Vec<typename N::Length>;
template <class N>
using Direction = Vec<typename N::Unit>; // unit: its length is 1 within 2^-29 in q32, 2^-12 in q16
template <class N>
using Rgb = Vec<typename N::Colour>;

// Names a surface: its place in the scene file (20 bits, unique) and its material (12 bits).
// Of two hits at the same t the lower place wins.
struct Tag {
    uint32_t bits;
    static constexpr uint32_t none = 0xffffffff;
    constexpr uint32_t material() const { return bits >> 20; }
    constexpr uint32_t place() const { return bits & 0xfffff; }
    friend constexpr bool operator==(Tag a, Tag b) { return a.bits == b.bits; }
};
constexpr Tag make_tag(uint32_t place, uint32_t material) { return {material << 20 | place}; }

template <class N>
struct Ray {
    Point<N> origin;
    Direction<N> direction;
    Tag from;     // the surface that the origin lies on, or Tag::none
    bool outward; // which side of it the ray leaves to: that of its outward normal
};

// Is there room for a ray that is made before the last one is traced?
template <class N>
inline constexpr bool rays_ahead = in_lanes<N>;

// Which of the eye's samples a ray is for: its column and row among all of that size.
struct EyeSample {
    uint32_t x, y;
};

// Of no sample of the eye's: panels shine from the middles of their places.
struct PanelMiddle {};

// How a ray stands to a surface that it meets.
enum class Leaves { no, outward, inward };

template <class N>
QRAY_INLINE constexpr Leaves leaves(const Ray<N>& ray, Tag tag)
{
    return !(ray.from == tag) ? Leaves::no : ray.outward ? Leaves::outward : Leaves::inward;
}

// Where a ray meets a curved surface, seen from the surface's centre: the ray's point nearest to that, and how far
// along the ray the hit is from there. In the surface's own block scale. Of a lean triangle, `near` is the normal.
template <class N>
struct Local {
    Point<N> near;
    typename N::Length offset;
};

// A point's rounded coordinates less the exact ones, times 2^fine.
template <class N>
struct Rounded {};
template <WideFixed N>
struct alignas(in_lanes<N> ? 8 : alignof(int16_t)) Rounded<N> { // in lanes to be read at once
    int16_t x, y, z;
};

template <InParts N>
QRAY_INLINE constexpr Point<N> lengths_of(const Rounded<N>& rounded)
{
    return {{rounded.x}, {rounded.y}, {rounded.z}};
}

// p as seen from the exact point.
template <class N>
QRAY_INLINE constexpr Point<N> from_exact(const Point<N>& p, [[maybe_unused]] const Rounded<N>& rounded)
{
    if constexpr (WideFixed<N>)
        return p + lengths_of<N>(rounded);
    else
        return p;
}
// And back.
template <class N>
QRAY_INLINE constexpr Point<N> from_rounded(const Point<N>& p, [[maybe_unused]] const Rounded<N>& rounded)
{
    if constexpr (WideFixed<N>)
        return p - lengths_of<N>(rounded);
    else
        return p;
}

} // namespace qray
