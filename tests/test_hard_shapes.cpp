// The hard cases of each shape, one test a case. Whether there is a hit is decided exactly, in integers or in __float128 on
// the numbers as stored; where a number system cannot tell by its nature, the test says how near it must come.
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
constexpr double resolution()
{
    return std::is_same_v<N, q16> ? 0x1p-10 : N::is_fixed ? 0x1p-24 : std::is_same_v<N, Float> ? 0x1p-17 : 0x1p-46;
}

// q16 sees no millionths: the smallest differences are multiplied by this for it.
template <class N>
constexpr double grain = std::is_same_v<N, q16> ? 0x1p14 : 1;

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
    aim_at_the_edge<N>(1, margin, std::is_same_v<N, q32> ? 0x1p-26 : 4 * resolution<N>());
}

TYPED_TEST(HardShapes, SphereOfAnEleventhousandthOfItsDistance)
{
    using N = TypeParam;
    if (std::is_same_v<N, q16>) // of a tenth of a pixel: its smallest are of five ulp
        return aim_at_the_edge<N>(0.05, 0.5, 8 * resolution<N>());
    const double margin = std::is_same_v<N, Float> ? 1e-2 : std::is_same_v<N, Double> ? 1e-6 : 2e-5;
    aim_at_the_edge<N>(0.005, margin, N::is_fixed ? 0x1p-26 : 4 * resolution<N>());
}

TYPED_TEST(HardShapes, SphereTouchedByATangentOfIntegers)
{
    QRAY_SHAPE_TEST;
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (double r : {1.0, 3.0, 0.25, 0.0078125})
        for (int i = 0; i < 3; i++)
            for (int k = 1; k <= 2; k++)
                for (double sign : {-1.0, 1.0}) {
                    const Vec3 d = axes[i] * sign, side = axes[(i + k) % 3] * (r * sign);
                    const SphereOf<N> s({2, -1, 0.5}, r);
                    ASSERT_TRUE(s.hit(M::ray(Vec3{2, -1, 0.5} + side - d * 5, d), limit, t));
                    EXPECT_EQ(value(t), 5);
                    // The next coordinate out: a miss.
                    const double out = r + M::length_ulp(5);
                    EXPECT_FALSE(s.hit(M::ray(Vec3{2, -1, 0.5} + axes[(i + k) % 3] * (out * sign) - d * 5, d), limit, t));
                }
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

TYPED_TEST(HardShapes, PlaneParallelToTheRayIsMissed)
{
    QRAY_SHAPE_TEST;
    for (double height : {0.0, 1.0, -1.0, 0x1p-20}) {
        const DiscOf<N> s({0, height, 0}, {0, 1, 0}, 60);
        EXPECT_FALSE(s.hit(M::ray({-1, 0, 2}, {1, 0, 0}), limit, t));
        EXPECT_FALSE(s.hit(M::ray({-1, 0, 2}, {3, 0, -4}), limit, t));
    }
}

TYPED_TEST(HardShapes, PlaneAtASlopeOfABillionthIsMetWhereItShouldBe)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 1, 0}, 100);
    const double slope = std::is_same_v<N, q16> ? 0x1p-14 : 0x1p-30;
    const double slack = std::is_same_v<N, q16> ? 64 * 0x1p-14 + resolution<N>() / 2 : 0; // a quotient of 14 bits
    auto ray = M::ray({-60, 1, 0}, {1, 0, 0});
    ray.direction.y = M::unit(-slope);
    ASSERT_EQ(value(ray.direction.y), -slope);
    EXPECT_FALSE(s.hit(ray, limit, t)); // 2^30 away: beyond the disc, and beyond what fixed point can hold
    ray.origin.y = M::length(64 * slope);
    ASSERT_TRUE(s.hit(ray, limit, t));
    EXPECT_NEAR(value(t), 64, slack);
    ray.direction.y = M::unit(slope);
    EXPECT_FALSE(s.hit(ray, limit, t));
    ray.origin.y = M::length(-64 * slope);
    ASSERT_TRUE(s.hit(ray, limit, t));
    EXPECT_NEAR(value(t), 64, slack);
}

