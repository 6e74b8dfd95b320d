// Which shapes a ray may meet, and the nearest that it does.
#pragma once

#include "../scene/scene.hpp"

namespace qray {

// Calls f(shape, kind, index) for every shape, until it returns true.
template <class N, Effects E, class F>
QRAY_INLINE constexpr void for_each_shape(const Scene<N, E>& scene, F f)
{
    if constexpr (E.sphere)
        QRAY_UNROLL
        for (uint32_t i = 0; i < scene.spheres.count; i++)
            if (f(scene.spheres[i], Kind::sphere, i))
                return;
    if constexpr (E.disc)
        for (uint32_t i = 0; i < scene.discs.count; i++)
            if (f(scene.discs[i], Kind::disc, i))
                return;
    if constexpr (E.cone)
        for (uint32_t i = 0; i < scene.cones.count; i++)
            if (f(scene.cones[i], Kind::cone, i))
                return;
    if constexpr (E.polygon)
        for (uint32_t i = 0; i < scene.polygons.count; i++)
            if (f(scene.polygons[i], Kind::polygon, i))
                return;
    if constexpr (E.patch)
        for (uint32_t i = 0; i < scene.patches.count; i++)
            if (f(scene.patches[i], Kind::patch, i))
                return;
}

template <class S>
concept HasCorners = requires(const S& s) { s.first; };
template <class S>
concept IsCurved = requires(const S& s) { s.fine; };

template <class N, Effects E, class S>
QRAY_INLINE constexpr bool intersect_in(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray,
                                        typename N::Length limit, typename N::Length& t,
                                        [[maybe_unused]] Local<N>& local)
{
    if constexpr (HasCorners<S>)
        return intersect(shape, scene.vertices.data, ray, limit, t);
    else if constexpr (IsCurved<S>)
        return intersect<!E.tree>(shape, ray, limit, t, local);
    else
        return intersect(shape, ray, limit, t);
}
template <class N, Effects E, class S>
QRAY_INLINE constexpr int crossings_in(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray,
                                       typename N::Length limit)
{
    if constexpr (HasCorners<S>)
        return crossings(shape, scene.vertices.data, ray, limit);
    else if constexpr (IsCurved<S>)
        return crossings<!E.tree>(shape, ray, limit);
    else
        return crossings(shape, ray, limit);
}

// Calls f(shape, kind, index) for the shape of that kind and index.
template <class N, Effects E, class F>
QRAY_INLINE constexpr bool with_shape(const Scene<N, E>& scene, Kind kind, uint32_t index, F f)
{
    if constexpr (E.sphere)
        if (kind == Kind::sphere)
            return f(scene.spheres[index], Kind::sphere, index);
    if constexpr (E.disc)
        if (kind == Kind::disc)
            return f(scene.discs[index], Kind::disc, index);
    if constexpr (E.cone)
        if (kind == Kind::cone)
            return f(scene.cones[index], Kind::cone, index);
    if constexpr (E.polygon)
        if (kind == Kind::polygon)
            return f(scene.polygons[index], Kind::polygon, index);
    if constexpr (E.patch)
        if (kind == Kind::patch)
            return f(scene.patches[index], Kind::patch, index);
    return false;
}

// The set of those shapes of a set that the ray does not surely miss.
template <class N, Effects E>
QRAY_INLINE constexpr ShapeSet near_shapes(const Scene<N, E>& scene, const Ray<N>& ray, ShapeSet of)
{
    if ((of & unasked) == 0)
        return of;
    const RejectRay<N> reject(ray);
    ShapeSet set = 0, bit = set_of(0);
    for_each_shape(scene, [&](const auto& shape, Kind kind, uint32_t) __attribute__((always_inline)) {
        if (kind != Kind::disc) {
            if ((of & bit) != 0 && !surely_missed(shape, reject))
                set |= bit;
            bit >>= 1;
        }
        return false;
    });
    return set | (of & (bit | (bit - 1))); // and the discs
}

// Calls f(shape, kind, index) for the shapes of a set, until it returns true.
template <class N, Effects E, class F>
QRAY_INLINE constexpr void for_each_in_sight(const Scene<N, E>& scene, const Ray<N>& ray, ShapeSet set, F f)
{
    // A sphere is its ball. What lies out of another's, as a hit on a polygon may whose corners are no plane's, is none.
    const auto ask = [&](const auto& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
        if constexpr (requires { shape.bound; })
            if (surely_missed(shape, RejectRay<N>(ray)))
                return false;
        return f(shape, kind, index);
    };
    const auto all_of = [&set, ask](const auto& table, Kind kind) __attribute__((always_inline)) {
        ShapeSet part = set & ~(0xffffffff >> table.count);
        set <<= table.count;
        if (QRAY_KNOWN(table.count == 1))
            return part != 0 && ask(table.data[0], kind, 0);
        while (part != 0) {
            const uint32_t i = static_cast<uint32_t>(count_leading_zeros(part));
            if (ask(table[i], kind, i))
                return true;
            part &= ~set_of(i);
        }
        return false;
    };
    if constexpr (E.sphere)
        if (all_of(scene.spheres, Kind::sphere))
            return;
    if constexpr (E.cone)
        if (all_of(scene.cones, Kind::cone))
            return;
    if constexpr (E.polygon)
        if (all_of(scene.polygons, Kind::polygon))
            return;
    if constexpr (E.patch)
        if (all_of(scene.patches, Kind::patch))
            return;
    if constexpr (E.disc)
        if (all_of(scene.discs, Kind::disc))
            return;
}

// Calls f(shape, kind, index) for every shape of a set that the ray may meet before limit(), until it returns true.
template <class N, Effects E, class Limit, class F>
QRAY_INLINE constexpr void for_each_candidate(const Scene<N, E>& scene, [[maybe_unused]] const Ray<N>& ray,
                                              [[maybe_unused]] ShapeSet set, [[maybe_unused]] Limit limit, F f)
{
    if constexpr (E.windows) {
        for_each_in_sight(scene, ray, near_shapes(scene, ray, set), f);
    } else if constexpr (E.tree) {
        walk(scene.tree.value, ray, limit, [&](auto id) QRAY_INLINE_LAMBDA {
            return with_shape(scene, id.kind(), id.index(), f);
        });
    } else {
        const RejectRay<N> reject(ray);
        const auto ask = [&](const auto& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
            return !surely_missed(shape, reject) && f(shape, kind, index);
        };
        // Inlined where loops are unrolled, the reject by wide products takes more registers than there are.
        if constexpr (WideFixed<N> && has_wide_multiply)
            for_each_shape(scene, [&](const auto& shape, Kind kind, uint32_t index) { return ask(shape, kind, index); });
        else
            for_each_shape(scene, ask);
    }
}

// Keeps the hit on a shape, if there is one before the last.
template <class N, Effects E, class S>
QRAY_INLINE constexpr void keep_nearest(const Scene<N, E>& scene, const Ray<N>& ray, const S& shape, Kind kind,
                                        uint32_t index, Hit<N>& hit)
{
    typename N::Length t{};
    Local<N> local{};
    if (intersect_in(scene, shape, ray, hit.t, t, local) && hit.is_behind(t, shape.tag)) {
        hit.t = t;
        hit.tag = shape.tag;
        hit.kind = kind;
        hit.index = index;
        if constexpr (IsCurved<S>)
            hit.local = local;
    }
}

// The nearest hit, of a set of shapes; of several at the same t, that of the first surface in the file. False where
// there is none.
template <class N, Effects E>
QRAY_INLINE constexpr bool nearest(const Scene<N, E>& scene, const Ray<N>& ray, Hit<N>& hit,
                                 [[maybe_unused]] ShapeSet set = every_shape)
{
    if constexpr ((!N::is_fixed && !E.windows) || (NarrowFixed<N> && has_wide_multiply))
        hit = {}; // or the compiler warns that it may be used unset
    if constexpr (E.windows) {
        hit.kind = Kind::sphere; // likewise
        hit.index = 0;
        hit.local = {};
    }
    hit.t = N::length_max;
    hit.tag = {Tag::none};
    const auto take = [&](const auto& shape, Kind kind, uint32_t index) QRAY_INLINE_LAMBDA {
        keep_nearest(scene, ray, shape, kind, index, hit);
        return false;
    };
    // Windows' shapes, too, are asked in a place or two.
    const auto take_inlined = [&](const auto& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
        keep_nearest(scene, ray, shape, kind, index, hit);
        return false;
    };
    const auto limit = [&hit] { return hit.t; };
    if constexpr (E.windows)
        for_each_candidate(scene, ray, set, limit, take_inlined);
    else
        for_each_candidate(scene, ray, set, limit, take);
    return !(hit.tag == Tag{Tag::none});
}

} // namespace qray
