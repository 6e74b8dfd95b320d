// What a scene calls for. The set is a template argument of the tracer: what is not in it is neither compiled
// nor stored.
#pragma once

#include <stdint.h>

namespace qray {

struct Effects {
    // shapes (a plane is a disc)
    bool sphere = false, disc = false, cone = false, polygon = false, patch = false;
    // textures
    bool checker = false, stripes = false, gradient = false, rings = false, noise = false;
    bool marble = false, wood = false, brick = false;
    // light
    bool light = false, sun = false;
    bool shadow = false;      // light can be blocked
    bool see_through = false; // and a surface in its way may let some of it through
    bool highlight = false;
    bool fractional_shine = false;
    // rays of higher depth
    bool mirror = false, transmit = false;
    bool eye_surface = false; // the eye lies on a surface
    // sampling: several samples a pixel, on a grid or adaptively
    bool grid = false, adaptive = false;
    bool windows = false; // the pixels in which a shape may be met are known
    bool tree = false;    // over the shapes
    // entries of the tracer's stack: the greatest max depth. Only transmit has a stack.
    uint8_t depth = 5;

    constexpr int shapes() const { return sphere + disc + cone + polygon + patch; }
    constexpr bool texture() const
    {
        return checker || stripes || gradient || rings || noise || marble || wood || brick;
    }
    constexpr bool spawns() const { return mirror || transmit; }
    constexpr bool lights() const { return light || sun; }

    // Can a tracer for this set draw a scene that calls for `other`?
    constexpr bool holds(const Effects& other) const;
    friend constexpr bool operator==(const Effects&, const Effects&) = default;
};

constexpr bool Effects::holds(const Effects& o) const
{
    const auto covers = [](bool have, bool want) { return have || !want; };
    return covers(sphere, o.sphere) && covers(disc, o.disc) && covers(cone, o.cone) && covers(polygon, o.polygon)
        && covers(patch, o.patch) && covers(checker, o.checker) && covers(stripes, o.stripes)
        && covers(gradient, o.gradient) && covers(rings, o.rings) && covers(noise, o.noise)
        && covers(marble, o.marble) && covers(wood, o.wood) && covers(brick, o.brick) && covers(light, o.light)
        && covers(sun, o.sun) && covers(shadow, o.shadow) && covers(see_through, o.see_through)
        && covers(highlight, o.highlight) && covers(fractional_shine, o.fractional_shine)
        && covers(mirror, o.mirror) && covers(transmit, o.transmit) && covers(eye_surface, o.eye_surface)
        && covers(grid, o.grid) && covers(adaptive, o.adaptive)
        && covers(windows, o.windows) && covers(tree, o.tree) && depth >= o.depth;
}

// The set of everything but windows, which only a compiled scene has; shadows are on.
constexpr Effects everything(uint8_t depth)
{
    Effects e;
    e.sphere = e.disc = e.cone = e.polygon = e.patch = true;
    e.checker = e.stripes = e.gradient = e.rings = e.noise = e.marble = e.wood = e.brick = true;
    e.light = e.sun = e.shadow = e.see_through = e.highlight = e.fractional_shine = true;
    e.mirror = e.transmit = e.eye_surface = e.grid = e.adaptive = e.tree = true;
    e.depth = depth;
    return e;
}

} // namespace qray
