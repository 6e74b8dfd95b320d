// A ray as seen along the axis in which its direction is largest, in integers of 32 bits: what a box or a triangle far
// from it is turned away by, for two products each. It is two lines, y = y0 + s x and z = z0 + s' x, x being
// the coordinate along that axis and slopes at most 1, in Q14. Lengths are in steps of 1/512, of which a world
// of +-62 has +-31744.
//
// How far a point p of the ray (|p - o| <= 63488 along x) is beside a line as computed: a slope is wrong by less than
// 2.4 2^-15, that is 0.87 from two components cut off to Q16 (the larger is at least 0.577), 0.5 from a reciprocal and
// 1 from rounding; in 63488 steps, 4.7. The origin's x is cut off, which is worth s more; the rest is exact to 2^-9.
#pragma once

#include "../number/math.hpp"
#include "shape.hpp"

namespace qray {

class ProjectedRay {
public:
    static constexpr int step_frac = 9, slope_frac = 14;

    struct Line {
        int32_t start, slope, steepness; // y where x is 0, Q14; Q14, and that without its sign

        // Does the line pass a box whose x and y are within half_x and half_y of these?
        QRAY_INLINE constexpr bool passes(int32_t box_x, int32_t half_x, int32_t box_y, int32_t half_y) const
        {
            // At most 127000 2^14, and `reach` half of that.
            const int32_t beside = (box_y << slope_frac) - start - slope * box_x;
            const uint32_t reach = (static_cast<uint32_t>(half_y) << slope_frac)
                + static_cast<uint32_t>(steepness * half_x);
            return static_cast<uint32_t>(beside) + reach <= 2 * reach;
        }
    };
    Line y, z;
    int32_t low, high; // x from the origin to the limit, and some steps more
    int32_t within;    // how far from both lines together a corner is at most that misses() is asked about
    int axis;          // 0, 1, 2; y and z are the other two in order

    template <class N>
    QRAY_INLINE constexpr explicit ProjectedRay(const Ray<N>& ray)
        : y{}, z{}, low(0), high(0), within(0), axis(0), x(0), along(0)
    {
        const auto& [o, d, from, outward] = ray;
        const int32_t dx = steps<16>(d.x), dy = steps<16>(d.y), dz = steps<16>(d.z);
        const int32_t ax = magnitude(dx), ay = magnitude(dy), az = magnitude(dz);
        if (ax >= ay && ax >= az) {
            set(steps<step_frac>(o.x), steps<fine>(o.y), steps<fine>(o.z), dx, dy, dz);
        } else if (ay >= az) {
            axis = 1;
            set(steps<step_frac>(o.y), steps<fine>(o.x), steps<fine>(o.z), dy, dx, dz);
        } else {
            axis = 2;
            set(steps<step_frac>(o.z), steps<fine>(o.x), steps<fine>(o.y), dz, dx, dy);
        }
    }

    // The same out of line, which takes less stack.
    template <class N>
    QRAY_NOINLINE static constexpr ProjectedRay of(const Ray<N>& ray)
    {
        return ProjectedRay(ray);
    }

    // From now on it ends at the distance `limit`.
    template <class N>
    QRAY_INLINE constexpr void end_at(typename N::Length limit)
    {
        constexpr int32_t endless = 0xffff;
        int32_t end = endless;
        if (N::is_fixed || limit < typename N::Length{127})
            end = steps<step_frac>(limit) + 1; // rounded up
        // What is cut off the direction is worth 2 steps, what is cut off the product and the origin 1 each.
        static_assert(step_frac == 9); // as hit_slack has it
        end = end >= endless ? endless : (end * magnitude(along) >> 15) + 4 + hit_slack<N>;
        low = x - (along < 0 ? end : hit_slack<N>);
        high = x + (along < 0 ? 1 + hit_slack<N> : end);
    }

    // Does a triangle ask the ray itself? Where upper halves of products are to be had, that is as short, and exact but
    // for what they cut off; `within` is then not needed.
    template <class N>
    static constexpr bool is_exact = WideFixed<N> && has_wide_multiply;

    // Is the ray's line surely beside a triangle?
    template <class N>
        requires(is_exact<N>)
    QRAY_NOINLINE constexpr bool misses(const Ray<N>& ray, const Point<N>& a, const Point<N>& b,
                                        const Point<N>& c) const
    {
        if (axis == 0)
            return misses<N, 0>(ray, a, b, c);
        return axis == 1 ? misses<N, 1>(ray, a, b, c) : misses<N, 2>(ray, a, b, c);
    }
    template <class N>
    QRAY_NOINLINE constexpr bool misses(const Ray<N>&, const Point<N>& a, const Point<N>& b, const Point<N>& c) const
    {
        if (within >> 15 != 0)
            return false;
        int32_t ua{}, va{}, ub{}, vb{}, uc{}, vc{};
        see<N>(a, ua, va);
        see<N>(b, ub, vb);
        see<N>(c, uc, vc);
        // Twice the areas that the line makes with each edge. A number is wrong by less than 8 (4.7, 2 for x and 1 for
        // what is cut off here), so that these are by less than 8 times four numbers, two of a corner, and 128.
        const int32_t ab = ua * vb - va * ub, bc = ub * vc - vb * uc, ca = uc * va - vc * ua;
        const int32_t tolerance = 16 * within + 128;
        return (ab > tolerance || bc > tolerance || ca > tolerance)
            && (ab < -tolerance || bc < -tolerance || ca < -tolerance);
    }

private:
    static constexpr int fine = step_frac + slope_frac;
    int32_t x, along; // of the origin; of the direction, Q15

