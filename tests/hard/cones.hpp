// Cylinders and cones.
#pragma once

#include "case.hpp"

namespace catalogue {

QRAY_CASE(CylinderIsNotMetAlongItsAxis)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(3, 4);
    for (int64_t x : List{0, 256, 511, 513, 1024}) // in 512ths
        for (int64_t z : List{-10, 0, 10})
            for (int64_t sign : List{-1, 1}) {
                const Ray<N> ray = M::ray(M::point({x, 0, z * 512}, 512), M::direction({0, 0, sign}));
                QRAY_HOLDS(!meets(check, s, ray, t));
            }
}

// In q16 and q24 four steps.
QRAY_CASE(CylinderGrazedAFourmillionthInsideAndOutside)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(2, 3);
    const Length off = power_of_two<Length>(2 - grain<N>), one = number<Length>(1);
    for (int64_t z : List{-2, 0, 1})
        for (int64_t sign : List{-1, 1})
            for (bool inside : List{true, false}) {
                const Length edge = inside ? one - off : one + off;
                const Point<N> o{number<Length>(-5), sign < 0 ? -edge : edge, number<Length>(z, 2)};
                QRAY_HOLDS(meets(check, s, M::ray(o, M::direction({1, 0, 0})), t) == inside);
                QRAY_HOLDS(!inside || (t < number<Length>(5) && t > number<Length>(9, 2)));
            }
}

QRAY_CASE(CylinderHoldsItsRimsAndNothingBeyond)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(2, 3);
    for (int64_t sign : List{-1, 1}) {
        Point<N> o = M::point({-20, 1, 8 * sign}, 4);
        QRAY_HOLDS(meets(check, s, M::ray(o, M::direction({1, 0, 0})), t));
        o.z = sign < 0 ? o.z - ulp : o.z + ulp;
        QRAY_HOLDS(!meets(check, s, M::ray(o, M::direction({1, 0, 0})), t));
    }
}

// The cone of 3, 4 and 5: r = 3 at z = 0, the apex at 4.
template <class N>
constexpr Cone<N> cone345(Tag tag = make_tag(0, 0))
{
    return Make<N>::cone(2, 3, 2, 4, -3, 2, 4, tag);
}

// A little below the apex it is as wide as it takes, and above it there is nothing.
QRAY_CASE(ConeEndsAtItsApex)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length below = power_of_two<Length>(ShortFixed<N> ? -5 : -10);
    const Length above = power_of_two<Length>(ShortFixed<N> ? -5 : NarrowFixed<N> ? -11 : -16);
    for (const Triple& d : List{Triple{5, 0, 0}, Triple{0, -5, 0}, Triple{3, 4, 0}, Triple{-4, 3, 0}}) {
        Ray<N> ray = M::ray(M::point(Triple{0, 0, 4} - d), M::direction(d, 5));
        ray.origin.z = number<Length>(4) - below;
        QRAY_HOLDS(meets(check, s, ray, t) && t < number<Length>(5) && t > number<Length>(9, 2));
        ray.origin.z = number<Length>(4) + above;
        QRAY_HOLDS(!meets(check, s, ray, t));
    }
}

// A ray in the surface: it may be met or not, but then on the generator.
QRAY_CASE(ConeSeenAlongAGeneratorIsMetOnItOrNot)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    for (const Triple& base : List{Triple{3, 0, 0}, Triple{-3, 0, 0}, Triple{0, 3, 0}, Triple{0, -3, 0}}) {
        const Triple d = Triple{0, 0, 4} - base;
        const bool hit = meets(check, s, M::ray(M::point(base - d), M::direction(d, 5)), t);
        QRAY_HOLDS(!hit || (t >= number<Length>(499, 100) && t <= number<Length>(1001, 100)));
    }
}

// Parallel to a generator the quadratic is a line: from (3, 0, -2) through the base to the far wall, 25/4.
QRAY_CASE(ConeSeenParallelToAGenerator)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length little = number<Length>(256, int64_t{1} << fine_steps<N>);
    for (int turn = 0; turn < 4; turn++) {
        const int64_t x = turn == 0 ? 1 : turn == 1 ? -1 : 0, y = turn == 2 ? 1 : turn == 3 ? -1 : 0;
        const Ray<N> ray = M::ray(M::point({3 * x, 3 * y, -2}), M::direction({-3 * x, -3 * y, 4}, 5));
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(25, 4), little));
    }
}

QRAY_CASE(OtherNappeIsNeverMet)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    for (int64_t z : List{65, 72, 96, 128}) // in 16ths
        for (int64_t y : List{-8, 0, 3}) {
            QRAY_HOLDS(!meets(check, s, M::ray(M::point({-96, y, z}, 16), M::direction({1, 0, 0})), t));
            QRAY_HOLDS(!meets(check, s, M::ray(M::point({96, y, z}, 16), M::direction({-1, 0, 0})), t));
        }
}

// At z = 1 it is 9/4 wide.
QRAY_CASE(ConeSeenFromInsideIsMetOnce)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length little = number<Length>(32, int64_t{1} << fine_steps<N>);
    for (const Triple& d : List{Triple{5, 0, 0}, Triple{0, -5, 0}, Triple{3, 4, 0}, Triple{-4, 3, 0}}) {
        const Ray<N> ray = M::ray(M::point({0, 0, 1}), M::direction(d, 5));
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(9, 4), little));
        QRAY_HOLDS(crossings(s, Corners<N>{}, ray, N::length_max) == 1);
    }
    QRAY_HOLDS(!meets(check, s, M::ray(M::point({0, 0, 1}), M::direction({0, 0, -1})), t));
}

// From the wall at z = 1 inward: across, up to the far wall, and down out of the open end.
QRAY_CASE(ConeEnteredFromBelowAndFromAbove)
{
    QRAY_NAMES;
    const Tag tag = make_tag(4, 0);
    const Cone<N> s = cone345<N>(tag);
    const Length little = number<Length>(64, int64_t{1} << fine_steps<N>);
    for (int turn = 0; turn < 4; turn++) {
        const int64_t x = turn == 0 ? 1 : turn == 1 ? -1 : 0, y = turn == 2 ? 1 : turn == 3 ? -1 : 0;
        const Point<N> wall = M::point({9 * x, 9 * y, 4}, 4);
        const auto inward = [&](int64_t across, int64_t up) {
            return M::ray(wall, M::direction({-across * x, -across * y, up}, 5), tag, false);
        };
        QRAY_HOLDS(meets(check, s, inward(5, 0), t) && near<N>(t, number<Length>(9, 2), little));
        QRAY_HOLDS(meets(check, s, inward(4, 3), t) && near<N>(t, number<Length>(18, 5), little));
        QRAY_HOLDS(!meets(check, s, inward(3, -4), t));
        Ray<N> out = inward(-5, 0);
        out.outward = true;
        QRAY_HOLDS(!meets(check, s, out, t));
    }
}

} // namespace catalogue
