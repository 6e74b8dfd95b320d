#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct DiscTest : ::testing::Test {};
TYPED_TEST_SUITE(DiscTest, NumberSystems, SystemNames);

TYPED_TEST(DiscTest, HeadOnHitsAreExactFromBothSides)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({1, 2, 3}, {0, 1, 0}, 2);
    ASSERT_TRUE(s.hit(M::ray({1, 7, 3}, {0, -1, 0}), limit, t));
    EXPECT_EQ(value(t), 5);
    ASSERT_TRUE(s.hit(M::ray({1, -4, 3}, {0, 1, 0}), limit, t));
    EXPECT_EQ(value(t), 6);
}

TYPED_TEST(DiscTest, RimBelongsToIt)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({1, 2, 3}, {0, 1, 0}, 2);
    const auto down = [](double x, double z) { return M::ray({x, 7, z}, {0, -1, 0}); };
    EXPECT_TRUE(s.hit(down(3, 3), limit, t));
    EXPECT_TRUE(s.hit(down(1, 1), limit, t));
    EXPECT_FALSE(s.hit(down(3.0625, 3), limit, t));
    EXPECT_FALSE(s.hit(down(1, 0.9375), limit, t));
    // A corner of the square around it is no part of it: (1.5, 1.5) is 2.12 from the middle.
    EXPECT_FALSE(s.hit(down(2.5, 4.5), limit, t));
    EXPECT_TRUE(s.hit(down(2.375, 4.375), limit, t)); // 1.94
}

TYPED_TEST(DiscTest, MissesBehindAndParallel)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 2);
    EXPECT_FALSE(s.hit(M::ray({0, 5, 0}, {0, 1, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({0, -5, 0}, {0, -1, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-5, 1, 0}, {1, 0, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-5, 0, 0}, {1, 0, 0}), limit, t)); // in its plane
}

TYPED_TEST(DiscTest, LimitIsIncluded)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 2);
    const auto ray = M::ray({0, 4, 0}, {0, -1, 0});
    EXPECT_TRUE(s.hit(ray, M::length(4), t));
    EXPECT_FALSE(s.hit(ray, M::length(3.75), t));
}

TYPED_TEST(DiscTest, AgreesWithThePlaneEquation)
{
    QRAY_SHAPE_TEST;
    Random random(30);
    double worst = 0;
    int hits = 0, wrong = 0;
    for (int i = 0; i < 20000; i++) {
        const DiscOf<N> s(random.point(4), random.direction(), random.uniform(0.5, 4));
        const Vec3 from = random.point(7);
        const auto ray = M::ray(from, random.point(4) - from);
        const auto n = real(s.shape.normal), d = real(ray.direction);
        const auto v = real(s.shape.centre) - real(ray.origin);
        const double cosine = static_cast<double>(dot(n, d));
        if (std::fabs(cosine) < 0.1)
            continue;
        const Real expected = dot(n, v) / dot(n, d);
        const double r = value(s.shape.radius);
        const double off = static_cast<double>(length(d * expected - v)) - r;
        if (std::fabs(off) < 0.01 || std::fabs(expected) < 0.01)
            continue; // on the rim, or at the origin
        const bool hit = s.hit(ray, limit, t);
        wrong += hit != (expected > 0 && off < 0);
        if (hit) {
            hits++;
            // Fixed point: the quotient's 2 ulp. Floating point: two sums of three products of that size, over a
            // cosine.
            const double ulp = M::length_ulp(static_cast<double>(length(v)));
            worst = std::fmax(worst,
                              static_cast<double>(std::fabs(value(t) - expected))
                                  / (N::is_fixed ? ulp : ulp / std::fabs(cosine)));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(hits, 2000);
    EXPECT_LE(worst, N::is_fixed ? 2 : 6);
}

TYPED_TEST(DiscTest, IsNotMetByARayThatLeavesIt)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 2, make_tag(4, 2));
    for (bool outward : {false, true})
        for (double y : {-0.001, 0.0, 0.001}) {
            const auto ray = ray_from<N>({0, y, 0}, {0.5, 0.5, 0}, s.shape.tag, outward);
            EXPECT_FALSE(s.hit(ray, limit, t));
            EXPECT_EQ(s.crossings(ray, M::length(50)), 0);
        }
    EXPECT_TRUE(s.hit(ray_from<N>({0, -1, 0}, {0, 1, 0}, make_tag(5, 2), true), limit, t)); // another surface's
}

TYPED_TEST(DiscTest, CrossingsAreCountedBeforeTheLight)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 2);
    const auto ray = M::ray({0, 4, 0}, {0, -1, 0});
    EXPECT_EQ(s.crossings(ray, M::length(3)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(4)), 0); // a light in the disc
    EXPECT_EQ(s.crossings(ray, M::length(4.5)), 1);
    EXPECT_EQ(s.crossings(ray, limit), 1);
    EXPECT_EQ(s.crossings(M::ray({2.5, 4, 0}, {0, -1, 0}), limit), 0);
}

TYPED_TEST(DiscTest, LightInItsPlaneIsNotBlockedHoweverFlatTheRay)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 8);
    for (double y : {2.0, 0.5, 0.125}) {
        const Vec3 from{-6, y, 0}, light{6, 0, 0};
        const auto ray = M::ray(from, light - from);
        EXPECT_EQ(s.crossings(ray, M::length(length(light - from))), 0) << y;
    }
}

TYPED_TEST(DiscTest, NormalIsTheGivenOne)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {2, -1, 2}, 8);
    expect_near(s.normal(M::ray({0, 4, 0}, {0, -1, 0})), {2. / 3, -1. / 3, 2. / 3}, M::unit_ulp());
}

// The point met can lie 128 lengths from the centre: the most negative number there is, which cannot be negated.
TEST(Disc, AHitAsFarFromTheCentreAsNumbersGoIsOutside)
{
    // t = 64, at -64 along x; the centre is at 64. The normal is (1, -2, 0)/sqrt 5, one component twice the other.
    DiscOf<q32> s({62, 34, 0}, {1, -2, 0}, 16);
    s.shape.normal = {{480191400}, {-960382800}, {0}};
    q32::Length t{};
    EXPECT_FALSE(s.hit(make<q32>::ray({-2, -30, 0}, {-1, 0, 0}), q32::length_max, t));
}

} // namespace
