// Panels: where their places are, what they add up to, and that what they lie in is not before them.
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct PanelTest : ::testing::Test {};
TYPED_TEST_SUITE(PanelTest, NumberSystems, SystemNames);

// What a sample shifts places by, as scenes/README.md has it.
struct Shift {
    Real a, b;
};
Shift shift_of(uint32_t x, uint32_t y, uint32_t number)
{
    uint32_t h = x * 0x8da6b343u ^ y * 0xd8163841u ^ number * 0xcb1ab31fu;
    h ^= h >> 15, h *= 0x2c1b3c6du, h ^= h >> 12, h *= 0x297a2d39u, h ^= h >> 15;
    return {(Real(h % 65536) + 0.5L) / 65536, (Real(h / 65536) + 0.5L) / 65536};
}
Vec3 place(const Vec3& at, const Vec3& u, const Vec3& v, int n, int k, int m, const Shift& shift)
{
    return at + u * static_cast<double>(2 * (k + shift.a) / n - 1) + v * static_cast<double>(2 * (m + shift.b) / n - 1);
}
std::string text_of(const Vec3& v)
{
    char text[100];
    std::snprintf(text, sizeof text, " %.17g %.17g %.17g", v.x, v.y, v.z);
    return text;
}
const std::string view = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 9 9\nambientlight 0 0 0\n";

TYPED_TEST(PanelTest, PlacesAreWhereTheSampleShiftsThem)
{
    using N = TypeParam;
    Random random(320);
    for (int i = 0; i < 200; i++) {
        const int n = 1 + static_cast<int>(random.bits() % 16);
        const Vec3 at = random.point(1), u = random.point(3), v = random.point(3);
        const double far = i % 2 == 0 ? 4 : 4e4; // also in larger units
        std::string text = view + "l 1 1 1 panel 1 0 0 9 1 0 0 0 1 0 panel " + std::to_string(n)
            + text_of(at * far) + text_of(u * far) + text_of(v * far) + " 1 0.5 0.25 s 0 0 0 1";
        scene::Error error;
        ASSERT_TRUE(parse("test.nff", text.data(), text.size(), description(), error)) << error.text;
        const scene::Storage<N>& s = storage<N>();
        const scene::Settings settings;
        scene::Builder<N> builder(description(), settings, storage<N>());
        ASSERT_TRUE(builder.build(error)) << error.text;
        ASSERT_EQ(s.panels.count, 2u);
        const Panel<N>& panel = s.panels.data[1];
        const EyeSample sample{static_cast<uint32_t>(random.bits()), static_cast<uint32_t>(random.bits() >> 40)};
        const Shift shift = shift_of(sample.x, sample.y, 1);
        int k = 0;
        panel.for_each_place(sample, [&](const Light<N>& lamp) {
            const Vec3 text_place = place(at * far, u * far, v * far, n, k % n, k / n, shift);
            const auto expected = builder.frame.point({text_place.x, text_place.y, text_place.z});
            const double ulp = std::ldexp(make<N>::length_ulp(8 * far * builder.frame.scale), lamp.shift);
            // Half an ulp of the corner, and of each of up to 2 n steps; in q16 and q24 these are finer, and rounded at
            // last.
            EXPECT_LE(distance(value(lamp.at) * std::ldexp(1, lamp.shift), {expected.x, expected.y, expected.z}),
                      (NarrowFixed<N> ? 0.5 + std::ldexp(n + 0.5, -Panel<N>::fine) : n + 2) * ulp) << i << " " << k;
            k++;
        });
        EXPECT_EQ(k, n * n);
    }
}

TEST(EyeSample, CountsAllSamplesOfItsSize)
{
    Camera<q32> c{};
    c.width = 6;
    c.height = 4;
    for (const int n : {1, 2, 3, 8}) {
        c.grid = static_cast<uint16_t>(n);
        for (int place = 0; place < 6 * n; place++) {
            const EyeSample s = eye_sample(c, 2 * place + 1 - 6 * n, 2 * (place / 2) + 1 - 4 * n, 1);
            EXPECT_EQ(s.x, static_cast<uint32_t>(place));
            EXPECT_EQ(s.y, static_cast<uint32_t>(place / 2));
        }
    }
    // Of 8 x 8 cells a pixel, squares of 4 x 4: the third in its row.
    EXPECT_EQ(eye_sample(c, 2 * 10 - 48, 2 * 2 - 32, 3).x, 2u);
    EXPECT_EQ(eye_sample(c, 2 * 10 - 48, 2 * 2 - 32, 3).y, 0u);
}

// Behind the eye, over a disc that it sees head on: the mean over the places, of which half a plane hides half.
TYPED_TEST(PanelTest, LightIsTheMeanOverThePlacesThatAreSeen)
{
    using N = TypeParam;
    const Vec3 at{0, 0, 10}, u{2, 0, 0}, v{0, 1.5, 0};
    for (const int n : {1, 2, 4, 16})
        for (const bool half : {false, true}) {
            const std::string hiding = half ? " material ambient 0 p 4 -9 -9 7.5  0 -9 7.5  0 9 7.5  -9 9 7.5" : "";
            ASSERT_TRUE(loaded<N>(view + "panel " + std::to_string(n) + text_of(at) + text_of(u) + text_of(v)
                                  + " 1 0.5 0.25\n material diffuse 0.75 highlight 0.5 shine 3 disc 0 0 0 0 0 1 9"
                                  + hiding));
            const Shift shift = shift_of(4, 4, 0);
            double sum = 0;
            for (int k = 0; k < n; k++)
                for (int m = 0; m < n; m++) {
                    const Vec3 l = unit(place(at, u, v, n, k, m, shift));
                    if (!half || l.x > 0)
                        sum += 0.75 * l.z + 0.5 * l.z * l.z * l.z; // r.v is n.l, seen along the normal
                }
            const double mean = sum / (n * n);
            expect_light(light_at<N>(4, 4), {mean, mean / 2, mean / 4}, 2 * light_tolerance<N>());
        }
}

