// What every shape says of itself and is asked. A shape is a structure with these constants, which are told and not guessed
//   has_corners   it is made of points in the scene's vertices
//   is_curved     what an intersection finds beside t is kept for the surface (Local)
//   is_smooth     it has shading normals of its own: shading_normal()
//   is_short      its test is so short that where code is cheap a loop over them is unrolled
// and these functions, found by its type:
//   tag_of(shape)                                                where it has no member `tag`
//   surely_missed(shape, reject)                                 may always say no; see reject.hpp
//   intersect<Near>(shape, corners, ray, limit, t, local)        the nearest t in (0, limit], or false
//   crossings<Near>(shape, corners, ray, distance)               how often the ray crosses it before a light at `distance`
//   surface_of(shape, corners, ray, t, local, point, normal)     the point of a hit, and the outward unit normal there
//   shading_normal(shape, corners, ray, normal)                  of a smooth one: unit, not yet turned
//   normal_of(shape, corners)                                    of one with corners: the outward unit normal
// Near says that the ray is known not to be surely_missed(). The surface that a ray has just left is told by its tag.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// The scene's corners, and the shading normals there; null where no shape has such.
template <class N>
struct Corners {
    static constexpr bool enclose = false;
    const Point<N>* points;
    const Direction<N>* normals;
};

// The same where the ray is known to pass inside of a shape's outline.
template <class N>
struct EnclosingCorners : Corners<N> {
    static constexpr bool enclose = true;
};

// In 1/512 of a length, how far along the ray a hit may be reported from where the ray's line passes through the shape,
// for trees: src/scene/tree_builder.hpp shows why.
template <class N>
inline constexpr int32_t hit_slack = NarrowFixed<N> ? 128 : 32;

template <class N>
struct RejectRay;

template <class S>
QRAY_INLINE constexpr Tag tag_of(const S& shape)
{
    return shape.tag;
}

// What forgets one of the above does not compile.
template <class S, class N>
concept ShapeIn = requires(const S& shape, const Corners<N>& corners, const Ray<N>& ray, const RejectRay<N>& reject,
                           typename N::Length t, Local<N> local, Point<N> point, Direction<N> normal) {
    requires Is<decltype(S::has_corners), const bool> && Is<decltype(S::is_curved), const bool>;
    requires Is<decltype(S::is_smooth), const bool> && Is<decltype(S::is_short), const bool>;
    { tag_of(shape) } -> Is<Tag>;
    { surely_missed(shape, reject) } -> Is<bool>;
    { intersect<true>(shape, corners, ray, t, t, local) } -> Is<bool>;
    { crossings<true>(shape, corners, ray, t) } -> Is<int>;
    { surface_of(shape, corners, ray, t, local, point, normal) } -> Is<void>;
    requires !S::has_corners || requires { { normal_of(shape, corners) } -> Is<Direction<N>>; };
    requires !S::is_smooth || requires { { shading_normal(shape, corners, ray, normal) } -> Is<Direction<N>>; };
};

} // namespace qray
