// Planes, discs and polygons.
#pragma once

#include "case.hpp"

namespace catalogue {

QRAY_CASE(PlaneParallelToTheRayIsMissed)
{
    QRAY_NAMES;
    for (int64_t height : List{0, 1 << 20, -(1 << 20), 1}) {
        Disc<N> s = M::disc({0, 0, 0}, axes[1], 60);
        s.centre.y = number<Length>(height, 1 << 20);
        QRAY_HOLDS(!meets(check, s, M::ray(M::point({-1, 0, 2}), M::direction({1, 0, 0})), t));
        QRAY_HOLDS(!meets(check, s, M::ray(M::point({-1, 0, 2}), M::direction({3, 0, -4}, 5)), t));
    }
}

// 64 away at a slope of 2^-30 (q16: 2^-14, q24: 2^-20); from a height of 1 it is out of reach.
QRAY_CASE(PlaneAtASlopeOfABillionthIsMetWhereItShouldBe)
{
    QRAY_NAMES;
    const Disc<N> s = M::disc({0, 0, 0}, axes[1], 100);
    constexpr int bits = slope<N>;
    // A quotient of 14 bits, or one to an ulp.
    const Length slack = ShortFixed<N> ? number<Length>(5, 1024) : NarrowFixed<N> ? ulp : Length{};
    for (int64_t side : List{-1, 1}) {
        Ray<N> ray = M::ray(M::point({-60, side, 0}), M::direction({1, 0, 0}));
        ray.direction.y = number<Unit>(-side, int64_t{1} << bits);
        QRAY_HOLDS(!meets(check, s, ray, t));
        ray.origin.y = number<Length>(side * 64, int64_t{1} << bits);
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(64), slack));
        ray.direction.y = number<Unit>(side, int64_t{1} << bits);
        QRAY_HOLDS(!meets(check, s, ray, t));
    }
}

QRAY_CASE(DiscExactlyAtTheLimitIsMet)
{
    QRAY_NAMES;
    const Disc<N> s = M::disc({0, 0, 0}, axes[2], 3);
    const Ray<N> ray = M::ray(M::point({1, 1, 5}), M::direction({0, 0, -1}));
    QRAY_HOLDS(meets(check, s, ray, t, number<Length>(5)) && t == number<Length>(5));
    QRAY_HOLDS(!meets(check, s, ray, t, number<Length>(5) - ulp));
}

QRAY_CASE(PlaneThroughTheOriginOfARayIsNotMet)
{
    QRAY_NAMES;
    for (int i = 0; i < 3; i++)
        for (const Exact& e : directions)
            for (int64_t x : List{-19, 0, 7}) {
                const Disc<N> s = M::disc({0, 0, 0}, axes[i], 60);
                const Triple o = axes[(i + 1) % 3] * x + axes[(i + 2) % 3] * 13;
                QRAY_HOLDS(!meets(check, s, M::ray(M::point(o), M::direction(e.d, e.over)), t));
            }
}

// (3, 4) is 5 from the centre.
QRAY_CASE(DiscHoldsItsRimAndNothingBeyond)
{
    QRAY_NAMES;
    for (int i = 0; i < 3; i++)
        for (const Triple& at : List{Triple{3, 4, 7}, Triple{-3, 4, 7}, Triple{4, -3, 7}, Triple{-4, -3, 7}}) {
            const Disc<N> s = M::disc({0, 0, 0}, Triple{0, 0, 1}.turned(i), 5);
            const Direction<N> d = M::direction(Triple{0, 0, -1}.turned(i));
            const Point<N> o = M::point(at.turned(i));
            const Triple out{at.x < 0 ? -1 : 1, 0, 0};
            QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t == number<Length>(7));
            const Point<N> beyond_it = o + M::point(out.turned(i), int64_t{1} << steps_at_5<N>);
            QRAY_HOLDS(!meets(check, s, M::ray(beyond_it, d), t));
        }
}

// --- Polygon

struct Flat {
    int64_t x, y;
};

// Corners across the z axis, x in steps of 1 / x_over and y of 1 / y_over.
template <class N>
struct Figure {
    static constexpr uint32_t most = 144;
    Point<N> at[most];
    Polygon<N> shape;
    uint32_t count;
    int64_t x_over, y_over;

