// Open cylinder and cone frustum, in one form. In the frame of the axis, with the origin of coordinates at its
// middle and the half-angle as (c, s): x_perp is on the surface where c |x_perp| = rho0 + s z, |z| <= half.
//
// The ray's origin is first moved to its point nearest to the middle, so that everything below is no
// larger than the bounding sphere. Then, with rho = rho0 + s z of that point and o, d the parts of origin and
// direction across the axis:
//   A = c^2 |d|^2 - (s dz)^2    B = c^2 o.d - rho s dz    C = c^2 |o|^2 - rho^2
//   B^2 - A C = c^2 (|U|^2 - V^2)    U = rho d - s dz o    V = c (o x d)
// which needs no 120-bit product, and roots q/A and C/q with q = -(B + sign(B) sqrt(B^2 - A C)), which need no
// special case where the ray is parallel to a generator. A nearly axial d is block-scaled by 2^k.
//
// U^2 - V^2 has an error of 2 |U| ulp, B^2 - A C one of 2 (|B| + rho |A|). Close to a generator, where A and
// B vanish and the root is small, that is the better in fixed point: a ray could lose the end of a chord that
// is 16 ulp deep. Where it comes out negative, too, and rho is far less at -B/A, near an apex, it is formed
// again there, where it is -A C.
#pragma once

#include "reject.hpp"

namespace qray {

template <class N>
struct Cone {
    static constexpr bool has_corners = false, keeps_local = true, is_smooth = false, is_short = false;

    Point<N> middle;            // of the axis
    Direction<N> e1, e2, axis;  // orthonormal; the axis points to the end b
    typename N::Length rho0;    // cosine * mean radius, times 2^fine
    typename N::Length half;    // half the height, times 2^fine
    typename N::Length bound;   // radius of the bounding sphere around the middle, times 2^fine
    typename N::Unit cosine;    // of the half-angle
    typename N::Unit sine;      // > 0 where the radius grows along the axis
    int32_t fine;               // >= 0; 0 in floating point: see sphere.hpp
    Tag tag;
    [[no_unique_address]] Rounded<N> rounded; // of the middle
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Cone<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_ball(s.middle, N::coarse_above(s.bound, s.fine));
}

// The ray's meetings with the frustum, t > 0: how many (0, 1 or 2), the nearer in t[0].
template <class N>
constexpr int meetings(const Cone<N>& s, const Ray<N>& ray, typename N::Length limit, typename N::Length (&t)[2],
                       Local<N>& local, typename N::Length (&tau)[2])
{
    using Length = typename N::Length;
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward) // one nappe is convex: never met again
        return 0;
    const Point<N> v = s.middle - ray.origin;
    const Length b = N::length(dot<N>(v, ray.direction));
    const Length reach = N::coarse_above(s.bound, s.fine);
    if (b < -reach || b - reach > limit)
        return 0;
    const Point<N> p = along<N>(b, ray.direction) - v;
    if (beyond<N>(p, reach))
        return 0;
    const Point<N> o = from_exact(fine_offset<N>(b, ray.direction, v, s.fine), s.rounded);
    local.near = o;

    const Length ox = N::length(dot<N>(o, s.e1));
    const Length oy = N::length(dot<N>(o, s.e2));
    const Length oz = N::length(dot<N>(o, s.axis));
    const auto wx = dot<N>(ray.direction, s.e1);
    const auto wy = dot<N>(ray.direction, s.e2);
    const auto dz = N::unit(dot<N>(ray.direction, s.axis));
    const auto ws = s.sine * dz;
    const int k = N::headroom(wx, wy, ws);
    if (k > N::most_headroom) // along the axis of a cylinder: hardly more than 1 ulp across in all its length
        return 0;
    const auto dx = N::unit(N::shifted(wx, k));
    const auto dy = N::unit(N::shifted(wy, k));
    const auto ds = N::unit(N::shifted(ws, k));

