// A light on a surface: that surface is not before it, but for where the way crosses it elsewhere.
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct LightSurfaces : ::testing::Test {};
TYPED_TEST_SUITE(LightSurfaces, NumberSystems, SystemNames);

// Turns the whole scene: nothing lies along an axis then.
struct Turn {
    Vec3 x, y, z;
    Vec3 operator()(const Vec3& v) const { return x * v.x + y * v.y + z * v.z; }
};
Turn turn(Random& random)
{
    const Vec3 x = random.direction(), y = unit(cross(x, random.direction()));
    return {x, y, cross(x, y)};
}

std::string text_of(const Vec3& v)
{
    char text[100];
    std::snprintf(text, sizeof text, " %.17g %.17g %.17g", v.x, v.y, v.z);
    return text;
}

// A floor of radius 8 at height 0 under a shape that holds the lamp, seen from above. `within` tells how far a floor
// point is inside of the light, in lengths; what is nearer to the edge than 0.06 may go either way.
template <class N, class Within>
void expect_floor(const Turn& t, const std::string& shape, const Vec3& lamp, Within within)
{
    constexpr int size = 24;
    const double half = std::tan(25 * M_PI / 180);
    ASSERT_TRUE(loaded<N>("ambientlight 0 0 0.25 l" + text_of(t(lamp)) + " 1 1 1 v from" + text_of(t({0, 20, 0}))
                          + " at" + text_of(t({0, 0, 0})) + " up" + text_of(t({0, 0, 1}))
                          + " angle 50 hither 1 resolution " + std::to_string(size) + " " + std::to_string(size)
                          + " material ambient 0 disc" + text_of(t({0, 0, 0})) + text_of(t({0, 1, 0}))
                          + " 8 material diffuse 0 " + shape));
    EXPECT_TRUE(storage<N>().effects.light_surface);
    int lit = 0, dark = 0;
    for (int j = 0; j < size; j++)
        for (int i = 0; i < size; i++) {
            const Vec3 light = light_at<N>(static_cast<uint32_t>(i), static_cast<uint32_t>(j));
            // u = w x up = -y x z = -x, t = u x w = z.
            const Vec3 q{-20 * half * (2 * (i + 0.5) / size - 1), 0, 20 * half * (1 - 2 * (j + 0.5) / size)};
            const double inside = within(q);
            if (light.z > 0.2 && light.x < 0.01) // the shape itself
                continue;
            if (length(q) > 7.9 || std::fabs(inside) < 0.06)
                continue;
            EXPECT_EQ(light.x > 0.001, inside > 0) << shape << " lamp " << text_of(lamp) << " floor " << text_of(q);
            (inside > 0 ? lit : dark)++;
        }
    EXPECT_GT(lit, 10);
    EXPECT_GT(dark, 10);
}

TYPED_TEST(LightSurfaces, OfABallLetTheLightAwayFromIt)
{
    using N = TypeParam;
    Random random(7);
    for (int k = 0; k < 12; k++) {
        const Turn t = turn(random);
        const Vec3 centre{0.5, 2, -0.25}, out = unit(Vec3{std::cos(0.5 * k), 0.3 - 0.1 * (k % 4), std::sin(0.5 * k)});
        const Vec3 lamp = centre + out * 1.5;
        // The tangent plane at the lamp parts them.
        const double flat = std::hypot(out.x, out.z);
        expect_floor<N>(t, "s" + text_of(t(centre)) + " 1.5", lamp,
                        [&](const Vec3& q) { return dot(q - lamp, out) / flat; });
    }
}