    Figure(const Flat* corners, uint32_t n, int64_t over_x, int64_t over_y)
        : count(n), x_over(over_x), y_over(over_y)
    {
        using Length = typename N::Length;
        Flat low = corners[0], high = corners[0];
        for (uint32_t i = 0; i < n; i++) {
            const Flat& c = corners[i];
            at[i] = {number<Length>(c.x, x_over), number<Length>(c.y, y_over), Length{}};
            low = {c.x < low.x ? c.x : low.x, c.y < low.y ? c.y : low.y};
            high = {c.x > high.x ? c.x : high.x, c.y > high.y ? c.y : high.y};
        }
        const Length w = number<Length>(high.x - low.x, x_over), h = number<Length>(high.y - low.y, y_over);
        const Length middle_x = number<Length>(low.x + high.x, 2 * x_over);
        const Length middle_y = number<Length>(low.y + high.y, 2 * y_over);
        // More than the half of a square's diagonal, 0.70711 of its edge.
        const Length wider = w > h ? w : h;
        const typename N::Unit share = number<typename N::Unit>(182, 256);
        const Length bound = N::length(wider * share) + number<Length>(8, int64_t{1} << fine_steps<N>);
        shape = {Make<N>::direction(axes[2]), {middle_x, middle_y, Length{}}, bound, 0, n, make_tag(0, 0)};
    }
    bool hit(Ray<N> ray, typename N::Length& t)
    {
        hide(*this);
        hide(ray);
        Local<N> local{};
        return !surely_missed(shape, RejectRay<N>(ray))
            && intersect<true>(shape, Corners<N>{at, nullptr}, ray, N::length_max, t, local);
    }
};

// By crossings in integers, below 2^62. Not `certain` on an edge, whose owner is another question, and where
// two rounded products of floats do not tell: 3 epsilon of their sum (Shewchuk 1997).
template <class N>
bool inside_exactly(const Flat* corners, uint32_t count, Flat p, bool& certain)
{
    const auto size = [](int64_t v) { return v < 0 ? -v : v; };
    bool inside = false;
    certain = true;
    for (uint32_t i = 0; i < count; i++) {
        const Flat a = corners[i], b = corners[i + 1 < count ? i + 1 : 0];
        const int64_t u = (a.x - p.x) * (b.y - p.y), v = (b.x - p.x) * (a.y - p.y);
        if (u == v && (a.x - p.x) * (b.x - p.x) <= 0 && (a.y - p.y) * (b.y - p.y) <= 0)
            certain = false;
        if ((a.y > p.y) == (b.y > p.y))
            continue;
        inside = inside != (b.y > p.y ? u > v : u < v);
        if (SingleFloat<N> && size(u - v) <= (size(u) + size(v)) >> 22)
            certain = false;
    }
    return inside;
}

constexpr int figure_rays = sizeof(void*) == 8 ? 20000 : 2000; // a board is slower

template <class N>
void compare_with_integers(Check& check, const Flat* corners, uint32_t count, int64_t x_over, int64_t y_over,
                           int rays, Flat low, Flat high)
{
    QRAY_NAMES;
    Figure<N> s(corners, count, x_over, y_over);
    Random random{79};
    int hits = 0, decided = 0;
    for (int i = 0; i < rays; i++) {
        const Flat p{random.in(low.x, high.x), random.in(low.y, high.y)};
        bool certain = false;
        const bool expected = inside_exactly<N>(corners, count, p, certain);
        if (!certain)
            continue;
        const Point<N> o{number<Length>(p.x, x_over), number<Length>(p.y, y_over), number<Length>(3)};
        const bool hit = s.hit(M::ray(o, M::direction({0, 0, -1})), t);
        QRAY_HOLDS(hit == expected);
        QRAY_HOLDS(!hit || t == number<Length>(3));
        hits += hit;
        decided++;
    }
    QRAY_HOLDS(hits > rays / 10 && decided > rays * 8 / 10);
}

// The owner of a ray through a corner or an edge is decided without any rounding.
QRAY_CASE(RayThroughACornerOfSixTrianglesHasOneOwner)
{
    QRAY_NAMES;
    constexpr Triple ring[6] = {{4, 1, 0}, {1, 3, 0}, {-3, 2, 0}, {-4, -2, 0}, {0, -5, 0}, {3, -2, 0}};
    for (int turned = 0; turned < 3; turned++) {
        Point<N> at[18];
        Polygon<N> fan[6];
        for (uint32_t i = 0; i < 6; i++) {
            at[3 * i] = M::point({0, 0, 0});
            at[3 * i + 1] = M::point(ring[i].turned(turned));
            at[3 * i + 2] = M::point(ring[(i + 1) % 6].turned(turned));
            const Direction<N> normal = M::direction(axes[2].turned(turned));
            fan[i] = {normal, at[3 * i], number<Length>(8), 3 * i, 3, make_tag(i, 0)};
        }
        hide(at);
        // Through the common corner and the middles of the edges, from every side. Directions are exact:
        // 16ths, of any length, which is none that the cheap reject is made for.
        for (int64_t x = -3; x <= 3; x++)
            for (int64_t y = -3; y <= 3; y++)
                for (int edge = -1; edge < 6; edge++)
                    for (int64_t side : List{-8, 8}) {
                        const Triple twice = edge < 0 ? Triple{0, 0, 0} : ring[edge], away{x, y, side};
                        Ray<N> ray = M::ray(M::point((twice + away * 2).turned(turned), 2),
                                            M::direction((away * -1).turned(turned), 16));
                        hide(ray);
                        int owners = 0;
                        Local<N> local{};
                        for (const Polygon<N>& f : fan)
                            owners += intersect(f, Corners<N>{at, nullptr}, ray, N::length_max, t, local);
                        QRAY_HOLDS(owners == 1);
                    }
    }
}