    const Length rho = s.rho0 + N::length(s.sine * oz);
    const Length cx = N::length(s.cosine * ox);
    const Length cy = N::length(s.cosine * oy);
    const auto cdx = N::unit(s.cosine * dx);
    const auto cdy = N::unit(s.cosine * dy);
    const auto a = cdx * cdx + cdy * cdy - ds * ds;
    bool along_generator = false;
    if constexpr (WideFixed<N>)
        along_generator = N::is_small(a);
    typename N::Moment root{}; // of D; 0 for a ray that stands on the surface, whatever rounding made of it
    if (!along_generator) {
        const Length ux = N::length(rho * dx - ox * ds);
        const Length uy = N::length(rho * dy - oy * ds);
        const Length v0 = N::length(cx * dy - cy * dx);
        const auto discriminant = ux * ux + uy * uy - v0 * v0;
        if (discriminant >= typename N::Area{})
            root = s.cosine * N::sqrt(discriminant);
        else if (leaving != Leaves::inward)
            return 0;
    }
    const auto half_b = cx * cdx + cy * cdy - rho * ds;
    const auto c = cx * cx + cy * cy - rho * rho;
    if constexpr (WideFixed<N>)
        if (along_generator) {
            bool real = N::small_discriminant(half_b, a, c, root);
            Length deepest{};
            if (!real && leaving != Leaves::inward && k >= 0 && N::quotient(-half_b, a, k, deepest)
                && deepest <= s.bound && -deepest <= s.bound) {
                deepest = N::coarse(deepest, k);
                const Length r = rho + N::length(deepest * ds), small = N::coarse(rho, 2);
                if (r < small && -r < small) { // near an apex
                    const Length x = cx + N::length(deepest * cdx);
                    const Length y = cy + N::length(deepest * cdy);
                    real = N::root_of_product(a, r * r - x * x - y * y, root);
                }
            }
            if (!real && leaving != Leaves::inward)
                return 0;
        }
    const auto q = half_b < typename N::Moment{} ? root - half_b : -(root + half_b);

    bool valid[2] = {N::quotient(q, a, k, tau[0]), N::quotient(c, q, k, tau[1])};
    for (int i = 0; i < 2; i++) {
        // Farther than the bounding sphere is beyond both ends.
        valid[i] = valid[i] && tau[i] <= s.bound && -tau[i] <= s.bound;
        t[i] = valid[i] ? b + N::coarse(tau[i], s.fine) : N::length_zero;
    }
    if (leaving == Leaves::inward) {
        // Inside between the roots where A > 0, and to its end where not. The end is the larger root; the
        // chord between the roots, 2 sqrt(D) / A, bounds it and stands in for it, since it knows nothing of
        // the error of B.
        if (!(a > typename N::Cosine{}))
            return 0;
        const int end = q > typename N::Moment{} ? 0 : 1;
        Length chord{};
        const bool bounded = N::quotient(root + root, a, k, chord) && chord <= s.bound + s.bound;
        if (!valid[end] && !bounded)
            return 0;
        t[0] = t[end];
        tau[0] = tau[end];
        if (bounded && (!valid[end] || t[0] > N::coarse(chord, s.fine))) {
            t[0] = N::coarse(chord, s.fine);
            tau[0] = chord - N::fine(b, s.fine);
        }
        // As C is 0 at the origin, the end is at -2 B / A of there, too: where the two differ, D was too
        // small to be known.
        Length far{};
        const Length begin = N::fine(b, s.fine), near = begin + tau[0];
        const auto slope = half_b - begin * N::unit(a);
        if (k == 0 && N::quotient(-(slope + slope), a, 0, far) && far > N::length_zero && far <= s.bound + s.bound
            && (!(near > N::length_zero) || far - near > near || near - far > far)) {
            t[0] = N::coarse(far, s.fine);
            tau[0] = far - begin;
        }
        if (!(t[0] > N::length_zero)) {
            t[0] = N::ulp;
            tau[0] = -N::fine(b, s.fine);
        }
        valid[0] = true;
        valid[1] = false;
    }
    for (int i = 0; i < 2; i++) {
        if (!valid[i])
            continue;
        const Length z = oz + N::length(tau[i] * dz);
        valid[i] = z <= s.half && z >= -s.half && t[i] > N::length_zero && t[i] <= limit;
    }
    if (valid[0] && valid[1]) {
        if (t[1] < t[0]) {
            const Length swap = t[0], swap_tau = tau[0];
            t[0] = t[1];
            t[1] = swap;
            tau[0] = tau[1];
            tau[1] = swap_tau;
        }
        return 2;
    }
    if (valid[1]) {
        t[0] = t[1];
        tau[0] = tau[1];
    }
    return valid[0] || valid[1];
}

