// Spheres.
#pragma once

#include "case.hpp"

namespace catalogue {

// One hit, at 5; the next coordinate out is a miss.
QRAY_CASE(SphereTouchedByATangentOfIntegers)
{
    QRAY_NAMES;
    for (int64_t over : List{1, 4, 128})
        for (int64_t r : List{1, 3})
            for (int i = 0; i < 3; i++)
                for (int k = 1; k <= 2; k++)
                    for (int64_t sign : List{-1, 1}) {
                        // In 128ths: the centre is (2, -1, 1/2), the ray starts at 5 before it.
                        const Triple c{256, -128, 64}, side = axes[(i + k) % 3] * (r * sign * 128 / over);
                        const Direction<N> d = M::direction(axes[i] * sign);
                        const Sphere<N> s = M::sphere(M::point(c, 128), r, over);
                        Point<N> o = M::point(c + side - axes[i] * (sign * 640), 128);
                        QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t == number<Length>(5));
                        const Triple out = axes[(i + k) % 3] * sign;
                        o = o + M::point(out, int64_t{1} << steps_at_5<N>);
                        QRAY_HOLDS(!meets(check, s, M::ray(o, d), t));
                    }
}

QRAY_CASE(SphereAimedAMillionthOfItsRadiusBesideItsEdge)
{
    QRAY_NAMES;
    // 16 2^-24 = 0.95e-6; in q16 and q24 a step.
    const Length off = power_of_two<Length>(NarrowFixed<N> ? -grain<N> : -20), one = number<Length>(1);
    for (int64_t sign : List{-1, 1})
        for (int64_t far : List{2, 10, 55}) {
            const Sphere<N> s = M::sphere(M::point({0, 0, 0}), 1);
            const Direction<N> d = M::direction({sign, 0, 0});
            for (const Length edge : List{one - off, -one + off}) {
                const Point<N> o{number<Length>(-far * sign), edge, Length{}};
                QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t <= number<Length>(far)
                           && t > number<Length>(far - 1));
                QRAY_HOLDS(meets(check, s, M::ray({o.x, o.z, o.y}, d), t));
            }
            for (const Length edge : List{one + off, -one - off}) {
                const Point<N> o{number<Length>(-far * sign), edge, Length{}};
                QRAY_HOLDS(!meets(check, s, M::ray(o, d), t));
                QRAY_HOLDS(!meets(check, s, M::ray({o.x, o.z, o.y}, d), t));
            }
        }
}

// A radius of 0.005 is 83886.08 steps of 2^-24 and 327.68 of 2^-16, seen from 55 away; one of 0.05 is 51.2 of 2^-10.
QRAY_CASE(SphereOfAnEleventhousandthOfItsDistance)
{
    QRAY_NAMES;
    const Sphere<N> s = M::sphere(M::point({30, 7, -9}), ShortFixed<N> ? 50 : 5, 1000);
    const int64_t edge = ShortFixed<N> ? 51 : NarrowFixed<N> ? 327 : 83886, over = int64_t{1} << grain<N>;
    // A float of 7 ends at 2^-21: from a centre of 0 only.
    const Sphere<N> at_zero = M::sphere(M::point({30, 0, 0}), ShortFixed<N> ? 50 : 5, 1000);
    for (int64_t sign : List{-1, 1})
        for (int64_t out : List{0, 1}) {
            const Length y = number<Length>(sign * (edge + out), over);
            const Direction<N> d = M::direction({1, 0, 0});
            QRAY_HOLDS(meets(check, at_zero, M::ray({number<Length>(-25), y, Length{}}, d), t) == (out == 0));
            if (N::is_fixed || sizeof(Length) == 8) {
                const Ray<N> ray = M::ray({number<Length>(-25), number<Length>(7), number<Length>(-9) + y}, d);
                QRAY_HOLDS(meets(check, s, ray, t) == (out == 0));
            }
        }
}

// 128 bits without a sign: a board's compiler has none.
struct Wide128 {
    uint64_t high, low;

    static constexpr Wide128 product(uint64_t a, uint64_t b)
    {
        constexpr uint64_t mask = 0xffffffff;
        const uint64_t ah = a >> 32, al = a & mask, bh = b >> 32, bl = b & mask;
        const uint64_t bottom = al * bl, one = ah * bl + (bottom >> 32), other = al * bh + (one & mask);
        return {ah * bh + (one >> 32) + (other >> 32), (other << 32) | (bottom & mask)};
    }
    friend constexpr Wide128 operator-(Wide128 a, Wide128 b)
    {
        return {a.high - b.high - (a.low < b.low), a.low - b.low};
    }
    friend constexpr bool operator<(Wide128 a, Wide128 b)
    {
        return a.high < b.high || (a.high == b.high && a.low < b.low);
    }
    constexpr Wide128 shifted(int by) const
    {
        return by == 0 ? *this : Wide128{(high << by) | (low >> (64 - by)), low << by};
    }
};

