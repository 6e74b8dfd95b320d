// The hard cases of each shape, one test a case. Whether there is a hit is decided exactly, in integers or in
// __float128 on the numbers as stored; where a number system cannot tell by its nature, the test says how near it must
// come. Polygons, and cases that need no more than integers, are in hard_catalogue.hpp.
#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

using Quad = __float128;

template <class N>
struct HardShapes : ::testing::Test {};
TYPED_TEST_SUITE(HardShapes, NumberSystems, SystemNames);

// What this system resolves at a distance of 60 from objects of size 1 and less: a unit in the last place of a
// coordinate of 32 to 64. (In fixed point the perpendicular of a ray is block-scaled: finer.)
template <class N>
double resolution()
{
    return N::is_fixed ? make<N>::length_ulp() : std::is_same_v<N, Float> ? 0x1p-17 : 0x1p-46;
}

// q16 and q24 see no millionths: the smallest differences are multiplied by this for them, to what five steps of a
// direction are 55 away.
template <class N>
constexpr double grain = ShortFixed<N> ? 0x1p14 : is_split<N> ? 0x1p8 : 1;

template <class T>
Vec<Quad> exact(const Vec<T>& v)
{
    // double holds Length and Unit of every system without rounding
    return {static_cast<Quad>(value(v.x)), static_cast<Quad>(value(v.y)), static_cast<Quad>(value(v.z))};
}

// r^2 - |p|^2 for the perpendicular p from the centre to the ray, exact to 2^-110.
template <class N>
Quad inside_of(const SphereOf<N>& s, const Ray<N>& ray)
{
    const Vec<Quad> v = exact(s.shape.centre) - exact(ray.origin), d = exact(ray.direction);
    const Quad d2 = dot(d, d), b = dot(v, d), r = static_cast<Quad>(s.radius());
    return r * r - (dot(v, v) - b * b / d2);
}

// Some unit vector across n.
Vec3 across(Random& random, const Vec3& n)
{
    for (;;) {
        const Vec3 d = random.direction(), a = d - n * dot(d, n);
        if (length(a) > 0.1)
            return unit(a);
    }
}

// --- Sphere

template <class N>
void aim_at_the_edge(double radius, double margin, double tolerance)
{
    using M = make<N>;
    Random random(71);
    int hits = 0, misses = 0;
    for (int i = 0; i < 4000; i++) {
        const Vec3 c = random.point(10), n = random.direction(), d = across(random, n);
        const SphereOf<N> s(c, radius);
        const double share = i % 2 == 0 ? 1 - margin : 1 + margin;
        const auto ray = M::ray(c + n * (radius * share) - d * 55, d);
        typename N::Length t{};
        const bool hit = s.hit(ray, N::length_max, t);
        const Quad rest = inside_of(s, ray);
        // Relative to r^2 the distance of the perpendicular from r counts twice.
        if (std::fabs(static_cast<double>(rest)) <= 2 * radius * tolerance)
            continue;
        EXPECT_EQ(hit, rest > 0) << "by " << static_cast<double>(rest) / (2 * radius);
        hit ? hits++ : misses++;
    }
    EXPECT_GT(hits, 500);
    EXPECT_GT(misses, 500);
}

TYPED_TEST(HardShapes, SphereAimedAMillionthOfItsRadiusBesideItsEdge)
{
    using N = TypeParam;
    // Float cannot: 55 radii away its coordinates end at 2^-18, four millionths.
    const double margin = std::is_same_v<N, Float> ? 1e-4 : 1e-6 * grain<N>;
    // The perpendicular has what products drop, sqrt(3)/8 ulp in q24, and half a step of its block scale in each part.
    aim_at_the_edge<N>(1, margin, resolution<N>() * (WideFixed<N> ? 0.25 : is_split<N> ? 0.5 : 4));
}

TYPED_TEST(HardShapes, SphereOfAnEleventhousandthOfItsDistance)
{
    using N = TypeParam;
    if (std::is_same_v<N, q16>) // of a tenth of a pixel: its smallest are of five ulp
        return aim_at_the_edge<N>(0.05, 0.5, 8 * resolution<N>());
    const double margin = std::is_same_v<N, Float> ? 1e-2 : std::is_same_v<N, Double> ? 1e-6 : 2e-5 * grain<N>;
    aim_at_the_edge<N>(0.005, margin, resolution<N>() * (N::is_fixed ? 0.25 : 4));
}