TYPED_TEST(HardShapes, DiscExactlyAtTheLimitIsMet)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 0, 1}, 3);
    const auto ray = M::ray({1, 1, 5}, {0, 0, -1});
    EXPECT_TRUE(s.hit(ray, M::length(5), t));
    EXPECT_FALSE(s.hit(ray, M::length(5 - M::length_ulp(4.9)), t));
}

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

// (3, 4) is 5 from the centre.
TYPED_TEST(HardShapes, DiscHoldsItsRimAndNothingBeyond)
{
    QRAY_SHAPE_TEST;
    const DiscOf<N> s({0, 0, 0}, {0, 0, 1}, 5);
    for (double x : {3.0, -3.0, 4.0, -4.0})
        for (double y : {5.0, -5.0}) {
            const double other = y < 0 ? -std::sqrt(25 - x * x) : std::sqrt(25 - x * x);
            EXPECT_TRUE(s.hit(M::ray({x, other, 7}, {0, 0, -1}), limit, t));
            const double out = x + (x < 0 ? -M::length_ulp(4) : M::length_ulp(4));
            EXPECT_FALSE(s.hit(M::ray({out, other, 7}, {0, 0, -1}), limit, t));
        }
}

// --- Polygon

// Corners and rays of integers: the owner of a ray through a corner or an edge is decided without any rounding.
TYPED_TEST(HardShapes, RayThroughACornerOfSixTrianglesHasOneOwner)
{
    QRAY_SHAPE_TEST;
    const Vec3 ring[6] = {{4, 1, 0}, {1, 3, 0}, {-3, 2, 0}, {-4, -2, 0}, {0, -5, 0}, {3, -2, 0}};
    for (int turned = 0; turned < 3; turned++) {
        const auto turn = [turned](const Vec3& v) {
            return turned == 0 ? v : turned == 1 ? Vec3{v.y, v.z, v.x} : Vec3{v.z, v.x, v.y};
        };
        std::vector<PolygonOf<N>> fan;
        for (int i = 0; i < 6; i++)
            fan.emplace_back(std::vector<Vec3>{turn({0, 0, 0}), turn(ring[i]), turn(ring[(i + 1) % 6])});
        // Through the common corner and through points of the edges, from every side.
        for (int x = -3; x <= 3; x++)
            for (int y = -3; y <= 3; y++)
                for (int edge = -1; edge < 6; edge++)
                    for (double side : {-8.0, 8.0}) {
                        const Vec3 target = edge < 0 ? Vec3{0, 0, 0} : ring[edge] * 0.5;
                        const Vec3 from = target + Vec3{static_cast<double>(x), static_cast<double>(y), side};
                        // Directions whose components are exact: 8 by small integers, as a vector that need not be unit.
                        auto ray = M::ray(turn(from), turn({0, 0, -side}));
                        const Vec3 d = turn(target - from) * 0x1p-4;
                        ray.direction = M::vector(d.x, d.y, d.z);
                        int owners = 0;
                        for (const PolygonOf<N>& f : fan)
                            owners += f.hit(ray, limit, t);
                        EXPECT_EQ(owners, 1) << x << " " << y << " " << edge << " " << side;
                    }
    }
}