// Does the line of a ray pass within r of a centre: is r^2 |d|^2 more than |v|^2 |d|^2 - (v.d)^2, in 128 bits
// on the numbers as stored? Not `certain` within so much of r: half a 2^-25 in q32, half a step in q24, four in q16.
template <class N>
    requires N::is_fixed
bool passes_within(const Sphere<N>& s, const Ray<N>& ray, bool& certain)
{
    const auto square = [](int64_t x, int64_t y, int64_t z) {
        return static_cast<uint64_t>(x * x + y * y + z * z);
    };
    const Point<N> c = s.centre, o = ray.origin;
    const Direction<N> d = ray.direction;
    const int64_t x = c.x.raw - o.x.raw, y = c.y.raw - o.y.raw, z = c.z.raw - o.z.raw;
    const int64_t b = x * d.x.raw + y * d.y.raw + z * d.z.raw;
    const uint64_t d2 = square(d.x.raw, d.y.raw, d.z.raw), along = static_cast<uint64_t>(b < 0 ? -b : b);
    const Wide128 coarse = Wide128::product(square(x, y, z), d2) - Wide128::product(along, along);
    const Wide128 across = coarse.shifted(2 * s.fine);
    const uint64_t r = static_cast<uint64_t>(s.radius.raw);
    const Wide128 reach = Wide128::product(r * r, d2);
    const bool inside = across < reach;
    const Wide128 off = inside ? reach - across : across - reach;
    const uint64_t r_fine = r << s.fine;
    certain = Wide128::product(ShortFixed<N> ? r_fine * 8 : NarrowFixed<N> ? r_fine : r_fine / 2, d2) < off;
    return inside;
}

template <class N>
bool shorter_than_1(const Point<N>& v)
{
    if constexpr (N::is_fixed) // a square of q24 does not hold all
        return wide_norm2(v.x.raw, v.y.raw, v.z.raw) < uint64_t{1} << (2 * N::Length::frac);
    else
        return norm2<N>(v) < 1;
}

// Rays of any direction that pass the edge of a sphere of r at 55 within some steps.
template <class N>
void aim_at_the_edge(Check& check, int64_t num, int64_t den, int64_t steps)
{
    QRAY_NAMES;
    Random random{71};
    int hits = 0, misses = 0;
    for (int i = 0; i < 400; i++) {
        Direction<N> d{}, n{};
        const auto any = [&random] {
            return M::point({random.in(-99, 99), random.in(-99, 99), random.in(1, 99)}, 4);
        };
        normalise<N>(any(), d);
        // Across d: other - (other.d) d, but for roundings, which do not matter.
        const Point<N> other = any();
        const Point<N> aside = other - along<N>(N::length(dot<N>(other, d)), d);
        if (shorter_than_1<N>(aside) || !normalise<N>(aside, n))
            continue;
        const Triple centre{random.in(-9, 9), random.in(-9, 9), random.in(-9, 9)};
        const Sphere<N> s = M::sphere(M::point(centre), num, den);
        Length away = number<Length>(num, den);
        const int64_t beside = random.in(-steps, steps);
        away = away + number<Length>(beside, int64_t{1} << (N::is_fixed ? grain<N> : 14));
        const Point<N> foot = s.centre + along<N>(away, n);
        const Ray<N> ray = M::ray(foot - along<N>(number<Length>(N::is_fixed ? 55 : 5), d), d);
        bool certain = beside > 8 || beside < -8, expected = beside < 0;
        if constexpr (N::is_fixed)
            expected = passes_within<N>(s, ray, certain);
        if (!certain)
            continue;
        QRAY_HOLDS(meets(check, s, ray, t) == expected);
        expected ? hits++ : misses++;
    }
    QRAY_HOLDS(hits > 50 && misses > 50);
}

QRAY_CASE(SphereSeenFromAnywhereBesideItsEdge) { aim_at_the_edge<N>(check, 1, 1, 24); }

// In q16 a tenth of a pixel: as small as half a hundred steps.
QRAY_CASE(SmallSphereSeenFromAnywhereBesideItsEdge)
{
    aim_at_the_edge<N>(check, ShortFixed<N> ? 50 : 5, 1000, ShortFixed<N> ? 40 : N::is_fixed ? 6 : 24);
}

QRAY_CASE(SphereSeenFromItsCentreIsItsRadiusAway)
{
    QRAY_NAMES;
    for (int64_t over : List{1, 2, 64})
        for (const Exact& e : directions) {
            const Sphere<N> s = M::sphere(M::point({-7, 11, 3}), 3, over);
            QRAY_HOLDS(meets(check, s, M::ray(M::point({-7, 11, 3}), M::direction(e.d, e.over)), t));
            QRAY_HOLDS(near<N>(t, number<Length>(3, over), e.over == 1 ? Length{} : ulp + ulp));
        }
}