TYPED_TEST(HardShapes, SphereLeftAlmostAlongItsTangentIsNotMetAgain)
{
    QRAY_SHAPE_TEST;
    Random random(72);
    const Tag tag = make_tag(3, 0);
    for (int i = 0; i < 2000; i++) {
        const Vec3 c = random.point(20), n = random.direction();
        const double r = std::exp(random.uniform(-4, 2));
        const SphereOf<N> s(c, r, tag);
        const Vec3 d = unit(across(random, n) + n * 1e-5);
        EXPECT_FALSE(s.hit(ray_from<N>(c + n * r, d, tag, true), limit, t));
    }
}

// In at cos 0.3 and in at cos 1e-5: the far end of the chord, 2 r cos away.
TYPED_TEST(HardShapes, SphereEnteredIsMetAtTheFarEndOfTheChord)
{
    QRAY_SHAPE_TEST;
    Random random(73);
    const Tag tag = make_tag(3, 0);
    for (int i = 0; i < 2000; i++) {
        const Vec3 c = random.point(20), n = random.direction();
        const double r = random.uniform(0.5, 8), cosine = i % 2 == 0 ? 0.3 : 1e-5;
        const SphereOf<N> s(c, r, tag);
        const auto ray = ray_from<N>(c + n * r, across(random, n) - n * cosine, tag, false);
        ASSERT_TRUE(s.hit(ray, limit, t));
        EXPECT_GT(value(t), 0);
        const Vec<Quad> v = exact(s.shape.centre) - exact(ray.origin), d = exact(ray.direction);
        const Quad half2 = inside_of(s, ray) / dot(d, d);
        const double half = half2 > 0 ? std::sqrt(static_cast<double>(half2)) : 0;
        const double far = static_cast<double>(dot(v, d) / dot(d, d)) + half;
        // An error of the perpendicular shows r / half as large in the chord.
        const double tolerance = 4 * resolution<N>() * (1 + r / std::fmax(half, 0.5 * std::sqrt(r * resolution<N>())));
        EXPECT_NEAR(value(t), far, tolerance);
    }
}

TYPED_TEST(HardShapes, SphereSeenFromItsCentreIsItsRadiusAway)
{
    QRAY_SHAPE_TEST;
    Random random(74);
    for (int i = 0; i < 2000; i++) {
        const Vec3 c = random.point(30);
        const double r = std::exp(random.uniform(-5, 3));
        const SphereOf<N> s(c, r);
        ASSERT_TRUE(s.hit(M::ray(value(s.shape.centre), random.direction()), limit, t));
        EXPECT_NEAR(value(t), s.radius(), M::length_ulp(r) + 2 * M::unit_ulp() * r);
    }
}

TYPED_TEST(HardShapes, SphereBehindIsNotMet)
{
    QRAY_SHAPE_TEST;
    Random random(75);
    for (int i = 0; i < 2000; i++) {
        const Vec3 n = random.direction();
        const SphereOf<N> s(n * 5, 1);
        const double away = i % 2 == 0 ? 1.001 : 40;
        EXPECT_FALSE(s.hit(M::ray(n * (5 - away), n * -1 + across(random, n) * 0.01), limit, t));
    }
}

TYPED_TEST(HardShapes, ConcentricSpheresAMillionthApartAreMetInOrder)
{
    QRAY_SHAPE_TEST;
    const SphereOf<N> inner({3, 4, 5}, 1), outer({3, 4, 5}, 1 + 0x1p-20 * grain<N>);
    Random random(76);
    for (int i = 0; i < 1000; i++) {
        const Vec3 n = random.direction();
        // From the outside at up to 0.3 beside the centre; from near where t would be too coarse from afar.
        const double far = std::is_same_v<N, Float> || std::is_same_v<N, q16> ? 2 : 50;
        const auto ray = M::ray(Vec3{3, 4, 5} - n * far + across(random, n) * random.uniform(0, 0.3), n);
        typename N::Length t_outer{};
        ASSERT_TRUE(inner.hit(ray, limit, t));
        ASSERT_TRUE(outer.hit(ray, limit, t_outer));
        EXPECT_LT(value(t_outer), value(t));
        const auto from_inside = M::ray({3, 4, 5}, n);
        ASSERT_TRUE(inner.hit(from_inside, limit, t));
        ASSERT_TRUE(outer.hit(from_inside, limit, t_outer));
        EXPECT_GT(value(t_outer), value(t));
    }
}

