#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct SphereTest : ::testing::Test {};
TYPED_TEST_SUITE(SphereTest, NumberSystems, SystemNames);

TYPED_TEST(SphereTest, HeadOnHitsAreExact)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({1, 2, 3}, 2);
    ASSERT_TRUE(s.hit(M::ray({-4, 2, 3}, {1, 0, 0}), limit, t));
    EXPECT_EQ(value(t), 3);
    ASSERT_TRUE(s.hit(M::ray({1, 2, 13}, {0, 0, -1}), limit, t));
    EXPECT_EQ(value(t), 8);
    ASSERT_TRUE(s.hit(M::ray({1, 2, 3}, {0, 1, 0}), limit, t)); // from the centre
    EXPECT_EQ(value(t), 2);
    ASSERT_TRUE(s.hit(M::ray({1, 1, 3}, {0, 1, 0}), limit, t)); // from inside: the far crossing
    EXPECT_EQ(value(t), 3);
}

TYPED_TEST(SphereTest, PythagoreanChordsAreExact)
{
    QRAY_SHAPE_TEST;
    // A chord at distance 3 from the centre of a ball of radius 5 is half 4.
    const SphereOf<N> s({0, 0, 0}, 5);
    ASSERT_TRUE(s.hit(M::ray({-8, 3, 0}, {1, 0, 0}), limit, t));
    EXPECT_EQ(value(t), 4);
    ASSERT_TRUE(s.hit(M::ray({0, -8, -3}, {0, 1, 0}), limit, t));
    EXPECT_EQ(value(t), 4);
}

TYPED_TEST(SphereTest, MissesBesideAndBehind)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1);
    EXPECT_FALSE(s.hit(M::ray({-5, 1.125, 0}, {1, 0, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-5, 0, 0}, {-1, 0, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-5, 0, 0}, {0, 0, 1}), limit, t));
}

TYPED_TEST(SphereTest, TangentTouches)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1);
    ASSERT_TRUE(s.hit(M::ray({-5, 1, 0}, {1, 0, 0}), limit, t));
    EXPECT_EQ(value(t), 5);
}

TYPED_TEST(SphereTest, LimitIsIncluded)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1);
    const auto ray = M::ray({-5, 0, 0}, {1, 0, 0});
    EXPECT_TRUE(s.hit(ray, limit, t));
    EXPECT_TRUE(s.hit(ray, M::length(4), t));
    EXPECT_FALSE(s.hit(ray, M::length(3.75), t));
}

// The crossings of the ray as it is, its direction not quite a unit vector.
template <class N>
struct Quadratic {
    Real a, b, c, discriminant;
    Quadratic(const SphereOf<N>& s, const Ray<N>& ray)
    {
        const auto o = real(ray.origin) - real(s.shape.centre), d = real(ray.direction);
        a = dot(d, d);
        b = dot(o, d);
        c = dot(o, o) - Real(s.radius()) * Real(s.radius());
        discriminant = b * b - a * c;
    }
    Real half() const { return discriminant > 0 ? std::sqrt(discriminant) / a : 0; }
    Real nearest() const { return -b / a - half() > 0 ? -b / a - half() : -b / a + half(); }
    bool hits() const { return discriminant > 0 && nearest() > 0; }
};