// Corners and rays in steps of `step` along z: the exact answer in 128-bit integers, with its least doubled area over
// the edges for those systems that round.
struct Flat {
    int64_t x, y;
};
bool inside_exactly(const std::vector<Flat>& corners, Flat p, double& relative)
{
    bool inside = false;
    relative = 1;
    for (size_t i = 0; i < corners.size(); i++) {
        const Flat a = corners[i], b = corners[(i + 1) % corners.size()];
        const __int128 u = static_cast<__int128>(a.x - p.x) * (b.y - p.y), v = static_cast<__int128>(b.x - p.x) * (a.y - p.y);
        const double sum = std::fabs(static_cast<double>(u)) + std::fabs(static_cast<double>(v));
        // On an edge itself the answer is its owner's, and there is but one polygon: not asked.
        if (u == v && (a.x - p.x) * (b.x - p.x) <= 0 && (a.y - p.y) * (b.y - p.y) <= 0)
            relative = -1;
        if ((a.y > p.y) != (b.y > p.y)) {
            inside = inside != (b.y > p.y ? u > v : u < v);
            relative = std::fmin(relative, sum > 0 ? std::fabs(static_cast<double>(u - v)) / sum : 0);
        }
    }
    return inside;
}
template <class N>
void compare_with_integers(const std::vector<Flat>& corners, double step, int count, int64_t low_x, int64_t high_x,
                           int64_t low_y, int64_t high_y)
{
    using M = make<N>;
    std::vector<Vec3> c;
    for (const Flat& f : corners)
        c.push_back({static_cast<double>(f.x) * step, static_cast<double>(f.y) * step, 0});
    const PolygonOf<N> s(c);
    Random random(79);
    int hits = 0, decided = 0;
    for (int i = 0; i < count; i++) {
        const auto pick = [&random](int64_t low, int64_t high) {
            return low + static_cast<int64_t>(random.bits() % static_cast<uint64_t>(high - low + 1));
        };
        const Flat p{pick(low_x, high_x), pick(low_y, high_y)};
        const auto ray = M::ray({static_cast<double>(p.x) * step, static_cast<double>(p.y) * step, 3}, {0, 0, -1});
        typename N::Length t{};
        double relative = 0;
        const bool expected = inside_exactly(corners, p, relative);
        // Two rounded products of floats tell areas apart down to 3 epsilon of their sum (Shewchuk 1997).
        if (relative <= (std::is_same_v<N, Float> ? 3 * 0x1p-24 : -1))
            continue;
        decided++;
        const bool hit = s.hit(ray, N::length_max, t);
        EXPECT_EQ(hit, expected) << p.x << " " << p.y;
        if (hit) {
            EXPECT_EQ(value(t), 3);
        }
        hits += hit;
    }
    EXPECT_GT(hits, count / 10);
    EXPECT_GT(decided, count * 8 / 10);
}

// 168 steps of 2^-24 are 1.0014e-5.
TYPED_TEST(HardShapes, SliverOf50ByAHundredthousandthIsExact)
{
    const std::vector<Flat> corners = {{-25 * 1024, 0}, {25 * 1024, 0}, {7 * 1024, 168}};
    // In two scales at once: x in 1024ths, y in 2^-24 (q16: 2^-10); floats hold both.
    constexpr double thin = 0x1p-24 * grain<TypeParam>;
    using N = TypeParam;
    using M = make<N>;
    std::vector<Vec3> c;
    for (const Flat& f : corners)
        c.push_back({static_cast<double>(f.x) / 1024, static_cast<double>(f.y) * thin, 0});
    const PolygonOf<N> s(c);
    Random random(80);
    int hits = 0;
    for (int i = 0; i < 20000; i++) {
        const Flat p{static_cast<int64_t>(random.bits() % 51200) - 25600, static_cast<int64_t>(random.bits() % 180) - 6};
        typename N::Length t{};
        double relative = 0;
        const bool expected = inside_exactly(corners, p, relative);
        if (relative <= (std::is_same_v<N, Float> ? 3 * 0x1p-24 : -1))
            continue;
        const bool hit = s.hit(M::ray({static_cast<double>(p.x) / 1024, static_cast<double>(p.y) * thin, 3}, {0, 0, -1}),
                               N::length_max, t);
        EXPECT_EQ(hit, expected) << p.x << " " << p.y;
        hits += hit;
    }
    EXPECT_GT(hits, 5000);
}

