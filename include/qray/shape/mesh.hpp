// A triangle in little room, for compiled scenes with a tree: its corners by their numbers, and of its normal only what
// the rounded corners do not say. A tree finds it, so it has no ball. It is met where, and as, a Polygon or a Patch is.
#pragma once

#include "corners.hpp"

namespace qray {

// In fixed point, what the normal has beyond that of normal_across(), in ulp.
template <class N>
struct LeanNormal {
    ByNumber<N, int8_t, typename N::Unit> x, y, z;
};

struct MeshCorners {
    uint16_t a, b, c;
};

template <class N, bool Smooth>
struct MeshTriangle {
    static constexpr bool has_corners = true, keeps_local = N::is_fixed, is_smooth = Smooth, is_short = false;
    static constexpr bool is_lean = true;

    MeshCorners corners; // in the scene's vertices; of a smooth one also corner normals
    uint16_t place;      // of its tag, as is the material
    LeanNormal<N> normal;
    uint8_t material;

    template <class P>
    QRAY_INLINE constexpr Figure<P> figure(const P* points) const
    {
        return {points + corners.a, points + corners.b, points + corners.c, 3};
    }
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
    if constexpr (WideFixed<N>)
        return N::normalise(x, y, z, n.x, n.y, n.z);
    // To 30 bits.
    const int64_t all = (x ^ (x >> 63)) | (y ^ (y >> 63)) | (z ^ (z >> 63)) | 1;
    const int zeros = count_leading_zeros(static_cast<uint64_t>(all));
    const int down = zeros < 34 ? 34 - zeros : 0;
    const auto word = [down](int64_t w) { return static_cast<int32_t>(w >> down); };
    return N::normalise(word(x), word(y), word(z), n.x, n.y, n.z);
}

template <class N>
QRAY_NOINLINE constexpr Direction<N> normal_of(const MeshCorners& at, const LeanNormal<N>& lean, const Point<N>* points)
{
    Direction<N> n{};
    normal_across<N>(points[at.a], points[at.b], points[at.c], n);
    return {{n.x.raw + lean.x}, {n.y.raw + lean.y}, {n.z.raw + lean.z}};
}
template <class N, bool Smooth>
QRAY_INLINE constexpr Direction<N> normal_of(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners)
{
    if constexpr (N::is_fixed)
        return normal_of<N>(s.corners, s.normal, corners.points);
    else
        return {s.normal.x, s.normal.y, s.normal.z};
}

} // namespace qray
