// Which shapes a ray may meet, and the nearest that it does.
#pragma once

#include "hit.hpp"

namespace qray {

// Calls f(shape, kind, index) for every shape, until it returns true.
template <class N, Effects E, class F>
QRAY_INLINE constexpr void for_each_shape(const Scene<N, E>& scene, F f)
{
#define QRAY_ASK(table, kind) \
    for (uint32_t i = 0; i < scene.table.count; i++) \
        if (f(scene.table[i], kind, i)) \
            return;
#define QRAY_ASK_EACH(Type, name, table) \
    if constexpr (E.name) { \
        if constexpr (Type<N>::is_short) { \
            QRAY_UNROLL \
            QRAY_ASK(table, Kind::name) \
        } else { \
            QRAY_ASK(table, Kind::name) \
        } \
    }
    QRAY_SHAPES(QRAY_ASK_EACH)
#undef QRAY_ASK_EACH
#undef QRAY_ASK
}

// The last kind of shape that a scene has: a shape of none of the others is of this one, without being asked.
template <Effects E>
constexpr Kind last_kind()
{
    Kind last{};
#define QRAY_LAST(Type, name, table) last = E.name ? Kind::name : last;
    QRAY_SHAPES(QRAY_LAST)
#undef QRAY_LAST
    return last;
}

// Does it have triangles in little room?
template <Effects E>
inline constexpr bool has_lean = E.triangle || E.smooth_triangle;

// Calls f(shape, kind, index), which returns a bool, for the shape of that kind and index.
template <class N, Effects E, class F>
QRAY_INLINE constexpr bool with_shape(const Scene<N, E>& scene, Kind kind, uint32_t index, F f)
{
#define QRAY_ASK(Type, name, table) \
    if constexpr (E.name) { \
        static_assert(ShapeIn<Type<N>, N>); \
        if (last_kind<E>() == Kind::name || kind == Kind::name) \
            return f(scene.table.at(index), Kind::name, index); \
    }
    QRAY_SHAPES(QRAY_ASK)
#undef QRAY_ASK
    return false;
}

// Calls f(shape, kind, index), which returns a bool, for `count` shapes of that kind until it returns true; does it?
template <class N, Effects E, class F>
QRAY_INLINE constexpr bool any_shape(const Scene<N, E>& scene, Kind kind, uint32_t first, uint32_t count, F f)
{
#define QRAY_ASK(Type, name, table) \
    if constexpr (E.name) \
        if (last_kind<E>() == Kind::name || kind == Kind::name) { \
            for (uint32_t i = first; i != first + count; i++) \
                if (f(scene.table.at(i), Kind::name, i)) \
                    return true; \
            return false; \
        }
    QRAY_SHAPES(QRAY_ASK)
#undef QRAY_ASK
    return false;
}

// The corners of those shapes that for_each_candidate() names.
template <class N, Effects E>
QRAY_INLINE constexpr auto candidates_corners(const Scene<N, E>& scene)
{
    if constexpr (E.tree && has_outlines<N>)
        return EnclosingCorners<N>{corners_of(scene)};
    else if constexpr (E.flat_tree && E.moving && !WideFixed<N>) // as of the triangles that stand still in little room
        return OutlineCorners<N>{corners_of(scene)};
    else
        return corners_of(scene);
}

// Calls f(shape, kind, index) for every shape that the ray may meet before limit(), until it returns true.
template <bool NearestFirst = false, class N, Effects E, class Limit, class F>
QRAY_INLINE constexpr void for_each_candidate(const Scene<N, E>& scene, [[maybe_unused]] const Ray<N>& ray,
                                              [[maybe_unused]] Limit limit, F f)
{
    if constexpr (E.tree) {
        walk<NearestFirst, E.corners()>(scene.tree.value, ray, limit, [&](auto id, [[maybe_unused]] bool open)
                                                                          QRAY_INLINE_LAMBDA {
            return with_shape(scene, id.kind(), id.index(), [&](const auto& shape, Kind kind, uint32_t index)
                                                                QRAY_INLINE_LAMBDA {
                if constexpr (requires { encloses(shape, corners_of(scene).points, ray); })
                    if (open && !encloses(shape, corners_of(scene).points, ray))
                        return false;
                return f(shape, kind, index);
            });
        });
    } else if constexpr (E.flat_tree) {
        // Only where corners were moved that a triangle left behind shares does a ray begin there.
        if constexpr (E.moving && !N::is_fixed)
            if (TreeEntry<N>::out_of_reach(ray.origin))
                return;
        const RejectRay<N> reject(ray);
        constexpr bool deep = has_lean<E> || E.moving; // a lean one keeps a normal
        ProjectedRay projected = deep ? ProjectedRay::of(ray) : ProjectedRay(ray);
        walk(scene.entries.data, projected, limit,
             [&](Kind of_leaf, uint32_t first, uint32_t count) __attribute__((always_inline)) {
            return any_shape(scene, of_leaf, first, count,
                             [&]<class S>(const S& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
                bool missed;
                if constexpr (S::has_corners)
                    missed = surely_missed(shape, corners_of(scene), ray, projected);
                else
                    missed = surely_missed(shape, reject);
                return !missed && f(shape, kind, index);
            });
        });
    } else {
        const RejectRay<N> reject(ray);
        const auto ask = [&](const auto& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
            return !surely_missed(shape, reject) && f(shape, kind, index);
        };
        // Inlined where loops are unrolled, the reject by wide products takes more registers than there are.
        if constexpr (WideFixed<N> && has_wide_multiply)
            for_each_shape(scene, [&](const auto& s, Kind kind, uint32_t index) { return ask(s, kind, index); });
        else
            for_each_shape(scene, ask);
    }
}

// Does the ray's line pass inside of what is met in its plane alone? It is not asked of others.
template <class N, Effects E, class S>
constexpr bool passes_inside(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray)
{
    if constexpr (S::has_corners)
        return encloses(shape, corners_of(scene).points, ray);
    else
        return true;
}

// How often a ray crosses a shape before a light at `distance`. Where lights lie on surfaces, `light` is its number.
template <class N, Effects E, class S>
QRAY_INLINE constexpr int crossings_before(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray,
                                           typename N::Length distance)
{
    return crossings<!E.tree>(shape, candidates_corners(scene), ray, distance);
}
template <class N, Effects E, class S>
constexpr int crossings_before(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray, typename N::Length distance,
                               uint32_t light)
{
    for (uint32_t i = 0; i < scene.light_surfaces.count; i++) {
        const LightSurface<N>& surface = scene.light_surfaces[i];
        if (surface.light != light || !(surface.tag == tag_of(shape)))
            continue;
        if constexpr (E.tree && !S::has_corners) // the others have been asked
            if (surely_missed(shape, RejectRay<N>(ray)))
                return 0;
        const Ray<N> back = from_light(surface, scene.lights[light].at, ray);
        const int at_light = (back.outward ? surface.side < 0 : surface.side > 0) && passes_inside(scene, shape, ray);
        // Between two points on one surface, which is flat or convex, the way does not cross it.
        return at_light + (ray.from == tag_of(shape) ? 0 : crossings(shape, corners_of(scene), back, distance));
    }
    return crossings_before(scene, shape, ray, distance);
}

// Likewise of a place of the panel of that number.
struct PanelNumber {
    uint32_t value;
};
template <class N, Effects E, class S>
constexpr int crossings_before(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray, typename N::Length distance,
                               PanelNumber panel)
{
    for (uint32_t i = 0; i < scene.light_surfaces.count; i++) {
        const LightSurface<N>& surface = scene.light_surfaces[i];
        // The way meets it nowhere else.
        if constexpr (requires { reaches(shape, corners_of(scene), ray, distance); })
            if (surface.light == ~panel.value && surface.tag == tag_of(shape)) {
                const bool from_outside = dot<N>(surface.normal, ray.direction) <= typename N::Cosine{};
                return (from_outside ? surface.side < 0 : surface.side > 0)
                    && reaches(shape, corners_of(scene), ray, distance);
            }
    }
    return crossings_before(scene, shape, ray, distance);
}

// Keeps the hit on a shape, if there is one before the last.
template <class N, Effects E, class S>
QRAY_INLINE constexpr void keep_nearest(const Scene<N, E>& scene, const Ray<N>& ray, const S& shape, Kind kind,
                                        uint32_t index, Hit<N>& hit)
{
    typename N::Length t{};
    Local<N> local{};
    if (intersect<!E.tree>(shape, candidates_corners(scene), ray, hit.t, t, local) && hit.is_behind(t, tag_of(shape))) {
        hit.t = t;
        hit.tag = tag_of(shape);
        hit.kind = kind;
        hit.index = index;
        if constexpr (S::keeps_local)
            hit.local = local;
    }
}

// The nearest hit; of several at the same t, that of the first surface in the file. False where there is none.
template <class N, Effects E>
QRAY_INLINE constexpr bool nearest(const Scene<N, E>& scene, const Ray<N>& ray, Hit<N>& hit)
{
    if constexpr (E.tree || !N::is_fixed || (NarrowFixed<N> && has_wide_multiply))
        hit = {}; // or the compiler warns that it may be used unset
    else if constexpr (E.flat_tree || sizeof(void*) == 8)
        hit.kind = {}; // likewise on a desktop, where the rest costs q32 0.8 % more instructions
    if constexpr (E.moving && has_lean<E> && WideFixed<N> && has_wide_multiply)
        hit.local.near.x = hit.local.near.y = {}; // likewise
    hit.t = N::length_max;
    hit.tag = {Tag::none};
    for_each_candidate<true>(scene, ray, [&hit] { return hit.t; },
                       [&](const auto& shape, Kind kind, uint32_t index) QRAY_INLINE_LAMBDA {
                           keep_nearest(scene, ray, shape, kind, index, hit);
                           return false;
                       });
    return !(hit.tag == Tag{Tag::none});
}

} // namespace qray