    QRAY_INLINE static constexpr int32_t magnitude(int32_t v) { return v < 0 ? -v : v; }

    // In 2^-Frac, cut off; |v| is less than 2^31 of these.
    template <int Frac, class T>
    QRAY_INLINE static constexpr int32_t steps(T v)
    {
        if constexpr (!requires { v.raw; })
            return static_cast<int32_t>(v * T(int32_t{1} << Frac));
        else if constexpr (T::frac >= Frac)
            return v.raw >> (T::frac - Frac);
        else
            return v.raw * (int32_t{1} << (Frac - T::frac));
    }

    QRAY_INLINE constexpr void set(int32_t ox, int32_t oy, int32_t oz, int32_t dx, int32_t dy, int32_t dz)
    {
        const uint32_t a = static_cast<uint32_t>(magnitude(dx));
        uint32_t inverse = 0; // 2^31 / a
        if constexpr (!has_wide_multiply) // nor a division
            inverse = (detail::reciprocal_mantissa(a >= 0x10000 ? 0xffff0000 : a << 16) + 0x8000) >> 16;
        const auto line = [&](int32_t at, int32_t d) -> Line {
            const uint32_t b = static_cast<uint32_t>(magnitude(d)); // at most a
            const int32_t steepness = static_cast<int32_t>(
                has_wide_multiply ? ((b << slope_frac) + a / 2) / a : (b * inverse + 0x10000) >> 17);
            const int32_t slope = (d ^ dx) < 0 ? -steepness : steepness;
            return {at - slope * ox, slope, steepness};
        };
        x = ox;
        along = dx / 2;
        y = line(oy, dy);
        z = line(oz, dz);
    }

    // A corner is (u, v) beside the ray, in Q22: the difference of two upper halves, each cut off, is wrong by less
    // than 1. It is less than 124 sqrt(3), and so than 2^29.8. Twice the area that the line makes with an edge is in
    // Q12: the four numbers being off are worth less than 4 2^29.8 / 2^32 < 0.9, what is cut off two products less
    // than 1. So the signs of what is not -1, 0 or 1 are those of exact arithmetic, as is what encloses() says.
    template <class N, int Axis>
    QRAY_INLINE static constexpr bool misses(const Ray<N>& ray, const Point<N>& a, const Point<N>& b, const Point<N>& c)
    {
        constexpr auto ahead_of = [](const auto& p) { return (Axis == 0 ? p.x : Axis == 1 ? p.y : p.z).raw; };
        constexpr auto first = [](const auto& p) { return (Axis == 0 ? p.y : p.x).raw; };
        constexpr auto second = [](const auto& p) { return (Axis == 2 ? p.y : p.z).raw; };
        const auto& [o, d, from, outward] = ray;
        const int32_t dx = ahead_of(d), dy = first(d), dz = second(d);
        const int32_t ax = ahead_of(a) - ahead_of(o), bx = ahead_of(b) - ahead_of(o), cx = ahead_of(c) - ahead_of(o);
        const auto seen = [dx](int32_t across, int32_t ahead, int32_t slope) {
            return signed_mul_high(across, dx) - signed_mul_high(ahead, slope);
        };
        const auto on_one_side = [](int32_t p, int32_t q, int32_t r) {
            return p > 0 ? q > 0 && r > 0 : p < 0 && q < 0 && r < 0;
        };
        const int32_t ua = seen(first(a) - first(o), ax, dy), ub = seen(first(b) - first(o), bx, dy),
                      uc = seen(first(c) - first(o), cx, dy);
        if (on_one_side(ua, ub, uc))
            return true;
        const int32_t va = seen(second(a) - second(o), ax, dz), vb = seen(second(b) - second(o), bx, dz),
                      vc = seen(second(c) - second(o), cx, dz);
        if (on_one_side(va, vb, vc))
            return true;
        const int32_t ab = signed_mul_high(ua, vb) - signed_mul_high(va, ub);
        const int32_t bc = signed_mul_high(ub, vc) - signed_mul_high(vb, uc);
        const int32_t ca = signed_mul_high(uc, va) - signed_mul_high(vc, ua);
        return (ab > 1 || bc > 1 || ca > 1) && (ab < -1 || bc < -1 || ca < -1);
    }

    // How far beside the lines a point is.
    template <class N>
    QRAY_INLINE constexpr void see(const Point<N>& p, int32_t& u, int32_t& v) const
    {
        const int32_t at = steps<step_frac>(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
        u = (steps<fine>(axis == 0 ? p.y : p.x) - y.start - y.slope * at) >> slope_frac;
        v = (steps<fine>(axis == 2 ? p.y : p.z) - z.start - z.slope * at) >> slope_frac;
    }
};

} // namespace qray