// 3355 steps of 2^-24 are 2e-4, far from the origin in fixed point.
TYPED_TEST(HardShapes, TriangleOfAFiveThousandthIsExact)
{
    constexpr double step = 0x1p-24 * grain<TypeParam>;
    compare_with_integers<TypeParam>({{0, 0}, {3355, 17}, {1211, 2903}}, step, 20000, -100, 3500, -100, 3000);
    if (TypeParam::is_fixed) {
        const int64_t far = static_cast<int64_t>(30 / step);
        compare_with_integers<TypeParam>({{far, -far}, {far + 3355, 17 - far}, {far + 1211, 2903 - far}}, step, 20000, far - 100,
                                         far + 3500, -far - 100, -far + 3000);
    }
}

// Steps that each system holds exactly in numbers up to 62.
template <class N>
constexpr int64_t steps = std::is_same_v<N, q16> ? 1024 : 4096;

TYPED_TEST(HardShapes, TriangleAsLargeAsTheWorldIsExact)
{
    constexpr int64_t n = steps<TypeParam>;
    compare_with_integers<TypeParam>({{-62 * n, -62 * n + 1}, {62 * n, -61 * n}, {5, 62 * n - 3}}, 1.0 / n, 20000, -62 * n, 62 * n,
                                     -62 * n, 62 * n);
}

TYPED_TEST(HardShapes, ConcavePolygonOf144CornersIsExact)
{
    constexpr int64_t n = steps<TypeParam>;
    std::vector<Flat> star;
    for (int i = 0; i < 144; i++) {
        const double a = 2 * M_PI * i / 144, r = static_cast<double>((i % 2 == 0 ? 30 : 17) * n);
        star.push_back({std::llrint(r * std::cos(a)), std::llrint(r * std::sin(a))});
    }
    compare_with_integers<TypeParam>(star, 1.0 / n, 20000, -30 * n, 30 * n, -30 * n, 30 * n);
}

TYPED_TEST(HardShapes, PolygonWithoutAreaIsNeverMet)
{
    QRAY_SHAPE_TEST;
    // Corners in a line, in integers: no parity is odd, whatever the ray.
    PolygonOf<N> s({{-4, -2, 1}, {0, 0, 1}, {4, 2, 1}});
    s.shape.normal = M::direction({0, 0, 1});
    PolygonOf<N> doubled({{1, 1, 1}, {3, 2, 1}, {3, 2, 1}, {1, 1, 1}});
    doubled.shape.normal = M::direction({0, 0, 1});
    for (int x = -5; x <= 5; x++)
        for (int y = -5; y <= 5; y++) {
            EXPECT_FALSE(s.hit(M::ray({static_cast<double>(x), y * 0.5, 4}, {0, 0, -1}), limit, t));
            EXPECT_FALSE(doubled.hit(M::ray({static_cast<double>(x), y * 0.5, 4}, {0, 0, -1}), limit, t));
        }
}

