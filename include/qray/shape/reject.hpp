// A conservative reject: in fixed point from 16-bit roundings of what a ray and a shape are, with products that fit a
// register, or from upper halves of products where a processor gives them in one step; in floating point by the shorter
// form, which cancels. It turns away most of the shapes that a ray misses, for a part of an exact test, and never one
// that it meets: the bounds below are what the roundings can amount to.
#pragma once

#include "shape.hpp"

namespace qray {

template <class N>
    requires(!N::is_fixed)
struct RejectRay<N> {
    const Ray<N>& ray;
    typename N::Length across; // the y component of origin x direction

    QRAY_INLINE constexpr explicit RejectRay(const Ray<N>& r)
        : ray(r), across(r.direction.x * r.origin.z - r.direction.z * r.origin.x)
    {
    }

    // |v|^2 - (v.d)^2 and the exact test's |p|^2 differ by less than 24 half epsilon of |v|^2. A ray inside the ball
    // that it left starts less than 192 epsilon outside: step_off() and the rounding of a point in a world of 62.
    QRAY_INLINE constexpr bool misses_ball(const Point<N>& centre, typename N::Length radius) const
    {
        using F = typename N::Length;
        // First in two dimensions, seen along y, where the direction is 1 or shorter. In a world of 62 that
        // is off by less than 512 epsilon, the exact test's perpendicular by less than 1024, and the start of
        // a ray inside by 192.
        const F aside = ray.direction.x * centre.z - ray.direction.z * centre.x - across;
        if (N::absolute(aside) > radius + F(2048) * N::epsilon)
            return true;
        const Point<N> v = centre - ray.origin;
        const F b = dot<N>(v, ray.direction), r = radius + F(256) * N::epsilon;
        return norm2<N>(v) * (F(1) - F(32) * N::epsilon) - b * b > r * r;
    }
    constexpr bool misses_plane(const Point<N>&, const Direction<N>&) const { return false; }
};

template <class N>
    requires(WideFixed<N> && !has_wide_multiply)
struct RejectRay<N> {
    // The origin in whole lengths / 2^8, less 1/2 so that a difference shifted down is rounded; the direction in Q14.
    int32_t ox, oy, oz, dx, dy, dz;

    static constexpr int down = N::Length::frac - 8;
    static constexpr int down_unit = N::Unit::frac - 14;

    QRAY_INLINE constexpr explicit RejectRay(const Ray<N>& ray)
        : ox(ray.origin.x.raw - half), oy(ray.origin.y.raw - half), oz(ray.origin.z.raw - half),
          dx(narrow(ray.direction.x)), dy(narrow(ray.direction.y)), dz(narrow(ray.direction.z))
    {
    }

    // With V the vector to the centre in 2^-8 (|V| <= 2^15, wrong by less than 1/2 a component) and D the direction in
    // 2^-14 (likewise): V.D and each V x D are off by less than sqrt(3)/2 (2^14 + 2^15) + 1 < 42600.
    QRAY_INLINE constexpr bool misses_ball(const Point<N>& centre, typename N::Length radius) const
    {
        const int32_t x = (centre.x.raw - ox) >> down;
        const int32_t y = (centre.y.raw - oy) >> down;
        const int32_t z = (centre.z.raw - oz) >> down;
        if (x * dx + y * dy + z * dz + (radius.raw >> 2) + slack < 0) // all behind
            return true;
        // The perpendicular distance in 2^-8: off by 42600 / 2^14 + sqrt(3) < 4.4.
        const int32_t px = (y * dz - z * dy) >> 14;
        const int32_t py = (z * dx - x * dz) >> 14;
        const int32_t pz = (x * dy - y * dx) >> 14;
        const int32_t r = (radius.raw >> down) + 6;
        return px * px + py * py + pz * pz > r * r;
    }

    // Is a plane behind the ray, or parallel to it within what is known?
    QRAY_INLINE constexpr bool misses_plane(const Point<N>& c, const Direction<N>& n) const
    {
        const int32_t nx = narrow(n.x), ny = narrow(n.y), nz = narrow(n.z);
        const int32_t den = nx * dx + ny * dy + nz * dz; // 2^-28, off by less than 28400
        const int32_t num = ((c.x.raw - ox) >> down) * nx + ((c.y.raw - oy) >> down) * ny
            + ((c.z.raw - oz) >> down) * nz;
        return (num > slack && den < -28400) || (num < -slack && den > 28400);
    }

private:
    static constexpr int32_t half = int32_t{1} << (down - 1);
    static constexpr int32_t slack = 42700;
    QRAY_INLINE static constexpr int32_t narrow(typename N::Unit v)
    {
        return (v.raw + (int32_t{1} << (down_unit - 1))) >> down_unit;
    }
};

// The same with the upper halves of 32-bit products, each wrong by less than 1 and always downward.
template <class N>
    requires(WideFixed<N> && has_wide_multiply)
struct RejectRay<N> {
    const Ray<N>& ray;