template <class N>
void expect_agreement_with_the_quadratic(int32_t fine, double largest)
{
    using M = make<N>;
    Random random(20);
    double worst = 0;
    int measured = 0, wrong = 0;
    for (int i = 0; i < 20000; i++) {
        const SphereOf<N> s(random.point(4), random.uniform(0.25, largest), make_tag(0, 0), fine);
        const Vec3 from = random.point(7);
        const auto ray = M::ray(from, random.point(3) - from);
        const Quadratic<N> q(s, ray);
        const double r = s.radius();
        // Rays that graze, and those that start within rounding of the surface, are left to the hard cases.
        if (std::fabs(q.discriminant) < 0.2 * r * r || std::fabs(q.c) < 0.05)
            continue;
        typename N::Length t{};
        const bool hit = s.hit(ray, N::length_max, t);
        wrong += hit != q.hits();
        if (hit && q.discriminant > 0.5 * r * r) {
            measured++;
            const double ulp = M::length_ulp(length(value(ray.origin) - value(s.shape.centre)) + r);
            worst = std::fmax(worst, static_cast<double>(std::fabs(value(t) - q.nearest())) / ulp);
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(measured, 500);
    // Fixed point states 2 ulp. In floating point v, b, p, its square and the root round at the size of the distance.
    EXPECT_LE(worst, N::is_fixed ? 2 : 8);
}

TYPED_TEST(SphereTest, AgreesWithTheQuadratic)
{
    expect_agreement_with_the_quadratic<TypeParam>(0, 3);
    if constexpr (TypeParam::is_fixed)
        expect_agreement_with_the_quadratic<TypeParam>(std::min(4, fine_for<TypeParam>(1.98, &Blocks::ball)), 1.98);
}

TYPED_TEST(SphereTest, LeavingOutwardNeverMeetsItAgain)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1, make_tag(3, 1));
    for (const Vec3& d : {Vec3{1, 0.001, 0}, {0.001, 1, 0}, {1, 0, 0}}) {
        const auto ray = ray_from<N>({1, 0, 0}, d, s.shape.tag, true);
        EXPECT_FALSE(s.hit(ray, limit, t));
        EXPECT_EQ(s.crossings(ray, M::length(50)), 0);
    }
}

TYPED_TEST(SphereTest, LeavingInwardMeetsTheFarSide)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1, make_tag(3, 1));
    const auto through = ray_from<N>({1, 0, 0}, {-1, 0, 0}, s.shape.tag, false);
    ASSERT_TRUE(s.hit(through, limit, t));
    EXPECT_EQ(value(t), 2);
    EXPECT_EQ(s.crossings(through, M::length(5)), 1);
    EXPECT_EQ(s.crossings(through, M::length(1.5)), 0);
    // At 60 degrees to the normal the chord is r.
    ASSERT_TRUE(s.hit(ray_from<N>({1, 0, 0}, {-0.5, std::sqrt(0.75), 0}, s.shape.tag, false), limit, t));
    EXPECT_NEAR(value(t), 1, 4 * M::length_ulp());
}

TYPED_TEST(SphereTest, CrossingsAreCountedBeforeTheLight)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> s({0, 0, 0}, 1);
    const auto ray = M::ray({-5, 0, 0}, {1, 0, 0}); // crosses at 4 and 6
    EXPECT_EQ(s.crossings(ray, M::length(3.5)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(5)), 1);
    EXPECT_EQ(s.crossings(ray, M::length(7)), 2);
    EXPECT_EQ(s.crossings(ray, limit), 2);
    // A light on the surface: the crossing at the light itself does not count.
    EXPECT_EQ(s.crossings(ray, M::length(4)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(6)), 1);
    EXPECT_EQ(s.crossings(M::ray({0, 0, 0}, {1, 0, 0}), M::length(5)), 1);   // from inside
    EXPECT_EQ(s.crossings(M::ray({5, 0, 0}, {1, 0, 0}), M::length(50)), 0);  // behind
    EXPECT_EQ(s.crossings(M::ray({-5, 2, 0}, {1, 0, 0}), M::length(50)), 0); // beside
}

