// The tables of a desktop's scene, for one number system: what the builder fills and every Scene<N, E> can look at.
// They lie in the caller's memory, as long as the description can make them.
#pragma once

#include <qray/scene/scene.hpp>

#include "description.hpp"

namespace qray::scene {

template <class T>
struct Array {
    uint32_t count;
    T* data;

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

    Room room; // the caller's, for all below

    Array<Sphere<N>> spheres;
    Array<Disc<N>> discs;
    Array<Cone<N>> cones;
    Array<Polygon<N>> polygons;
    Array<Patch<N>> patches;
    Array<Point<N>> vertices;
    Array<Direction<N>> normals;

    Array<ShapeId> shape_ids;
    Array<BallBlock> blocks;
    Tree tree;
    Array<uint32_t> order; // of objects, for the builder to sort

    Array<Matte<N>> mattes;
    Array<Highlight<N>> highlights;
    Array<Mirror<N>> mirrors;
    Array<Transmit<N>> transmits;
    Array<TextureRef> textures;
    Array<Checker<N>> checkers;
    Array<Stripes<N>> stripes;
    Array<Gradient<N>> gradients;
    Array<Rings<N>> rings;
    Array<Noise<N>> noises;
    Array<Marble<N>> marbles;
    Array<Wood<N>> woods;
    Array<Brick<N>> bricks;

    Array<qray::Light<N>> lights;
    Array<Sun<N>> suns;

    // Cuts empty tables from the room where it is large enough; returns how many bytes it must have.
    size_t lay_out(const Description& d)
    {
        uint32_t objects[shape_count] = {}, corners = 0, patch_corners = 0, with[texture_count] = {};
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            objects[static_cast<int>(o.shape)]++;
            corners += o.count;
            patch_corners += o.shape == Shape::patch ? o.count : 0;
        }
        for (uint32_t i = 0; i < d.fill_count; i++)
            with[static_cast<int>(d.fills[i].texture.kind)]++;
        const auto of = [&objects](Shape shape) { return objects[static_cast<int>(shape)]; };
        const auto textured = [&with](TextureKind kind) { return with[static_cast<int>(kind)]; };
        const uint32_t triangles = patch_corners - 2 * of(Shape::patch);
        const uint32_t shapes = d.object_count - of(Shape::patch) + triangles;
        return lay_out_in(room, [&](Layout& layout) {
            const auto cut = [&layout]<class T>(Array<T>& array, uint32_t count) {
                array = {0, layout.array<T>(count)};
            };
            cut(spheres, of(Shape::sphere));
            cut(discs, of(Shape::disc) + of(Shape::plane));
            cut(cones, of(Shape::cone));
            cut(polygons, of(Shape::polygon));
            cut(patches, triangles);
            cut(vertices, corners);
            cut(normals, patch_corners);
            cut(shape_ids, shapes + bound_lanes);
            cut(order, d.object_count);
            cut(blocks, shapes / (bound_lanes - 1) + 64);
            cut(mattes, d.fill_count);
            cut(highlights, d.fill_count);
            cut(mirrors, d.fill_count);
            cut(transmits, d.fill_count);
            cut(textures, d.fill_count);
            cut(checkers, textured(TextureKind::checker));
            cut(stripes, textured(TextureKind::stripes));
            cut(gradients, textured(TextureKind::gradient));
            cut(rings, textured(TextureKind::rings));
            cut(noises, textured(TextureKind::noise));
            cut(marbles, textured(TextureKind::marble));
            cut(woods, textured(TextureKind::wood));
            cut(bricks, textured(TextureKind::brick));
            cut(lights, d.light_count); // one that is far away becomes a sun
            cut(suns, d.light_count);
        });
    }

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
