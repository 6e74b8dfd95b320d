// The surface where a ray ends, its colour there, and rays that leave it.
#pragma once

#include "nearest.hpp"

namespace qray {

// Has a surface of this kind shading normals of its own? What is none of the others then asks nothing.
template <class N, Effects E>
QRAY_INLINE constexpr bool is_smooth([[maybe_unused]] Kind kind)
{
#define QRAY_SMOOTH(Type, name, table) \
    if constexpr (E.name && Type<N>::is_smooth) \
        if (E.shapes() == 1 || kind == Kind::name) \
            return true;
    QRAY_SHAPES(QRAY_SMOOTH)
#undef QRAY_SMOOTH
    return false;
}

template <class N, Effects E>
QRAY_INLINE constexpr Surface<N> surface_at(const Scene<N, E>& scene, const Ray<N>& ray, const Hit<N>& hit)
{
    Point<N> q;
    Direction<N> g, n;
    const auto at = [&]<class Shape>(const Shape& shape, Kind, uint32_t) __attribute__((always_inline)) {
        surface_of(shape, corners_of(scene), ray, hit.t, hit.local, q, g);
        if constexpr (Shape::is_smooth)
            n = shading_normal(shape, corners_of(scene), ray, g);
        else
            n = g;
        return true;
    };
    with_shape(scene, hit.kind, hit.index, at);
    const auto n_d = N::unit(dot<N>(n, ray.direction));
    const bool turned = n_d > N::zero;
    if constexpr (keeps_step<N>) {
        const Direction<N> to_viewer = turned ? -n : n;
        return {q, g, to_viewer, turned ? -n_d : n_d, turned, step_off<N>(q, to_viewer, true)};
    } else {
        return {q, g, turned ? -n : n, turned ? -n_d : n_d, turned};
    }
}

// A ray that leaves the surface in direction d; `above` tells whether n.d > 0. Where the shading normal is
// the geometric one, or that one turned, that also tells the side.
template <class N, Effects E>
QRAY_INLINE constexpr Ray<N> leaving(const Surface<N>& s, [[maybe_unused]] Kind kind, Tag tag,
                                     const Direction<N>& d, bool above)
{
    if (is_smooth<N, E>(kind)) {
        const bool outward = dot<N>(s.geometric, d) > typename N::Cosine{};
        return {step_off<N>(s.point, s.geometric, outward), d, tag, outward};
    }
    if constexpr (keeps_step<N>)
        if (above)
            return {parts_of(s.above), d, tag, !s.turned};
    return {step_off<N>(s.point, s.normal, above), d, tag, above != s.turned};
}

// The same for a ray that brings back a picture, given |n.d|. A step along the normal moves it to its side,
// and what it meets in mirrors and lenses by far more; unless the ray is flat, a step along itself leads away
// from the surface as well.
template <class N, Effects E>
QRAY_INLINE constexpr Ray<N> going_on(const Surface<N>& s, [[maybe_unused]] Kind kind, Tag tag,
                                      const Direction<N>& d, bool above, [[maybe_unused]] typename N::Unit cosine)
{
    if constexpr (WideFixed<N>) {
        bool outward = above != s.turned;
        if (is_smooth<N, E>(kind)) {
            cosine = N::unit(dot<N>(s.geometric, d));
            outward = cosine > N::zero;
            cosine = outward ? cosine : -cosine;
        }
        if (cosine >= N::steep)
            return {step_along<N>(s.point, d), d, tag, outward};
    }
    return leaving<N, E>(s, kind, tag, d, above);
}

template <class N, Effects E>
QRAY_INLINE constexpr Vec<typename N::Unit> colour_at(const Scene<N, E>& scene, uint32_t material, const Point<N>& q)
{
    const Vec<typename N::Unit>& m = scene.mattes[material].colour;
    if constexpr (E.texture()) {
        const TextureRef& ref = scene.textures[material];
#define QRAY_ASK(Type, name, table) \
    if constexpr (E.name) \
        if (ref.kind == TextureKind::name) \
            return scene.table.at(ref.index)(m, q);
        QRAY_TEXTURES(QRAY_ASK)
#undef QRAY_ASK
    }
    return m;
}

} // namespace qray