// What is met in a longer number system (N::Longer): the same values with more bits. What is block-scaled has as many
// there.
template <class N>
concept MetInLonger = requires { typename N::Longer; };
template <MetInLonger N>
struct Lengthened {
    using L = typename N::Longer;
    static constexpr int lengths = L::Length::frac - N::Length::frac, units = L::Unit::frac - N::Unit::frac;

    static constexpr typename L::Length length(typename N::Length l) { return {l.raw * (1 << lengths)}; }
    static constexpr typename L::Unit unit(typename N::Unit u) { return {u.raw * (1 << units)}; }
    static constexpr Point<L> point(const Point<N>& p) { return {length(p.x), length(p.y), length(p.z)}; }
    static constexpr Direction<L> direction(const Direction<N>& d) { return {unit(d.x), unit(d.y), unit(d.z)}; }
    static constexpr Ray<L> ray(const Ray<N>& r)
    {
        return {point(r.origin), direction(r.direction), r.from, r.outward};
    }
    static constexpr Cone<L> cone(const Cone<N>& s)
    {
        return {point(s.middle), direction(s.e1), direction(s.e2), direction(s.axis), {s.rho0.raw}, {s.half.raw},
                {s.bound.raw}, unit(s.cosine), unit(s.sine), s.fine - lengths, s.tag, {}};
    }
    // And back: to the nearest.
    static constexpr typename N::Length shorter(typename L::Length l)
    {
        return {(l.raw + (1 << lengths >> 1)) >> lengths};
    }
    // The longest that is rounded to l.
    static constexpr typename L::Length longest(typename N::Length l)
    {
        return {length(l).raw + (1 << lengths >> 1) - 1};
    }
    static constexpr typename N::Unit shorter(typename L::Unit u) { return {(u.raw + (1 << units >> 1)) >> units}; }
};

template <MetInLonger N>
constexpr int meetings(const Cone<N>& s, const Ray<N>& ray, typename N::Length limit, typename N::Length (&t)[2],
                       Local<N>& local, typename N::Length (&tau)[2])
{
    using Long = Lengthened<N>;
    typename Long::L::Length both[2]{}, from_near[2]{};
    Local<typename Long::L> at{};
    const int found = meetings(Long::cone(s), Long::ray(ray), Long::longest(limit), both, at, from_near);
    if (found == 0)
        return 0;
    local.near = {{at.near.x.raw}, {at.near.y.raw}, {at.near.z.raw}};
    int n = 0;
    for (int i = 0; i < found; i++) {
        t[n] = Long::shorter(both[i]);
        if (!(t[n] > N::length_zero)) {
            if (leaves(ray, s.tag) != Leaves::inward)
                continue;
            t[n] = N::ulp;
        }
        tau[n++] = {from_near[i].raw};
    }
    return n;
}

// The nearest t in (0, limit], or false.
template <bool Near = false, class N>
QRAY_INLINE constexpr bool intersect(const Cone<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>& local)
{
    typename N::Length both[2]{}, tau[2]{};
    if (meetings(s, ray, limit, both, local, tau) == 0)
        return false;
    t = both[0];
    local.offset = tau[0];
    return true;
}

// How often the ray crosses the frustum strictly between its origin and a light at `distance`: 0, 1 or 2.
template <bool Near = false, class N>
QRAY_INLINE constexpr int crossings(const Cone<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length distance)
{
    const auto limit = distance - N::light_clearance;
    typename N::Length t[2]{}, tau[2]{};
    Local<N> local{};
    const int n = meetings(s, ray, limit, t, local, tau);
    return (n > 0 && t[0] < limit) + (n > 1 && t[1] < limit);
}

