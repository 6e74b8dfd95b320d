// The fixed arrays of a desktop's scene, for one number system: what the builder fills and every Scene<N, E>
// can look at. Tables are as long as the limits; only the pages that a scene touches cost memory.
#pragma once

#include <type_traits>

#include <qray/scene/scene.hpp>

#include "description.hpp"

namespace qray::scene {

template <class T, uint32_t Capacity>
struct Array {
    // Or starting would write to all of it, where only the pages that a scene touches should cost.
    static_assert(std::is_trivially_default_constructible_v<T>);
    uint32_t count;
    T data[Capacity];

    T& push()
    {
        return data[count++];
    }
    template <bool Present>
    Table<T, Present> table() const
    {
        if constexpr (Present)
            return {data, count};
        else
            return {};
    }
};

template <class N>
struct Storage {
    Effects effects;
    Camera<N> camera;
    EyeSurface<N> eye_surface; // Tag::none: on no surface
    Rgb<N> background;
    int32_t exposure;
    uint8_t max_depth;
    typename N::Unit cutoff;
    bool shadows;
    uint8_t levels;
    typename N::Unit threshold;
    uint32_t vanished; // objects smaller than the number system's resolution
    Warning lost;      // these, and whatever else it cannot draw right

    Array<Sphere<N>, Limits::objects> spheres;
    Array<Disc<N>, Limits::objects> discs;
    Array<Cone<N>, Limits::objects> cones;
    Array<Polygon<N>, Limits::objects> polygons;
    Array<Patch<N>, Limits::vertices> patches;
    Array<Point<N>, Limits::vertices> vertices;
    Array<Direction<N>, Limits::vertices> normals;

    static constexpr uint32_t shape_limit = Limits::objects + Limits::vertices;
    Array<ShapeId, shape_limit + bound_lanes> shape_ids;
    Array<BallBlock, shape_limit / (bound_lanes - 1) + 64> blocks;
    Tree tree;
    uint32_t order[Limits::objects]; // for the builder to sort

    Array<Matte<N>, Limits::materials> mattes;
    Array<Highlight<N>, Limits::materials> highlights;
    Array<Mirror<N>, Limits::materials> mirrors;
    Array<Transmit<N>, Limits::materials> transmits;
    Array<TextureRef, Limits::materials> textures;
    Array<Checker<N>, Limits::materials> checkers;
    Array<Stripes<N>, Limits::materials> stripes;
    Array<Gradient<N>, Limits::materials> gradients;
    Array<Rings<N>, Limits::materials> rings;
    Array<Noise<N>, Limits::materials> noises;
    Array<Marble<N>, Limits::materials> marbles;
    Array<Wood<N>, Limits::materials> woods;
    Array<Brick<N>, Limits::materials> bricks;

    Array<qray::Light<N>, Limits::lights> lights;
    Array<Sun<N>, Limits::lights> suns;

    // The scene as a tracer for E reads it; E.holds(effects).
    template <Effects E>
    Scene<N, E> view() const
    {
        Scene<N, E> s{};
        s.camera = camera;
        if constexpr (E.eye_surface)
            s.eye_surface.value = eye_surface;
        s.background = background;
        s.exposure = exposure;
        if constexpr (E.spawns()) {
            s.max_depth.value = max_depth;
            s.cutoff.value = cutoff;
        }
        if constexpr (E.shadow)
            s.shadows.value = shadows;
        if constexpr (E.adaptive) {
            s.levels.value = levels;
            s.threshold.value = threshold;
        }
        if constexpr (E.tree)
            s.tree.value = tree;
        s.spheres = spheres.template table<E.sphere>();
        s.discs = discs.template table<E.disc>();
        s.cones = cones.template table<E.cone>();
        s.polygons = polygons.template table<E.polygon>();
        s.patches = patches.template table<E.patch>();
        s.vertices = vertices.template table<(E.polygon || E.patch)>();
        s.normals = normals.template table<E.patch>();
        s.mattes = mattes.template table<true>();
        s.highlights = highlights.template table<E.highlight>();
        s.mirrors = mirrors.template table<E.mirror>();
        s.transmits = transmits.template table<(E.transmit || E.see_through)>();
        s.textures = textures.template table<E.texture()>();
        s.checkers = checkers.template table<E.checker>();
        s.stripes = stripes.template table<E.stripes>();
        s.gradients = gradients.template table<E.gradient>();
        s.rings = rings.template table<E.rings>();
        s.noises = noises.template table<E.noise>();
        s.marbles = marbles.template table<E.marble>();
        s.woods = woods.template table<E.wood>();
        s.bricks = bricks.template table<E.brick>();
        s.lights = lights.template table<E.light>();
        s.suns = suns.template table<E.sun>();
        return s;
    }
};

} // namespace qray::scene
