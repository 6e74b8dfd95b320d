// What a scene calls for. The set is a template argument of the tracer: what is not in it is neither compiled
// nor stored.
#pragma once

#include "lists.hpp"

namespace qray {

struct Effects {
#define QRAY_EFFECT(Type, name, table) bool name = false;
    QRAY_EFFECTS(QRAY_EFFECT)
#undef QRAY_EFFECT
    // entries of the tracer's stack: the greatest max depth. Only transmit has a stack.
    uint8_t depth = 5;
    bool moving = false; // the camera stands beside the scene, in RAM
    uint8_t light_bits = 8; // of a colour in light maps: 2, 4 or 8

#define QRAY_COUNT(Type, name, table) +name
    constexpr int shapes() const { return QRAY_SHAPES(QRAY_COUNT); }
    constexpr bool texture() const { return (QRAY_TEXTURES(QRAY_COUNT)) != 0; }
    constexpr bool lights() const { return (QRAY_LIGHTS(QRAY_COUNT)) != 0; }
#undef QRAY_COUNT
#define QRAY_ANY(Type, name, table) || (name && Type<Float>::has_corners)
    constexpr bool corners() const { return false QRAY_SHAPES(QRAY_ANY); }
#undef QRAY_ANY
#define QRAY_ANY(Type, name, table) || (name && Type<Float>::is_smooth)
    constexpr bool smooth() const { return false QRAY_SHAPES(QRAY_ANY); }
#undef QRAY_ANY
#define QRAY_ANY(Type, name, table) || (name && has_texels(Type<Float>::text))
    constexpr bool texels() const { return false QRAY_TEXTURES(QRAY_ANY); }
#undef QRAY_ANY
    constexpr bool spawns() const { return mirror || transmit; }
    constexpr bool transmits() const { return transmit || see_through; }
    constexpr bool always() const { return true; }

    // Can a tracer for this set draw a scene that calls for `other`?
#define QRAY_COVERS(Type, name, table) && (name || !other.name)
    constexpr bool holds(const Effects& other) const { return depth >= other.depth QRAY_EFFECTS(QRAY_COVERS); }
#undef QRAY_COVERS
    friend constexpr bool operator==(const Effects&, const Effects&) = default;
};

// The set of everything; shadows are on.
constexpr Effects everything(uint8_t depth)
{
    Effects e;
#define QRAY_TAKE(Type, name, table) e.name = true;
    QRAY_EFFECTS(QRAY_TAKE)
#undef QRAY_TAKE
    e.depth = depth;
    return e;
}
static_assert(everything(1).shapes() <= 8, "a shape's kind has 3 bits in a tree's entries: ShapeId, TreeEntry");

} // namespace qray