// Between them is a shell of 2^-20: a ray that enters the outer one meets the inner, not the outer again.
TYPED_TEST(HardShapes, ShellOfAMillionthIsCrossedFaceByFace)
{
    QRAY_SHAPE_TEST;
    const Tag tag = make_tag(1, 0);
    const double thick = 0x1p-20 * grain<N>;
    const SphereOf<N> inner({0, 0, 0}, 1), outer({0, 0, 0}, 1 + thick, tag);
    Random random(77);
    for (int i = 0; i < 1000; i++) {
        const Vec3 n = random.direction();
        const auto ray = ray_from<N>(n * (1 + thick), n * -1, tag, false);
        typename N::Length t_outer{};
        ASSERT_TRUE(inner.hit(ray, limit, t));
        EXPECT_NEAR(value(t), thick, 4 * M::length_ulp(1));
        ASSERT_TRUE(outer.hit(ray, limit, t_outer));
        EXPECT_NEAR(value(t_outer), 2 + 2 * thick, 4 * M::length_ulp(2));
    }
}

// --- Plane and disc

TYPED_TEST(HardShapes, PlaneThroughTheOriginOfARayIsNotMet)
{
    QRAY_SHAPE_TEST;
    Random random(78);
    for (int i = 0; i < 2000; i++) {
        const DiscOf<N> s({0, 0, 0}, {0, 0, 1}, 60);
        const Vec3 o{random.uniform(-20, 20), random.uniform(-20, 20), 0};
        EXPECT_FALSE(s.hit(M::ray(o, random.direction()), limit, t));
    }
}

// --- Cylinder and cone

// t and whether a ray meets a frustum around the z axis, in __float128: the nearest root within the rims.
bool meets_cone(Vec<Quad> o, Vec<Quad> d, Quad r0, Quad slope, Quad half, Quad& t)
{
    const Quad a = d.x * d.x + d.y * d.y - slope * slope * d.z * d.z;
    const Quad r = r0 + slope * o.z, b = o.x * d.x + o.y * d.y - r * slope * d.z, c = o.x * o.x + o.y * o.y - r * r;
    const Quad disc = b * b - a * c;
    if (disc < 0)
        return false;
    Quad root = static_cast<Quad>(std::sqrt(static_cast<long double>(disc)));
    if (root > 0)
        root = (root + disc / root) / 2;
    const Quad q = b < 0 ? root - b : -root - b;
    bool found = false;
    for (const Quad at : {a != 0 ? q / a : Quad{-1}, q != 0 ? c / q : Quad{-1}}) {
        const Quad z = o.z + at * d.z;
        if (at > 0 && z <= half && -z <= half && (!found || at < t)) {
            t = at;
            found = true;
        }
    }
    return found;
}

// The wall is 1e4 radii along the ray: cylinders with radius 0.001.
TYPED_TEST(HardShapes, CylinderSeenATenthousandthOffItsAxis)
{
    QRAY_SHAPE_TEST;
    Random random(81);
    const double coarser = std::is_same_v<N, q16> ? 64 : 1, lean = 1e-4 * coarser;
    for (int i = 0; i < 2000; i++) {
        const double r = random.uniform(0.0005, 0.002) * coarser;
        const ConeOf<N> s({0, 0, -30}, r, {0, 0, 30}, r);
        const double turn = random.uniform(0, 7);
        const auto ray = M::ray({random.uniform(-0.5, 0.5) * r, random.uniform(-0.5, 0.5) * r, -20},
                                {lean * std::cos(turn), lean * std::sin(turn), 1});
        Quad expected = 0;
        const Quad radius = static_cast<Quad>(std::ldexp(value(s.shape.rho0), -s.shape.fine));
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), radius, 0, 30, expected);
        ASSERT_EQ(s.hit(ray, limit, t), meets);
        if (meets) {
            // An ulp across is 10^4 along.
            EXPECT_NEAR(value(t), static_cast<double>(expected), 3 * M::length_ulp(0.002) / lean + 4 * resolution<N>());
        }
    }
}

TYPED_TEST(HardShapes, CylinderGrazedAFourmillionthInsideAndOutside)
{
    QRAY_SHAPE_TEST;
    const double off = 0x1p-22 * grain<N>;
    for (double z : {-1.0, 0.0, 0.7})
        for (double side : {-1.0, 1.0}) {
            const ConeOf<N> s({0, 0, -2}, 1, {0, 0, 2}, 1);
            EXPECT_TRUE(s.hit(M::ray({-5, side * (1 - off), z}, {1, 0, 0}), limit, t));
            // The chord is 2 sqrt(2 off).
            EXPECT_NEAR(value(t), 5 - std::sqrt(2 * off), 0.1 * std::sqrt(2 * off));
            EXPECT_FALSE(s.hit(M::ray({-5, side * (1 + off), z}, {1, 0, 0}), limit, t));
        }
}

