// The hard cases of light, textures, sampling, range, colour, camera and input: one test a case.
#include "hard_scenes.hpp"
#include "scene_helpers.hpp"
#include "texture_helpers.hpp"

#include <qray/surface/mirror.hpp>
#include <qray/surface/transmit.hpp>

#include <limits>

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct HardCases : ::testing::Test {};
TYPED_TEST_SUITE(HardCases, NumberSystems, SystemNames);

Vec3 across(Random& random, const Vec3& n)
{
    for (;;) {
        const Vec3 d = random.direction(), a = d - n * dot(d, n);
        if (length(a) > 0.1)
            return unit(a);
    }
}

const std::string view9 = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 9 9\n";

// --- Refraction

template <class N>
bool bend(const Direction<N>& d, const Direction<N>& n, double eta, Direction<N>& out)
{
    return refracted<N>(d, n, N::unit(qray::dot<N>(d, n)), make<N>::eta(eta), out);
}

// A millionth of a radian to either side, where the root of k falls like 1.5e-3; in q16, whose directions have 14 bits,
// a sixtieth of a radian.
TYPED_TEST(HardCases, RefractionAMillionthOffTheCriticalAngle)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(91);
    const double near = NarrowFixed<N> ? 0x1p14 * 1e-6 : 1e-6;
    for (double ior : {1.5, 1.25, 2.4, 1.0625}) {
        const double index = value(M::eta(ior)), critical = std::asin(1 / index);
        for (int i = 0; i < 500; i++) {
            const Vec3 n = random.direction(), side = across(random, n);
            for (double off : {-near, near}) {
                const double angle = critical + off;
                const auto d = M::direction(side * std::sin(angle) - n * std::cos(angle));
                const auto stored_n = M::direction(n);
                Direction<N> out{};
                // What the stored vectors, not quite at that angle nor unit, say exactly.
                const auto rd = real(d), rn = real(stored_n);
                const Real c = dot(rd, rn) / (length(rd) * length(rn));
                const Real k = 1 - Real(index) * index * (1 - c * c);
                const double slack = 16 * index * M::unit_ulp();
                if (std::fabs(static_cast<double>(k)) < slack)
                    continue;
                EXPECT_EQ(bend<N>(d, stored_n, ior, out), k > 0) << ior << " " << static_cast<double>(k);
            }
        }
    }
    // And the margin is what it takes: k is 2.2e-6 and more there, above the slack of every system.
    EXPECT_GT(2 * near * std::tan(std::asin(1 / 2.4)) * 2.4 / 2.4,
              16 * 2.4 * M::unit_ulp() * (std::is_same_v<N, Float> ? 0 : 1));
}

TYPED_TEST(HardCases, IndexAMillionthOffOneLeavesThePictureAsItIs)
{
    using N = TypeParam;
    const auto draw_with = [](const char* ball) {
        EXPECT_TRUE(loaded<N>(
            "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 64 64\n l 3 4 5 1 1 1\n shadows off\n"
            "material diffuse 0.75\n texture gradient 0 0.5 1 8 1 1 0\n disc 0 0 -5 0 0 1 20\n"
            + std::string(ball)));
        return draw<N>();
    };
    const Picture without = draw_with("");
    for (const char* ior : {"1.00000095367431640625", "0.99999904632568359375"}) {
        const Picture with =
            draw_with(("material colour 0 0 0 ambient 0 transmit 1 ior " + std::string(ior) + " s 0 0 0 1.5").c_str());
        size_t differing = 0;
        int most = 0;
        for (size_t i = 0; i < with.rgb.size(); i++) {
            const int off = std::abs(with.rgb[i] - without.rgb[i]);
            differing += off > 1;
            most = std::max(most, off);
        }
        // The last thousandth of the rim deflects by more than 2^-20 sqrt(1000): still below a level of this gradient.
        EXPECT_EQ(differing, 0u) << "by up to " << most;
    }
}

