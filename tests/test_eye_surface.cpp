// The eye on a surface: rays from there do not meet it at t = 0, but on its other side where there is one.
#include "hard_scenes.hpp"
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct EyeSurfaces : ::testing::Test {};
TYPED_TEST_SUITE(EyeSurfaces, NumberSystems, SystemNames);

enum class Seen { surface, nothing, unsure };

struct Tally {
    int surface = 0, nothing = 0;
};

// Looks from `eye` in 40 directions, each of them the middle of a picture of one pixel, at a scene in which all that
// there is shines white on black.
template <class N, class Objects, class Expected>
void look_around(Random& random, const Objects& objects, const World& world, const Vec3& eye, Expected expected,
                 Tally& tally)
{
    for (int i = 0; i < 40; i++) {
        const Vec3 d = random.direction();
        const Seen seen = expected(d);
        if (seen == Seen::unsure || std::fabs(d.y) > 0.99)
            continue;
        SceneText text(world);
        text.background(0, 0, 0);
        text.view(eye, eye + d, 30, 1);
        objects(text);
        ASSERT_TRUE(loaded<N>("ambientlight 1 1 1\n" + text.text()));
        EXPECT_TRUE(storage<N>().effects.eye_surface);
        EXPECT_EQ(light_at<N>(0, 0).x > 0.5, seen == Seen::surface) << text.text();
        (seen == Seen::surface ? tally.surface : tally.nothing)++;
    }
}

World odd_world(Random& random)
{
    return {random.uniform(0.2, 3), random.point(7), false, false};
}
// Directions are known to one part in 2^14 in q16, and its lengths to a thousandth.
template <class N>
double margin()
{
    return NarrowFixed<N> ? 0.03 : 1e-4;
}

TYPED_TEST(EyeSurfaces, BallShowsItsInside)
{
    using N = TypeParam;
    Random random(71);
    Tally tally;
    for (int i = 0; i < 40; i++) {
        const Vec3 centre = random.point(3), n = random.direction();
        const double r = random.uniform(0.3, 2);
        look_around<N>(
            random, [&](SceneText& text) { text.sphere(centre, r); }, odd_world(random), centre + n * r,
            [&](const Vec3& d) {
                const double out = dot(d, n);
                return std::fabs(out) < margin<N>() ? Seen::unsure : out < 0 ? Seen::surface : Seen::nothing;
            },
            tally);
    }
    EXPECT_GT(tally.surface, 500);
    EXPECT_GT(tally.nothing, 500);
}

// With o = E + t d in the frame of the axis, C = 0 at t = 0, and the other root is -2 B / A.
TYPED_TEST(EyeSurfaces, CylinderAndConeShowTheirInside)
{
    using N = TypeParam;
    Random random(72);
    Tally tally;
    for (int i = 0; i < 60; i++) {
        const Vec3 axis = random.direction(), e1 = unit(cross(axis, random.direction())), middle = random.point(2);
        const double half = random.uniform(1, 3), mean = random.uniform(0.5, 1);
        const double growth = i % 3 == 0 ? 0 : random.uniform(-0.3, 0.3);
        const double z = random.uniform(-0.8, 0.8) * half, r = mean + growth * z;
        if (mean - std::fabs(growth) * half < 0.05)
            continue;
        const Vec3 n = unit(e1 - axis * growth);
        look_around<N>(
            random,
            [&](SceneText& text) {
                text.cone(middle - axis * half, mean - growth * half, middle + axis * half, mean + growth * half);
            },
            odd_world(random), middle + axis * z + e1 * r,
            [&](const Vec3& d) {
                const double dz = dot(d, axis), across = dot(d, d) - dz * dz;
                const double a = across - growth * growth * dz * dz, b = dot(d, e1) * r - growth * r * dz;
                if (std::fabs(dot(d, n)) < margin<N>() || std::fabs(a) < margin<N>())
                    return Seen::unsure;
                if (dot(d, n) > 0 || a < 0)
                    return Seen::nothing;
                const double beyond = std::fabs(z - 2 * b / a * dz) - half;
                return std::fabs(beyond) < 4 * margin<N>() ? Seen::unsure : beyond < 0 ? Seen::surface : Seen::nothing;
            },
            tally);
    }
    EXPECT_GT(tally.surface, 300);
    EXPECT_GT(tally.nothing, 500);
}

// Every chord of a cone through its apex is along it.
TYPED_TEST(EyeSurfaces, ApexHidesItsCone)
{
    using N = TypeParam;
    Random random(73);
    Tally tally;
    for (int i = 0; i < 20; i++) {
        const Vec3 apex = random.point(2), axis = random.direction();
        const double height = random.uniform(0.5, 2), r = height * random.uniform(0.2, 1);
        look_around<N>(
            random, [&](SceneText& text) { text.cone(apex + axis * height, r, apex, 0); }, odd_world(random), apex,
            [&](const Vec3& d) {
                const double dz = dot(d, axis), generator = height / std::sqrt(height * height + r * r);
                return std::fabs(dz - generator) < margin<N>() ? Seen::unsure : Seen::nothing;
            },
            tally);
    }
    EXPECT_GT(tally.nothing, 500);
}

TYPED_TEST(EyeSurfaces, WhatIsFlatHidesItself)
{
    using N = TypeParam;
    Random random(74);
    Tally tally;
    for (int i = 0; i < 60; i++) {
        const Vec3 centre = random.point(2), n = random.direction();
        const Vec3 u = unit(cross(n, random.direction())), v = cross(n, u);
        const Vec3 corners[] = {centre - u * 2 - v, centre + u * 2 - v, centre + v * 2};
        look_around<N>(
            random,
            [&](SceneText& text) {
                switch (i % 4) {
                case 0: text.plane(centre - u * 3, n); break;
                case 1: text.disc(centre - u * 0.5, n, 2); break;
                case 2: text.polygon({corners, corners + 3}); break;
                case 3: text.patch({corners, corners + 3}, {n, n, n}); break;
                }
            },
            odd_world(random), centre, [](const Vec3&) { return Seen::nothing; }, tally);
    }
    EXPECT_GT(tally.nothing, 1500);
}

