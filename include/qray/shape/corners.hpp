// Where a ray meets a planar figure with corners: for polygons and patches.
//
// Inside or outside is decided by crossing parity in the ray's own frame: each corner is sheared once so that the
// ray runs along the dominant axis of its direction (after Woop, Benthin, Wald, Watertight Ray/Triangle Intersection,
// JCGT 2013), and an edge counts where it crosses the half-line y = 0, x > 0. Whether it does depends on
// nothing but the ray and the two corners, and not on their order: of two polygons that share an edge exactly one
// owns each ray through it, and a closed mesh has no leak, in every number system. In fixed point the answer is that of
// exact arithmetic on the ray and the corners as they are given.
#pragma once

#include "plane.hpp"
#include "projected_ray.hpp"

namespace qray {

// A point in the plane across the ray.
template <class N>
struct Sheared {
    typename N::Length x, y;
};

// Where products have 32 bits, the sheared corner is exact: not rounded to a Length.
template <class N>
    requires NarrowFixed<N>
struct Sheared<N> {
    typename N::Moment x, y;
};

template <class N>
struct Shear {
    static constexpr bool is_wide_fixed = WideFixed<N>;

    int axis; // the dominant axis of the direction: 0, 1, 2
    typename N::Unit dx, dy, dz; // the direction, that axis last

    constexpr explicit Shear(const Direction<N>& d) : axis(0), dx(d.y), dy(d.z), dz(d.x)
    {
        const auto ax = d.x < N::zero ? -d.x : d.x;
        const auto ay = d.y < N::zero ? -d.y : d.y;
        const auto az = d.z < N::zero ? -d.z : d.z;
        if (ay > ax && ay >= az) {
            axis = 1;
            dx = d.z;
            dy = d.x;
            dz = d.y;
        } else if (az > ax) {
            axis = 2;
            dx = d.x;
            dy = d.y;
            dz = d.z;
        }
    }