TYPED_TEST(HardCases, SlabLetsOutWhatCameInParallel)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(92);
    for (double ior : {1.25, 1.5, 2.4})
        for (double degrees : {0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 85.0, 89.0}) {
            // eta and 1 / eta are each within half a unit of their own format.
            const double eta_error = std::fmax(M::template step<typename N::Eta>(ior) / ior,
                                               M::template step<typename N::Eta>(1 / ior) * ior);
            double worst = 0;
            for (int i = 0; i < 500; i++) {
                const Vec3 n = random.direction(), side = across(random, n);
                const double angle = degrees * M_PI / 180;
                const auto d = M::direction(side * std::sin(angle) - n * std::cos(angle)), stored_n = M::direction(n);
                Direction<N> inside{}, out{};
                ASSERT_TRUE(bend<N>(d, stored_n, 1 / ior, inside));
                const bool lets_out = bend<N>(inside, stored_n, ior, out);
                if (NarrowFixed<N> && !lets_out) { // k, here cos^2, may be below its own error
                    EXPECT_LE(std::cos(angle) * std::cos(angle), 2 * (eta_error + 4 * M::unit_ulp() * ior))
                        << ior << " " << degrees;
                    continue;
                }
                ASSERT_TRUE(lets_out);
                worst = std::fmax(worst, distance(value(out), value(d)));
            }
            const double tangent = std::tan(degrees * M_PI / 180);
            EXPECT_LE(worst, 4 * M::unit_ulp() * std::fmax(1, tangent) * ior + eta_error * std::fmax(1, tangent))
                << ior << " " << degrees;
        }
}

// The eye inside of glass, all of it totally reflecting or letting out: a furnace of light 1 stays 1, with at most two
// rays for each that meets a surface.
template <class N>
void expect_bounded_in_glass(const std::string& glass)
{
    scene::Settings settings;
    settings.depth = 12;
    settings.cutoff = 0;
    ASSERT_TRUE(loaded<N>(
        "v from 0.1 0.2 0.3 at 1 0.4 0.7 up 0 1 0 angle 120 hither 1 resolution 9 9\n b 1 1 1\n ambientlight 0 0 0\n"
        "material colour 0 0 0 ambient 0 diffuse 0 mirror 0.1 transmit 0.9 ior 1.5\n"
            + glass,
        settings));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++) {
            RayCount count;
            const Vec3 light = light_at<N>(i, j, &count);
            EXPECT_LE(light.x, 1 + 64 * light_tolerance<N>());
            EXPECT_GE(light.x, 0);
            EXPECT_LE(count[RayKind::mirrored] + count[RayKind::refracted], (uint64_t{1} << 12) - 2);
        }
}
TYPED_TEST(HardCases, TotalReflectionInsideABallIsBounded) { expect_bounded_in_glass<TypeParam>("s 0 0 0 1"); }
TYPED_TEST(HardCases, TotalReflectionInsideACubeIsBounded)
{
    std::string cube;
    for (const char* face :
         {"-1 -1 1 1 -1 1 1 1 1 -1 1 1", "1 -1 -1 -1 -1 -1 -1 1 -1 1 1 -1", "1 -1 1 1 -1 -1 1 1 -1 1 1 1",
          "-1 -1 -1 -1 -1 1 -1 1 1 -1 1 -1", "-1 1 1 1 1 1 1 1 -1 -1 1 -1", "-1 -1 -1 1 -1 -1 1 -1 1 -1 -1 1"})
        cube += "p 4 " + std::string(face) + "\n";
    expect_bounded_in_glass<TypeParam>(cube);
}

// --- Reflection

TYPED_TEST(HardCases, FacingMirrorsOfWeightOneGoToTheGreatestDepth)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = scene::Settings::max_depth;
    ASSERT_TRUE(loaded<N>(view9 + "b 0 0 0\n ambientlight 0 0 0\n material colour 0 0 0 mirror 1\n"
                                  "disc 0 0 -3 0 0 1 30\n disc 0 0 8 0 0 1 30\n", settings));
    RayCount count;
    const Vec3 light = light_at<N>(4, 4, &count);
    EXPECT_EQ(light.x, 0);
    EXPECT_EQ(count[RayKind::mirrored], uint64_t{scene::Settings::max_depth - 1});
}

