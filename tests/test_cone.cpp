#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct ConeTest : ::testing::Test {};
TYPED_TEST_SUITE(ConeTest, NumberSystems, SystemNames);

// In fixed point U, V and the root round at the shape's own scale, and the quotient adds 2 ulp.
template <class N>
double tolerance(double size)
{
    return (N::is_fixed ? 4 : 16) * make<N>::length_ulp(size);
}

TYPED_TEST(ConeTest, CylinderIsMetSquarelyFromOutsideAndInside)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({1, -2, 0}, 2, {1, 4, 0}, 2);
    ASSERT_TRUE(s.hit(M::ray({-7, 1, 0}, {1, 0, 0}), limit, t));
    EXPECT_NEAR(value(t), 6, tolerance<N>(8));
    ASSERT_TRUE(s.hit(M::ray({1, 1, 0}, {0, 0, 1}), limit, t));
    EXPECT_NEAR(value(t), 2, tolerance<N>(8));
    ASSERT_TRUE(s.hit(M::ray({1, 1, -1}, {0, 0, 1}), limit, t));
    EXPECT_NEAR(value(t), 3, tolerance<N>(8));
    // A chord 1.2 off the axis of a cylinder of radius 2 is half 1.6.
    ASSERT_TRUE(s.hit(M::ray({-7, 1, 1.2}, {1, 0, 0}), limit, t));
    EXPECT_NEAR(value(t), 6.4, 2 * tolerance<N>(8));
}

TYPED_TEST(ConeTest, CylinderIsOpenAndEndsAtItsRims)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, -1, 0}, 1, {0, 1, 0}, 1);
    const auto level = [](double y) { return M::ray({-5, y, 0}, {1, 0, 0}); };
    EXPECT_TRUE(s.hit(level(1), limit, t)); // the rim belongs to it
    EXPECT_TRUE(s.hit(level(-1), limit, t));
    EXPECT_FALSE(s.hit(level(1.0625), limit, t));
    EXPECT_FALSE(s.hit(level(-1.0625), limit, t));
    EXPECT_FALSE(s.hit(M::ray({0, 5, 0}, {0, -1, 0}), limit, t));   // through, along the axis
    EXPECT_FALSE(s.hit(M::ray({0.5, 5, 0}, {0, -1, 0}), limit, t)); // and beside it
    // In by the open top, out by the wall: from (0, 3) to (1, 0) it crosses the top at x = 2/3.
    ASSERT_TRUE(s.hit(M::ray({0, 3, 0}, {1, -3, 0}), limit, t));
    EXPECT_NEAR(value(t), std::sqrt(10), tolerance<N>(8));
}

TYPED_TEST(ConeTest, ConeNarrowsToItsApex)
{
    QRAY_SHAPE_TEST;
    // Radius 3 at the base, 0 at the apex, 4 up: at height y it is 3 (1 - y / 4).
    const ConeOf<N> s({0, 0, 0}, 3, {0, 4, 0}, 0);
    for (double y : {0.5, 1.0, 2.0, 3.0, 3.5}) {
        ASSERT_TRUE(s.hit(M::ray({-8, y, 0}, {1, 0, 0}), limit, t)) << y;
        EXPECT_NEAR(value(t), 8 - 3 * (1 - y / 4), 2 * tolerance<N>(8)) << y;
    }
    EXPECT_FALSE(s.hit(M::ray({-8, 4.0625, 0}, {1, 0, 0}), limit, t)); // the other nappe is no part of it
    EXPECT_FALSE(s.hit(M::ray({-8, 6, 0}, {1, 0, 0}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({-8, -0.0625, 0}, {1, 0, 0}), limit, t));
    ASSERT_TRUE(s.hit(M::ray({0, -4, 2}, {0, 1, 0}), limit, t)); // parallel to the axis, 2 off: where the radius is 2
    EXPECT_NEAR(value(t), 4 + 4. / 3, 2 * tolerance<N>(8));
}

TYPED_TEST(ConeTest, EndsMayStandEitherWay)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> up({0, 0, 0}, 3, {0, 4, 0}, 1), down({0, 4, 0}, 1, {0, 0, 0}, 3);
    for (double y : {0.25, 1.0, 2.0, 3.75}) {
        typename N::Length t2{};
        const auto ray = M::ray({-8, y, 0.5}, {1, 0, 0});
        ASSERT_TRUE(up.hit(ray, limit, t));
        ASSERT_TRUE(down.hit(ray, limit, t2));
        const double r = 3 - y / 2;
        EXPECT_NEAR(value(t), 8 - std::sqrt(r * r - 0.25), 2 * tolerance<N>(8));
        EXPECT_NEAR(value(t2), 8 - std::sqrt(r * r - 0.25), 2 * tolerance<N>(8));
    }
}

