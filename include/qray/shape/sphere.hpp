// Sphere. With v = c - o, b = v.d and p = v - b d (the perpendicular from the ray to the centre), the ray
// meets it where |p|^2 <= r^2, at t = b -+ sqrt(r^2 - |p|^2) (Haines, Guenther, Akenine-Moeller, Ray Tracing
// Gems ch. 7): no cancellation, and an error of |d| counts only in its square.
//
// In fixed point, what is no longer than the radius is block-scaled: p, the half chord and the radius itself have
// `fine` more bits than Length, so that a small ball far away is as round as a large one.
#pragma once

#include "reject.hpp"

namespace qray {

template <class N>
struct Sphere {
    static constexpr bool has_corners = false, keeps_local = true, is_smooth = false, is_short = true;

    Point<N> centre;
    typename N::Length radius;        // > 0, times 2^fine
    typename N::Scale inverse_radius; // of that
    int32_t fine;                     // >= 0; 0 in floating point
    Tag tag;
    [[no_unique_address]] Rounded<N> rounded; // of the centre
};

template <class N>
QRAY_INLINE constexpr bool surely_missed(const Sphere<N>& s, const RejectRay<N>& ray)
{
    return ray.misses_ball(s.centre, N::coarse_above(s.radius, s.fine));
}

// Half the chord that the ray cuts from the sphere, the t of its middle, and that middle, from the centre; false
// where they do not meet. `from_centre`, `half` and `foot`, which is what rounding took off `middle`, are times 2^fine.
// Near: the ray is known not to be surely_missed().
template <bool Near, class N>
QRAY_INLINE constexpr bool chord(const Sphere<N>& s, const Ray<N>& ray, Leaves leaving, typename N::Length& middle,
                                 typename N::Length& half, Point<N>& from_centre,
                                 [[maybe_unused]] typename N::Length& foot)
{
    const Point<N> v = s.centre - ray.origin;
    const auto moment = dot<N>(v, ray.direction);
    middle = N::length(moment);
    if constexpr (NarrowFixed<N>) {
        if (!Near && surely_missed(s, RejectRay<N>(ray)))
            return false;
    } else if constexpr (!Near) {
        if (leaving != Leaves::inward) {
            const auto reach = N::coarse_above(s.radius, s.fine);
            if (middle < -reach)
                return false;
            const Point<N> p = along<N>(middle, ray.direction) - v;
            if (norm2<N>(p) > reach * reach)
                return false;
        }
    }
    from_centre = from_exact(fine_offset<N>(middle, ray.direction, v, s.fine), s.rounded);
    const auto p2 = norm2<N>(from_centre);
    const auto r2 = s.radius * s.radius;
    if (p2 > r2) {
        half = N::length_zero;
        return leaving == Leaves::inward; // however short, that chord has another end
    }
    half = N::root(r2 - p2);
    if constexpr (WideFixed<N>)
        foot = N::fine_rest(moment, middle, s.fine);
    return true;
}

// The nearest t in (0, limit], or false. t is within 2 ulp of the hit of the ray as given, more where it grazes.
template <bool Near = false, class N>
QRAY_INLINE constexpr bool intersect(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length limit,
                                     typename N::Length& t, Local<N>& local)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward) // convex: never met again
        return false;
    typename N::Length middle{}, half{}, foot{};
    if (!chord<Near>(s, ray, leaving, middle, half, local.near, foot))
        return false;
    const auto coarse = N::coarse(half, s.fine);
    t = middle - coarse;
    local.offset = -half;
    if (leaving == Leaves::inward || !(t > N::length_zero)) {
        t = middle + coarse;
        local.offset = half;
        if (!(t > N::length_zero)) {
            if (leaving != Leaves::inward)
                return false;
            t = N::ulp;
        }
    }
    if constexpr (WideFixed<N>)
        local.offset = foot + local.offset;
    return t <= limit;
}

// How often the ray crosses the sphere strictly between its origin and a light at `distance`: 0, 1 or 2.
template <bool Near = false, class N>
QRAY_INLINE constexpr int crossings(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray,
                                    typename N::Length distance)
{
    const Leaves leaving = leaves(ray, s.tag);
    if (leaving == Leaves::outward)
        return 0;
    typename N::Length middle{}, half{}, foot{};
    Point<N> from_centre{};
    if (!chord<Near>(s, ray, leaving, middle, half, from_centre, foot))
        return 0;
    const auto limit = distance - N::light_clearance;
    const auto coarse = N::coarse(half, s.fine);
    const auto near = middle - coarse;
    if (near >= limit)
        return 0;
    const auto far = middle + coarse;
    if (leaving == Leaves::inward)
        return far < limit;
    return (near > N::length_zero) + (far > N::length_zero && far < limit);
}