// Two mirrors of a half that shine with 1/2 themselves: 1/2 sum 2^-k over 40 depths is 1 - 2^-40.
TYPED_TEST(HardCases, MirrorsOfAHalfFor40Bounces)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 40;
    settings.cutoff = 0;
    ASSERT_TRUE(loaded<N>(view9 + "b 0 0 0\n ambientlight 1 1 1\n material colour 0.5 0.25 1 mirror 0.5 diffuse 0\n"
                                  "disc 0 0 -3 0 0 1 30\n disc 0 0 8 0 0 1 30\n", settings));
    RayCount count;
    // Weights below the last place of Unit end it sooner: what they would have added is less than that.
    const double sum = 1 - 0x1p-40;
    expect_light(light_at<N>(4, 4, &count), {sum, sum / 2, sum * 2}, 8 * light_tolerance<N>());
    uint64_t least = 39;
    if constexpr (N::is_fixed)
        least = N::Unit::frac - 1;
    EXPECT_GE(count[RayKind::mirrored], least);
    EXPECT_LE(count[RayKind::mirrored], 39u);
}

TYPED_TEST(HardCases, ThousandBouncesKeepTheDirectionUnit)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(93);
    for (int start = 0; start < 20; start++) {
        auto d = M::direction(random.direction());
        double worst = 0;
        for (int i = 0; i < 1000; i++) {
            const auto n = M::direction(random.direction());
            d = mirrored<N>(d, n, N::unit(qray::dot<N>(d, n)));
            worst = std::fmax(worst, std::fabs(length(value(d)) - 1));
        }
        // In q16 what one bounce may leave: half an ulp in each component and in the correction.
        const double most = NarrowFixed<N> ? (std::sqrt(3) + 1) / 2 * M::unit_ulp()
            : N::is_fixed                  ? 1e-8
                                           : 8 * M::unit_ulp();
        EXPECT_LE(worst, most);
    }
}

// --- Shadow

// A light 1e-5 high at a distance of 1 over a floor lights all of it with its cosine, and nothing else stands in its
// way.
TYPED_TEST(HardCases, LightAtACosineOfAHundredthousandth)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(
        "v from 0 5 0.001 at 0 0 0 up 0 0 -1 angle 60 hither 1 resolution 33 33\n b 0 0 0\n ambientlight 0 0 0\n"
        "l 6 6e-5 0 64 64 64\n material\n p 4 -4 0 4 4 0 4 4 0 -4 -4 0 -4\n"));
    const double h = std::tan(30 * M_PI / 180);
    for (uint32_t j = 0; j < 33; j++)
        for (uint32_t i = 0; i < 33; i++) {
            const double x = 5 * h * (2 * (i + 0.5) / 33 - 1), z = 5 * h * (2 * (j + 0.5) / 33 - 1);
            const double away = std::sqrt((6 - x) * (6 - x) + z * z), cosine = 6e-5 / away;
            // An error of the height in the last place counts 1 / away.
            const double slack = 0.02 * cosine + 4 * make<N>::length_ulp(5) / away;
            EXPECT_NEAR(light_at<N>(i, j).x, 64 * cosine, 64 * slack) << i << " " << j;
        }
}

