// A point in the frame of a ray that runs along z, and whether an edge there counts.
//
// Inside or outside is decided by crossing parity in the ray's own frame: each corner is sheared once so that the
// ray runs along the dominant axis of its direction (after Woop, Benthin, Wald, Watertight Ray/Triangle Intersection,
// JCGT 2013), and an edge counts where it crosses the half-line y = 0, x > 0. Whether it does depends on
// nothing but the ray and the two corners, and not on their order: of two polygons that share an edge exactly one
// owns each ray through it, and a closed mesh has no leak, in every number system. In q16 and q32 the answer is that of
// exact arithmetic on the ray and the corners as they are given; q24 rounds a sheared corner, for all its edges alike.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// A point in the plane across the ray. Where products have 32 bits it is exact: not rounded to a Length.
template <class N>
struct Sheared {
    Either<NarrowFixed<N>, typename N::Moment, typename N::Length> x, y;
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
    // The sign of the exact edge(a - o, b - o).
    QRAY_NOINLINE constexpr int edge_sign(const Point<N>& a, const Point<N>& b, const Point<N>& o) const
        requires is_wide_fixed
    {
        const Moments m = exact(a - o), n = exact(b - o);
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
        const int64_t margin = int64_t{magnitude(a.x.raw) | magnitude(a.y.raw)
                                       | magnitude(b.x.raw) | magnitude(b.y.raw)} * 4 + 2;
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

} // namespace qray