// The outward unit normal at a hit (at an apex, the axis away from the body), and the point, moved onto the
// surface along it: where a ray grazes, or is nearly parallel to a generator, its t alone would leave that
// some ulp off.
template <class N>
constexpr void surface_of(const Cone<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length,
                          const Local<N>& local, Point<N>& point, Direction<N>& n)
{
    const Point<N> w = local.near + along<N>(local.offset, ray.direction);
    const auto z = N::length(dot<N>(w, s.axis));
    const Point<N> across = w - along<N>(z, s.axis);
    const auto rho = s.rho0 + N::length(s.sine * z);
    // Along c^2 x_perp - s rho axis.
    const auto back = N::length(s.sine * rho);
    const auto c = s.cosine;
    const Point<N> outward{N::length(N::length(c * across.x) * c - back * s.axis.x),
                           N::length(N::length(c * across.y) * c - back * s.axis.y),
                           N::length(N::length(c * across.z) * c - back * s.axis.z)};
    n = s.sine > N::zero ? -s.axis : s.axis;
    normalise_short<N>(outward, n);
    const auto height = N::length(c * N::sqrt(norm2<N>(across))) - rho;
    point = s.middle + coarse<N>(from_rounded(w - along<N>(height, n), s.rounded), s.fine);
}

template <MetInLonger N>
constexpr void surface_of(const Cone<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length t,
                          const Local<N>& local, Point<N>& point, Direction<N>& n)
{
    using Long = Lengthened<N>;
    using L = typename Long::L;
    const Local<L> at{{{local.near.x.raw}, {local.near.y.raw}, {local.near.z.raw}}, {local.offset.raw}};
    Point<L> p{};
    Direction<L> u{};
    surface_of(Long::cone(s), Corners<L>{}, Long::ray(ray), Long::length(t), at, p, u);
    point = {Long::shorter(p.x), Long::shorter(p.y), Long::shorter(p.z)};
    n = {Long::shorter(u.x), Long::shorter(u.y), Long::shorter(u.z)};
}

template <class N>
constexpr bool move(const Cone<N>& from, const Corners<N>&, const Motion<N>& motion, Cone<N>& to,
                    const MovedCorners<N>&)
{
    using Length = typename N::Length;
    Cone<N> s = from;
    s.middle = motion(from.middle);
    s.e1 = motion.direction(from.e1);
    s.e2 = motion.direction(from.e2);
    s.axis = motion.direction(from.axis);
    if (motion.turned() || motion.scaled())
        s.rounded = {};
    if (motion.scaled()) {
        s.fine = block_scale<N>(motion.length(from.bound, -from.fine), &Blocks::cone);
        const int up = s.fine - from.fine;
        s.rho0 = motion.length(from.rho0, up);
        s.half = motion.length(from.half, up);
        s.bound = motion.length(from.bound, up) + N::ulp + N::ulp;
    }
    const Length bound = N::coarse(s.bound, s.fine);
    Length most{};
    if constexpr (N::is_fixed)
        most = {N::blocks.cone.size >> N::blocks.cone.least};
    else
        most = 40;
    if (!motion.valid() || !(bound <= most) || !(s.half > N::length_zero) || !(s.half <= s.bound)
        || !ball_in_world<N>(s.middle))
        return false;
    const Point<N> end = along<N>(N::coarse(s.half, s.fine), s.axis);
    if (!ball_in_world<N>(s.middle + end) || !ball_in_world<N>(s.middle - end))
        return false;
    // No point of it is farther from the middle than its ball, nor from the axis than that lets it be.
    if (!ball_in_world<N>(s.middle, bound)) {
        Length rim{};
        if constexpr (N::is_fixed) {
            const auto square = wide_square(s.bound.raw) - wide_square(s.half.raw);
            rim = N::coarse_below({static_cast<int32_t>(isqrt(square))}, s.fine);
        } else
            rim = N::sqrt(s.bound * s.bound - s.half * s.half);
        if (!disc_in_world<N>(s.middle + end, s.axis, rim) || !disc_in_world<N>(s.middle - end, s.axis, rim))
            return false;
    }
    to = s;
    return true;
}

template <class N>
constexpr BoundingBox<N> box_of(const Cone<N>& s, const Corners<N>&)
{
    // One that is all but a disc is met beside its rims, within sqrt(2) bounds: see src/scene/tree_builder.hpp.
    const auto bound = N::coarse_above(s.bound, s.fine);
    return BoundingBox<N>::ball(s.middle, bound + N::length(bound * N::fraction(1, 2)));
}

} // namespace qray