TYPED_TEST(HardCases, LightExactlyOnASurfaceLightsTheOthersAndNotItsOwn)
{
    using N = TypeParam;
    // On the floor at (1, 0, 0), a wall at x = 3 facing it.
    ASSERT_TRUE(
        loaded<N>("v from 2 1 0 at 3 1 0 up 0 1 0 angle 20 hither 1 resolution 9 9\n b 0 0 0\n ambientlight 0 0 0\n"
                  "l 1 0 0 1 1 1\n material\n p 4 0 0 3 4 0 3 4 0 -3 0 0 -3\n p 4 3 0 -3 3 0 3 3 3 3 3 3 -3\n"));
    const double h = std::tan(10 * M_PI / 180);
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++) {
            const double y = 1 - h * (2 * (j + 0.5) / 9 - 1), z = h * (2 * (i + 0.5) / 9 - 1);
            EXPECT_NEAR(light_at<N>(i, j).x, 2 / std::sqrt(4 + y * y + z * z), 16 * light_tolerance<N>());
        }
    ASSERT_TRUE(
        loaded<N>("v from 0 3 3 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 9 9\n b 0 0 0\n ambientlight 0 0 0\n"
                  "l 1 0 0 1 1 1\n material\n p 4 -4 0 4 4 0 4 4 0 -4 -4 0 -4\n"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            EXPECT_NEAR(light_at<N>(i, j).x, 0, 16 * light_tolerance<N>());
}

TYPED_TEST(HardCases, LightOnABallIsBlockedByTheBallAlone)
{
    using N = TypeParam;
    // The light at the top of a ball of 1 around (0, 1, 0): all of the ball lies below its tangent plane, and the floor
    // behind the ball.
    ASSERT_TRUE(loaded<N>(
        "v from 0 6 0.001 at 0 0 0 up 0 0 -1 angle 40 hither 1 resolution 17 17\n b 0 0 0\n ambientlight 0 0 0\n"
        "l 0 2 0 1 1 1\n material\n p 4 -9 0 9 9 0 9 9 0 -9 -9 0 -9\n s 0 1 0 1\n"));
    const double h = std::tan(20 * M_PI / 180);
    int seen = 0;
    for (uint32_t j = 0; j < 17; j++)
        for (uint32_t i = 0; i < 17; i++) {
            const double x = 6 * h * (2 * (i + 0.5) / 17 - 1), z = 6 * h * (2 * (j + 0.5) / 17 - 1);
            if (x * x + z * z < 1.4)
                continue;
            // Every segment from the floor up to the light at the pole enters the ball there: dark.
            EXPECT_EQ(light_at<N>(i, j).x, 0) << x << " " << z;
            seen++;
        }
    EXPECT_GT(seen, 100);
}

TYPED_TEST(HardCases, LightInsideAnOpaqueBallStaysThere)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(
        view9 + "b 0 0 0\n ambientlight 0 0 0\n l 0 0 0 1 1 1\n material\n s 0 0 0 0.01\n disc 0 0 -2 0 0 1 20\n"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            EXPECT_EQ(light_at<N>(i, j).x, 0);
}

TYPED_TEST(HardCases, OccluderBeyondTheLightDoesNotBlockIt)
{
    using N = TypeParam;
    // From the floor to the light at height 1 below a lid: one that lies at it, one 1e-4 above it, one below; 0.02 in
    // q16, which holds 4 ulp for nothing between a light and what it touches, here 0.016.
    const std::string below = NarrowFixed<N> ? "0.98" : "0.9999";
    for (const std::string& lid : {std::string("1"), std::string(NarrowFixed<N> ? "1.02" : "1.0001"), below}) {
        ASSERT_TRUE(loaded<N>("v from 0 0.5 2 at 0 0 0 up 0 1 0 angle 30 hither 1 resolution 9 9\n b 0 0 0\n "
                              "ambientlight 0 0 0\n l 0 1 0 1 1 1\n"
                              "material\n p 4 -9 0 9 9 0 9 9 0 -9 -9 0 -9\n disc 0 "
                              + lid + " 0 0 1 0 5\n"));
        EXPECT_EQ(light_at<N>(4, 6).x > 0.5, lid != below) << lid;
    }
}

// --- Texture

// p = q/size to 32 and more bits, in integers: cells of 2^-15 at up to 2^20 cells away, at lattice points and beside
// them.
TYPED_TEST(HardCases, TextureCellsAMillionAwayAreRight)
{
    using N = TypeParam;
    using M = make<N>;
    const Placing at{0x1p-15, {0, 0, 0}, 1};
    const auto axis = make_axis<N>(at, {1, 0, 0}, 0, true);
    for (int64_t cell : {int64_t{0}, int64_t{1}, int64_t{-1}, int64_t{1} << 20, -(int64_t{1} << 20),
                         (int64_t{1} << 20) - 1, int64_t{700001}, int64_t{-700001}})
        for (int sixteenth = -8; sixteenth <= 8; sixteenth++) {
            const double q = (static_cast<double>(cell) + sixteenth / 16.0) * 0x1p-15;
            const Point<N> p = M::point({q, 0, 0});
            if (value(p.x) != q) // not a number of this system
                continue;
            const int64_t expected = cell + (sixteenth < 0 ? -1 : 0);
            EXPECT_EQ(axis.cell(p).index, static_cast<uint32_t>(static_cast<uint64_t>(expected)))
                << cell << " " << sixteenth;
        }
}

TYPED_TEST(HardCases, TextureOneStepBelowALatticePlane)
{
    using N = TypeParam;
    using M = make<N>;
    const Placing at{1, {0, 0, 0}, 1};
    const auto plain = make_axis<N>(at, {1, 0, 0}, 0, true), clean = make_axis<N>(at, {1, 0, 0}, 1.0 / 1024, true);
    for (int cell = -20; cell <= 20; cell++) {
        const double below = cell - M::length_ulp(31);
        EXPECT_EQ(plain.cell(M::point({static_cast<double>(cell), 0, 0})).index, static_cast<uint32_t>(cell));
        EXPECT_EQ(plain.cell(M::point({below, 0, 0})).index, static_cast<uint32_t>(cell - 1));
        // With its epsilon a texture does not see so small a step.
        EXPECT_EQ(clean.cell(M::point({static_cast<double>(cell), 0, 0})).index, static_cast<uint32_t>(cell));
        EXPECT_EQ(clean.cell(M::point({below, 0, 0})).index, static_cast<uint32_t>(cell));
    }
}

// Walls in lattice planes, at 0 and at -3: whatever side of it their points are rounded to, one colour.
TYPED_TEST(HardCases, SurfaceInALatticePlaneIsClean)
{
    using N = TypeParam;
    for (double z : {0.0, -3.0}) {
        SceneText s({1, {0, 0, 0}, false, false});
        s.view({0.4, 0.2, 6}, {0.4, 0.2, 0}, 50, 48);
        s.light({0.4, 0.2, 6}, 1);
        s.fill({1, 1, 1}, 0, 0, 1, 0, 0, 1);
        s.checker({0, 0, 0}, 1);
        s.polygon({{-9, -9, z}, {9, -9, z}, {9, 9, z}, {-9, 9, z}});
        ASSERT_TRUE(loaded<N>(s.text() + "ambientlight 1 1 1\n"));
        const Picture p = draw<N>();
        const double h = std::tan(25 * M_PI / 180) * (6 - z);
        for (uint32_t j = 0; j < 48; j++)
            for (uint32_t i = 0; i < 48; i++) {
                const double x = 0.4 + h * (2 * (i + 0.5) / 48 - 1), y = 0.2 - h * (2 * (j + 0.5) / 48 - 1);
                const double ex = x + 1.0 / 1024, ey = y + 1.0 / 1024;
                if (from_integer(ex) < 1e-4 || from_integer(ey) < 1e-4)
                    continue;
                const bool even = std::fmod(std::fabs(std::floor(ex) + std::floor(ey) + z), 2) == 0;
                EXPECT_EQ(p.at(i, j).r, even ? 255 : 0) << i << " " << j;
            }
    }
}

// --- Anti-aliasing

template <class N>
uint64_t samples_of(uint32_t i, uint32_t j, uint64_t* rays = nullptr)
{
    const auto s = storage<N>().template view<scene::desktop_effects()>();
    RayCount count;
    (void)render_pixel(s, i, j, count);
    if (rays != nullptr)
        *rays = count[RayKind::shadow] + count[RayKind::mirrored] + count[RayKind::refracted];
    return count[RayKind::camera];
}

TYPED_TEST(HardCases, DetailBelowAPixelTakesBoundedSamples)
{
    using N = TypeParam;
    for (uint32_t levels : {2u, 3u, 6u}) {
        scene::Settings settings;
        settings.levels = levels;
        settings.threshold = 0;
        // A checker of a hundredth of a pixel.
        ASSERT_TRUE(loaded<N>(view9
                                  + "b 0 0 0\n ambientlight 1 1 1\n material colour 1 1 1 diffuse 0\n texture checker "
                                    "0 0 0 0.005\n disc 0 0 0 0 0 1 20\n",
                              settings));
        for (uint32_t k = 0; k < 9; k++) {
            const uint64_t n = samples_of<N>(k, k);
            EXPECT_GE(n, 4u);
            EXPECT_LE(n, ((uint64_t{4} << (2 * levels)) - 4) / 3); // 4 + 16 + ... + 4^levels
        }
    }
}

TYPED_TEST(HardCases, FlatSceneTakesTheBaseSamplesOnly)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.levels = 5;
    ASSERT_TRUE(
        loaded<N>(view9 + "b 0.3 0.4 0.5\n ambientlight 1 1 1\n material diffuse 0\n disc 0 0 0 0 0 1 20\n", settings));
    for (uint32_t k = 0; k < 9; k++)
        EXPECT_EQ(samples_of<N>(k, 8 - k), 4u);
}