// 168 steps of 2^-24 are 1.0014e-5; in q16 and q24 of their own.
QRAY_CASE(SliverOf50ByAHundredthousandthIsExact)
{
    constexpr Flat corners[] = {{-25 * 1024, 0}, {25 * 1024, 0}, {7 * 1024, 168}};
    const int64_t over = int64_t{1} << grain<N>;
    compare_with_integers<N>(check, corners, 3, 1024, over, figure_rays, {-25600, -6}, {25599, 173});
}

// 3355 steps of 2^-24 are 2e-4; and so in a corner of the world.
QRAY_CASE(TriangleOfAFiveThousandthIsExact)
{
    constexpr Flat corners[] = {{0, 0}, {3355, 17}, {1211, 2903}};
    const int64_t over = int64_t{1} << grain<N>;
    compare_with_integers<N>(check, corners, 3, over, over, figure_rays, {-100, -100}, {3500, 3000});
    if constexpr (N::is_fixed) {
        const int64_t far = 30 * over;
        const Flat there[] = {{far, -far}, {far + 3355, 17 - far}, {far + 1211, 2903 - far}};
        compare_with_integers<N>(check, there, 3, over, over, figure_rays, {far - 100, -far - 100},
                                 {far + 3500, 3000 - far});
    }
}

QRAY_CASE(TriangleAsLargeAsTheWorldIsExact)
{
    constexpr int64_t n = ShortFixed<N> ? 1024 : 4096;
    constexpr Flat corners[] = {{-62 * n, -62 * n + 1}, {62 * n, -61 * n}, {5, 62 * n - 3}};
    compare_with_integers<N>(check, corners, 3, n, n, figure_rays, {-62 * n, -62 * n}, {62 * n, 62 * n});
}

// A star between two squares on their corners.
QRAY_CASE(ConcavePolygonOf144CornersIsExact)
{
    constexpr int64_t n = ShortFixed<N> ? 1024 : 4096;
    Flat star[144];
    for (int i = 0; i < 144; i++) {
        const int64_t reach = (i % 2 == 0 ? 40 : 17) * n, along = reach * (i % 36) / 36;
        const Flat p{reach - along, along};
        star[i] = i < 36 ? p : i < 72 ? Flat{-p.y, p.x} : i < 108 ? Flat{-p.x, -p.y} : Flat{p.y, -p.x};
    }
    compare_with_integers<N>(check, star, 144, n, n, figure_rays / 4, {-40 * n, -40 * n}, {40 * n, 40 * n});
}

// Corners in a line, and doubled ones: no parity is odd, whatever the ray.
QRAY_CASE(PolygonWithoutAreaIsNeverMet)
{
    QRAY_NAMES;
    constexpr Flat line[] = {{-4, -2}, {0, 0}, {4, 2}}, pairs[] = {{1, 1}, {3, 2}, {3, 2}, {1, 1}};
    Figure<N> in_a_line(line, 3, 1, 1), doubled(pairs, 4, 1, 1);
    for (int64_t x = -10; x <= 10; x++)
        for (int64_t y = -5; y <= 5; y++) {
            const Ray<N> ray = M::ray(M::point({x, y, 8}, 2), M::direction({0, 0, -1}));
            QRAY_HOLDS(!in_a_line.hit(ray, t));
            QRAY_HOLDS(!doubled.hit(ray, t));
        }
}

// Seen exactly edge on a polygon is a line, of which even parity is all there is.
QRAY_CASE(PolygonIsNotMetByARayInItsPlane)
{
    QRAY_NAMES;
    constexpr Flat corners[] = {{-4, -4}, {-4, 4}, {4, 4}, {4, -4}};
    Figure<N> s(corners, 4, 1, 1);
    for (int64_t x = -6; x <= 6; x++)
        for (int64_t y = -6; y <= 6; y++) {
            QRAY_HOLDS(!s.hit(M::ray(M::point({x, y, 0}), M::direction({1, 0, 0})), t));
            QRAY_HOLDS(!s.hit(M::ray(M::point({x, y, 0}), M::direction({4, -3, 0}, 5)), t));
        }
}

// Seen at 2^-30 (q16: 2^-14, q24: 2^-20) from edge on: between its nearest and its farthest corner, if at all.
QRAY_CASE(PolygonAlmostEdgeOnIsMetWithinItself)
{
    QRAY_NAMES;
    constexpr Flat corners[] = {{-4, -4}, {-4, 4}, {4, 4}, {4, -4}};
    Figure<N> s(corners, 4, 1, 1);
    for (int64_t i = -100; i <= 100; i++) {
        Ray<N> ray = M::ray(M::point({-20, 1, 0}), M::direction({1, 0, 0}));
        ray.origin.z = number<Length>(i, int64_t{1} << grain<N>);
        ray.direction.z = number<Unit>(i < 0 ? 1 : -1, int64_t{1} << slope<N>);
        QRAY_HOLDS(!s.hit(ray, t) || (t >= number<Length>(16) && t <= number<Length>(24)));
    }
}

} // namespace catalogue