TYPED_TEST(HardShapes, ConeGrazedBesideItsWall)
{
    QRAY_SHAPE_TEST;
    Random random(82);
    int hits = 0, misses = 0;
    for (int i = 0; i < 4000; i++) {
        // r = 1 + z / 2 around the z axis, grazed across its wall at height z.
        const ConeOf<N> s({0, 0, -1}, 0.5, {0, 0, 1}, 1.5);
        const double turn = random.uniform(0, 7), z = random.uniform(-0.9, 0.9);
        const Vec3 out{std::cos(turn), std::sin(turn), 0}, side{-out.y, out.x, 0};
        const Vec3 d = unit(side + unit(out * 0.5 + Vec3{0, 0, 1}) * random.uniform(-1, 1));
        const double margin = std::is_same_v<N, Float> ? 1e-4 : 1e-6 * (NarrowFixed<N> ? 2 * grain<N> : 1);
        const Vec3 n = unit(out - Vec3{0, 0, 0.5});
        const auto ray = M::ray(out * (1 + z / 2) + Vec3{0, 0, z} + n * (margin * random.uniform(-1, 1)) - d * 5, d);
        Quad expected = 0;
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{1} / 2, 1, expected);
        // Nearer than this to its wall a ray may be judged either way: the same ray a little nearer, or farther.
        Quad other = 0;
        const Quad shift = static_cast<Quad>(8 * resolution<N>());
        const Vec<Quad> step{static_cast<Quad>(n.x) * shift, static_cast<Quad>(n.y) * shift,
                             static_cast<Quad>(n.z) * shift};
        if (meets_cone(exact(ray.origin) - step, exact(ray.direction), 1, Quad{1} / 2, 1, other)
            != meets_cone(exact(ray.origin) + step, exact(ray.direction), 1, Quad{1} / 2, 1, other))
            continue;
        EXPECT_EQ(s.hit(ray, limit, t), meets);
        meets ? hits++ : misses++;
    }
    EXPECT_GT(hits, 700);
    EXPECT_GT(misses, 700);
}

TYPED_TEST(HardShapes, ConeSeenFromInsideIsMetOnce)
{
    QRAY_SHAPE_TEST;
    Random random(83);
    const ConeOf<N> s({0, 0, -1}, 0.5, {0, 0, 1}, 1.5);
    for (int i = 0; i < 4000; i++) {
        const auto ray = M::ray({random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5)},
                                random.direction());
        Quad expected = 0;
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{1} / 2, 1, expected);
        const bool hit = s.hit(ray, limit, t);
        // At a rim, to all that can be told?
        const Quad shift = static_cast<Quad>(16 * resolution<N>());
        Quad other = 0;
        if (meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{1} / 2, 1 - shift, other)
            != meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{1} / 2, 1 + shift, other))
            continue;
        ASSERT_EQ(hit, meets);
        EXPECT_EQ(s.crossings(ray, limit), meets);
        if (hit) {
            EXPECT_NEAR(value(t), static_cast<double>(expected), 32 * resolution<N>());
        }
    }
}

// Through the apex itself a ray may pass or hit; what it hits is the apex. A few ulp beside it there is no doubt.
TYPED_TEST(HardShapes, ConeHitThroughItsApex)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, 0, 0}, 1, {0, 0, 2}, 0);
    Random random(84);
    for (int i = 0; i < 1000; i++) {
        const double turn = random.uniform(0, 7);
        const Vec3 d{std::cos(turn), std::sin(turn), random.uniform(-1, 1)};
        if (s.hit(M::ray(Vec3{0, 0, 2} - unit(d) * 5, d), limit, t)) {
            EXPECT_NEAR(value(t), 5, 64 * std::sqrt(resolution<N>()) * 0.01 + 16 * resolution<N>());
        }
        // A little below the apex it is as wide as it takes, and above it there is nothing.
        const double near = NarrowFixed<N> ? 0x1p-5 : 0x1p-10, above = NarrowFixed<N> ? 0x1p-5 : 0x1p-16;
        EXPECT_TRUE(
            s.hit(M::ray({-5 * std::cos(turn), -5 * std::sin(turn), 2 - near}, {std::cos(turn), std::sin(turn), 0}),
                  limit, t));
        EXPECT_FALSE(
            s.hit(M::ray({-5 * std::cos(turn), -5 * std::sin(turn), 2 + above}, {std::cos(turn), std::sin(turn), 0}),
                  limit, t));
    }
}