// --- Colour

TYPED_TEST(HardCases, PowersNearOneAndOfZero)
{
    using N = TypeParam;
    using M = make<N>;
    if constexpr (NarrowFixed<N>) { // the power of what lies within half an ulp of x, of which 14 bits count
        const double ulp = 0x1p-14, p = value(N::power(M::unit(1 - ulp), M::shine(10000)));
        EXPECT_GE(p, std::pow(1 - 1.5 * ulp, 10000.0));
        EXPECT_LE(p, std::pow(1 - 0.5 * ulp, 10000.0));
    } else {
        const auto x = M::unit(1 - 0x1p-16);
        // 24 multiplications, each of which doubles the error before it; fixed point works on 1 - x instead.
        const double tolerance = N::is_fixed ? 0x1p-28 : 10000 * M::unit_ulp(0.5);
        EXPECT_NEAR(value(N::power(x, M::shine(10000))), std::pow(1 - 0x1p-16, 10000.0), tolerance);
    }
    EXPECT_EQ(value(N::power(M::unit(0), M::shine(0))), 1);
    EXPECT_EQ(value(N::power(M::unit(0), M::shine(1))), 0);
    EXPECT_EQ(value(N::power(M::unit(0), M::shine(0.5))), 0);
    for (double v : {0.0, 1e-9, 0.1, 0.5, 1.0})
        EXPECT_EQ(value(N::power(M::unit(v), M::shine(0))), 1) << v;
    EXPECT_EQ(value(N::power(M::unit(1), M::shine(1e6))), 1);
}