TYPED_TEST(ConeTest, LimitIsKept)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, -1, 0}, 1, {0, 1, 0}, 1);
    const auto ray = M::ray({-5, 0, 0}, {1, 0, 0});
    EXPECT_TRUE(s.hit(ray, M::length(4.125), t));
    EXPECT_FALSE(s.hit(ray, M::length(3.875), t));
    EXPECT_FALSE(s.hit(M::ray({5, 0, 0}, {1, 0, 0}), limit, t)); // behind
}

// Among what is met at one distance the first in the file is taken, in whatever order it is asked: so what is met at t
// is met where t is the limit, too. Here by fractions of an ulp behind 4.
TYPED_TEST(ConeTest, WhatIsMetAtTheLimitIsMet)
{
    QRAY_SHAPE_TEST;
    for (int i = 0; i < 64; i++) {
        const ConeOf<N> s({0, -1, 0}, 1 - std::ldexp(i, -21), {0, 1, 0}, 1 - std::ldexp(i, -21));
        const auto ray = M::ray({-5, 0, 0}, {1, 0, 0});
        ASSERT_TRUE(s.hit(ray, limit, t)) << i;
        typename N::Length again{};
        ASSERT_TRUE(s.hit(ray, t, again)) << i;
        EXPECT_EQ(value(again), value(t)) << i;
        EXPECT_FALSE(s.hit(ray, t - N::ulp, again)) << i;
    }
}

// The crossings of the surface that the fields state, of the ray as it is.
struct Roots {
    int count = 0;
    Real t[2]{};
    bool clear = true; // no crossing grazes, lies at a rim, or at the origin
    Real discriminant = 0;
};
template <class N>
Roots roots(const Cone<N>& s, const Ray<N>& ray)
{
    const auto o = real(ray.origin) - real(s.middle), d = real(ray.direction);
    const auto e1 = real(s.e1), e2 = real(s.e2), axis = real(s.axis);
    const Real down = std::ldexp(Real(1), -s.fine);
    const Real rho0 = value(s.rho0) * down, half = value(s.half) * down, c = value(s.cosine), sine = value(s.sine);
    const Real ox = dot(o, e1), oy = dot(o, e2), oz = dot(o, axis);
    const Real dx = dot(d, e1), dy = dot(d, e2), dz = dot(d, axis);
    const Real rho = rho0 + sine * oz;
    const Real qa = c * c * (dx * dx + dy * dy) - sine * dz * sine * dz;
    const Real qb = c * c * (ox * dx + oy * dy) - rho * sine * dz;
    const Real qc = c * c * (ox * ox + oy * oy) - rho * rho;
    Roots r;
    r.discriminant = qb * qb - qa * qc;
    const double near = 0.02 + 64 * make<N>::length_ulp();
    r.clear = std::fabs(r.discriminant) > 5 * near && std::fabs(qa) > near && std::fabs(qc) > near;
    if (r.discriminant <= 0)
        return r;
    const Real root = std::sqrt(r.discriminant);
    Real both[2] = {(-qb - root) / qa, (-qb + root) / qa};
    if (both[1] < both[0])
        std::swap(both[0], both[1]);
    for (Real t : both) {
        const Real z = oz + t * dz;
        const bool real_nappe = rho0 + sine * z >= 0;
        if (std::fabs(std::fabs(z) - half) < 0.01 + 16 * make<N>::length_ulp())
            r.clear = false;
        if (t > 0 && real_nappe && std::fabs(z) <= half)
            r.t[r.count++] = t;
    }
    return r;
}

