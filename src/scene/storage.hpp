// The tables of a desktop's scene, for one number system: what the builder fills and every Scene<N, E> can look at.
// They lie in the caller's memory, as long as the description can make them.
#pragma once

#include <qray/scene/look_at.hpp>
#include <qray/scene/scene.hpp>

#include "convert.hpp"
#include "settings.hpp"
#include "shapes.hpp"
#include "split.hpp"

namespace qray::scene {

template <class T>
struct Array {
    uint32_t count;
    T* data;

    T& push() { return data[count++]; }
    template <bool Present>
    Table<T, Present> view() const
    {
        if constexpr (Present)
            return {data, count};
        else
            return {};
    }
};

// All that a desktop's scene can call for: what takes little room is for compiled ones.
constexpr Effects desktop_effects(uint8_t depth = Settings::max_depth)
{
    Effects e = everything(depth);
    e.triangle = e.smooth_triangle = e.flat_tree = false;
    return e;
}

template <class N>
struct Storage {
    Effects effects;
    Camera<N> camera;
    EyeSurface<N> eye_surface; // Tag::none: on no surface
    qray::Frame<N> frame;      // of a scene that moves,
    qray::View<N> text_view;   // and its view
    uint64_t moving;           // as Settings
    Rgb<N> background;
    int32_t exposure;
    Rgb<N> colour(const Vec3d& c) const { return Convert<N>::rgb(c * ldexp(1, -exposure)); }
    uint8_t max_depth;
    typename N::Unit cutoff;
    bool shadows;
    uint8_t levels;
    typename N::Unit threshold;
    uint32_t vanished; // objects smaller than the number system's resolution
    Warning lost;      // these, and whatever else it cannot draw right
    Warning unmoved;   // what cannot move as was asked, or is not known where something does
    Vec3d origin;      // of the moved scene, in the text's units, and what it was scaled by
    double scale;
    uint64_t far_lights; // a bit for each light of the text that is so far away that it is a sun

    Room room; // the caller's, for all below

#define QRAY_ARRAY(Type, name, table) Array<Type<N>> table;
    QRAY_TABLES(QRAY_ARRAY)
#undef QRAY_ARRAY

    Array<TreeShape> tree_shapes;
    Array<OutlineBlock<N>> outlines;
    Array<BoxNode> nodes;
    BallNode balls[Tree<N>::most_balls];
    Tree<N> tree;
    // For the builder alone.
    Array<SplitBox> split_shapes, split_nodes; // as is
    Array<SortedObject> sorted;
    Array<uint32_t> order, tests;
    Array<uint32_t> corner_slots; // the number of a corner, and 1, at its hash or the next place that was free

    // Cuts empty tables from the room where it is large enough; returns how many bytes it must have.
    size_t lay_out(const Description& d, bool compiled)
    {
        uint32_t shapes[everything(1).shapes()] = {}, flat = 0, smooth = 0, all = 0; // flat, smooth: with corners
        for (uint32_t i = 0; i < d.object_count; i++)
            with_shape_of<N>(d.objects[i].kind, [&, &o = d.objects[i]]<class Shape>(auto host) {
                const uint32_t surfaces = host.surfaces_of(o);
                shapes[static_cast<int>(o.kind)] += surfaces;
                (Shape::is_smooth ? smooth : flat) += Shape::has_corners ? surfaces : 0;
                all += surfaces;
            });
        return lay_out_in(room, [&](Layout& layout) {
            const auto cut = [&layout]<class T>(Array<T>& table, uint32_t most) { table = {0, layout.array<T>(most)}; };
#define QRAY_CUT(Type, name, table) cut(table, shapes[static_cast<int>(Kind::name)]);
            QRAY_SHAPES(QRAY_CUT)
#undef QRAY_CUT
            // For compiled scenes alone: see lean.hpp, flatten.hpp. A patch that lean.hpp takes in part
            // has its corners twice.
            const uint32_t once = compiled;
            cut(triangles, once * flat);
            cut(smooth_triangles, once * smooth);
            cut(corner_slots, once * (2 * d.vertex_count + 1));
            cut(entries, 1 + once * 2 * all);
            cut(order, all);
            cut(tests, once * 2 * all);
            cut(vertices, (1 + once) * d.vertex_count);
            cut(normals, (1 + once) * d.vertex_count);
            cut(tree_shapes, all);
            // One for each surface but an object's first; most for its size, four, takes what has one corner more than
            // fit a block: 7 or 5.
            if constexpr (has_outlines<N>)
                cut(outlines, all - d.object_count + d.vertex_count * 4 / (bound_lanes / 2 + 3));
            cut(split_shapes, all);
            cut(split_nodes, 2 * all);
            // All but those of leaves are full, and with two leaves each there are bound_lanes of these below one.
            cut(nodes, (all + 1) / 2 * bound_lanes / (bound_lanes - 1) + 2);
            cut(sorted, d.object_count);
            cut(mattes, d.fill_count);
            cut(textures, d.fill_count);
            cut(texels, static_cast<uint32_t>(d.image_bytes.size));
#define QRAY_CUT(Type, name, table) cut(table, d.fill_count);
            QRAY_SURFACES(QRAY_CUT)
            QRAY_TEXTURES(QRAY_CUT)
#undef QRAY_CUT
#define QRAY_CUT(Type, name, table) cut(table, d.light_count); // one that is far away becomes a sun
            QRAY_LIGHTS(QRAY_CUT)
#undef QRAY_CUT
            cut(light_surfaces, d.light_count * Limits::light_surfaces);
            const uint32_t lit = d.radiosity > 0 ? all : 0;
            cut(lights_of, lit);
            cut(even_lights, 2 * lit);
            cut(light_maps, d.grid_count);
            cut(light_cells, 3 * d.light_size);
            uint32_t knots = d.root_count;
            for (uint32_t i = 0; i < d.grid_count; i++)
                knots += d.grids[i].x.steps + d.grids[i].y.steps + 2;
            cut(light_knots, knots);
            cut(light_cuts, d.cut_count);
            cut(light_planes, d.cut_count);
        });
    }

    // The scene as a tracer for E reads it; E.holds(effects).
    template <Effects E>
    Scene<N, E> view() const
    {
        Scene<N, E> s{.camera = camera, .background = background, .exposure = exposure};
        if constexpr (E.eye_surface)
            s.eye_surface.value = eye_surface;
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
#define QRAY_VIEW(Type, name, table) s.table = table.template view<E.name>();
        QRAY_TABLES(QRAY_VIEW)
#undef QRAY_VIEW
        return s;
    }
};

} // namespace qray::scene