TYPED_TEST(HardCases, SixteenLightsOfOneSaturate)
{
    using N = TypeParam;
    std::string lights;
    for (int i = 0; i < 16; i++)
        lights += "l 0 0 5 1 1 1\n";
    ASSERT_TRUE(loaded<N>(view9 + lights
                          + "b 0 0 0\n ambientlight 0 0 0\n material highlight 1 shine 3\n disc 0 0 0 0 0 1 20\n"));
    expect_light(light_at<N>(4, 4), {32, 32, 32}, 64 * light_tolerance<N>());
    const Picture p = draw<N>();
    for (uint8_t byte : p.rgb)
        EXPECT_EQ(byte, 255);
}

TYPED_TEST(HardCases, SixtyfourLightsOfSixtyfourSaturate)
{
    using N = TypeParam;
    std::string lights;
    for (int i = 0; i < 64; i++)
        lights += "l 0 0 5 64 64 64\n";
    scene::Settings settings;
    settings.depth = 64;
    // Two mirrors of weight 1 that gather it 64 times over: 64 * 64 * 2 * 64 = 2^19.
    ASSERT_TRUE(loaded<N>(view9 + lights
                              + "b 64 64 64\n ambientlight 64 64 64\n material highlight 1 mirror 1\n disc 0 0 0 0 0 1 "
                                "20\n disc 0 0 9 0 0 -1 20\n",
                          settings));
    const Picture p = draw<N>();
    for (uint8_t byte : p.rgb)
        EXPECT_EQ(byte, 255);
}