TYPED_TEST(ConeTest, AgreesWithTheQuadratic)
{
    QRAY_SHAPE_TEST;
    Random random(40);
    double worst = 0;
    int hits = 0, wrong = 0, wrong_crossings = 0;
    for (int i = 0; i < 30000; i++) {
        const Vec3 base = random.point(2), apex = base + random.direction() * random.uniform(1, 4);
        const double ra = random.uniform(0.5, 2), rb = i % 3 == 0 ? ra : i % 3 == 1 ? 0 : random.uniform(0.25, 2);
        const ConeOf<N> s(base, ra, apex, rb);
        const Vec3 from = random.point(7);
        const auto ray = M::ray(from, random.point(3) - from);
        const Roots exact = roots(s.shape, ray);
        if (!exact.clear)
            continue;
        const bool hit = s.hit(ray, limit, t);
        wrong += hit != (exact.count > 0);
        wrong_crossings += s.crossings(ray, limit) != exact.count;
        if (hit && exact.count > 0) {
            hits++;
            // Rounding U moves the discriminant by twice |U| times an ulp, and t by that over its root.
            const double slope = 1 + 1 / std::sqrt(static_cast<double>(exact.discriminant));
            worst =
                std::fmax(worst, static_cast<double>(std::fabs(value(t) - exact.t[0])) / (slope * M::length_ulp(10)));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(wrong_crossings, 0);
    EXPECT_GT(hits, 2000);
    EXPECT_LE(worst, 1);
}

TYPED_TEST(ConeTest, LeavingOutwardNeverMeetsItAgain)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, -2, 0}, 1, {0, 2, 0}, 1, make_tag(3, 0));
    for (const Vec3& d : {Vec3{1, 0, 0}, {0.001, 0, 1}, {0.001, 1, 0}}) {
        const auto ray = ray_from<N>({1, 0, 0}, d, s.shape.tag, true);
        EXPECT_FALSE(s.hit(ray, limit, t));
        EXPECT_EQ(s.crossings(ray, M::length(50)), 0);
    }
}

TYPED_TEST(ConeTest, LeavingInwardMeetsTheOtherSide)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, -2, 0}, 1, {0, 2, 0}, 1, make_tag(3, 0));
    const auto across = ray_from<N>({1, 0, 0}, {-1, 0, 0}, s.shape.tag, false);
    ASSERT_TRUE(s.hit(across, limit, t));
    EXPECT_NEAR(value(t), 2, tolerance<N>(4));
    EXPECT_EQ(s.crossings(across, M::length(5)), 1);
    EXPECT_EQ(s.crossings(across, M::length(1.5)), 0);
    // 3 up while 2 across: out by the open end, 2 up.
    EXPECT_FALSE(s.hit(ray_from<N>({1, 0, 0}, {-2, 3, 0}, s.shape.tag, false), limit, t));
    // 1 up while 2 across.
    ASSERT_TRUE(s.hit(ray_from<N>({1, 0, 0}, {-2, 1, 0}, s.shape.tag, false), limit, t));
    EXPECT_NEAR(value(t), std::sqrt(5), tolerance<N>(4));
}