TYPED_TEST(SphereTest, NormalPointsOutwardAndIsUnit)
{
    QRAY_SHAPE_TEST;
    Random random(21);
    double worst = 0;
    for (int i = 0; i < 5000; i++) {
        const double r = random.uniform(0.25, 3);
        const SphereOf<N> s(random.point(3), r);
        // From afar, and from inside: outward it is all the same.
        const Vec3 from = i % 2 == 0 ? random.direction() * 8 : value(s.shape.centre);
        const auto ray = M::ray(from, i % 2 == 0 ? value(s.shape.centre) + random.direction() * (0.5 * r) - from
                                                 : random.direction());
        if (!s.hit(ray, limit, t))
            continue;
        const auto o = real(ray.origin) - real(s.shape.centre);
        const auto exact = unit(o + real(ray.direction) * Quadratic<N>(s, ray).nearest());
        // The error of the point hit, seen from the centre.
        worst = std::fmax(worst, distance(s.normal(ray), rounded(exact)) * s.radius() / M::length_ulp(8));
    }
    EXPECT_LE(worst, 6);
    const SphereOf<N> s({1, -2, 0.5}, 3);
    EXPECT_NEAR(s.normal(M::ray({8, -2, 0.5}, {-1, 0, 0})).x, 1, M::unit_ulp());
    EXPECT_NEAR(s.normal(M::ray({1, -2, 0.5}, {0, -1, 0})).y, -1, M::unit_ulp());
}

// However far the ray has come: so that a ray that leaves from there starts on the right side.
TYPED_TEST(SphereTest, PointOfAHitLiesOnTheSphere)
{
    QRAY_SHAPE_TEST;
    Random random(22);
    double worst = 0, worst_hit = 0;
    for (int i = 0; i < 5000; i++) {
        const double r = std::exp2(random.uniform(-4, 1));
        const SphereOf<N> s(random.point(3), r);
        const Vec3 from = random.direction() * 14;
        const auto ray = M::ray(from, value(s.shape.centre) + random.direction() * (0.7 * r) - from);
        if (!s.hit(ray, limit, t))
            continue;
        Vec3 q, n;
        s.surface(ray, q, n);
        const double rho = static_cast<double>(length(real(q) - real(s.shape.centre)));
        worst = std::fmax(worst, std::fabs(rho - s.radius()) / M::length_ulp(4));
        const auto expected = real(ray.origin) + real(ray.direction) * Quadratic<N>(s, ray).nearest();
        worst_hit = std::fmax(worst_hit, distance(q, rounded(expected)) / M::length_ulp(16));
    }
    EXPECT_LE(worst, 2); // three components, each rounded
    EXPECT_LE(worst_hit, 4);
}

// A small ball whose centre lies between two ulp: seen along z, a shift of the centre by a shows in the normal as -a/r.
TEST(SphereOfQ32, CentreIsFinerThanAnUlp)
{
    using N = q32;
    using M = make<N>;
    const double r = 1.0 / 64, ulp = std::ldexp(1, -24), shift = 0.375 * ulp;
    SphereOf<N> s({0.25, -0.5, 40}, r, make_tag(0, 0), 10);
    s.shape.rounded = {-384, 384, 0}; // the rounded centre less the exact one, in 2^-34
    Vec3 q, n;
    s.surface(M::ray({0.25, -0.5, 0}, {0, 0, 1}), q, n);
    EXPECT_NEAR(n.x, -shift / r, 2 * M::unit_ulp());
    EXPECT_NEAR(n.y, shift / r, 2 * M::unit_ulp());
    EXPECT_NEAR(n.z, -1, 2 * M::unit_ulp());
    EXPECT_EQ(q.x, 0.25);
    EXPECT_EQ(q.y, -0.5);
    EXPECT_EQ(q.z, 40 - r);
    // Rays just inside and outside of the exact rim.
    N::Length t{};
    EXPECT_TRUE(s.hit(M::ray({0.25 + r, -0.5, 0}, {0, 0, 1}), N::length_max, t));
    EXPECT_FALSE(s.hit(M::ray({0.25 - r, -0.5, 0}, {0, 0, 1}), N::length_max, t));
    EXPECT_FALSE(s.hit(M::ray({0.25, -0.5 + r, 0}, {0, 0, 1}), N::length_max, t));
    EXPECT_TRUE(s.hit(M::ray({0.25, -0.5 - r, 0}, {0, 0, 1}), N::length_max, t));
}

} // namespace
