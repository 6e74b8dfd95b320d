#include <array>

#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct PolygonTest : ::testing::Test {};
TYPED_TEST_SUITE(PolygonTest, NumberSystems, SystemNames);

const std::vector<Vec3> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
// An L: the square without its upper right quarter.
const std::vector<Vec3> corner{{-1, -1, 0}, {1, -1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-1, 1, 0}};

template <class N>
Ray<N> down(double x, double y)
{
    return make<N>::ray({x, y, 4}, {0, 0, -1});
}

TYPED_TEST(PolygonTest, HeadOnHitsAreExactFromBothSides)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(square);
    ASSERT_TRUE(s.hit(down<N>(0.5, 0.25), limit, t));
    EXPECT_EQ(value(t), 4);
    ASSERT_TRUE(s.hit(M::ray({0.5, 0.25, -3}, {0, 0, 1}), limit, t));
    EXPECT_EQ(value(t), 3);
    EXPECT_EQ(s.normal(down<N>(0, 0)), (Vec3{0, 0, 1})); // counter-clockwise towards the viewer
}

TYPED_TEST(PolygonTest, MissesBesideBehindAndParallel)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(square);
    for (double x : {-1.5, -1.0625, 0.0, 1.0625, 1.5})
        for (double y : {-1.5, -1.0625, 0.0, 1.0625, 1.5})
            EXPECT_EQ(s.hit(down<N>(x, y), limit, t), x == 0 && y == 0) << x << " " << y;
    EXPECT_FALSE(s.hit(M::ray({0, 0, 4}, {0, 0, 1}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-5, 0, 0.25}, {1, 0, 0}), limit, t));
}

TYPED_TEST(PolygonTest, LimitIsIncluded)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(square);
    EXPECT_TRUE(s.hit(down<N>(0, 0), M::length(4), t));
    EXPECT_FALSE(s.hit(down<N>(0, 0), M::length(3.875), t));
}

TYPED_TEST(PolygonTest, ConcaveCornersAreOutside)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(corner);
    EXPECT_TRUE(s.hit(down<N>(0.5, -0.5), limit, t));
    EXPECT_TRUE(s.hit(down<N>(-0.5, 0.5), limit, t));
    EXPECT_TRUE(s.hit(down<N>(-0.5, -0.5), limit, t));
    EXPECT_FALSE(s.hit(down<N>(0.5, 0.5), limit, t));
    EXPECT_FALSE(s.hit(down<N>(0.0625, 0.0625), limit, t));
    EXPECT_TRUE(s.hit(down<N>(-0.0625, -0.0625), limit, t));
}

// Parity in the plane, away from the edges: each of 12 directions of the ray takes another axis or sign.
TYPED_TEST(PolygonTest, CombOf144CornersHasItsTeeth)
{
    QRAY_SHAPE_TEST;
    std::vector<Vec3> comb;
    constexpr int teeth = 36; // each a rectangle 0.1 wide and 1 high, 0.1 apart, on a bar below
    for (int i = 0; i < teeth; i++) {
        const double x = 0.2 * i - 3.6;
        comb.push_back({x, i == 0 ? -0.5 : 0, 0});
        comb.push_back({x, 1, 0});
        comb.push_back({x + 0.1, 1, 0});
        comb.push_back({x + 0.1, i == teeth - 1 ? -0.5 : 0, 0});
    }
    ASSERT_EQ(comb.size(), 144u);
    const PolygonOf<N> s(comb);
    for (int i = 0; i < 2 * teeth - 1; i++) {
        const double x = 0.1 * i + 0.05 - 3.6;
        for (double slant : {0.0, 0.375, -2.0}) {
            const auto at = [&](double y) { return M::ray({x - 2 * slant, y, 2}, {slant, 0, -1}); };
            EXPECT_EQ(s.hit(at(0.5), limit, t), i % 2 == 0) << i;
            EXPECT_TRUE(s.hit(at(-0.25), limit, t)) << i;
            EXPECT_FALSE(s.hit(at(1.125), limit, t)) << i;
        }
    }
}