// Almost along a generator the chord is long and shallow. Where it is 16 ulp deep its end is found, by a ray that names
// the surface which it left and by one that does not.
TEST(Cone, EndOfAShallowChordAlongAGeneratorIsFound)
{
    using N = q32;
    using M = make<N>;
    Random random(43);
    const double ulp = 0x1p-24;
    int chords = 0, lost = 0, lost_unnamed = 0;
    for (int i = 0; i < 400000; i++) {
        const Vec3 base = random.point(8), axis = random.direction();
        const double height = random.uniform(2, 12), ra = random.uniform(4, 8), rb = ra * random.uniform(0, 0.9);
        const ConeOf<N> s(base, ra, base + axis * height, rb, make_tag(3, 0));
        const Vec3 side = unit(cross(axis, random.direction()));
        const double share = random.uniform(0, 1), slope = (rb - ra) / height;
        const Vec3 generator = unit(axis + side * slope) * (i % 2 ? 1 : -1), normal = unit(side - axis * slope);
        const Vec3 from = base + axis * (height * share) + side * (ra + (rb - ra) * share) - normal * (2 * ulp);
        const double across = std::exp(random.uniform(-7, -2)), down = std::exp(random.uniform(-15, -10));
        const auto ray = ray_from<N>(from, generator + cross(generator, normal) * across - normal * down, s.shape.tag,
                                     false);
        const Roots exact = roots(s.shape, ray);
        if (exact.count != 1 || exact.t[0] < 0.1)
            continue;
        const auto w = real(ray.origin) + real(ray.direction) * (exact.t[0] / 2) - real(s.shape.middle);
        const Real z = dot(w, real(s.shape.axis)), x = length(w - real(s.shape.axis) * z);
        const Real outside = value(s.shape.cosine) * x - std::ldexp(Real(value(s.shape.rho0)), -s.shape.fine)
            - value(s.shape.sine) * z;
        // The error of B moves the end along the generator, which may be past a rim.
        const Real end = z + dot(real(ray.direction), real(s.shape.axis)) * exact.t[0] / 2;
        const bool at_rim = std::fabs(end) > std::ldexp(Real(value(s.shape.half)), -s.shape.fine) - exact.t[0] / 4;
        if (outside > -16 * ulp || outside < -32 * ulp || at_rim)
            continue;
        chords++;
        typename N::Length t{};
        lost += !s.hit(ray, M::length(100), t) || value(t) < exact.t[0] / 2;
        auto unnamed = ray;
        unnamed.from = {Tag::none};
        lost_unnamed += !s.hit(unnamed, M::length(100), t) || value(t) < exact.t[0] / 2;
    }
    EXPECT_GT(chords, 3000);
    EXPECT_EQ(lost, 0);
    EXPECT_EQ(lost_unnamed, 0);
}

TYPED_TEST(ConeTest, CrossingsAreCountedBeforeTheLight)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, -2, 0}, 1, {0, 2, 0}, 1);
    const auto ray = M::ray({-5, 0, 0}, {1, 0, 0}); // crosses at 4 and 6
    EXPECT_EQ(s.crossings(ray, M::length(3.5)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(5)), 1);
    EXPECT_EQ(s.crossings(ray, M::length(7)), 2);
    EXPECT_EQ(s.crossings(ray, limit), 2);
    EXPECT_EQ(s.crossings(ray, M::length(4)), 0); // a light on the surface
    EXPECT_EQ(s.crossings(ray, M::length(6)), 1);
    EXPECT_EQ(s.crossings(M::ray({0, 0, 0}, {1, 0, 0}), M::length(5)), 1);
    EXPECT_EQ(s.crossings(M::ray({0, 5, 0}, {0, -1, 0}), limit), 0);
}

TYPED_TEST(ConeTest, NormalsAreClosedForms)
{
    QRAY_SHAPE_TEST;
    const double near = 8 * M::length_ulp(8);
    const ConeOf<N> cylinder({0, -2, 0}, 1, {0, 2, 0}, 1);
    expect_near(cylinder.normal(M::ray({-5, 0, 0}, {1, 0, 0})), {-1, 0, 0}, near);
    expect_near(cylinder.normal(M::ray({0, 0, 0}, {1, 0, 0})), {1, 0, 0}, near); // outward, seen from inside too
    expect_near(cylinder.normal(M::ray({-5, 1, 0.6}, {1, 0, 0})), {-0.8, 0, 0.6}, near);
    // 3 wide and 4 high: the normal has the sides of the triangle, exchanged.
    const ConeOf<N> cone({0, 0, 0}, 3, {0, 4, 0}, 0);
    expect_near(cone.normal(M::ray({-8, 1, 0}, {1, 0, 0})), {-0.8, 0.6, 0}, near);
    expect_near(cone.normal(M::ray({0, 2, 8}, {0, 0, -1})), {0, 0.6, 0.8}, near);
    const ConeOf<N> widening({0, 0, 0}, 1, {0, 4, 0}, 4);
    expect_near(widening.normal(M::ray({-8, 1, 0}, {1, 0, 0})), {-0.8, -0.6, 0}, near);
}

