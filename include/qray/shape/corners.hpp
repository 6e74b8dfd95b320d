// Where a ray meets a planar figure with corners: for polygons, patches and triangles. Inside or outside is decided by
// crossing parity in the ray's own frame: see sheared.hpp.
#pragma once

#include "plane.hpp"
#include "projected_ray.hpp"
#include "reject.hpp"
#include "sheared.hpp"

namespace qray {

// Where the corners of a figure are in the scene's points, or normals: those behind the second are in a row.
template <class P>
struct Figure {
    const P *first, *second, *others;
    uint32_t count;

    QRAY_INLINE constexpr const P& operator[](uint32_t i) const
    {
        return i == 0 ? *first : i == 1 ? *second : others[i - 2];
    }
};

// The distance to the plane of a surface that the ray is known to pass through. Where the plane is seen almost
// edge on its equation says little; the corners' own distances then bound it.
template <class N>
QRAY_NOINLINE constexpr bool plane_distance(const Direction<N>& normal, const Figure<Point<N>>& figure,
                                            const Ray<N>& ray, typename N::Length limit, typename N::Length& t)
{
    typename N::Length near = N::length_max, far = -N::length_max;
    for (uint32_t i = 0; i < figure.count; i++) {
        const auto depth = N::length(dot<N>(figure[i] - ray.origin, ray.direction));
        if (depth < near)
            near = depth;
        if (depth > far)
            far = depth;
    }
    if (!N::quotient(dot<N>(*figure.first - ray.origin, normal), dot<N>(ray.direction, normal), 0, t) || t < near)
        t = near;
    if (t > far)
        t = far;
    return t > N::length_zero && t <= limit;
}

// Does the ray's line pass inside of the outline?
template <class N>
QRAY_NOINLINE constexpr bool encloses(const Figure<Point<N>>& figure, const Ray<N>& ray)
{
    const Shear<N> shear(ray.direction);
    const Point<N> *from = figure.first, *to = figure.second, *next = figure.others;
    Sheared<N> a = shear.below(*from - ray.origin);
    bool inside = false;
    for (uint32_t left = figure.count;;) {
        const Sheared<N> b = shear.below(*to - ray.origin);
        const auto sign = [&] {
            if constexpr (Shear<N>::is_wide_fixed)
                return shear.edge_sign(*from, *to, ray.origin);
        };
        inside = inside != crosses<N>(a, b, sign);
        if (--left == 0)
            return inside;
        a = b;
        from = to;
        to = left == 1 ? figure.first : next++;
    }
}

// Where the ray meets the plane through c; 0 where that is seen almost edge on, and says too little. False where it is
// not met in (0, limit].
template <class N>
QRAY_STAGE constexpr bool meets_plane(const Direction<N>& normal, const Point<N>& c, const Ray<N>& ray,
                                      typename N::Length limit, typename N::Length& t)
{
    const auto den = dot<N>(ray.direction, normal);
    t = N::length_zero;
    return N::nearly_zero(den) || intersect_plane<N>(dot<N>(c - ray.origin, normal), den, limit, t);
}

// What shape.hpp asks, of all shapes with corners. Such a shape says where they are, figure(points), and whether it is
// lean: it has no ball, and its normal costs more than all else and so comes last.
template <class S>
concept HasCorners = S::has_corners;

template <HasCorners S, class N>
QRAY_INLINE constexpr Direction<N> normal_of(const S& s, const Corners<N>&)
{
    return s.normal;
}

template <HasCorners S, class N>
QRAY_INLINE constexpr bool surely_missed(const S& s, const RejectRay<N>& ray)
{
    if constexpr (S::is_lean)
        return false;
    else
        return ray.misses_ball(s.middle, s.bound);
}

// Only one of three or four corners.
template <HasCorners S, class N>
QRAY_INLINE constexpr bool surely_missed(const S& s, const Corners<N>& corners, const Ray<N>& ray,
                                         const ProjectedRay& seen)
{
    // What is as large as a floor is seldom missed.
    if constexpr (ProjectedRay::is_exact<N> && !S::is_lean)
        if (s.bound.raw >> (N::Length::frac + 4) != 0)
            return false;
    const auto [a, b, others, count] = s.figure(corners.points);
    // Where it passes inside of one, it passes inside of an odd number of the triangles that it is fanned into.
    return count <= 4 && seen.misses(ray, *a, *b, others[0])
        && (count == 3 || seen.misses(ray, *a, others[0], others[1]));
}

template <HasCorners S, class N>
QRAY_NOINLINE constexpr bool encloses(const S& s, const Point<N>* points, const Ray<N>& ray)
{
    return encloses(s.figure(points), ray);
}

template <HasCorners S, class D>
QRAY_INLINE constexpr const D& known_normal(const S&, const D& normal)
{
    return normal;
}
template <HasCorners S>
QRAY_INLINE constexpr const auto& known_normal(const S& s)
{
    return s.normal;
}

// t in (0, limit], or false; also where that is a crossing at the light that stands at `limit`. Enclosed: the ray is
// known to pass inside. `own`: the normal, where the shape does not have it. The steps are functions, so that they take
// the same stack in turn.
template <bool Enclosed, HasCorners S, class N, class... Own>
QRAY_STAGE constexpr bool meets(const S& s, const Point<N>* points, const Ray<N>& ray, typename N::Length limit,
                                typename N::Length& t, bool to_light, const Own&... own)
{
    const Direction<N>& normal = known_normal(s, own...);
    auto end = limit;
    if constexpr (NarrowFixed<N>) // so far behind the corners the plane may be, to whose distances t is put back below
        end.raw += hit_slack<N> << (N::Length::frac - 9);
    if (!meets_plane<N>(normal, *s.figure(points).first, ray, end, t))
        return false;
    if constexpr (!Enclosed)
        if (!encloses(s.figure(points), ray))
            return false;
    // A rounded normal may put the plane beside the corners.
    if ((NarrowFixed<N> || !(t > N::length_zero)) && !plane_distance<N>(normal, s.figure(points), ray, limit, t))
        return false;
    return !to_light || before_light<N>(normal, ray, t, limit);
}

// The figure that the ray starts on does not count. What a lean one's normal costs is kept in `local`.
template <HasCorners S, class N, class C>
QRAY_INLINE constexpr bool meets(const S& s, const C& corners, const Ray<N>& ray, typename N::Length limit,
                                 typename N::Length& t, bool to_light, Local<N>& local)
{
    constexpr bool outline_first = S::is_lean || C::outline_first;
    if (ray.from == tag_of(s) || (outline_first && !encloses(s, corners.points, ray)))
        return false;
    if constexpr (S::is_lean) {
        const Direction<N> normal = normal_of(s, corners);
        if constexpr (S::keeps_local)
            local.near = {{normal.x.raw}, {normal.y.raw}, {normal.z.raw}};
        return meets<true>(s, corners.points, ray, limit, t, to_light, normal);
    } else {
        return meets<outline_first || C::enclose>(s, corners.points, ray, limit, t, to_light);
    }
}

template <bool Near = false, HasCorners S, class N, class C>
QRAY_INLINE constexpr bool intersect(const S& s, const C& corners, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>& local)
{
    return meets(s, corners, ray, limit, t, false, local);
}

// How often the ray crosses it strictly between its origin and a light at `distance`: 0 or 1.
template <bool Near = false, HasCorners S, class N, class C>
QRAY_INLINE constexpr int crossings(const S& s, const C& corners, const Ray<N>& ray, typename N::Length distance)
{
    typename N::Length t{};
    Local<N> local{};
    return meets(s, corners, ray, distance, t, true, local);
}

template <HasCorners S, class N>
QRAY_INLINE constexpr void surface_of(const S& s, const Corners<N>& corners, const Ray<N>& ray, typename N::Length t,
                                      [[maybe_unused]] const Local<N>& local, Point<N>& point, Direction<N>& n)
{
    if constexpr (S::keeps_local)
        n = {{local.near.x.raw}, {local.near.y.raw}, {local.near.z.raw}};
    else
        n = normal_of(s, corners);
    const Point<N> hit = S::is_smooth ? ray.origin + along<N>(t, ray.direction) : in_world(ray, t);
    point = on_plane<N>(*s.figure(corners.points).first, n, hit);
}

// The barycentric weights of where the ray passes a triangle with these corners, or false. By itself, so that its stack
// is free again where the blend is made unit.
template <class N, HasCorners S>
QRAY_STAGE constexpr bool corner_weights(const S& s, const Point<N>* points, const Ray<N>& ray,
                                         typename N::Unit (&w)[3])
{
    const Figure<Point<N>> figure = s.figure(points);
    const Shear<N> shear(ray.direction);
    const Sheared<N> a = shear(*figure.first - ray.origin), b = shear(*figure.second - ray.origin),
                     c = shear(*figure.others - ray.origin);
    return N::weights(edge<N>(b, c), edge<N>(c, a), edge<N>(a, b), w[0], w[1], w[2]);
}

// The blend of three normals by weights, made unit; false where that vanishes.
template <class N, HasCorners S>
QRAY_STAGE constexpr bool blended(const S& s, const Direction<N>* normals, const typename N::Unit (&w)[3],
                                  Direction<N>& n)
{
    const auto [a, b, c, count] = s.figure(normals);
    using Blend = Vec<typename N::Cosine>;
    return normalise_short<N>(Blend{w[0] * a->x + w[1] * b->x + w[2] * c->x, w[0] * a->y + w[1] * b->y + w[2] * c->y,
                                    w[0] * a->z + w[1] * b->z + w[2] * c->z},
                              n);
}

// The blend of a triangle's corner normals where the ray meets it; g where that vanishes.
template <HasCorners S, class N>
    requires S::is_smooth
QRAY_INLINE constexpr Direction<N> shading_normal(const S& s, const Corners<N>& corners, const Ray<N>& ray,
                                                 const Direction<N>& g)
{
    typename N::Unit w[3]{};
    Direction<N> n = g;
    if (corner_weights<N>(s, corners.points, ray, w))
        blended<N>(s, corners.normals, w, n);
    return n;
}

// What is lean keeps of its normal what its rounded corners do not say, and is for scenes that stand still.
template <HasCorners S, class N>
constexpr bool move(const S& from, const Corners<N>& corners, const Motion<N>& motion, S& to,
                    const MovedCorners<N>& moved)
{
    if constexpr (!S::is_lean) {
        if (!motion.valid())
            return false;
        const Figure<Point<N>> figure = from.figure(corners.points);
        for (uint32_t i = 0; i < figure.count; i++)
            if (!ball_in_world<N>(motion(figure[i])))
                return false;
        const Point<N> middle = motion(from.middle);
        const bool rounds = motion.turned() || motion.scaled();
        const auto bound = motion.length(from.bound) + (rounds ? N::ulp + N::ulp + N::ulp : N::length_zero);
        if (!ball_in_world<N>(middle) || !ball_in_world<N>({}, bound))
            return false;
        if (moved.points == nullptr)
            return true;
        for (uint32_t i = 0; i < figure.count; i++) {
            const auto number = &figure[i] - corners.points;
            moved.points[number] = motion(figure[i]);
            if constexpr (S::is_smooth)
                moved.normals[number] = motion.blend(corners.normals[number]);
        }
        to = from;
        to.normal = motion.direction(from.normal);
        to.middle = middle;
        to.bound = bound;
    }
    return !S::is_lean;
}

template <HasCorners S, class N>
constexpr BoundingBox<N> box_of(const S& s, const Corners<N>& corners)
{
    const Figure<Point<N>> figure = s.figure(corners.points);
    BoundingBox<N> box{*figure.first, *figure.first};
    for (uint32_t i = 1; i < figure.count; i++)
        box.add(figure[i], figure[i]);
    // As reach_beside() of src/scene/shape/corners.hpp: how far beside corners off its plane a flat ray may meet it.
    typename N::Length off{};
    for (uint32_t i = 1; figure.count > 3 && i < figure.count; i++) {
        const auto height = N::length(dot<N>(figure[i] - *figure.first, normal_of(s, corners)));
        const auto size = height < N::length_zero ? -height : height;
        off = size > off ? size : off;
    }
    if constexpr (N::is_fixed)
        off = {off.raw <= 16 ? 0 : 64 * (off.raw >> N::Length::frac == 0 ? off.raw : 1 << N::Length::frac)};
    else
        off = off > 8 * N::ulp ? 64 * (off < 1 ? off : 1) : 0;
    const Point<N> reach{off, off, off};
    box.add(box.low - reach, box.high + reach);
    return box;
}

// The point is asked for in the box alone, the ray's line in the outline: both belong to shapes side by side as rays
// do. Only of a ray almost in the plane does the line pass inside elsewhere. Wider by what the point is off, but not
// beyond box_slack of src/scene/tree_builder.hpp.
template <HasCorners S, class N>
constexpr bool reaches(const S& s, const Corners<N>& corners, const Ray<N>& ray, typename N::Length distance)
{
    if (!encloses(s, corners.points, ray))
        return false;
    typename N::Length slack{};
    if constexpr (N::is_fixed)
        slack.raw = 1 << (N::Length::frac - (NarrowFixed<N> ? 5 : 14));
    else
        slack = N::fraction(1, 1 << 14);
    const Point<N> wider{slack, slack, slack};
    BoundingBox<N> box = box_of(s, corners);
    box = {box.low - wider, box.high + wider};
    return box.holds(ray.origin + along<N>(distance, ray.direction));
}

} // namespace qray