// Seen exactly edge on a polygon is a line, of which even parity is all there is.
TYPED_TEST(HardShapes, PolygonIsNotMetByARayInItsPlane)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s({{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
    for (int x = -6; x <= 6; x++)
        for (int z = -6; z <= 6; z++) {
            auto ray = M::ray({static_cast<double>(x), 0, static_cast<double>(z)}, {1, 0, 0});
            EXPECT_FALSE(s.hit(ray, limit, t));
            ray.direction = M::vector(0.5, 0, 0.25);
            EXPECT_FALSE(s.hit(ray, limit, t));
        }
}

// Seen at 2^-30 from edge on: between its nearest and its farthest corner, if at all.
TYPED_TEST(HardShapes, PolygonAlmostEdgeOnIsMetWithinItself)
{
    QRAY_SHAPE_TEST;
    const PolygonOf<N> s({{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
    for (int i = 0; i < 200; i++) {
        auto ray = M::ray({-20, (i - 100) * 0x1p-24, 1}, {1, 0, 0});
        ray.direction.y = M::unit(i < 100 ? 0x1p-30 : -0x1p-30);
        if (s.hit(ray, limit, t)) {
            EXPECT_GE(value(t), 16);
            EXPECT_LE(value(t), 24);
        }
    }
}

// --- Cylinder and cone

TYPED_TEST(HardShapes, CylinderIsNotMetAlongItsAxis)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, 0, -3}, 1, {0, 0, 3}, 1);
    for (double x : {0.0, 0.5, 0.999, 1.001, 2.0})
        for (double z : {-10.0, 0.0, 10.0}) {
            EXPECT_FALSE(s.hit(M::ray({x, 0, z}, {0, 0, 1}), limit, t)) << x;
            EXPECT_FALSE(s.hit(M::ray({x, 0, z}, {0, 0, -1}), limit, t)) << x;
        }
}

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
        const Quad radius = static_cast<Quad>(value(s.shape.rho0)) / static_cast<Quad>(1 << s.shape.fine);
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
        const double margin = std::is_same_v<N, Float> ? 1e-4 : 1e-6 * (IsNarrow<N> ? 2 * grain<N> : 1);
        const Vec3 n = unit(out - Vec3{0, 0, 0.5});
        const auto ray = M::ray(out * (1 + z / 2) + Vec3{0, 0, z} + n * (margin * random.uniform(-1, 1)) - d * 5, d);
        Quad expected = 0;
        const bool meets = meets_cone(exact(ray.origin), exact(ray.direction), 1, Quad{1} / 2, 1, expected);
        // Nearer than this to its wall a ray may be judged either way: the same ray a little nearer, or farther.
        Quad other = 0;
        const Quad shift = static_cast<Quad>(8 * resolution<N>());
        const Vec<Quad> step{static_cast<Quad>(n.x) * shift, static_cast<Quad>(n.y) * shift, static_cast<Quad>(n.z) * shift};
        if (meets_cone(exact(ray.origin) - step, exact(ray.direction), 1, Quad{1} / 2, 1, other)
            != meets_cone(exact(ray.origin) + step, exact(ray.direction), 1, Quad{1} / 2, 1, other))
            continue;
        EXPECT_EQ(s.hit(ray, limit, t), meets);
        meets ? hits++ : misses++;
    }
    EXPECT_GT(hits, 700);
    EXPECT_GT(misses, 700);
}

TYPED_TEST(HardShapes, CylinderHoldsItsRimsAndNothingBeyond)
{
    QRAY_SHAPE_TEST;
    const ConeOf<N> s({0, 0, -2}, 1, {0, 0, 2}, 1);
    for (double z : {-2.0, 2.0}) {
        EXPECT_TRUE(s.hit(M::ray({-5, 0.25, z}, {1, 0, 0}), limit, t));
        const double out = z + std::copysign(M::length_ulp(2.1), z);
        EXPECT_FALSE(s.hit(M::ray({-5, 0.25, out}, {1, 0, 0}), limit, t));
    }
}

TYPED_TEST(HardShapes, ConeSeenFromInsideIsMetOnce)
{
    QRAY_SHAPE_TEST;
    Random random(83);
    const ConeOf<N> s({0, 0, -1}, 0.5, {0, 0, 1}, 1.5);
    for (int i = 0; i < 4000; i++) {
        const auto ray = M::ray({random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.5, 0.5)}, random.direction());
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
        const double near = IsNarrow<N> ? 0x1p-5 : 0x1p-10, above = IsNarrow<N> ? 0x1p-5 : 0x1p-16;
        EXPECT_TRUE(s.hit(M::ray({-5 * std::cos(turn), -5 * std::sin(turn), 2 - near}, {std::cos(turn), std::sin(turn), 0}), limit, t));
        EXPECT_FALSE(s.hit(M::ray({-5 * std::cos(turn), -5 * std::sin(turn), 2 + above}, {std::cos(turn), std::sin(turn), 0}), limit, t));
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
        EXPECT_FALSE(s.hit(M::ray(target - Vec3{6 * std::cos(turn), 6 * std::sin(turn), 0}, {std::cos(turn), std::sin(turn), 0}), limit, t));
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