TYPED_TEST(PanelTest, OfNoSizeIsALamp)
{
    using N = TypeParam;
    const std::string rest = " 1 0.5 0.25 material diffuse 0.8 s 0.5 0 0 1 plane 0 0 -1 0 0 1";
    ASSERT_TRUE(loaded<N>(view + "l 3 4 5" + rest));
    const Picture lamp = draw<N>();
    ASSERT_TRUE(loaded<N>(view + "panel 4 3 4 5 0 0 0 0 0 0" + rest));
    const Picture panel = draw<N>();
    for (size_t i = 0; i < lamp.rgb.size(); i++)
        EXPECT_LE(std::abs(lamp.rgb[i] - panel.rgb[i]), 1);
}

// Far away and small, it is a sun; there and large, no number system of limited range can tell its places.
TYPED_TEST(PanelTest, FarAwayIsASunOrAnError)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view + "panel 2 0 1e14 1e14 1 0 0 0 1 0 1 1 1 disc 0 0 0 0 0 1 9"));
    const double level = std::sqrt(0.5);
    expect_light(light_at<N>(4, 4), {level, level, level}, 2 * light_tolerance<N>());
    scene::Error error;
    const std::string text = view + "panel 2 0 1e14 1e14 1e14 0 0 0 1e14 0 1 1 1 disc 0 0 0 0 0 1 9";
    ASSERT_TRUE(parse("far", text.data(), text.size(), description(), error));
    const bool built = scene::Builder<N>(description(), {}, storage<N>()).build(error);
    EXPECT_EQ(built, !N::is_fixed);
    EXPECT_TRUE(built || std::string(error.text).find("a panel that is too far away for its size, 2e+14 by 2e+14") == 0)
        << error.text;
}

// A pane that holds a panel, whatever its shape, is as good as one that lets all light through. Turned at random, so
// that no plane is that of an axis; with glass beside it, for both kinds of shadow rays.
TYPED_TEST(PanelTest, WhatItLiesInIsNotBeforeIt)
{
    using N = TypeParam;
    Random random(321);
    for (int i = 0; i < 12; i++) {
        const Vec3 x = random.direction(), z = unit(cross(x, random.direction())), y = cross(z, x);
        const auto turned = [&](double a, double b, double c) { return text_of(x * a + y * b + z * c); };
        const Vec3 normal = y;
        const auto tiles = [&](const char* entity, const std::string& at_corner) {
            std::string all;
            for (int k = 0; k < 50; k++) {
                const double a = k / 2 % 5 * 0.8 - 2, b = k / 10 * 0.8 - 2, other = k % 2 * 0.8;
                all += entity + turned(a + other, 4, b + other) + at_corner + turned(a + 0.8, 4, b) + at_corner
                    + turned(a, 4, b + 0.8) + at_corner + "\n";
            }
            return all;
        };
        const std::string panes[] = {
            "p 4" + turned(-2, 4, -2) + turned(2, 4, -2) + turned(2, 4, 2) + turned(-2, 4, 2),
            "p 3" + turned(-0.5, 4, -0.5) + turned(0.5, 4, -0.5) + turned(0, 4, 0.7), // smaller than the panel
            "disc" + turned(0.3, 4, 0) + text_of(normal) + " 1.2",
            "pp 4" + turned(-2, 4, -2) + text_of(normal) + turned(2, 4, -2) + text_of(normal)
                + turned(2, 4, 2) + text_of(normal) + turned(-2, 4, 2) + text_of(normal),
            tiles("p 3", ""),
            tiles("pp 3", text_of(normal)),
        };
        const std::string head = "ambientlight 0 0 0 v from" + turned(0, 2, 9) + " at" + turned(0, 0.5, 0) + " up"
            + text_of(normal) + " angle 40 hither 1 resolution 24 18\n panel 3" + turned(0, 4, 0) + turned(1, 0, 0.2)
            + turned(0.1, 0, 0.9) + " 1 0.8 0.6 material diffuse 0.8 disc" + turned(0, 0, 0) + text_of(normal) + " 6 s"
            + turned(0.5, 0.5, 0) + " 0.5"
            + (i % 2 == 0 ? " material colour 0 0 0 transmit 0.5 s" + turned(-1.5, 0.5, 0) + " 0.4" : "");
        const std::string& pane = panes[i / 2];
        ASSERT_TRUE(loaded<N>(head + " material colour 0 0 0 " + pane));
        ASSERT_TRUE(storage<N>().effects.light_surface);
        const Picture with = draw<N>();
        if (i >= 8) { // of more a tree is made
            ASSERT_TRUE(loaded<N>(head + " material colour 0 0 0 " + pane, compiled()));
            ASSERT_GT(storage<N>().entries.count, 0u);
            ASSERT_EQ((draw<N, flat()>()), with);
        }
        ASSERT_TRUE(loaded<N>(head + " material colour 0 0 0 transmit 1 " + pane));
        const Picture without = draw<N>();
        int lit = 0;
        for (size_t k = 0; k < with.rgb.size(); k++) {
            ASSERT_LE(std::abs(with.rgb[k] - without.rgb[k]), 1) << pane << " byte " << k;
            lit += with.rgb[k] > 100;
        }
        EXPECT_GT(lit, 100);
    }
}

} // namespace
