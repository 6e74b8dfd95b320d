// What every shape says of itself and is asked. A shape is a structure with these constants, which are
// told and not guessed
//   has_corners   it is made of points in the scene's vertices
//   keeps_local   what an intersection finds beside t is kept for the surface (Local)
//   is_smooth     it has shading normals of its own: shading_normal()
//   is_short      its test is so short that where code is cheap a loop over them is unrolled
// and these functions, found by its type:
//   tag_of(shape)                                            where it has no member `tag`
//   surely_missed(shape, reject)                             may always say no; see reject.hpp
//   intersect<Near>(shape, corners, ray, limit, t, local)    the nearest t in (0, limit], or false
//   crossings<Near>(shape, corners, ray, distance)           how often the ray crosses it before a light at `distance`
//   surface_of(shape, corners, ray, t, local, point, normal) the point of a hit, and the outward unit normal there
//   shading_normal(shape, corners, ray, normal)              of a smooth one: unit, not yet turned
//   normal_of(shape, corners)                                of one with corners: the outward unit normal
//   reaches(shape, corners, ray, distance)                   of a flat one: does it hold the ray's point there,
//                                                            which is in its plane?
//   move(shape, corners, motion, moved, moved_corners)       what it is then, with all that is derived; false,
//                                                            and nothing changes, where it leaves the world or is tiny
//   box_of(shape, corners)                                   a box that holds it, for trees
// Near says that the ray is known not to be surely_missed(). The surface that a ray has just left is told by its tag.
#pragma once

#include "../vector/motion.hpp"

namespace qray {

// The scene's corners, and the shading normals there; null where no shape has such.
template <class N>
struct Corners {
    static constexpr bool enclose = false, outline_first = false;
    const Point<N>* points;
    const Direction<N>* normals;
};

// The same where the ray is known to pass inside of a shape's outline.
template <class N>
struct EnclosingCorners : Corners<N> {
    static constexpr bool enclose = true;
};
// The same where its outline is to be asked before its plane.
template <class N>
struct OutlineCorners : Corners<N> {
    static constexpr bool outline_first = true;
};

// In 1/512 of a length, how far along the ray a hit may be reported from where the ray's line passes through the shape,
// for trees: src/scene/tree_builder.hpp shows why.
template <class N>
inline constexpr int32_t hit_slack = NarrowFixed<N> ? 128 : 32;

// Where corners and normals go that are moved; null to move nothing, and ask only whether that can be.
template <class N>
struct MovedCorners {
    Point<N>* points;
    Direction<N>* normals;
};

template <class N>
struct BoundingBox {
    Point<N> low, high;

    static constexpr BoundingBox ball(const Point<N>& centre, typename N::Length radius)
    {
        const Point<N> r{radius, radius, radius};
        return {centre - r, centre + r};
    }
    constexpr void add(const Point<N>& a, const Point<N>& b)
    {
        const auto lower = [](auto u, auto v) { return u < v ? u : v; };
        const auto higher = [](auto u, auto v) { return u < v ? v : u; };
        low = {lower(low.x, a.x), lower(low.y, a.y), lower(low.z, a.z)};
        high = {higher(high.x, b.x), higher(high.y, b.y), higher(high.z, b.z)};
    }
    constexpr bool holds(const Point<N>& p) const
    {
        return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
    }
};

// The same for a shape without corners of the scene.
template <class N, template <class> class S>
    requires(!S<N>::has_corners)
constexpr bool move(const S<N>& from, const Motion<N>& motion, S<N>& to)
{
    return move(from, Corners<N>{}, motion, to, MovedCorners<N>{});
}

// The most bits that a shape of this size can have beyond Length's: see Blocks.
template <class N>
constexpr int block_scale(typename N::Length size, [[maybe_unused]] Blocks::Of Blocks::*of)
{
    int fine = 0;
    if constexpr (N::is_fixed) {
        const int64_t with_slack = int64_t{size.raw} + N::blocks.slack;
        const Blocks::Of& block = N::blocks.*of;
        const int up = block.least < 0 ? -block.least : 0;
        fine = block.least;
        while (fine < block.most && with_slack << (fine + 1 + up) <= int64_t{block.size} << up)
            fine++;
    }
    return fine;
}

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
                           typename N::Length t, Local<N> local, Point<N> point, Direction<N> normal,
                           const Motion<N>& motion, S& moved, const MovedCorners<N>& moved_corners) {
    requires Is<decltype(S::has_corners), const bool> && Is<decltype(S::keeps_local), const bool>;
    requires Is<decltype(S::is_smooth), const bool> && Is<decltype(S::is_short), const bool>;
    { tag_of(shape) } -> Is<Tag>;
    { surely_missed(shape, reject) } -> Is<bool>;
    { intersect<true>(shape, corners, ray, t, t, local) } -> Is<bool>;
    { crossings<true>(shape, corners, ray, t) } -> Is<int>;
    { surface_of(shape, corners, ray, t, local, point, normal) } -> Is<void>;
    { move(shape, corners, motion, moved, moved_corners) } -> Is<bool>;
    { box_of(shape, corners) } -> Is<BoundingBox<N>>;
    requires !S::has_corners || requires { { normal_of(shape, corners) } -> Is<Direction<N>>; };
    requires !S::is_smooth || requires { { shading_normal(shape, corners, ray, normal) } -> Is<Direction<N>>; };
};

} // namespace qray
