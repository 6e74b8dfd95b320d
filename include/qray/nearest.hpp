// Which shapes a ray may meet, and the nearest that it does.
#pragma once

#include "scene.hpp"

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

// Calls f(shape, kind, index) for every shape that the ray may meet before limit(), until it returns true.
template <class N, Effects E, class Limit, class F>
QRAY_INLINE constexpr void for_each_candidate(const Scene<N, E>& scene, [[maybe_unused]] const Ray<N>& ray,
                                              [[maybe_unused]] Limit limit, F f)
{
    if constexpr (E.tree) {
        walk(scene.tree.value, ray, limit, [&](auto id) QRAY_INLINE_LAMBDA {
            return with_shape(scene, id.kind(), id.index(), f);
        });
    } else {
        const NarrowRay<N> narrow(ray);
        const auto ask = [&](const auto& shape, Kind kind, uint32_t index) __attribute__((always_inline)) {
            return !surely_missed(shape, narrow) && f(shape, kind, index);
        };
        // Inlined where loops are unrolled, the reject by wide products takes more registers than there are.
        if constexpr (N::is_fixed && !IsNarrow<N> && has_wide_multiply)
            for_each_shape(scene, [&](const auto& shape, Kind kind, uint32_t index) { return ask(shape, kind, index); });
        else
            for_each_shape(scene, ask);
    }
}

// The nearest hit; of several at the same t, that of the first surface in the file. False where there is none.
template <class N, Effects E>
QRAY_INLINE constexpr bool nearest(const Scene<N, E>& scene, const Ray<N>& ray, Hit<N>& hit)
{
    if constexpr (!N::is_fixed || (IsNarrow<N> && has_wide_multiply))
        hit = {}; // or the compiler warns that it may be used unset
    hit.t = N::length_max;
    hit.tag = {Tag::none};
    const auto take = [&](const auto& shape, Kind kind, uint32_t index) QRAY_INLINE_LAMBDA {
        typename N::Length t{};
        Local<N> local{};
        if (intersect_in(scene, shape, ray, hit.t, t, local) && hit.after(t, shape.tag)) {
            hit.t = t;
            hit.tag = shape.tag;
            hit.kind = kind;
            hit.index = index;
            if constexpr (IsCurved<decltype(shape)>)
                hit.local = local;
        }
        return false;
    };
    for_each_candidate(scene, ray, [&hit] { return hit.t; }, take);
    return !(hit.tag == Tag{Tag::none});
}

} // namespace qray