// Down from within a green plane, at a red ball.
TYPED_TEST(EyeSurfaces, OtherSurfacesAreSeenThroughIt)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0.3 0.1 0.2 at 0.3 -3 0.2 up 0 0 1 angle 20 hither 0 resolution 1 1\n"
                          "ambientlight 1 1 1\n material colour 0 1 0\n plane 5 0.1 2 0 1 0\n"
                          "material colour 1 0 0\n s 0.3 -2 0.2 0.5\n"));
    EXPECT_NEAR(light_at<N>(0, 0).x, 1, light_tolerance<N>());
    EXPECT_NEAR(light_at<N>(0, 0).y, 0, light_tolerance<N>());
}

// A thousandth off, the near side is met; in q16, whose steps are about that, a fiftieth.
TYPED_TEST(EyeSurfaces, NearASurfaceIsNotOnIt)
{
    using N = TypeParam;
    const double off = NarrowFixed<N> ? 0.02 : std::is_same_v<N, Float> ? 1e-3 : 1e-5;
    for (const char* object : {"s 0 0 0 1", "disc 0 1 0 0 1 0 2", "plane 0 1 0 0 1 0", "p 3 -2 1 -2 2 1 -2 0 1 3",
                               "c 0 0 -2 1 0 0 2 1", "pp 3 -2 1 -2 0 1 0 2 1 -2 0 1 0 0 1 3 0 1 0"})
        for (double side : {1.0, -1.0}) {
            char text[400];
            std::snprintf(text, sizeof text,
                          "v from 0 %.17g 0 at 0 %d 0 up 0 0 1 angle 20 hither 0 resolution 1 1\n far 8\n"
                          "ambientlight 1 1 1\n material\n%s\n",
                          1 + side * off, side > 0 ? 0 : 2, object);
            ASSERT_TRUE(loaded<N>(text));
            EXPECT_FALSE(storage<N>().effects.eye_surface) << text;
            EXPECT_NEAR(light_at<N>(0, 0).x, 1, light_tolerance<N>()) << text;
        }
}

// However near: from its own side the surface is met, and where it is not closed there is nothing behind the eye.
TYPED_TEST(EyeSurfaces, NextToASurfaceIsOnItsSide)
{
    using N = TypeParam;
    for (const char* object : {"s 0 0 0 1", "c 0 0 -2 1 0 0 2 1", "c 0 0 -2 1.5 0 0 2 0.5", "disc 0 1 0 0 1 0 2",
                               "plane 0 1 0 0 1 0", "p 3 -2 1 -2 2 1 -2 0 1 3",
                               "pp 3 -2 1 -2 0 1 0 2 1 -2 0 1 0 0 1 3 0 1 0"})
        for (const double off : {1e-13, 1e-10, 1e-8, 1e-6, 1e-4})
            for (const double side : {1.0, -1.0})
                for (const bool towards : {true, false}) {
                    char text[400];
                    std::snprintf(text, sizeof text,
                                  "v from 0 %.17g 0 at 0 %d 0 up 0 0 1 angle 20 hither 0 resolution 1 1\n far 8\n"
                                  "ambientlight 1 1 1\n material\n%s\n",
                                  1 + side * off, (side > 0) == towards ? -3 : 5, object);
                    ASSERT_TRUE(loaded<N>(text));
                    EXPECT_FALSE(storage<N>().effects.eye_surface) << text;
                    const bool closed = object[0] == 's' || object[0] == 'c';
                    EXPECT_NEAR(light_at<N>(0, 0).x, towards || (closed && side < 0), light_tolerance<N>()) << text;
                }
}

// On a tilted plane, across it and to both sides, far from where the plane is said to pass.
TYPED_TEST(EyeSurfaces, NextToATiltedPlaneIsOnItsSide)
{
    using N = TypeParam;
    Random random(75);
    for (int i = 0; i < 200; i++) {
        const Vec3 n = random.direction(), u = unit(cross(n, random.direction())), at = random.point(2);
        const double side = i % 2 != 0 ? 1 : -1;
        const Vec3 eye = at + u * 3 + n * (side * 1e-9);
        const Vec3 down = unit(u + n * (-0.2 * side)), up = unit(u + n * (0.2 * side));
        for (const Vec3& d : {down, up}) {
            if (std::fabs(d.y) > 0.99)
                continue;
            SceneText text({1, {0, 0, 0}, false, false});
            text.background(0, 0, 0);
            text.view(eye, eye + d * 2, 30, 1);
            text.plane(at, n);
            ASSERT_TRUE(loaded<N>("ambientlight 1 1 1\n" + text.text()));
            EXPECT_EQ(light_at<N>(0, 0).x > 0.5, &d == &down || d == down) << text.text();
        }
    }
}

// In a world whose steps are longer than a ball is wide.
TYPED_TEST(EyeSurfaces, SmallBallInAVastWorldIsFarOff)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 0.5 0 at 0 0 0 up 0 0 1 angle 20 hither 0 resolution 1 1\n"
                          "s 0 0 0 0.25\n s 1e15 0 0 1\n s -1e15 0 0 1\n"));
    EXPECT_FALSE(storage<N>().effects.eye_surface);
}

} // namespace
