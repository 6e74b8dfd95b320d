// What a number system cannot draw right is said, once, with the line of the first object; and nothing else is. The
// bounds are what tests/oracle shows: scenes a little coarser are right to 28 dB in q16, 40 in q24, 60 in q32, 45 in
// float.
#include "scene_helpers.hpp"

#include <string>

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct ResolutionTest : ::testing::Test {};
TYPED_TEST_SUITE(ResolutionTest, NumberSystems, SystemNames);

// In a world of +-62: of coordinates near 62, in floating point.
template <class N>
constexpr double step = ShortFixed<N>     ? 0x1p-10
    : NarrowFixed<N>                  ? 0x1p-16
    : N::is_fixed                     ? 0x1p-24
    : sizeof(typename N::Length) == 4 ? 0x1p-18 : 0x1p-47;

std::string number(double v)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", v);
    return text;
}
// Its radius is 3, and with a plane its scale 1; objects begin in line 2.
const std::string view = "v from 0 6 0 at 0 0 0 up 0 0 1 angle 30 hither 0 resolution 160 120 far 60\n";

// The line that is named, 0 for none; once, however often the scene is asked about.
template <class N>
uint32_t named(const std::string& text)
{
    EXPECT_TRUE(loaded<N>(text)) << text;
    const scene::Warning& lost = storage<N>().lost;
    EXPECT_LE(lost.count, 1u) << text;
    return lost.count != 0 ? lost.line : 0;
}

TYPED_TEST(ResolutionTest, SurfacesThatFallTogether)
{
    using N = TypeParam;
    const std::string glass = "material transmit 1 diffuse 0 ambient 0 ior 1.4\n", red = "material colour 1 0 0\n";
    const auto shell = [&](double r) { return view + red + "s 0 0 0 1\n" + glass + "s 0 0 0 " + number(r) + "\n"; };
    const auto pipe = [&](double r) {
        return view + red + "c -1 0 0 1 1 0 0 1\n" + glass + "c -1 0 0 " + number(r) + " 1 0 0 " + number(r) + "\n";
    };
    const auto decal = [&](double h) {
        return view + "plane 0 0 0 0 1 0\n" + red + "p 4 -1 " + number(h) + " -1 -1 " + number(h) + " 1 1 " + number(h)
            + " 1 1 " + number(h) + " -1\n";
    };
    const double near = N::is_fixed ? step<N> : step<N> / 32;
    // Balls and pipes stand alone, with a scale of 16. double itself reads them as one.
    const uint32_t line = std::is_same_v<N, Double> ? 0 : 5;
    EXPECT_EQ(named<N>(shell(1 + near / (N::is_fixed ? 16 : 1))), line);
    EXPECT_EQ(named<N>(pipe(1 + near / (N::is_fixed ? 16 : 1))), line);
    EXPECT_EQ(named<N>(decal(near / 2)), 4u);
    EXPECT_EQ(named<N>(decal(-near / 2)), 0u); // not seen
    EXPECT_EQ(named<N>(shell(1 + 100 * step<N>)), 0u);
    EXPECT_EQ(named<N>(pipe(1 + 100 * step<N>)), 0u);
    EXPECT_EQ(named<N>(decal(100 * step<N>)), 0u);
    // What is one surface by the text is said to be so there.
    EXPECT_EQ(named<N>(shell(1)), 0u);
    EXPECT_EQ(named<N>(decal(0)), 0u);
    // Tiles of a floor, and balls that touch.
    EXPECT_EQ(named<N>(view + "p 4 0 0 0 1 0 0 1 0 1 0 0 1\n" + red
                       + "p 4 1 0 0 2 0 0 2 0 1 1 0 1\n s -1 1 0 1 s 1 1 0 1"), 0u);
}

TYPED_TEST(ResolutionTest, WhatSpansFewSteps)
{
    using N = TypeParam;
    const auto ball = [](double away) {
        const double angle = 2 * std::atan(1.5 / away) * 180 / M_PI;
        return "v from " + number(0.48 * away) + " " + number(0.6 * away) + " " + number(0.64 * away)
            + " at 0 0 0 up 0 1 0 angle " + number(angle) + " hither 0 resolution 160 120\ns 0 0 0 1\n";
    };
    const double far = ShortFixed<N> ? 1e3 : NarrowFixed<N> ? 1e4 : N::is_fixed ? 1e6
        : sizeof(typename N::Length) == 4 ? 1e5 : 1e9;
    EXPECT_EQ(named<N>(ball(far)), 2u);
    EXPECT_EQ(named<N>(ball(far / 100)), 0u);
    // Out of view, or far smaller than a pixel.
    const std::string wide = "v from 0 0 0 at " + number(far) + " 0 0 up 0 1 0 angle 30 hither 0 resolution 160 120\n";
    EXPECT_EQ(named<N>(wide + "s 0 0 " + number(far) + " " + number(far / 4) + "\n"), 0u);
    EXPECT_EQ(named<N>(wide + "s " + number(far) + " 0 0 " + number(far / 4) + "\n"), 0u);
}

