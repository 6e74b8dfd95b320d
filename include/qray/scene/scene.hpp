// A scene as the tracer reads it: pointers and counts into fixed arrays, a desktop's storage or a compiled scene's
// constant tables. Tables of effects that are not in E are empty types.
#pragma once

#include "../texture/brick.hpp"
#include "camera.hpp"
#include "../texture/checker.hpp"
#include "../shape/cone.hpp"
#include "../shape/disc.hpp"
#include "effects.hpp"
#include "eye_surface.hpp"
#include "../texture/gradient.hpp"
#include "../surface/highlight.hpp"
#include "../light/light.hpp"
#include "../texture/marble.hpp"
#include "../surface/material.hpp"
#include "../surface/mirror.hpp"
#include "../texture/noise.hpp"
#include "../shape/patch.hpp"
#include "../shape/polygon.hpp"
#include "../texture/rings.hpp"
#include "sight.hpp"
#include "../shape/sphere.hpp"
#include "../texture/stripes.hpp"
#include "../light/sun.hpp"
#include "../surface/transmit.hpp"
#include "tree.hpp"
#include "windows.hpp"
#include "../texture/wood.hpp"

namespace qray {

template <class T, bool Present>
struct Table {
    const T* data;
    uint32_t count;
    constexpr const T& operator[](uint32_t i) const { return data[i]; }
    // The same, for a table that often has but one: if it is known to, that is known.
    constexpr const T& at(uint32_t i) const
    {
        return data[QRAY_KNOWN(count == 1) ? 0 : i];
    }
};
template <class T>
struct Table<T, false> {};

// A single value that only some scenes need.
template <class T, bool Present>
struct Maybe {
    T value;
};
template <class T>
struct Maybe<T, false> {};

template <class N, Effects E>
struct Scene {
    Camera<N> camera;
    [[no_unique_address]] Maybe<EyeSurface<N>, E.eye_surface> eye_surface{};
    Rgb<N> background;
    int32_t exposure; // colours are stored divided by 2^exposure
    [[no_unique_address]] Maybe<uint8_t, E.spawns()> max_depth{}; // at most E.depth
    [[no_unique_address]] Maybe<typename N::Unit, E.spawns()> cutoff{};
    [[no_unique_address]] Maybe<bool, E.shadow> shadows{};
    [[no_unique_address]] Maybe<uint8_t, E.adaptive> levels{};
    [[no_unique_address]] Maybe<typename N::Unit, E.adaptive> threshold{};
    [[no_unique_address]] Maybe<Windows, E.windows> windows{};

    [[no_unique_address]] Table<Sphere<N>, E.sphere> spheres{};
    [[no_unique_address]] Table<Disc<N>, E.disc> discs{};
    [[no_unique_address]] Table<Cone<N>, E.cone> cones{};
    [[no_unique_address]] Table<Polygon<N>, E.polygon> polygons{};
    [[no_unique_address]] Table<Patch<N>, E.patch> patches{};
    [[no_unique_address]] Table<Point<N>, E.polygon || E.patch> vertices{};
    [[no_unique_address]] Table<Direction<N>, E.patch> normals{};

    [[no_unique_address]] Maybe<Tree, E.tree> tree{};

    Table<Matte<N>, true> mattes{};
    [[no_unique_address]] Table<Highlight<N>, E.highlight> highlights{};
    [[no_unique_address]] Table<Mirror<N>, E.mirror> mirrors{};
    [[no_unique_address]] Table<Transmit<N>, E.transmit || E.see_through> transmits{};
    [[no_unique_address]] Table<TextureRef, E.texture()> textures{};
    [[no_unique_address]] Table<Checker<N>, E.checker> checkers{};
    [[no_unique_address]] Table<Stripes<N>, E.stripes> stripes{};
    [[no_unique_address]] Table<Gradient<N>, E.gradient> gradients{};
    [[no_unique_address]] Table<Rings<N>, E.rings> rings{};
    [[no_unique_address]] Table<Noise<N>, E.noise> noises{};
    [[no_unique_address]] Table<Marble<N>, E.marble> marbles{};
    [[no_unique_address]] Table<Wood<N>, E.wood> woods{};
    [[no_unique_address]] Table<Brick<N>, E.brick> bricks{};

    [[no_unique_address]] Table<Light<N>, E.light> lights{};
    [[no_unique_address]] Table<Sun<N>, E.sun> suns{};
};

} // namespace qray