TYPED_TEST(ConeTest, NormalsAreUnitAndAcrossTheGenerator)
{
    QRAY_SHAPE_TEST;
    Random random(41);
    double worst_length = 0, worst = 0;
    int hits = 0;
    for (int i = 0; i < 10000; i++) {
        const Vec3 base = random.point(2), apex = base + random.direction() * random.uniform(1, 4);
        const ConeOf<N> s(base, random.uniform(0.5, 2), apex, random.uniform(0.5, 2));
        const Vec3 from = random.point(7);
        const auto ray = M::ray(from, random.point(3) - from);
        const Roots exact = roots(s.shape, ray);
        if (!exact.clear || exact.count == 0 || !s.hit(ray, limit, t))
            continue;
        hits++;
        const Vec3 n = s.normal(ray);
        // Away from the axis by the cosine, along it by minus the sine.
        const auto q = rounded(real(ray.origin) + real(ray.direction) * exact.t[0]) - value(s.shape.middle);
        const Vec3 axis = value(s.shape.axis);
        const Vec3 across = unit(q - axis * dot(q, axis));
        const Vec3 expected = across * value(s.shape.cosine) - axis * value(s.shape.sine);
        worst = std::fmax(worst, distance(n, expected) / M::length_ulp(10));
        worst_length = std::fmax(worst_length, std::fabs(length(n) - 1) / M::unit_ulp());
    }
    EXPECT_GT(hits, 500);
    EXPECT_LE(worst_length, 2); // of three components, each within 1 ulp
    // At a radius of half a unit the error of the point counts twice.
    EXPECT_LE(worst, 2);
}

// However far the ray has come: so that a ray that leaves from there starts on the right side.
TYPED_TEST(ConeTest, PointOfAHitLiesOnTheSurface)
{
    QRAY_SHAPE_TEST;
    Random random(42);
    double worst = 0;
    int hits = 0;
    for (int i = 0; i < 10000; i++) {
        const Vec3 base = random.point(2), apex = base + random.direction() * random.uniform(1, 4);
        const ConeOf<N> s(base, random.uniform(0.5, 2), apex, random.uniform(0, 2));
        const Vec3 from = random.direction() * 14;
        const auto ray = M::ray(from, random.point(3) - from);
        if (!s.hit(ray, limit, t))
            continue;
        hits++;
        Vec3 q, n;
        s.surface(ray, q, n);
        // c |x_perp| = rho0 + s z.
        const auto w = real(q) - real(s.shape.middle), axis = real(s.shape.axis);
        const Real z = dot(w, axis), rho = length(w - axis * z);
        const Real rho0 = std::ldexp(Real(value(s.shape.rho0)), -s.shape.fine);
        const Real off = value(s.shape.cosine) * rho - rho0 - value(s.shape.sine) * z;
        worst = std::fmax(worst, static_cast<double>(std::fabs(off)) / M::length_ulp(8));
    }
    EXPECT_GT(hits, 500);
    EXPECT_LE(worst, 3);
}

// A thin cylinder whose axis lies between two ulp: seen along z, a shift of the axis by a shows in the normal as -a/r.
TEST(ConeOfQ32, MiddleIsFinerThanAnUlp)
{
    using N = q32;
    using M = make<N>;
    const double r = 1.0 / 64, ulp = std::ldexp(1, -24), shift = 0.375 * ulp;
    ConeOf<N> s({0.25, -0.5 - r, 40}, r, {0.25, -0.5 + r, 40}, r);
    ASSERT_EQ(s.shape.fine, 8); // 2^8 (r sqrt(2) + 1/16) is below 40, twice that is not
    s.shape.rounded = {-96, 96, 0}; // the rounded middle less the exact one, in 2^-32
    Vec3 q, n;
    s.surface(M::ray({0.25, -0.5, 0}, {0, 0, 1}), q, n);
    EXPECT_NEAR(n.x, -shift / r, std::ldexp(2, -32) / r); // two roundings in the block scale
    EXPECT_EQ(n.y, 0);
    EXPECT_NEAR(n.z, -1, 2 * M::unit_ulp());
    EXPECT_EQ(q.x, 0.25);
    EXPECT_NEAR(q.z, 40 - r, ulp);
}

} // namespace