// A ray in the surface: it may be met or not, but then on the generator.
TYPED_TEST(HardShapes, ConeSeenAlongAGeneratorIsMetOnItOrNot)
{
    QRAY_SHAPE_TEST;
    Random random(85);
    const ConeOf<N> s({0, 0, 0}, 3, {0, 0, 4}, 0);
    for (int i = 0; i < 1000; i++) {
        const double turn = random.uniform(0, 7);
        const Vec3 apex{0, 0, 4}, base{3 * std::cos(turn), 3 * std::sin(turn), 0};
        if (s.hit(M::ray(base + (base - apex), apex - base), limit, t)) {
            EXPECT_GE(value(t), 5 - 0.01);
            EXPECT_LE(value(t), 10 + 0.01);
        }
    }
}

// Parallel to a generator the quadratic is a line: one crossing, at C / 2B.
TYPED_TEST(HardShapes, ConeSeenParallelToAGenerator)
{
    QRAY_SHAPE_TEST;
    Random random(86);
    for (int i = 0; i < 4000; i++) {
        const ConeOf<N> s({0, 0, -2}, 3, {0, 0, 2}, 0); // r = 1.5 - 3/4 z
        const double turn = random.uniform(0, 7), off = i % 2 == 0 ? 0 : 1e-6;
        const Vec3 g{-0.6 * std::cos(turn), -0.6 * std::sin(turn), 0.8};
        const Vec3 through{random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), random.uniform(-1, 0.5)};
        const auto ray = M::ray(through - g * 12, g + random.direction() * off);
        Quad expected = 0;
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), Quad{3} / 2, Quad{-3} / 4, 2, expected);
        const double z = static_cast<double>(exact(ray.origin).z + expected * exact(ray.direction).z);
        const bool hit = s.hit(ray, limit, t);
        if (meets && std::fabs(std::fabs(z) - 2) < 1e-3)
            continue;
        ASSERT_EQ(hit, meets);
        if (hit) {
            // The slope of the wall against the ray: it runs almost along it.
            EXPECT_NEAR(value(t), static_cast<double>(expected), 256 * resolution<N>());
        }
    }
}

TYPED_TEST(HardShapes, OtherNappeIsNeverMet)
{
    QRAY_SHAPE_TEST;
    Random random(87);
    const ConeOf<N> s({0, 0, 0}, 1, {0, 0, 2}, 0);
    for (int i = 0; i < 2000; i++) {
        const Vec3 target{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(2.01, 4)};
        const double turn = random.uniform(0, 7);
        EXPECT_FALSE(
            s.hit(M::ray(target - Vec3{6 * std::cos(turn), 6 * std::sin(turn), 0}, {std::cos(turn), std::sin(turn), 0}),
                  limit, t));
    }
}

// From the wall inward, up and down: the far wall, or out at an open end.
TYPED_TEST(HardShapes, ConeEnteredFromBelowAndFromAbove)
{
    QRAY_SHAPE_TEST;
    Random random(88);
    const Tag tag = make_tag(4, 0);
    const ConeOf<N> s({0, 0, -1}, 1.5, {0, 0, 1}, 0.5, tag); // r = 1 - z / 2
    for (int i = 0; i < 4000; i++) {
        const double turn = random.uniform(0, 7), z = random.uniform(-0.9, 0.9), r = 1 - z / 2;
        const Vec3 out{std::cos(turn), std::sin(turn), 0};
        const Vec3 n = unit(out + Vec3{0, 0, 0.5});
        Vec3 d = random.direction();
        if (dot(d, n) > 0)
            d = d * -1;
        if (dot(d, n) > -0.01)
            continue;
        const auto ray = ray_from<N>(out * r + Vec3{0, 0, z} - n * (8 * resolution<N>()), d, tag, false);
        Quad expected = 0;
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{-1} / 2, 1, expected);
        const double at = static_cast<double>(exact(ray.origin).z + expected * exact(ray.direction).z);
        if (meets && std::fabs(std::fabs(at) - 1) < 1e-3)
            continue;
        const bool hit = s.hit(ray, limit, t);
        ASSERT_EQ(hit, meets);
        if (hit) {
            EXPECT_NEAR(value(t), static_cast<double>(expected), 4096 * resolution<N>());
        }
    }
}

} // namespace