    QRAY_INLINE constexpr explicit RejectRay(const Ray<N>& r) : ray(r) {}

    QRAY_INLINE constexpr bool misses_ball(const Point<N>& centre, typename N::Length radius) const
    {
        const Point<N> v = centre - ray.origin;
        const int32_t b = component(v, ray.direction); // 2^-22, up to 3 too low
        // |v|^2 - b^2 in 2^-16: |v|^2 up to 3 too low; b^2, of up to 12 2^-24 (and 128) each, off by up to 13.
        const int32_t b24 = b * 4;
        const int32_t square = high_dot(v.x.raw, v.y.raw, v.z.raw, v.x.raw, v.y.raw, v.z.raw);
        if (square - signed_mul_high(b24, b24) > signed_mul_high(radius.raw, radius.raw) + 20)
            return true;
        return b + (radius.raw >> 2) + 8 < 0; // all behind
    }

    QRAY_INLINE constexpr bool misses_plane(const Point<N>& c, const Direction<N>& n) const
    {
        const int32_t den = component(ray.direction, n);
        const int32_t num = component(c - ray.origin, n);
        return (num > 0 && den < -3) || (num < -3 && den > 0);
    }

private:
    template <class T>
    QRAY_INLINE static constexpr int32_t component(const Vec<T>& a, const Direction<N>& d)
    {
        return high_dot(a.x.raw, a.y.raw, a.z.raw, d.x.raw, d.y.raw, d.z.raw);
    }
};

// Where the exact test is as narrow: the perpendicular of sphere.hpp to one ulp, component by component.
template <class N>
    requires ShortFixed<N>
struct RejectRay<N> {
    const Ray<N>& ray;

    QRAY_INLINE constexpr explicit RejectRay(const Ray<N>& r) : ray(r) {}

    // `radius` is 3 more than the ball's: that much, b and the components are off, each downward by less than 1.
    QRAY_INLINE constexpr bool misses_ball(const Point<N>& centre, typename N::Length radius) const
    {
        constexpr int down = N::Unit::frac;
        const Point<N> v = centre - ray.origin;
        const int32_t r = radius.raw;
        const int32_t b = dot<N>(v, ray.direction).raw >> down;
        if (b + r < 0) // all behind
            return true;
        using detail::is_outside, detail::square;
        const int32_t x = (b * ray.direction.x.raw >> down) - v.x.raw;
        if (is_outside(x, r))
            return true;
        const int32_t y = (b * ray.direction.y.raw >> down) - v.y.raw;
        if (is_outside(y, r))
            return true;
        const int32_t z = (b * ray.direction.z.raw >> down) - v.z.raw;
        if (is_outside(z, r))
            return true;
        return r <= 37800 && square(x) + square(y) + square(z) > square(r); // three of these fit
    }
    constexpr bool misses_plane(const Point<N>&, const Direction<N>&) const { return false; }
};

// In q24, q16's of what is cut off to it. A difference of points (up to 128000) is wrong by less than 1 a component, a
// direction by 1/2: so b by less than sqrt(3) (128000 2^-15 + 1) + 1 < 9.5, and the perpendicular by that and by
// sqrt(3) (128000 2^-15 + 2): less than 20 in all, and the radius by 1.
template <class N>
    requires(NarrowFixed<N> && !ShortFixed<N>)
struct RejectRay<N> {
    static constexpr int down = N::Length::frac - q16::Length::frac, down_unit = N::Unit::frac - q16::Unit::frac;
    static constexpr int slack = 21;
    Ray<q16> ray;

    QRAY_INLINE constexpr explicit RejectRay(const Ray<N>& r)
        : ray{cut(r.origin), {rounded(r.direction.x), rounded(r.direction.y), rounded(r.direction.z)}, r.from,
              r.outward}
    {
    }

    QRAY_INLINE constexpr bool misses_ball(const Point<N>& centre, typename N::Length radius) const
    {
        return RejectRay<q16>(ray).misses_ball(cut(centre), {(radius.raw >> down) + slack});
    }
    constexpr bool misses_plane(const Point<N>&, const Direction<N>&) const { return false; }

private:
    QRAY_INLINE static constexpr Point<q16> cut(const Point<N>& p)
    {
        return {{p.x.raw >> down}, {p.y.raw >> down}, {p.z.raw >> down}};
    }
    QRAY_INLINE static constexpr q16::Unit rounded(typename N::Unit v)
    {
        return {(v.raw + (1 << (down_unit - 1))) >> down_unit};
    }
};

} // namespace qray