QRAY_CASE(SphereBehindIsNotMet)
{
    QRAY_NAMES;
    const Sphere<N> s = M::sphere(M::point({1, 2, 3}), 1);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1})
            for (int64_t away : List{513, 1024, 20480}) { // in 512ths
                const Point<N> o = M::point(Triple{512, 1024, 1536} + axes[i] * (sign * away), 512);
                QRAY_HOLDS(!meets(check, s, M::ray(o, M::direction(axes[i] * sign)), t));
                QRAY_HOLDS(meets(check, s, M::ray(o, M::direction(axes[i] * -sign)), t)
                           && t == number<Length>(away - 512, 512));
            }
}

QRAY_CASE(ConcentricSpheresAMillionthApartAreMetInOrder)
{
    QRAY_NAMES;
    const int64_t thin = 1 << (grain<N> - 4);
    const Point<N> centre = M::point({3, 4, 5});
    const Sphere<N> inner = M::sphere(centre, 1), outer = M::sphere(centre, thin + 1, thin);
    const int64_t far = N::is_fixed && !ShortFixed<N> ? 50 : 2;
    for (const Exact& e : directions)
        for (int beside = 0; beside < 4; beside++) {
            const Triple aside = axes[beside % 3] * (e.over * (beside > 0));
            const Triple from = Triple{3, 4, 5} * (4 * e.over) - e.d * (4 * far) + aside;
            const Ray<N> ray = M::ray(M::point(from, 4 * e.over), M::direction(e.d, e.over));
            Length t_outer{};
            QRAY_HOLDS(meets(check, inner, ray, t) && meets(check, outer, ray, t_outer) && t_outer < t);
            const Ray<N> back = M::ray(M::point({3, 4, 5}), ray.direction);
            QRAY_HOLDS(meets(check, inner, back, t) && meets(check, outer, back, t_outer) && t < t_outer);
        }
}

// A ray that enters the outer one meets the inner, then what is left is the outer's far side.
QRAY_CASE(ShellOfAMillionthIsCrossedFaceByFace)
{
    QRAY_NAMES;
    const int64_t thin = 1 << (grain<N> - 4);
    const Tag tag = make_tag(1, 0);
    const Sphere<N> inner = M::sphere(M::point({0, 0, 0}), 1);
    const Sphere<N> outer = M::sphere(M::point({0, 0, 0}), thin + 1, thin, tag);
    const Length little = number<Length>(4, int64_t{1} << fine_steps<N>);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Point<N> o = M::point(axes[i] * (sign * (thin + 1)), thin);
            const Ray<N> ray = M::ray(o, M::direction(axes[i] * -sign), tag);
            QRAY_HOLDS(meets(check, inner, ray, t) && near<N>(t, number<Length>(1, thin), little));
            QRAY_HOLDS(meets(check, outer, ray, t) && near<N>(t, number<Length>(2 * thin + 2, thin), little));
        }
}

// At a cosine of 2^-17 (q16: 2^-14): known as the surface that the ray left, and not.
QRAY_CASE(SphereLeftAlmostAlongItsTangentIsNotMetAgain)
{
    QRAY_NAMES;
    const Tag tag = make_tag(3, 0);
    const int64_t flat = ShortFixed<N> ? 1 << 14 : 1 << 17;
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Sphere<N> s = M::sphere(M::point({9, -5, 2}), 2, 1, tag);
            const Direction<N> g = M::direction(axes[i] * sign);
            Ray<N> ray = M::ray(M::point(Triple{9, -5, 2} + axes[i] * (sign * 2)),
                                M::direction(axes[i] * sign + axes[(i + 1) % 3] * flat, flat), tag, true);
            QRAY_HOLDS(!meets(check, s, ray, t));
            ray.origin = step_off<N>(ray.origin, g, true);
            QRAY_HOLDS(!meets(check, s, ray, t));
            if (NarrowFixed<N>) // whose directions are longer or shorter than 1 by more than that
                continue;
            ray.from = {Tag::none};
            QRAY_HOLDS(!meets(check, s, ray, t));
        }
}

QRAY_CASE(SphereEnteredIsMetAtTheFarEndOfTheChord)
{
    QRAY_NAMES;
    const Tag tag = make_tag(3, 0);
    const Length little = number<Length>(16, int64_t{1} << fine_steps<N>);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Sphere<N> s = M::sphere(M::point({0, 0, 0}), 2, 1, tag);
            const Point<N> o = M::point(axes[i] * (sign * 2));
            Direction<N> d = M::direction(axes[i] * -sign);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && t == number<Length>(4));
            // Down at a sine of 3/5: 2 r 3/5.
            d = M::direction(axes[i] * (-3 * sign) + axes[(i + 2) % 3] * 4, 5);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && near<N>(t, number<Length>(12, 5), little));
            // And at 2^-17: the chord is 2^-15 long, if the origin were on the ball exactly; it has another
            // end.
            d = M::direction(axes[i] * -sign + axes[(i + 1) % 3] * (1 << 17), 1 << 17);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && t > Length{} && t <= number<Length>(1, 4));
        }
}

} // namespace catalogue