// Open at both ends: from within, light leaves by the lower one.
TYPED_TEST(LightSurfaces, OfAConeLetTheLightAwayFromItAndThroughItsEnd)
{
    using N = TypeParam;
    Random random(8);
    for (const double top : {1.5, 1.0, 0.5, 0.0})
        for (int k = 0; k < 6; k++) {
            const Turn t = turn(random);
            // From height 0.5 and radius 1.5 to height 3.
            const double slope = (top - 1.5) / 2.5, height = 1 + 0.3 * k, r = 1.5 + slope * (height - 0.5),
                         angle = 1.1 * k;
            const Vec3 lamp{r * std::cos(angle), height, r * std::sin(angle)};
            const Vec3 out = unit(Vec3{std::cos(angle), -slope, std::sin(angle)});
            const double flat = std::hypot(out.x, out.z);
            expect_floor<N>(t,
                            "c" + text_of(t({0, 0.5, 0})) + " 1.5" + text_of(t({0, 3, 0})) + " " + std::to_string(top),
                            lamp, [&](const Vec3& q) {
                                const double away = dot(q - lamp, out) / flat;
                                const Vec3 end = lamp + (q - lamp) * ((height - 0.5) / height);
                                const double through = (1.5 - std::hypot(end.x, end.z)) * height / (height - 0.5);
                                return std::fmax(away, through);
                            });
        }
}

// A lamp next to a surface is on its side of it, however little rounding leaves of that.
TYPED_TEST(LightSurfaces, KnowOnWhichSideTheLightIs)
{
    using N = TypeParam;
    for (const double off : {-1e-6, -1e-8, 1e-8, 1e-6}) {
        char text[400];
        // Within a ball, at its lowest point: the ball's lower half is seen from within.
        std::snprintf(text, sizeof text,
                      "ambientlight 0 0 0 l 0 %.17g 0 1 1 1 v from 0 0 0 at 0 -1 0.3 up 0 0 1 angle 20 hither 1 "
                      "resolution 1 1 s 0 0 0 2",
                      -2 - off);
        ASSERT_TRUE(loaded<N>(text));
        EXPECT_EQ(light_at<N>(0, 0).x > 0, off < 0) << off;
    }
}

// A lamp next to the plane of a triangle, within its extent and beside its outline, where nothing is before it: with a
// tree that asks outlines first, with one that does not, and without.
TYPED_TEST(LightSurfaces, OfAFigureEndAtItsOutline)
{
    using N = TypeParam;
    constexpr Effects no_tree = [] {
        Effects e;
        e.polygon = e.patch = e.light = e.panel = e.shadow = e.light_surface = true;
        return e;
    }();
    std::string others; // enough for a tree
    for (int i = 0; i < 45; i++)
        others += " p 3" + text_of({-8, 0.1 * i, -8}) + text_of({-7, 0.1 * i, -8}) + text_of({-8, 0.1 * i, -7});
    const char* const figures[] = {" p 3 -2 2 -2 2 2 -2 -2 2 2", " p 4 -2 2 -2 2 2 -2 -1 2 -1 -2 2 2",
                                   " pp 3 -2 2 -2 0 1 0 2 2 -2 0 1 0 -2 2 2 0 1 0"};
    for (const char* const figure : figures)
        for (const double steps : {-0.5, -0.01, 0.01, 0.5})
            for (const char* const light : {"l ", "panel 1 "}) {
                SCOPED_TRACE(figure);
                const double off = steps * make<N>::length_ulp(), side = steps > 0 ? 1 : -1; // seen from the other
                const std::string at = std::to_string(2 - side);
                const std::string text = "ambientlight 0 0 0 " + (light + text_of({1.5, 2 + off, 1.5}).substr(1))
                    + (*light == 'p' ? " 1e-6 0 0 0 0 1e-6" : "") + " 1 1 1 v from 1.5 " + at + " 1.4 at 1.5 "
                    + std::to_string(2 - 2 * side) + " 1.5 up 0 0 1 angle 20 hither 1 resolution 1 1 p 4"
                    + text_of({-8, 2 - 2 * side, -8}) + text_of({8, 2 - 2 * side, -8}) + text_of({8, 2 - 2 * side, 8})
                    + text_of({-8, 2 - 2 * side, 8}) + figure + others;
                ASSERT_TRUE(loaded<N>(text));
                EXPECT_TRUE(storage<N>().effects.light_surface);
                EXPECT_GT((light_at<N, no_tree>(0, 0).x), 0.9);
                EXPECT_GT(light_at<N>(0, 0).x, 0.9);
                ASSERT_TRUE(loaded<N>(text, compiled()));
                EXPECT_GT((light_at<N, flat()>(0, 0).x), 0.9);
            }
}

} // namespace