TYPED_TEST(HardCases, SixtyfourSamplesOfWhiteAreWhite)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.grid = 8;
    ASSERT_TRUE(
        loaded<N>(view9 + "b 1 1 1\n ambientlight 1 1 1\n material diffuse 0\n disc 0 0 0 0 0 1 1\n", settings));
    const Picture p = draw<N>();
    for (uint8_t byte : p.rgb)
        EXPECT_EQ(byte, 255);
}

// --- Camera and input

scene::Error error_of(const std::string& text)
{
    scene::Error error;
    EXPECT_FALSE(parse("x.nff", text.data(), text.size(), description(), error)) << text;
    const std::string message = error.text;
    EXPECT_EQ(message.rfind("x.nff:", 0), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return error;
}
std::string camera(const std::string& up, const std::string& angle, const std::string& resolution)
{
    return "v from 0 0 5 at 0 0 0 up " + up + " angle " + angle + " hither 1 resolution " + resolution + "\n";
}

TEST(HardCamera, UpAlongTheViewIsAnError)
{
    error_of(camera("0 0 1", "45", "9 9"));
    error_of(camera("0 0 -3e-7", "45", "9 9"));
    error_of(camera("0 0 0", "45", "9 9"));
}
TEST(HardCamera, AngleOf0And180AreErrors)
{
    for (const char* angle : {"0", "180", "-1", "181", "1e9"})
        error_of(camera("0 1 0", angle, "9 9"));
}
TEST(HardCamera, NoPixelsAreAnError)
{
    for (const char* resolution : {"0 0", "0 9", "9 0", "-1 9", "1.5 9", "1e9 9"})
        error_of(camera("0 1 0", "45", resolution));
}
TYPED_TEST(HardCases, CameraOfASinglePixel)
{
    using N = TypeParam;
    for (const char* angle : {"45", "1e-9", "179.999", "4.9e-324"}) {
        ASSERT_TRUE(loaded<N>(camera("0 1 0", angle, "1 1")
                              + "b 0 0 0\n ambientlight 1 1 1\n material colour 0.2 0.4 1 diffuse 0\n s 0 0 0 1\n"));
        const Picture p = draw<N>();
        EXPECT_EQ(p.at(0, 0).r, 51) << angle;
        EXPECT_EQ(p.at(0, 0).g, 102);
        EXPECT_EQ(p.at(0, 0).b, 255);
    }
}

TEST(HardInput, WhatIsNoNumberIsAnError)
{
    for (const char* number :
         {"nan", "NaN", "inf", "-inf", "infinity", "1e400", "-1e400", "0x10", "1e", "--1", "1.2.3", ".", "+", "1e+"})
        error_of(camera("0 1 0", "45", "9 9") + "s 0 0 0 " + number + "\n");
}
TEST(HardInput, ALengthTooLargeIsAnError)
{
    error_of(camera("0 1 0", "45", "9 9") + "s 0 0 1e300 1\n");
    error_of(camera("0 1 0", "45", "9 9") + "s 0 0 0 1e300\n");
}
TYPED_TEST(HardCases, DenormalsAreNothing)
{
    using N = TypeParam;
    ASSERT_TRUE(
        loaded<N>(view9 + "b 0.2 0.4 1\n s 0 0 0 4.9e-324\n disc 0 0 0 0 0 1 1e-310\n c 0 0 0 1e-320 0 1 0 0\n"));
    EXPECT_EQ(description().object_count, 0u);
    EXPECT_EQ(description().dropped, 3u);
    const Picture p = draw<N>();
    EXPECT_EQ(p.at(4, 4).r, 51);
}
TYPED_TEST(HardCases, NegativeRadiusIsTakenWithoutItsSign)
{
    using N = TypeParam;
    const std::string rest = "b 0 0 0\n ambientlight 1 1 1\n material diffuse 0\n";
    ASSERT_TRUE(loaded<N>(view9 + rest + "s 0 0 0 -1\n c -2 0 0 -0.5 -2 1 0 -0.25\n disc 2 0 0 0 0 1 -0.5\n"));
    const Picture a = draw<N>();
    ASSERT_TRUE(loaded<N>(view9 + rest + "s 0 0 0 1\n c -2 0 0 0.5 -2 1 0 0.25\n disc 2 0 0 0 0 1 0.5\n"));
    EXPECT_EQ(a, draw<N>());
}
TYPED_TEST(HardCases, WhatHasNoExtentIsDroppedAndCounted)
{
    using N = TypeParam;
    // A ball of radius 0; corners in a line; doubled corners; a patch of no area.
    ASSERT_TRUE(loaded<N>(view9 + "b 0.2 0.4 1\n s 0 0 0 0\n p 3 -1 0 0 0 0 0 1 0 0\n p 4 1 1 0 1 1 0 -1 -1 0 -1 -1 0\n"
                                  "pp 3 0 0 0 0 0 1 0 0 0 0 0 1 1 1 0 0 0 1\n"));
    EXPECT_EQ(description().object_count, 0u);
    EXPECT_EQ(description().dropped, 4u);
    const Picture p = draw<N>();
    for (size_t i = 0; i < p.rgb.size(); i += 3)
        EXPECT_EQ(p.rgb[i], 51);
}
TEST(HardInput, AnAxisOfZeroIsAnError) { error_of(camera("0 1 0", "45", "9 9") + "c 1 2 3 1 1 2 3 1\n"); }
TEST(HardInput, AMissingNumberIsAnErrorWhereItShouldStand)
{
    const std::string message = error_of(camera("0 1 0", "45", "9 9") + "s 0 0 0\ns 1 1 1 1\n").text;
    EXPECT_EQ(message.rfind("x.nff:3:1:", 0), 0u) << message;
}
TEST(HardInput, AnUnknownEntityIsAnErrorAtItsPlace)
{
    const std::string message = error_of(camera("0 1 0", "45", "9 9") + "\n   torus 1 2 3\n").text;
    EXPECT_EQ(message.rfind("x.nff:3:4:", 0), 0u) << message;
    EXPECT_NE(message.find("torus"), std::string::npos);
}
// Every prefix of a scene is a scene or one line of error.
TEST(HardInput, AFileThatEndsEarly)
{
    const std::string whole = camera("0 1 0", "45", "9 9")
        + "b 0 0 0 l 1 2 3 f 1 1 1 0.5 0.5 3 0 1 s 0 0 0 1 c 0 0 0 1 0 1 0 0 p 3 0 0 0 1 0 0 0 1 0\n"
          "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 texture checker 1 0 0 2 plane 0 0 0 0 1 0\n";
    // Only one of these may be without an error: a light after an object is one itself.
    int errors = 0;
    for (size_t n = 0; n < whole.size(); n++) {
        scene::Error error;
        if (!parse("x.nff", whole.data(), n, description(), error)) {
            errors++;
            EXPECT_EQ(std::string(error.text).rfind("x.nff:", 0), 0u) << error.text;
        }
    }
    EXPECT_GT(errors, 200);
}
TEST(HardInput, MoreObjectsThanFitAreAnErrorThatNamesTheLimit)
{
    std::string text = camera("0 1 0", "45", "9 9");
    for (uint32_t i = 0; i <= scene::Limits::objects; i++)
        text += "s 0 0 0 1\n";
    const std::string message = error_of(text).text;
    EXPECT_NE(message.find("1048576"), std::string::npos) << message;
    EXPECT_NE(message.find("objects"), std::string::npos) << message;
    text = camera("0 1 0", "45", "9 9") + "p 3145729 0 0 0";
    EXPECT_NE(std::string(error_of(text).text).find("3145728"), std::string::npos);
}

} // namespace