    // v is relative to the ray's origin. One rounding a component; |result| <= |v|.
    constexpr Sheared<N> operator()(const Point<N>& v) const
    {
        const Moments m = exact(v);
        if constexpr (NarrowFixed<N>)
            return {m.x, m.y};
        else
            return {N::length(m.x), N::length(m.y)};
    }
    // The same, but in fixed point each component keeps its sign: what is not exact is rounded down.
    constexpr Sheared<N> below(const Point<N>& v) const
    {
        if constexpr (is_wide_fixed) {
            const Moments m = exact(v);
            return {N::length_below(m.x), N::length_below(m.y)};
        } else {
            return (*this)(v);
        }
    }
    // The sign of the exact edge(a, b).
    QRAY_NOINLINE constexpr int edge_sign(const Point<N>& a, const Point<N>& b) const
        requires is_wide_fixed
    {
        const Moments m = exact(a), n = exact(b);
        return compare_products(m.x.raw, n.y.raw, n.x.raw, m.y.raw);
    }

private:
    struct Moments {
        typename N::Moment x, y;
    };
    QRAY_INLINE constexpr Moments exact(const Point<N>& v) const
    {
        const auto z = axis == 0 ? v.x : axis == 1 ? v.y : v.z;
        const auto x = axis == 0 ? v.y : axis == 1 ? v.z : v.x;
        const auto y = axis == 0 ? v.z : axis == 1 ? v.x : v.y;
        return {x * dz - z * dx, y * dz - z * dy};
    }
};

// Twice the signed area of (0, a, b).
template <class N>
QRAY_INLINE constexpr auto edge(const Sheared<N>& a, const Sheared<N>& b)
{
    if constexpr (NarrowFixed<N>)
        return Wide<2 * N::Moment::frac, 32>{wide_mul(a.x.raw, b.y.raw) - wide_mul(b.x.raw, a.y.raw)};
    else
        return a.x * b.y - b.x * a.y;
}

// Does the edge a-b cross the half-line y = 0, x > 0? The same answer for b-a. sign() is that of the exact edge(a, b),
// where rounding leaves it open.
template <class N, class Sign>
QRAY_INLINE constexpr bool crosses(const Sheared<N>& a, const Sheared<N>& b, [[maybe_unused]] Sign sign)
{
    constexpr decltype(a.x) o{};
    if constexpr (Shear<N>::is_wide_fixed) {
        const bool up = b.y >= o;
        if ((a.y >= o) == up)
            return false;
        if (a.x < o && b.x < o)
            return false;
        if (a.x > o && b.x > o)
            return true;
        // Each coordinate is less than 1 too low, which is worth less than it and 1 in a product.
        const int64_t margin = int64_t{N::magnitude(a.x.raw) | N::magnitude(a.y.raw)
                                       | N::magnitude(b.x.raw) | N::magnitude(b.y.raw)} * 4 + 2;
        const int64_t e = edge<N>(a, b).raw;
        if (e > margin || e < -margin)
            return (e > 0) == up;
        const int s = sign();
        return up ? s > 0 : s < 0;
    } else {
        const bool up = b.y > o;
        if ((a.y > o) == up)
            return false;
        if (a.x <= o && b.x <= o)
            return false;
        if (a.x > o && b.x > o)
            return true;
        const auto e = edge<N>(a, b);
        constexpr decltype(e) none{};
        return up ? e > none : e < none;
    }
}

// The distance to the plane of a surface that the ray is known to pass through. Where the plane is seen almost
// edge on its equation says little; the corners' own distances then bound it.
template <class N, class Corner>
QRAY_NOINLINE constexpr bool plane_distance(const Direction<N>& normal, uint32_t count, const Corner& corner,
                                            const Ray<N>& ray, typename N::Length limit, typename N::Length& t)
{
    typename N::Length near = N::length_max, far = -N::length_max;
    for (uint32_t i = 0; i < count; i++) {
        const auto depth = N::length(dot<N>(corner(i), ray.direction));
        if (depth < near)
            near = depth;
        if (depth > far)
            far = depth;
    }
    if (!N::quotient(dot<N>(corner(0), normal), dot<N>(ray.direction, normal), 0, t) || t < near)
        t = near;
    if (t > far)
        t = far;
    return t > N::length_zero && t <= limit;
}

// Does the ray's line pass inside of the outline? Corners are given relative to the ray's origin by corner(i).
template <class N, class Corner>
QRAY_NOINLINE constexpr bool encloses(uint32_t count, const Corner& corner, const Direction<N>& d)
{
    const Shear<N> shear(d);
    bool inside = false;
    uint32_t last = count - 1;
    Sheared<N> a = shear.below(corner(last));
    for (uint32_t i = 0; i < count; i++) {
        const Sheared<N> b = shear.below(corner(i));
        const auto sign = [&] {
            if constexpr (Shear<N>::is_wide_fixed)
                return shear.edge_sign(corner(last), corner(i));
        };
        inside = inside != crosses<N>(a, b, sign);
        a = b;
        last = i;
    }
    return inside;
}

// Is the ray's line surely beside a figure of three or four corners?
template <class N, class Point_of>
QRAY_INLINE constexpr bool surely_beside(uint32_t count, Point_of point, const ProjectedRay& ray)
{
    // Where it passes inside of one, it passes inside of an odd number of the triangles that it is fanned into.
    return count <= 4 && ray.misses<N>(point(0), point(1), point(2))
        && (count == 3 || ray.misses<N>(point(0), point(2), point(3)));
}

// Where the ray meets the plane through c; 0 where that is seen almost edge on, and says too little. False where it is
// not met in (0, limit].
template <class N>
QRAY_NOINLINE constexpr bool meets_plane(const Direction<N>& normal, const Point<N>& c, const Ray<N>& ray,
                                         typename N::Length limit, typename N::Length& t)
{
    const auto den = dot<N>(ray.direction, normal);
    t = N::length_zero;
    return N::nearly_zero(den) || intersect_plane<N>(dot<N>(c - ray.origin, normal), den, limit, t);
}

// Enclosed: the ray is known to pass inside. The steps are functions, so that they take the same stack in turn.
template <bool Enclosed, class N, class Corner>
QRAY_INLINE constexpr bool intersect_corners(const Direction<N>& normal, uint32_t count, const Point<N>& first,
                                             const Corner& corner, const Ray<N>& ray, typename N::Length limit,
                                             typename N::Length& t)
{
    if (!meets_plane<N>(normal, first, ray, limit, t))
        return false;
    if constexpr (!Enclosed)
        if (!encloses<N>(count, corner, ray.direction))
            return false;
    // A rounded normal may put the plane beside the corners.
    if constexpr (!NarrowFixed<N>)
        if (t > N::length_zero)
            return true;
    return plane_distance<N>(normal, count, corner, ray, limit, t);
}

// The barycentric weights of where the ray passes a triangle with these corners, or false. By itself, so that its stack
// is free again where the blend is made unit.
template <class N>
QRAY_NOINLINE constexpr bool corner_weights(const Point<N>& a, const Point<N>& b, const Point<N>& c, const Ray<N>& ray,
                                            typename N::Unit (&w)[3])
{
    const Shear<N> shear(ray.direction);
    const Sheared<N> at = shear(a - ray.origin), bt = shear(b - ray.origin), ct = shear(c - ray.origin);
    return N::weights(edge<N>(bt, ct), edge<N>(ct, at), edge<N>(at, bt), w[0], w[1], w[2]);
}

// The blend of a triangle's corner normals where the ray meets it: unit, not yet turned; g where it vanishes.
template <class N, class S>
QRAY_INLINE constexpr Direction<N> blended_normal(const S& s, const Corners<N>& corners, const Ray<N>& ray,
                                                  const Direction<N>& g)
{
    const auto& [vertices, normals] = corners;
    typename N::Unit w[3]{};
    Direction<N> n = g;
    if (corner_weights<N>(vertices[s.corner(0)], vertices[s.corner(1)], vertices[s.corner(2)], ray, w)) {
        const Direction<N>& na = normals[s.corner(0)];
        const Direction<N>& nb = normals[s.corner(1)];
        const Direction<N>& nc = normals[s.corner(2)];
        using Blend = Vec<typename N::Cosine>;
        normalise_short<N>(Blend{w[0] * na.x + w[1] * nb.x + w[2] * nc.x, w[0] * na.y + w[1] * nb.y + w[2] * nc.y,
                                 w[0] * na.z + w[1] * nb.z + w[2] * nc.z},
                           n);
    }
    return n;
}

// Moves a figure's normal, its ball and its corners; corner(i) is the number of the i-th.
template <class N, class S, class Corner>
constexpr bool move_figure(const S& from, uint32_t count, Corner corner, const Corners<N>& corners, const Motion<N>& motion,
                           S& to, const MovedCorners<N>& moved)
{
    if (!motion.valid())
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!ball_in_world<N>(motion(corners.points[corner(i)])))
            return false;
    const Point<N> middle = motion(from.middle);
    const bool rounds = motion.turned() || motion.scaled();
    const auto bound = motion.length(from.bound) + (rounds ? N::ulp + N::ulp + N::ulp : N::length_zero);
    if (!ball_in_world<N>(middle) || !ball_in_world<N>({}, bound))
        return false;
    if (moved.points == nullptr)
        return true;
    for (uint32_t i = 0; i < count; i++)
        moved.points[corner(i)] = motion(corners.points[corner(i)]);
    if constexpr (S::is_smooth)
        for (uint32_t i = 0; i < count; i++)
            moved.normals[corner(i)] = motion.blend(corners.normals[corner(i)]);
    to = from;
    to.normal = motion.direction(from.normal);
    to.middle = middle;
    to.bound = bound;
    return true;
}

template <class N, class Corner>
constexpr Box<N> box_of_figure(uint32_t count, Corner corner, const Corners<N>& corners)
{
    Box<N> box{corners.points[corner(0)], corners.points[corner(0)]};
    for (uint32_t i = 1; i < count; i++)
        box.add(corners.points[corner(i)], corners.points[corner(i)]);
    return box;
}

} // namespace qray
