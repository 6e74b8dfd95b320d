// Checker, stripes, gradient, rings, noise, marble, wood and brick, each against its definition.
#include <qray/texture/brick.hpp>
#include <qray/texture/checker.hpp>
#include <qray/texture/gradient.hpp>
#include <qray/texture/marble.hpp>
#include <qray/texture/noise.hpp>
#include <qray/texture/rings.hpp>
#include <qray/texture/stripes.hpp>
#include <qray/texture/wood.hpp>

#include "texture_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct TextureTest : ::testing::Test {};
TYPED_TEST_SUITE(TextureTest, NumberSystems, SystemNames);

const Vec3 m_colour{0.25, 1, 0.125}, n_colour{0.75, 0, 0.5}; // of few bits

template <class N>
Vec<typename N::Unit> m()
{
    return make<N>::vector(m_colour.x, m_colour.y, m_colour.z);
}
template <class N>
Vec<typename N::Unit> n()
{
    return make<N>::vector(n_colour.x, n_colour.y, n_colour.z);
}
// How much of N is in a colour.
Real share(const Vec3& colour)
{
    return (colour.x - m_colour.x) / (n_colour.x - m_colour.x);
}

// Calls check(placing, axis, q, p) for many places.
template <class N, class F>
void everywhere(uint64_t seed, F check)
{
    Random random(seed);
    for (int i = 0; i < 4000; i++) {
        const Placing at{std::exp2(random.uniform(-2, 3)), random.point(8),
                         std::ldexp(1, static_cast<int>(random.bits() % 3))};
        const Vec3 axis = random.direction();
        const auto q = make<N>::point(random.point(15));
        check(at, axis, q, texture_point<N>(at, q));
    }
}

template <class N>
double place_tolerance(const Placing& at)
{
    return test::place_tolerance<N>(at, 26);
}
// Whether floor(p + offset) is the same for all that p may be taken for.
template <class N>
bool settled(const Placing& at, Real p)
{
    return from_integer(p) > place_tolerance<N>(at);
}

TYPED_TEST(TextureTest, CheckerIsTheParityOfThreeFloors)
{
    using N = TypeParam;
    int odd_ones = 0;
    everywhere<N>(80, [&](const Placing& at, const Vec3&, const Point<N>& q, const Vec<Real>& p) {
        const Real e = texture_epsilon;
        if (!settled<N>(at, p.x + e) || !settled<N>(at, p.y + e) || !settled<N>(at, p.z + e))
            return;
        const Checker<N> texture{n<N>(), make_lattice<N>(at, static_cast<double>(e))};
        const bool odd = is_odd(std::floor(p.x + e) + std::floor(p.y + e) + std::floor(p.z + e));
        odd_ones += odd;
        ASSERT_EQ(value(texture(m<N>(), q)), odd ? n_colour : m_colour);
    });
    EXPECT_GT(odd_ones, 1000);
    EXPECT_LT(odd_ones, 3000);
}

TYPED_TEST(TextureTest, CheckerIsCleanInALatticePlane)
{
    using N = TypeParam;
    using M = make<N>;
    // On y = 0, 1 and -3, and as far from them as a hit may lie, it is a plane board. In q16 that is an ulp, of 1/1024
    // itself, and the builder gives the texture an epsilon of half as much again.
    const Checker<N> texture{n<N>(), make_lattice<N>({}, (NarrowFixed<N> ? 1.5 : 1.0) / 1024)};
    for (double y : {0.0, 1.0, -3.0})
        for (double ulps : {-2.0, -1.0, 0.0, 1.0, 2.0})
            for (double x : {-1.5, -0.5, 0.5, 1.5})
                for (double z : {-0.5, 0.5}) {
                    const double off = NarrowFixed<N> ? ulps / 2 : ulps;
                    const auto q = M::point(x, y + off * M::length_ulp(4), z);
                    const bool odd = is_odd(Real(std::floor(x) + y + std::floor(z)));
                    EXPECT_EQ(value(texture(m<N>(), q)), odd ? n_colour : m_colour) << x << " " << y << " " << z;
                }
}

TYPED_TEST(TextureTest, StripesAreTheParityAlongAnAxis)
{
    using N = TypeParam;
    everywhere<N>(81, [&](const Placing& at, const Vec3& axis, const Point<N>& q, const Vec<Real>& p) {
        const Real along = dot(p, real(axis)) + texture_epsilon;
        if (!settled<N>(at, along))
            return;
        const Stripes<N> texture{n<N>(), make_axis<N>(at, axis, 1.0 / 1024, true)};
        ASSERT_EQ(value(texture(m<N>(), q)), is_odd(std::floor(along)) ? n_colour : m_colour);
    });
}