// A plane has no middle, but a pattern where the eye looks. What is 5 below and 20 before the eye is as tall in the
// picture as the angle says; steps are a third of a world of 165 units.
TYPED_TEST(ResolutionTest, APatternOnAPlaneSpansFewSteps)
{
    using N = TypeParam;
    const std::string checker = "texture checker 0 0 0 0.1\n", floor = "plane 0 0 0 0 1 0\n";
    const auto from = [](double angle) {
        return "v from 0 5 0 at 0 0 -20 up 0 1 0 angle " + number(angle) + " hither 0 resolution 160 120\n";
    };
    const double narrow = ShortFixed<N> ? 1 : NarrowFixed<N> ? 0.5 : N::is_fixed ? 1e-3
        : sizeof(typename N::Length) == 4 ? 1e-3 : 1e-6; // 14, 31 and 52 dB in fixed point
    EXPECT_EQ(named<N>(from(narrow) + checker + floor), 3u);
    EXPECT_EQ(named<N>(from(narrow) + floor), 0u); // one colour
    EXPECT_EQ(named<N>(from(narrow * 20) + checker + floor), 0u);
    EXPECT_EQ(named<N>(from(narrow) + checker + "plane 0 0 1 0 0 1\n"), 0u); // behind the eye
    EXPECT_EQ(named<N>(from(narrow) + "far 3 " + checker + floor), 0u);       // ends before
}

// Between two floors there is no room to stand off both.
TYPED_TEST(ResolutionTest, EyeThatFallsOntoASurface)
{
    using N = TypeParam;
    const double h = step<N> / 4;
    const std::string eye =
        "v from 0 " + number(h) + " 0 at 5 0 0 up 0 1 0 angle 30 hither 0 resolution 160 120 far 60\n";
    ASSERT_TRUE(loaded<N>(eye + "plane 0 0 0 0 1 0\nplane 0 " + number(2 * h) + " 0 0 1 0\n"));
    EXPECT_GE(storage<N>().lost.count, 1u);
    EXPECT_EQ(storage<N>().lost.line, 2u);
    EXPECT_EQ(named<N>(eye + "plane 0 0 0 0 1 0\n"), 0u);
    EXPECT_EQ(named<N>(eye + "plane 0 0 0 0 1 0\nplane 0 0 " + number(-h) + " 0 0 1\n"), 0u); // a corner
}

// Balls as large as the world, whose radius may have fewer bits than lengths: what is not said is right.
const std::string flat = "ambientlight 1 1 1 material colour 1 0 0 ambient 1 diffuse 0\n";
std::string view_from(const Vec3& eye, const Vec3& at)
{
    const auto point = [](const Vec3& p) { return number(p.x) + " " + number(p.y) + " " + number(p.z); };
    return "v from " + point(eye) + " at " + point(at) + " up 0 0 1 angle 20 hither 0 resolution 5 5\n b 0 0 0\n";
}
std::string ball(double radius) { return "s 0 0 0 " + number(radius) + "\n"; }

// Calls f(radius, some steps), of balls that fill the world more or less. double reads as one what is nearer.
template <class N, class F>
void for_large_balls(F f)
{
    for (const double radius : {4., 5., 6., 11., 12., 20., 24., 40., 60.})
        for (const double steps : {0.25, 1., 2., 3., 5., 7., 9., 12., 16., 24., 32., 48., 64., 100.})
            f(radius, steps * std::fmax(step<N>, 0x1p-40));
}

TYPED_TEST(ResolutionTest, OfTwoLargeBallsTheOuterIsSeen)
{
    using N = TypeParam;
    int right = 0;
    for_large_balls<N>([&](double r, double h) {
        const std::string outer = "material colour 0 1 0 ambient 1 diffuse 0\n" + ball(r + h);
        if (named<N>(view_from({0, 1.5 * r, 0}, {0, 0, 0}) + flat + ball(r) + outer) != 0)
            return;
        for (uint32_t i = 0; i < 25; i++)
            EXPECT_GT(light_at<N>(i % 5, i / 5).y, 0.5) << r << " " << h / step<N>;
        right++;
    });
    EXPECT_GT(right, 60);
}

TYPED_TEST(ResolutionTest, EyeBesideALargeBallSeesIt)
{
    using N = TypeParam;
    Random random(91);
    int right = 0;
    for_large_balls<N>([&](double r, double h) {
        for (const double side : {-1, 1})
            for (int i = 0; i < 8; i++) {
                const Vec3 n = random.direction(), eye = n * (r + side * h), d = random.direction();
                const double horizon = -std::sqrt(2 * h / r), up = dot(d, n);
                if (side > 0 && std::fabs(up - horizon) < 0.1)
                    continue;
                ASSERT_TRUE(loaded<N>(view_from(eye, eye + d * 20) + flat + ball(r)));
                if (storage<N>().lost.count != 0)
                    continue;
                EXPECT_EQ(light_at<N>(2, 2).x > 0.5, side < 0 || up < horizon) << r << " " << side * h / step<N>;
                right++;
            }
    });
    EXPECT_GT(right, 1200);
}

// By how much of a picture's height it may move silently.
TYPED_TEST(ResolutionTest, HorizonOfALargeBallIsWhereItIs)
{
    using N = TypeParam;
    if (ShortFixed<N>) // what it rounds, the eye and the ball, moves the horizon as far
        return;
    const double off = (N::is_fixed ? 2e-3 : 4e-3) * 2 * std::tan(M_PI / 18);
    Random random(92);
    int right = 0;
    for_large_balls<N>([&](double r, double h) {
        for (int i = 0; i < 4; i++) {
            const Vec3 n = random.direction(), along = unit(cross(n, random.direction())), eye = n * (r + h);
            const double slope = -std::sqrt(h * (2 * r + h)) / r;
            for (const double side : {-1, 1}) {
                const std::string from = view_from(eye, eye + (along + n * (slope + side * off)) * 20);
                ASSERT_TRUE(loaded<N>(from + flat + ball(r)));
                if (storage<N>().lost.count != 0)
                    continue;
                EXPECT_EQ(light_at<N>(2, 2).x > 0.5, side < 0) << r << " " << h / step<N>;
                right++;
            }
        }
    });
    EXPECT_GT(right, 200);
}

} // namespace