// The outward unit normal at a hit, and the point: centre + r n, which lies on the sphere to 1 ulp however
// far the ray has come and whatever its direction's length.
template <class N>
QRAY_INLINE constexpr void surface_of(const Sphere<N>& s, const Corners<N>&, const Ray<N>& ray, typename N::Length,
                                      const Local<N>& local, Point<N>& point, Direction<N>& n)
{
    auto from_near = local.offset;
    if constexpr (NarrowFixed<N>) // the middle was rounded to a coarse ulp, and `near` is off by that along the ray
        from_near = from_near - N::length(dot<N>(local.near, ray.direction));
    const Point<N> w = local.near + along<N>(from_near, ray.direction);
    // An error of |d| shows in |w|, and between mirrors would grow from one to the next: so made unit again.
    n = ratio<N>(w, s.inverse_radius);
    sharpen<N>(n);
    point = s.centre + coarse<N>(from_rounded(along<N>(s.radius, n), s.rounded), s.fine);
}

// 1/r for r > 0.
template <class N>
constexpr typename N::Scale inverse_of(typename N::Length r)
{
    if constexpr (WideFixed<N>) {
        const uint32_t u = static_cast<uint32_t>(r.raw);
        const int shift = count_leading_zeros(u) - 1; // u << shift in [2^30, 2^31)
        return {divide(1 << 29, u << shift, 32), shift};
    } else if constexpr (N::is_fixed) {
        const uint32_t u = static_cast<uint32_t>(r.raw);
        const int most = 32 - N::ratio_bits, zeros = count_leading_zeros(u);
        const int shift = zeros > most ? zeros - most : 0; // u << shift has ratio_bits, or u itself some more
        return {divide(1, u << shift, 14 + N::ratio_bits), shift};
    } else {
        return 1 / r;
    }
}

// With this radius, or false where that is too small for a ray to leave, or too large.
template <class N, class Radius>
constexpr bool set_radius(Sphere<N>& s, Radius radius_times) // radius_times(fine): times 2^fine
{
    using Length = typename N::Length;
    const Length size = radius_times(0);
    if constexpr (N::is_fixed) {
        if (size < N::leave(N::one) || size.raw > 36700 << (Length::frac - 10)) // of a ball in the world: 62 / sqrt(3)
            return false;
        s.fine = block_scale<N>(size, &Blocks::ball);
        s.radius = radius_times(s.fine);
    } else {
        if (!(size >= Length(1) / Length(int64_t{1} << 40)))
            return false;
        s.radius = size;
    }
    s.inverse_radius = inverse_of<N>(s.radius);
    return true;
}

template <class N>
constexpr bool move(const Sphere<N>& from, const Corners<N>&, const Motion<N>& motion, Sphere<N>& to,
                    const MovedCorners<N>&)
{
    Sphere<N> s = from;
    s.centre = motion(from.centre);
    if (motion.turned() || motion.scaled())
        s.rounded = {};
    if (!motion.valid()
        || (motion.scaled()
            && !set_radius(s, [&](int fine) { return motion.length(from.radius, fine - from.fine); }))
        || !ball_in_world<N>(s.centre, N::coarse(s.radius, s.fine)))
        return false;
    to = s;
    return true;
}

// The sphere that the text has as `s` with these numbers. False, and nothing changes, as with move().
template <class N>
constexpr bool place(Sphere<N>& sphere, const Frame<N>& frame, const ScenePoint<N>& centre, Coordinate<N> radius)
{
    Sphere<N> s = sphere;
    s.centre = frame.point(centre);
    s.rounded = {};
    if (!set_radius(s, [&](int fine) { return frame.length(radius, fine); })
        || !ball_in_world<N>(s.centre, N::coarse(s.radius, s.fine)))
        return false;
    sphere = s;
    return true;
}

template <class N>
constexpr BoundingBox<N> box_of(const Sphere<N>& s, const Corners<N>&)
{
    return BoundingBox<N>::ball(s.centre, N::coarse_above(s.radius, s.fine));
}

} // namespace qray