TYPED_TEST(TextureTest, GradientIsLinearBetweenItsEnds)
{
    using N = TypeParam;
    using M = make<N>;
    int between = 0;
    everywhere<N>(82, [&](const Placing& at, const Vec3& axis, const Point<N>& q, const Vec<Real>& p) {
        const double k = std::fmin(1, std::fmax(0, static_cast<double>(dot(p, real(axis)))));
        between += k > 0 && k < 1;
        const Gradient<N> texture{n<N>(), make_axis<N>(at, axis, 0, false)};
        expect_near(value(texture(m<N>(), q)), m_colour + (n_colour - m_colour) * k,
                    place_tolerance<N>(at) + 2 * M::unit_ulp());
    });
    EXPECT_GT(between, 200);
}

TYPED_TEST(TextureTest, RingsAreTheParityOfTheDistanceFromTheYAxis)
{
    using N = TypeParam;
    everywhere<N>(83, [&](const Placing& at, const Vec3&, const Point<N>& q, const Vec<Real>& p) {
        const Real rho = std::hypot(p.x, p.z) + texture_epsilon;
        if (from_integer(rho) < 2 * place_tolerance<N>(at))
            return;
        const Rings<N> texture{n<N>(), make_axis<N>(at, {1, 0, 0}, 0, false), make_axis<N>(at, {0, 0, 1}, 0, false)};
        ASSERT_EQ(value(texture(m<N>(), q)), is_odd(std::floor(rho)) ? n_colour : m_colour);
    });
}

// Computed apart, in Python, from the definition.
TYPED_TEST(TextureTest, LatticeNoiseIsTheDefinedHash)
{
    using N = TypeParam;
    const struct {
        uint32_t x, y, z, top;
    } known[] = {{0, 0, 0, 0x000000},          {1, 0, 0, 0xe9e294},
                 {0, 1, 0, 0xb0354b},          {0, 0, 1, 0xeeb450},
                 {1, 2, 3, 0x09147e},          {0xffffffff, 0, 0, 0xdc186d},
                 {0xffffffff, 0xfffffffe, 0xfffffffd, 0xe5b62c}, {1000000, 2000000, 3000000, 0x8047e0}};
    for (const auto& k : known) {
        const double expected = std::ldexp(k.top, -24);
        // A Unit of fewer bits has the upper ones.
        EXPECT_NEAR(value(lattice_noise<N>(k.x, k.y, k.z)), expected, std::fmax(0, make<N>::unit_ulp(0.5) - 0x1p-24));
    }
}

Real hash(Real x, Real y, Real z)
{
    const auto bits = [](Real v) { return static_cast<uint32_t>(static_cast<int64_t>(v)); };
    uint32_t h = bits(x) * 0x8da6b343u ^ bits(y) * 0xd8163841u ^ bits(z) * 0xcb1ab31fu;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    h ^= h >> 15;
    return std::ldexp(static_cast<Real>(h >> 8), -24);
}

// The blend as a sum of eight weighted corners.
Real noise_of(const Vec<Real>& p)
{
    const Vec<Real> cell{std::floor(p.x), std::floor(p.y), std::floor(p.z)}, f = p - cell;
    const auto weight = [](Real t, int upper) {
        const Real s = t * t * (3 - 2 * t);
        return upper != 0 ? s : 1 - s;
    };
    Real sum = 0;
    for (int i = 0; i < 8; i++)
        sum += weight(f.x, i & 1) * weight(f.y, i & 2) * weight(f.z, i & 4)
            * hash(cell.x + (i & 1), cell.y + (i >> 1 & 1), cell.z + (i >> 2));
    return sum;
}

TYPED_TEST(TextureTest, SmoothstepIsItsPolynomial)
{
    using N = TypeParam;
    using M = make<N>;
    EXPECT_EQ(value(smoothstep<N>(M::unit(0))), 0);
    EXPECT_EQ(value(smoothstep<N>(M::unit(1))), 1);
    for (int i = 1; i < 1000; i++) {
        const double f = value(M::unit(i / 1000.));
        ASSERT_NEAR(value(smoothstep<N>(M::unit(f))), f * f * (3 - 2 * f), 3 * M::unit_ulp());
    }
}