TYPED_TEST(PolygonTest, AgreesWithThePlaneAndTheSidesOfATriangle)
{
    QRAY_SHAPE_TEST;
    Random random(50);
    double worst = 0;
    int hits = 0, wrong = 0;
    for (int i = 0; i < 30000; i++) {
        const std::vector<Vec3> c{random.point(3), random.point(3), random.point(3)};
        if (length(cross(c[1] - c[0], c[2] - c[0])) < 1)
            continue;
        const PolygonOf<N> s(c);
        const Vec3 from = random.point(7);
        const auto ray = M::ray(from, random.point(3) - from);
        const auto d = real(ray.direction), o = real(ray.origin);
        const auto a = real(s.points[0]) - o, b = real(s.points[1]) - o, e = real(s.points[2]) - o;
        const auto n = cross(b - a, e - b);
        if (std::fabs(dot(n, d)) < 0.1 * length(n))
            continue;
        // The triple products tell on which side of each edge the line passes.
        const Real u = dot(d, cross(b, e)), v = dot(d, cross(e, a)), w = dot(d, cross(a, b));
        const Real expected = dot(n, a) / dot(n, d);
        if (std::fmin(std::fabs(u), std::fmin(std::fabs(v), std::fabs(w))) < 0.01 || std::fabs(expected) < 0.01)
            continue;
        const bool inside = expected > 0 && (u > 0) == (v > 0) && (v > 0) == (w > 0);
        const bool hit = s.hit(ray, limit, t);
        wrong += hit != inside;
        if (hit && inside) {
            hits++;
            // With the normal as it was rounded: the header's plane.
            const auto g = real(s.shape.normal);
            const double off = static_cast<double>(std::fabs(value(t) - dot(g, a) / dot(g, d)));
            worst = std::fmax(worst, off * static_cast<double>(std::fabs(dot(g, d))) / M::length_ulp(12));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(hits, 1000);
    EXPECT_LE(worst, 2);
}

// Of the ray's direction and two corners seen from its origin, in steps of the number system: on which side the edge
// passes.
template <class N>
__int128 volume(const Ray<N>& ray, const Point<N>& a, const Point<N>& b)
{
    const auto from = [&ray](const Point<N>& p) {
        return std::array<__int128, 3>{__int128{p.x.raw} - ray.origin.x.raw, __int128{p.y.raw} - ray.origin.y.raw,
                                       __int128{p.z.raw} - ray.origin.z.raw};
    };
    const auto u = from(a), v = from(b);
    const auto& d = ray.direction;
    return d.x.raw * (u[1] * v[2] - u[2] * v[1]) + d.y.raw * (u[2] * v[0] - u[0] * v[2])
        + d.z.raw * (u[0] * v[1] - u[1] * v[0]);
}

// Is it too much for rounding to say otherwise? q24 drops less than 1/8 ulp of each part of a sheared corner; no part
// is longer than the corner is far, and the direction's dominant part is 1/sqrt(3) at least.
template <class N>
bool is_certain(__int128 volume, const Ray<N>& ray, const Point<N>& a, const Point<N>& b)
{
    if (!is_split<N>)
        return volume != 0;
    const double reach = length(value(a - ray.origin)) + length(value(b - ray.origin));
    const double most = std::sqrt(3) * 2 * reach * make<N>::length_ulp() / 8;
    return std::ldexp(std::fabs(static_cast<double>(volume)), -2 * N::Length::frac - N::Unit::frac) > 1.001 * most;
}

// For fixed point; in floating point corners are rounded when they are sheared.
template <class N>
void expect_exact_edges()
{
    using M = make<N>;
    typename N::Length t{};
    const auto limit = N::length_max;
    // Slivers of some steps' width, and rays aimed at their edges.
    Random random(57);
    int inside = 0, outside = 0, wrong = 0;
    for (int k = 0; k < 4000; k++) {
        const Vec3 a = random.point(20), along = random.direction() * random.uniform(1, 20);
        const double width = std::exp2(random.uniform(0, 12)) * M::length_ulp(1);
        const Vec3 g = unit(cross(along, random.direction()));
        const Vec3 b = a + along, c = a + along * random.uniform(0.1, 0.9) + cross(unit(along), g) * width;
        const PolygonOf<N> s({a, b, c});
        for (int i = 0; i < 10; i++) {
            const Vec3 at =
                a + along * random.uniform(0, 1) + cross(unit(along), g) * (width * random.uniform(-0.5, 1));
            const Vec3 from = at + (g + random.point(0.5)) * random.uniform(1, 15);
            const auto ray = M::ray(from, at - from);
            const auto* p = s.points.data();
            const auto u = volume<N>(ray, p[0], p[1]), v = volume<N>(ray, p[1], p[2]), w = volume<N>(ray, p[2], p[0]);
            if (!is_certain(u, ray, p[0], p[1]) || !is_certain(v, ray, p[1], p[2]) || !is_certain(w, ray, p[2], p[0]))
                continue;
            const bool expected = (u > 0) == (v > 0) && (v > 0) == (w > 0);
            (expected ? inside : outside)++;
            wrong += s.hit(ray, limit, t) != expected;
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(inside, 1000);
    EXPECT_GT(outside, 1000);
}
TEST(PolygonEdge, IsWhereExactArithmeticSaysInQ32) { expect_exact_edges<q32>(); }
TEST(PolygonEdge, IsWhereExactArithmeticSaysInQ16) { expect_exact_edges<q16>(); }
TEST(PolygonEdge, IsWhereExactArithmeticSaysInQ24) { expect_exact_edges<q24>(); }

TYPED_TEST(PolygonTest, OfTwoThatShareAnEdgeExactlyOneIsHit)
{
    QRAY_SHAPE_TEST;
    // A square cut along its diagonal, tilted so that nothing is exact; rays aimed at points of the diagonal.
    Random random(51);
    for (int k = 0; k < 40; k++) {
        const Vec3 e = random.direction(), f = unit(cross(e, random.direction())), o = random.point(1);
        const Vec3 a = o - e - f, b = o + e - f, c = o + e + f, d = o - e + f;
        const PolygonOf<N> lower({a, b, c}), upper({a, c, d});
        for (int i = 0; i < 100; i++) {
            const Vec3 at = a + (c - a) * random.uniform(0.05, 0.95);
            const Vec3 from = at + random.direction() * random.uniform(1, 6);
            if (std::fabs(dot(unit(from - at), cross(e, f))) < 0.1)
                continue;
            const auto ray = M::ray(from, at - from);
            ASSERT_EQ(lower.hit(ray, limit, t) + upper.hit(ray, limit, t), 1);
        }
    }
}

TYPED_TEST(PolygonTest, RayThroughASharedCornerHitsExactlyOneOfAFan)
{
    QRAY_SHAPE_TEST;
    // Six triangles around (0.5, 0.25, 0), which every ray is aimed at exactly.
    const Vec3 hub{0.5, 0.25, 0};
    std::vector<PolygonOf<N>> fan;
    const Vec3 rim[6] = {{2, 0, 0}, {1.5, 2, 0}, {-0.5, 2, 0}, {-1, 0.5, 0}, {-0.5, -1, 0}, {1.25, -1.5, 0}};
    for (int i = 0; i < 6; i++)
        fan.emplace_back(std::vector<Vec3>{hub, rim[i], rim[(i + 1) % 6]});
    for (const Vec3& step : {Vec3{0, 0, 4}, {0, 3, 4}, {-3, 0, 4}, {4, 4, 2}, {-2, 1, -2}, {1, -2, -2}, {0, 0, -4}}) {
        const auto ray = M::ray(hub + step, -step);
        int hits = 0;
        for (const auto& s : fan)
            hits += s.hit(ray, limit, t);
        EXPECT_EQ(hits, 1) << step.x << " " << step.y << " " << step.z;
    }
}

TYPED_TEST(PolygonTest, IsNotMetByARayThatLeavesIt)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(square, make_tag(4, 2));
    for (bool outward : {false, true})
        for (double z : {-0.001, 0.0, 0.001}) {
            const auto ray = ray_from<N>({0, 0, z}, {0.5, 0, 0.5}, s.shape.tag, outward);
            EXPECT_FALSE(s.hit(ray, limit, t));
            EXPECT_EQ(s.crossings(ray, limit), 0);
        }
}

TYPED_TEST(PolygonTest, CrossingsAreCountedBeforeTheLight)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s(corner);
    const auto ray = down<N>(-0.5, 0.25);
    EXPECT_EQ(s.crossings(ray, M::length(3)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(4)), 0); // a light in the polygon
    EXPECT_EQ(s.crossings(ray, M::length(4.5)), 1);
    EXPECT_EQ(s.crossings(ray, limit), 1);
    EXPECT_EQ(s.crossings(down<N>(0.5, 0.5), limit), 0);
}

// Of several shapes the nearest is found in any order only if a hit depends on the limit by no more than this. A
// triangle seen flat, whose plane is met behind it, is met in its farthest corner: it may be before a limit that
// the plane is behind.
TYPED_TEST(PolygonTest, AHitIsTheSameForEveryLimitBehindIt)
{
    QRAY_SHAPE_TEST;
    Random random(77);
    int hits = 0;
    for (int i = 0; i < 20000; i++) {
        const Vec3 a = random.point(20), along = random.direction(), aside = random.direction();
        const double size = random.uniform(0.05, 0.5);
        const PolygonOf<N> s({a, a + (along + aside) * size, a + (along - aside) * size});
        const Vec3 flat = along + cross(along, aside) * random.uniform(-0.3, 0.3);
        const auto ray = M::ray(a + along * (size * random.uniform(0.9, 1)) - flat * random.uniform(2, 40), flat);
        if (!s.hit(ray, limit, t))
            continue;
        hits++;
        typename N::Length again{};
        ASSERT_TRUE(s.hit(ray, t, again)) << i << " " << value(t);
        ASSERT_EQ(value(again), value(t)) << i;
    }
    EXPECT_GT(hits, 1000);
}

} // namespace
