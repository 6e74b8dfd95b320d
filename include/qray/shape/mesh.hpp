// A triangle in little room, for compiled scenes with a tree: its corners by their numbers, and of its normal only what the
// rounded corners do not say. A tree finds it, so it has no ball. It is met where, and as, a Polygon or a Patch is.
#pragma once

#include "corners.hpp"
#include "reject.hpp"

namespace qray {

// In fixed point, what the normal has beyond that of normal_across(), in ulp.
template <class N>
struct LeanNormal {
    int8_t x, y, z;
};
template <class N>
    requires(!N::is_fixed)
struct LeanNormal<N> {
    typename N::Unit x, y, z;
};

struct MeshCorners {
    uint16_t a, b, c;
};

template <class N, bool Smooth>
struct MeshTriangle {
    static constexpr bool has_corners = true, is_curved = false, is_smooth = Smooth, is_short = false;

    MeshCorners corners; // in the scene's vertices; of a smooth one also corner normals
    uint16_t place;      // of its tag, as is the material
    LeanNormal<N> normal;
    uint8_t material;

    constexpr uint32_t corner(uint32_t i) const { return i == 0 ? corners.a : i == 1 ? corners.b : corners.c; }
};

template <class N, bool Smooth>
QRAY_INLINE constexpr Tag tag_of(const MeshTriangle<N, Smooth>& s)
{
    return make_tag(s.place, s.material);
}

// The unit normal of a triangle with these corners. False where they lie on a line.
template <class N>
constexpr bool normal_across(const Point<N>& a, const Point<N>& b, const Point<N>& c, Direction<N>& n)
{
    const Point<N> u = b - a, v = c - a;
    const auto area = [](auto p, auto q, auto r, auto s) { return wide_mul(p.raw, q.raw) - wide_mul(r.raw, s.raw); };
    const int64_t x = area(u.y, v.z, u.z, v.y), y = area(u.z, v.x, u.x, v.z), z = area(u.x, v.y, u.y, v.x);
    // To 30 bits.
    const int zeros = count_leading_zeros(static_cast<uint64_t>((x ^ (x >> 63)) | (y ^ (y >> 63)) | (z ^ (z >> 63)) | 1));
    const int down = zeros < 34 ? 34 - zeros : 0;
    const auto word = [down](int64_t w) { return static_cast<int32_t>(w >> down); };
    return N::normalise(word(x), word(y), word(z), n.x, n.y, n.z);
}

template <class N>
QRAY_NOINLINE constexpr Direction<N> normal_of(const MeshCorners& at, const LeanNormal<N>& lean, const Point<N>* points)
{
    if constexpr (N::is_fixed) {
        Direction<N> n{};
        normal_across<N>(points[at.a], points[at.b], points[at.c], n);
        return {{n.x.raw + lean.x}, {n.y.raw + lean.y}, {n.z.raw + lean.z}};
    } else {
        return {lean.x, lean.y, lean.z};
    }
}
template <class N, bool Smooth>
QRAY_INLINE constexpr Direction<N> normal_of(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners)
{
    return normal_of<N>(s.corners, s.normal, corners.points);
}

template <class N, bool Smooth>
QRAY_INLINE constexpr bool surely_missed(const MeshTriangle<N, Smooth>&, const RejectRay<N>&)
{
    return false;
}

template <class N, bool Smooth>
QRAY_INLINE constexpr bool surely_missed(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const ProjectedRay& ray)
{
    const auto& [a, b, c] = s.corners;
    return ray.misses<N>(corners.points[a], corners.points[b], corners.points[c]);
}

// The corners, relative to a ray's origin.
template <class N>
struct CornerFrom {
    const MeshCorners& at;
    const Point<N>* points;
    const Point<N>& origin;
    QRAY_INLINE constexpr Point<N> operator()(uint32_t i) const
    {
        return points[i == 0 ? at.a : i == 1 ? at.b : at.c] - origin;
    }
};

// By itself, so that its stack is free again where the normal wants some.
template <class N>
QRAY_NOINLINE constexpr bool encloses(const CornerFrom<N>& corner, const Ray<N>& ray)
{
    return encloses<N>(3, corner, ray.direction);
}

template <class N, bool Smooth>
constexpr bool encloses(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const Ray<N>& ray)
{
    return encloses(CornerFrom<N>{s.corners, corners.points, ray.origin}, ray);
}

// Where a ray meets a triangle that its line passes through.
template <class N>
QRAY_NOINLINE constexpr bool meets(const CornerFrom<N>& corner, const LeanNormal<N>& lean, const Ray<N>& ray,
                                   typename N::Length limit, typename N::Length& t, bool to_light)
{
    const Direction<N> normal = normal_of<N>(corner.at, lean, corner.points);
    const auto den = dot<N>(ray.direction, normal);
    const bool edge_on = N::nearly_zero(den);
    if (!edge_on && !intersect_plane<N>(dot<N>(corner(0), normal), den, limit, t))
        return false;
    if ((edge_on || NarrowFixed<N>) && !plane_distance<N>(normal, 3, corner, ray, limit, t))
        return false;
    return !to_light || before_light<N>(normal, ray, t, limit);
}

// t in (0, limit], or false; also where that is a crossing at the light that stands at `limit`. The normal costs more than
// all else, so it comes last.
template <class N, bool Smooth>
QRAY_INLINE constexpr bool meets(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const Ray<N>& ray,
                                 typename N::Length limit, typename N::Length& t, bool to_light)
{
    const CornerFrom<N> corner{s.corners, corners.points, ray.origin};
    return !(ray.from == tag_of(s)) && encloses(corner, ray) && meets(corner, s.normal, ray, limit, t, to_light);
}

template <bool Near = false, class N, bool Smooth>
QRAY_INLINE constexpr bool intersect(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const Ray<N>& ray,
                                     typename N::Length limit, typename N::Length& t, Local<N>&)
{
    return meets(s, corners, ray, limit, t, false);
}

// How often the ray crosses it strictly between its origin and a light at `distance`: 0 or 1.
template <bool Near = false, class N, bool Smooth>
QRAY_INLINE constexpr int crossings(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const Ray<N>& ray,
                                    typename N::Length distance)
{
    typename N::Length t{};
    return meets(s, corners, ray, distance, t, true);
}

template <class N, bool Smooth>
QRAY_INLINE constexpr void surface_of(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners, const Ray<N>& ray,
                                      typename N::Length t, const Local<N>&, Point<N>& point, Direction<N>& n)
{
    n = normal_of(s, corners);
    const Point<N> hit = Smooth ? ray.origin + along<N>(t, ray.direction) : in_world(ray, t);
    point = on_plane<N>(corners.points[s.corners.a], n, hit);
}

template <class N>
constexpr Direction<N> shading_normal(const MeshTriangle<N, true>& s, const Corners<N>& corners, const Ray<N>& ray,
                                      const Direction<N>& g)
{
    return blended_normal(s, corners, ray, g);
}

// What takes little room keeps its normal as a rest beside that of its rounded corners: for scenes that stand still.
template <class N, bool Smooth>
constexpr bool move(const MeshTriangle<N, Smooth>&, const Corners<N>&, const Motion<N>&, MeshTriangle<N, Smooth>&,
                    const MovedCorners<N>&)
{
    return false;
}

template <class N, bool Smooth>
constexpr Box<N> box_of(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners)
{
    return box_of_figure(3, [&s](uint32_t i) { return s.corner(i); }, corners);
}

} // namespace qray