TYPED_TEST(TextureTest, NoiseIsTheSmoothBlendOfEightCorners)
{
    using N = TypeParam;
    using M = make<N>;
    everywhere<N>(84, [&](const Placing& at, const Vec3&, const Point<N>& q, const Vec<Real>& p) {
        const Noise<N> texture{n<N>(), make_lattice<N>(at, 0)};
        // Its slope is at most 3/2 along each axis; 8 ulp are its own, and the blend of the colours adds one.
        const double tolerance = 4.5 * place_tolerance<N>(at) + 9 * M::unit_ulp();
        ASSERT_NEAR(static_cast<double>(share(value(texture(m<N>(), q)))), static_cast<double>(noise_of(p)),
                    2 * tolerance);
    });
}

TYPED_TEST(TextureTest, MarbleIsVeinsBentByTurbulence)
{
    using N = TypeParam;
    using M = make<N>;
    everywhere<N>(85, [&](const Placing& at, const Vec3& axis, const Point<N>& q, const Vec<Real>& p) {
        const Marble<N> texture{n<N>(), make_lattice<N>(at, 0), make_axis<N>(at, axis, 0, true)};
        Real turbulence = 0;
        for (int octave = 0; octave < 4; octave++)
            turbulence += noise_of(p * std::ldexp(Real(1), octave)) * std::ldexp(Real(1), -octave);
        Real w = dot(p, real(axis)) + 2 * turbulence;
        w -= std::floor(w);
        const Real s = 1 - std::fabs(2 * w - 1);
        const double expected = static_cast<double>(s * s * (3 - 2 * s));
        // d(expected)/dw <= 3; w moves with the place by 1 + 2 * 4 octaves * 4.5 and has 30 roundings or so of its own.
        const double tolerance = 3 * (37 * place_tolerance<N>(at) + 60 * M::unit_ulp());
        ASSERT_NEAR(static_cast<double>(share(value(texture(m<N>(), q)))), expected, 2 * tolerance);
    });
}

TYPED_TEST(TextureTest, WoodIsGrowthRingsAroundAnAxis)
{
    using N = TypeParam;
    using M = make<N>;
    everywhere<N>(86, [&](const Placing& at, const Vec3& axis, const Point<N>& q, const Vec<Real>& p) {
        const Vec3 e1 = unit(cross(axis, std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})),
                   e2 = cross(axis, e1);
        const Wood<N> texture{n<N>(), make_lattice<N>(at, 0), make_axis<N>(at, e1, 0, false),
                              make_axis<N>(at, e2, 0, false)};
        const Real rho = length(p - real(axis) * dot(p, real(axis)));
        Real w = rho + noise_of(p) / 2;
        const double tolerance = 5 * place_tolerance<N>(at) + 12 * M::unit_ulp();
        if (from_integer(w) < tolerance)
            return; // it jumps there
        w -= std::floor(w);
        ASSERT_NEAR(static_cast<double>(share(value(texture(m<N>(), q)))), static_cast<double>(w * w), 4 * tolerance);
    });
}

TYPED_TEST(TextureTest, BrickIsCoursesAndJoints)
{
    using N = TypeParam;
    int mortar = 0, brick = 0;
    everywhere<N>(87, [&](const Placing& at, const Vec3&, const Point<N>& q, const Vec<Real>& p) {
        Lattice<N> lattice = make_lattice<N>(at, 1.0 / 1024);
        lattice.y = make_step<N>(at, {0, 2, 0}, 1.0 / 1024);
        const Brick<N> texture{n<N>(), lattice};
        const Real e = texture_epsilon, course = 2 * p.y + e;
        const Real shift = is_odd(std::floor(course)) ? Real(1) / 2 : 0;
        const auto inside = [](Real v) { return v - std::floor(v); };
        const Real x = inside(p.x + shift + e), z = inside(p.z + shift + e), y = inside(course);
        // Away from where it jumps.
        const auto clear = [&](Real v, Real edge) {
            return from_integer(v) > 3 * place_tolerance<N>(at) && std::fabs(v - edge) > 3 * place_tolerance<N>(at);
        };
        if (!clear(x, Real(1) / 16) || !clear(z, Real(1) / 16) || !clear(y, Real(1) / 8))
            return;
        const bool joint = x < Real(1) / 16 || z < Real(1) / 16 || y < Real(1) / 8;
        (joint ? mortar : brick)++;
        ASSERT_EQ(value(texture(m<N>(), q)), joint ? n_colour : m_colour);
    });
    EXPECT_GT(mortar, 300);
    EXPECT_GT(brick, 300);
}

} // namespace
