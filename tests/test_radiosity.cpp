// Light between surfaces: closed forms, and the cases in which it is easily lost or found where none can be.
#include "scene_helpers.hpp"

#include "../src/scene/radiosity.hpp"

#include <algorithm>

namespace {

using namespace qray;
using namespace qray::test;
using scene::LightGrid;
using scene::Vec3d;

bool make_room(scene::Room& room, size_t size)
{
    if (size > room.size) {
        std::free(room.at);
        room = {static_cast<uint8_t*>(std::aligned_alloc(scene::Layout::alignment, (size + 63) / 64 * 64)), size};
    }
    return room.at != nullptr;
}
template <bool Backwards>
void run(void (*part)(void*, uint32_t), void* work, uint32_t count, const scene::Solving&)
{
    for (uint32_t i = 0; i < count; i++)
        part(work, Backwards ? count - 1 - i : i);
}

std::string error_of(const std::string& text, bool backwards = false, uint32_t rays = 256)
{
    scene::Error error;
    const scene::Solving solving{make_room, backwards ? run<true> : run<false>, 1, false, rays};
    if (parse("test.nff", text.data(), text.size(), description(), error))
        solve_radiosity(description(), solving, error);
    return error.text;
}
template <class N>
void build()
{
    scene::Error error;
    const scene::Settings settings;
    ASSERT_TRUE(scene::Builder<N>(description(), settings, storage<N>()).build(error)) << error.text;
}

std::string view(const std::string& radiosity = "1")
{
    return "v from 0.3 0.4 0.5 at 0.1 0.2 -1 up 0 1 0 angle 90 hither 1 resolution 16 16\nambientlight 0 0 0 radiosity "
        + radiosity + "\n";
}
// The box of two corners, seen from inside and outside.
std::string box(double a, double b)
{
    std::string text;
    for (int axis = 0; axis < 3; axis++)
        for (const double at : {a, b}) {
            text += "p 4";
            for (int i = 0; i < 4; i++) {
                double p[3];
                p[axis] = at;
                p[(axis + 1) % 3] = i == 1 || i == 2 ? b : a;
                p[(axis + 2) % 3] = i >= 2 ? b : a;
                char corner[100];
                std::snprintf(corner, sizeof corner, "  %g %g %g", p[0], p[1], p[2]);
                text += corner;
            }
            text += "\n";
        }
    return text;
}
std::string square(double x, double y, double z, double half)
{
    char text[200];
    std::snprintf(text, sizeof text, "p 4  %g %g %g  %g %g %g  %g %g %g  %g %g %g\n", x - half, y, z - half, x - half,
        y, z + half,
                  x + half, y, z + half, x + half, y, z - half);
    return text;
}

// All lights of a side.
std::vector<double> lights(uint32_t surface, uint32_t side)
{
    const LightGrid& grid = description().grids[2 * surface + side];
    std::vector<double> all;
    for (uint32_t i = 0; i < grid.lights(); i++)
        all.push_back(description().light[grid.first + i].x);
    return all;
}
double mean(const std::vector<double>& v)
{
    double sum = 0;
    for (const double l : v)
        sum += l;
    return sum / static_cast<double>(v.size());
}
// Of the brighter side, over its cells' middles.
double mean_of_cells(uint32_t surface)
{
    double means[2];
    for (uint32_t side = 0; side < 2; side++) {
        const LightGrid& grid = description().grids[2 * surface + side];
        std::vector<double> middles;
        for (uint32_t y = 0; y < grid.y.count; y++)
            for (uint32_t x = 0; x < grid.x.count; x++)
                if (description().nodes[grid.x.first + x] % 8 == 4 && description().nodes[grid.y.first + y] % 8 == 4)
                    middles.push_back(description().light[grid.first + y * grid.x.count + x].x);
        means[side] = mean(middles);
    }
    return std::max(means[0], means[1]);
}

// From a point to a rectangle that is parallel and has a corner over it: Howell's catalogue, B-3.
double corner_factor(double a, double b, double distance)
{
    const double x = a / distance, y = b / distance, s = std::sqrt(1 + x * x), t = std::sqrt(1 + y * y);
    return (x / s * std::atan(y / s) + y / t * std::atan(x / t)) / (2 * M_PI);
}
double square_factor(double x, double z, double half, double distance)
{
    const auto part = [distance](double a, double b) {
        return std::copysign(1, a) * std::copysign(1, b) * corner_factor(std::fabs(a), std::fabs(b), distance);
    };
    return part(half - x, half - z) + part(half + x, half - z) + part(half - x, half + z) + part(half + x, half + z);
}

template <class N>
struct LookUp : ::testing::Test {};
TYPED_TEST_SUITE(LookUp, NumberSystems, SystemNames);

template <class N>
Rgb<N> light_at(uint32_t place, bool inside, const scene::Frame& frame, const Vec3d& p)
{
    const auto view = storage<N>().template view<scene::desktop_effects()>();
    return light_of_surfaces(view, make_tag(place, 0), inside, scene::Convert<N>::point(frame.point(p)));
}

// Beside a lamp, light is as the closed form has it. What is off by more than a 64th gets finer nodes, down to an 8th
// of a cell; cells hold 255ths of the brightest.
TYPED_TEST(LookUp, IsNearTheClosedForm)
{
    using N = TypeParam;
    for (const double edge : {1.0, 0.5}) {
        const std::string text = view(std::to_string(edge)) + "material diffuse 0.5 " + square(0, 0, 0, 2)
            + "material diffuse 0 emission 2 " + square(0, 1.5, 0, 1);
        ASSERT_EQ(error_of(text), "");
        scene::Error error;
        const scene::Settings settings;
        scene::Builder<N> builder(description(), settings, storage<N>());
        ASSERT_TRUE(builder.build(error)) << error.text;
        double worst = 0;
        for (int i = 0; i < 400; i++) {
            const Vec3d p{(i % 20 - 9.5) * 0.2, 0, (i / 20 - 9.5) * 0.2};
            const double exact = square_factor(p.x, p.z, 1, 1.5);
            const auto light = light_at<N>(0, false, builder.frame, p);
            const auto dark = light_at<N>(0, true, builder.frame, p);
            worst = std::max(worst, std::fabs(std::ldexp(scene::value(std::max(light.x, dark.x)), storage<N>().exposure)
                - exact));
        }
        EXPECT_LT(worst, 1.0 / 64 + 0.004 * edge * edge + 0.004) << edge;
    }
}

// All rays see the same, so that light is as exact as the number system.
TYPED_TEST(LookUp, OfAClosedRoomOfOneColour)
{
    using N = TypeParam;
    for (const char* inner : {"", "inner"}) {
        const std::string text = view() + "material colour 0.5 0.25 0.75 diffuse 0.8 emission 0.4\n" + box(-1, 1.1)
            + (*inner != 0 ? box(-0.9, -0.3) : "");
        ASSERT_EQ(error_of(text), "");
        build<N>();
        const auto view = storage<N>().template view<scene::desktop_effects()>();
        for (uint32_t k = 0; k < 256; k += 7) {
            Rgb<N> c{};
            RayCount count;
            c = trace(view, eye_ray(view, view.camera.row(static_cast<int>(k / 16 * 2) - 15)
                + view.camera.right * (static_cast<int>(k % 16 * 2) - 15)), count,
                      EyeSample{});
            const double bytes = NarrowFixed<N> ? 0.003 : 0.002;
            const auto near = [&](auto got, double colour) {
                const double exact = colour * 0.4 / (1 - colour * 0.8);
                EXPECT_NEAR(std::ldexp(scene::value(got), view.exposure), exact, bytes * exact);
            };
            near(c.x, 0.5);
            near(c.y, 0.25);
            near(c.z, 0.75);
        }
    }
}

TEST(Radiosity, FormFactorsOfUnitSquares)
{
    const std::string dark = view("0.1") + "material diffuse 1 ", lamp = "material colour 1 1 1 diffuse 0 emission 1 ";
    ASSERT_EQ(error_of(dark + square(0, 0, 0, 0.5) + lamp + square(0, 1, 0, 0.5)), "");
    EXPECT_NEAR(mean_of_cells(0), 0.199825, 0.001); // Howell's catalogue, C-11
    ASSERT_EQ(error_of(dark + square(0, 0, 0, 0.5) + lamp + "p 4  0.5 0 -0.5  0.5 0 0.5  0.5 1 0.5  0.5 1 -0.5"), "");
    EXPECT_NEAR(mean_of_cells(0), 0.200044, 0.001); // C-14
}

TEST(Radiosity, OfAPolygonWithAHole)
{
    // Joined to its hole by a cut: all of it less the hole.
    const std::string ring =
        "p 10  -1 2 -1  -1 2 1  1 2 1  1 2 -1  -1 2 -1  -0.5 2 -0.5  0.5 2 -0.5  0.5 2 0.5  -0.5 2 0.5  -0.5 2 -0.5\n";
    ASSERT_EQ(error_of(view("0.05") + "material diffuse 1 " + square(0, 0, 0, 0.05) + "material diffuse 0 emission 1 "
        + ring), "");
    const double exact = square_factor(0, 0, 1, 2) - square_factor(0, 0, 0.5, 2);
    EXPECT_NEAR(mean_of_cells(0), exact, 0.005 * exact);
    // A plate with a hole, and light beyond it.
    ASSERT_EQ(error_of(view("0.1") + "material diffuse 1 " + square(0, 0, 0, 0.1) + "material diffuse 0 " + ring
                       + "material diffuse 0 emission 1 " + square(0, 2.01, 0, 0.9)),
              "");
    EXPECT_NEAR(mean_of_cells(0), square_factor(0, 0, 0.5, 2), 0.03 * square_factor(0, 0, 0.5, 2));
}

TEST(Radiosity, GlassLetsItsShareThrough)
{
    const std::string ends = view("0.5") + "material diffuse 1 " + square(0, 0, 0, 1) + "material diffuse 0 emission 1 "
        + square(0, 2, 0, 1);
    ASSERT_EQ(error_of(ends), "");
    const double open = mean_of_cells(0);
    ASSERT_EQ(error_of(ends + "material diffuse 0 transmit 0.75 " + square(0, 1, 0, 4) + square(0, 1.1, 0, 4)), "");
    EXPECT_NEAR(mean_of_cells(0), open * 0.75 * 0.75, 1e-6);
    // And of the sky as much, by rays.
    ASSERT_EQ(error_of(view("100") + "b 1 0.5 0.25 material diffuse 1 " + square(0, 0, 0, 1)
        + "material diffuse 0 transmit 0.5 "
                       + square(0, 0.1, 0, 400)),
              "");
    EXPECT_NEAR(mean_of_cells(0), 1, 1e-6);              // below
    EXPECT_NEAR(mean(lights(0, 0)) + mean(lights(0, 1)), 1.5, 1e-3); // and above
}

// Wherever a wall stands, and however it is turned: the dark half of a room that it parts stays black.
TEST(Radiosity, NoLightLeaksThroughWalls)
{
    for (int i = 0; i < 3; i++) {
        const double x = 0.37 * i - 0.4, turn = 0.4 * i, top = turn / 2;
        char wall[300], roof[200];
        std::snprintf(wall, sizeof wall, "p 4  %g -1 -1  %g -1 1  %g 1 1  %g 1 -1\n", x - top, x + top, x + top,
                      x - top);
        std::snprintf(roof, sizeof roof,
            "material diffuse 0 emission 1 p 4  -1 0.9 -1  -1 0.9 1  %g 0.9 1  %g 0.9 -1\n", x + top, x - top);
        ASSERT_EQ(error_of(view("0.5") + "material diffuse 0.9 colour 0.9 0.9 0.9 " + box(-1, 1) + wall + roof), "");
        build<q32>();
        const scene::Frame& frame = [] {
            static scene::Frame f;
            const scene::Settings settings;
            scene::Builder<q32> builder(description(), settings, storage<q32>());
            scene::Error error;
            EXPECT_TRUE(builder.build(error));
            f = builder.frame;
            return f;
        }();
        for (int k = 0; k < 400; k++) {
            const Vec3d p{(k % 20 - 9.5) * 0.1, -1, (k / 20 - 9.5) * 0.1};
            const double off = p.x - x - p.z * top;
            if (std::fabs(off) < 1e-3)
                continue;
            const auto a = light_at<q32>(2, false, frame, p), b = light_at<q32>(2, true, frame, p); // the floor
            if (off > 0)
                EXPECT_EQ(std::max(a.x.raw, b.x.raw), 0) << p.x << ' ' << p.z << ' ' << i;
            else
                EXPECT_GT(scene::value(std::max(a.x, b.x)), 0.02) << p.x << ' ' << p.z << ' ' << i;
        }
    }
}

// What walls take is what the lamp gives, and nowhere is more than that.
TEST(Radiosity, EnergyNeverGrows)
{
    ASSERT_EQ(error_of(view("0.25") + "material colour 0.7 0.7 0.7 diffuse 1 " + box(-1, 1)
        + "material diffuse 0 emission 1 "
                       + square(0, 0.5, 0, 0.5)),
              "");
    double taken = 0;
    for (uint32_t i = 0; i < 6; i++) {
        taken += mean_of_cells(i) * 4 * 0.3;
        for (uint32_t side = 0; side < 2; side++)
            for (const double light : lights(i, side))
                EXPECT_LT(light, 1 / 0.3);
    }
    const double given = 2;          // both sides of it; some of what comes back ends there
    EXPECT_LT(taken, given * 1.005);
    EXPECT_GT(taken, given * 0.6);
}

// Lamps, suns and panels are sent on as well, and what takes no part sends on what it has of them.
TEST(Radiosity, OfLampsAndOfWhatTakesNoPart)
{
    // A lit floor, seen by a wall on it: half of its half sphere but for the end.
    const std::string scene =
        "v from 0 1 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 8 8 ambientlight 0 0 0 radiosity 5 far 900\n";
    ASSERT_EQ(error_of(scene
                       + "sun 0 1 0  1 1 1 material diffuse 0.5 p 4  -900 0 -900  -900 0 900  900 0 900  900 0 -900\n"
                       "material diffuse 1 p 4 -1 1 0  1 1 0  1 2 0  -1 2 0\n"),
              "'radiosity 5' needs 259202 cells of light; expected at most 32768 (limit 'cells')");
    ASSERT_EQ(error_of(scene + "sun 0 1 0  1 1 1 material diffuse 0.5 plane 0 0 0 0 1 0\n"
                       "material diffuse 1 p 4 -1 1 0  1 1 0  1 2 0  -1 2 0\n"), "");
    EXPECT_NEAR(mean_of_cells(0), 0.25, 0.005);
    ASSERT_EQ(error_of(scene + "panel 2  0 900 0  1 0 0  0 0 1  1 1 1 material diffuse 0.5 plane 0 0 0 0 1 0\n"
                       "material diffuse 1 p 4 -1 1 0  1 1 0  1 2 0  -1 2 0\n"), "");
    EXPECT_NEAR(mean_of_cells(0), 0.25, 0.005);
    // Around a ball that glows: the share of the sky that it takes.
    ASSERT_EQ(error_of(scene + "material diffuse 1 p 4 -0.1 0 -0.1  -0.1 0 0.1  0.1 0 0.1  0.1 0 -0.1\n"
                       "material diffuse 0 emission 1 s 0 2 0 1\n"), "");
    EXPECT_NEAR(mean_of_cells(0), 0.25, 0.005);
}

TEST(Radiosity, IsTheSameInAnyOrder)
{
    const std::string text = view("0.4") + "b 0.1 0.2 0.3 material colour 0.7 0.6 0.5 diffuse 0.9 " + box(-1, 1)
        + box(-0.8, 0.1)
        + "material diffuse 0 emission 9 " + square(0.2, 0.8, 0.1, 0.1);
    ASSERT_EQ(error_of(text), "");
    const std::vector<Vec3d> light(description().light, description().light + description().light_size);
    ASSERT_GT(light.size(), 400u);
    ASSERT_EQ(error_of(text, true), "");
    EXPECT_EQ(light, std::vector<Vec3d>(description().light, description().light + description().light_size));
}

// Corners off the plane, in line, twice the same; edges that cross; far away; cells that are large, small, too many.
TEST(Radiosity, OfHostileScenes)
{
    Random random(321);
    const auto in = [&random](double low, double high) { return random.uniform(low, high); };
    int solved = 0;
    for (int i = 0; i < 60; i++) {
        const double size = i % 3 == 0 ? std::pow(10, in(-9, 9)) : 1, off = i % 4 == 0 ? in(-3, 3) * size : 0;
        const auto number = [&] {
            char text[40];
            const double v = in(-1, 1);
            std::snprintf(text, sizeof text, " %.17g", off + size * (i % 2 == 0 ? std::round(v * 2) / 2 : v));
            return std::string(text);
        };
        const auto point = [&] { return number() + number() + number(); };
        char edge[40];
        std::snprintf(edge, sizeof edge, "%.17g", size * std::pow(10, in(-0.3, 2)));
        char eye[40];
        std::snprintf(eye, sizeof eye, " %.17g", off + 3 * size);
        std::string text = "v from" + number() + number() + eye + " at" + point()
            + " up 1 2 3 angle 60 hither 1 resolution 2 2 b 0.5 0.2 0.1 radiosity " + edge + " l" + point()
            + " 0.2 0.1 0.3\n";
        for (uint64_t k = 1 + random.bits() % 7; k > 0; k--) {
            if (random.bits() % 2 == 0)
                text += "material colour 0.8 0.6 0.9 diffuse 0.7 emission 0.4 transmit 0.1\n";
            else if (random.bits() % 2 == 0)
                text += "material colour 0.8 0.6 0.9 diffuse 0.9 texture noise 0.1 0.9 0.5 0.3\n";
            const uint64_t count = 3 + random.bits() % 6;
            const uint64_t kind = random.bits() % 8;
            char radius[40];
            std::snprintf(radius, sizeof radius, " %.17g\n", size / 2);
            if (kind == 0)
                text += "s" + point() + radius;
            else if (kind == 1)
                text += "disc" + point() + " 1 2 3" + radius;
            else
                for (text += "p " + std::to_string(count); text.back() != '\n';) {
                    for (uint64_t c = 0; c < count; c++)
                        text += point();
                    text += "\n";
                }
        }
        const std::string error = error_of(text, false, 16);
        if (!error.empty())
            continue;
        solved++;
        for (uint32_t k = 0; k < description().light_size; k++) {
            const Vec3d& light = description().light[k];
            ASSERT_TRUE(light.x >= 0 && light.y >= 0 && light.z >= 0 && scene::largest(light) < 64) << text;
        }
        build<q32>();
        build<Double>();
        const auto q = storage<q32>().view<scene::desktop_effects()>();
        const auto d = storage<Double>().view<scene::desktop_effects()>();
        for (uint32_t k = 0; k < 4; k++) {
            RayCount count;
            render_pixel(q, k % 2, k / 2, count);
            render_pixel(d, k % 2, k / 2, count);
        }
    }
    EXPECT_GT(solved, 30);
}

TEST(Radiosity, OfARoomThatLosesNoneIsAnError)
{
    const std::string error = error_of(view("2") + "material diffuse 1 emission 1 " + box(-1, 1));
    EXPECT_NE(error.find("a room that loses none has no picture"), std::string::npos);
}

} // namespace
