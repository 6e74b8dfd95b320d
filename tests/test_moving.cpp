#include <qray/scene/look_at.hpp>
#include <qray/scene/refit.hpp>

#include "scene_helpers.hpp"

#include "../src/scene/emitter.hpp"
#include "../src/scene/moving.hpp"

#ifndef QRAY_MOVES
#define QRAY_MOVES 20000
#endif

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct MovingTest : ::testing::Test {};
TYPED_TEST_SUITE(MovingTest, NumberSystems, SystemNames);

// Numbers that a text and a Coordinate both hold: eighths.
std::string eighths(int v)
{
    char text[32];
    snprintf(text, sizeof text, "%.3f", v / 8.0);
    return text;
}
template <class N>
ScenePoint<N> place_of(int x, int y, int z)
{
    return {coordinate<N>(x, 8), coordinate<N>(y, 8), coordinate<N>(z, 8)};
}
std::string text_of(int x, int y, int z) { return eighths(x) + " " + eighths(y) + " " + eighths(z) + " "; }

scene::Settings moving()
{
    scene::Settings s;
    s.compiled = true;
    EXPECT_TRUE(scene::read_moving("all", s.moving));
    s.within.add({-10, -10, -10});
    s.within.add({10, 10, 10});
    return s;
}

std::string scene_text(const std::string& view, const std::string& objects, const std::string& lights = "")
{
    return "v\n" + view + "\nangle 40\nhither 0\nresolution 16 12\nl 1 2 3\n" + lights + "\nf 1 1 1 1 0 0 0 1\n"
        + objects
        + "\n";
}
const char* const any_view = "from 0 0 9\nat 0 0 0\nup 0 1 0";

TEST(Sine, IsWithinItsBound)
{
    long double worst = 0;
    Random random(1);
    for (int i = 0; i < 200'000; i++) {
        const auto angle = i < 4096 ? static_cast<uint32_t>(i) << 20 : static_cast<uint32_t>(random.bits());
        const SineCosine got = sine_cosine(angle);
        const long double turns = 2 * 3.14159265358979323846264338327950288L * angle / 4294967296.0L;
        worst = fmaxl(worst, fabsl(got.sine - ldexpl(sinl(turns), 30)));
        worst = fmaxl(worst, fabsl(got.cosine - ldexpl(cosl(turns), 30)));
    }
    EXPECT_LE(worst, 1.25L);
    const int32_t one = 1 << 30;
    for (uint32_t quarter = 0; quarter < 4; quarter++) {
        const SineCosine got = sine_cosine(quarter << 30);
        EXPECT_EQ(got.sine, quarter == 1 ? one : quarter == 3 ? -one : 0);
        EXPECT_EQ(got.cosine, quarter == 0 ? one : quarter == 2 ? -one : 0);
    }
    EXPECT_EQ(part_of_turn(1, 3), 0x5555'5555u);
    EXPECT_EQ(part_of_turn(1000, 1000), 0u);
    EXPECT_EQ(part_of_turn(65535, 65536), 0xffff'0000u);
}

TYPED_TEST(MovingTest, FrameIsTheBuilders)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text(any_view, "s 1 2 -3 1.25"), moving()));
    const auto& s = storage<N>();
    const Point<N> centre = s.frame.point(place_of<N>(8, 16, -24));
    EXPECT_EQ(centre, s.spheres.data[0].centre);
    expect_near(value(s.frame.place(centre)), {1, 2, -3}, N::is_fixed ? 1.0 / 65536 : 1e-6);
    EXPECT_EQ(value(s.frame.length(coordinate<N>(5, 4))), std::ldexp(value(s.spheres.data[0].radius),
                                                                          -s.spheres.data[0].fine));
    if constexpr (N::is_fixed) { // clamped, and so out of the world
        const Coordinate<N> most{INT32_MAX}, least{INT32_MIN};
        EXPECT_FALSE(ball_in_world<N>(s.frame.point({most, least, most}), N::length_zero));
        EXPECT_EQ(detail::shifted_even(INT64_MAX / 2, 40), INT32_MAX);
        EXPECT_EQ(detail::shifted_even(-(INT64_MAX / 2), 3), -INT32_MAX);
        EXPECT_EQ(detail::shifted_even(5, -1), 2); // halves to even
        EXPECT_EQ(detail::shifted_even(7, -1), 4);
        EXPECT_EQ(detail::shifted_even(-5, -1), -2);
        EXPECT_EQ(detail::shifted_even(-7, -62), 0);
    }
}

// Of the camera that a desktop makes of the same numbers, in ulp of Unit.
template <class N>
double off(const Camera<N>& a, const Camera<N>& b)
{
    // The pencils as the samples at the picture's edges add them up, to the largest of these as 1.
    const double half = std::tan(20 * M_PI / 180);
    const double most = N::is_fixed ? std::ldexp(1, NarrowFixed<N> ? 29 : 60)
        : std::fmax(1, half * std::fmax(1, double(a.width) / a.height));
    const auto real_of = [most](const Pencil<N>& p, int k) {
        return Vec3{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)} * (k / most);
    };
    double worst = distance(real_of(a.centre, 1), real_of(b.centre, 1));
    worst = std::fmax(worst, distance(real_of(a.right, a.grid * a.width), real_of(b.right, a.grid * a.width)));
    worst = std::fmax(worst, distance(real_of(a.down, a.grid * a.height), real_of(b.down, a.grid * a.height)));
    return worst / make<N>::unit_ulp();
}

TYPED_TEST(MovingTest, CamerasAreTheDesktops)
{
    using N = TypeParam;
    Random random(7);
    double worst = 0, worst_angle = 0;
    for (int i = 0; i < 400; i++) {
        const auto coordinate_of = [&] { return static_cast<int>(random.bits() % 145) - 72; };
        const int e[3] = {coordinate_of(), coordinate_of(), coordinate_of()},
                  a[3] = {coordinate_of(), coordinate_of(), coordinate_of()},
                  u[3] = {coordinate_of(), coordinate_of(), coordinate_of()};
        const Vec3 along{double(a[0] - e[0]), double(a[1] - e[1]), double(a[2] - e[2])},
            above{double(u[0]), double(u[1]), double(u[2])};
        const Vec3 across{along.y * above.z - along.z * above.y, along.z * above.x - along.x * above.z,
                          along.x * above.y - along.y * above.x};
        if (!(length(across) > 0.25 * length(along) * length(above)))
            continue;
        scene::Settings settings = moving();
        settings.width = 1 + static_cast<uint32_t>(random.bits() % 640);
        settings.height = 1 + static_cast<uint32_t>(random.bits() % 480);
        settings.grid = 1 + static_cast<uint32_t>(random.bits() % 3);
        const std::string view = "from " + text_of(e[0], e[1], e[2]) + "\nat " + text_of(a[0], a[1], a[2]) + "\nup "
            + text_of(u[0], u[1], u[2]);
        ASSERT_TRUE(loaded<N>(scene_text(view, "s 0 0 0 1"), settings));
        const auto& s = storage<N>();
        const View<N> at{place_of<N>(e[0], e[1], e[2]), place_of<N>(a[0], a[1], a[2]), place_of<N>(u[0], u[1], u[2]),
            s.text_view.field};
        Camera<N> camera = s.camera;
        camera.eye = {};
        camera.centre = camera.right = camera.down = {};
        ASSERT_TRUE(look_at(camera, s.frame, at));
        EXPECT_EQ(camera.eye, s.camera.eye);
        worst = std::fmax(worst, off(camera, s.camera));
        // The same from the field as an angle.
        View<N> by_angle = at;
        by_angle.field = field<N>(part_of_turn(40, 360));
        ASSERT_TRUE(look_at(camera, s.frame, by_angle));
        if (N::is_fixed || sizeof(typename N::Length) == 4)
            worst_angle = std::fmax(worst_angle, off(camera, s.camera));
    }
    EXPECT_LE(worst, 2);
    EXPECT_LE(worst_angle, 2);
}

// Down to the smallest angles that there are: in few bits a step rounds to 0, and nothing is undefined.
TYPED_TEST(MovingTest, ACameraOfNextToNoAngle)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text(any_view, "s 0 0 0 1"), moving()));
    const auto& s = storage<N>();
    for (const uint32_t angle : {1u, 2u, 3u, 5u, 8u}) {
        Camera<N> camera = s.camera;
        const bool looks = look_at(camera, s.frame,
                                   {place_of<N>(1, 2, 3), place_of<N>(0, 0, 0), place_of<N>(0, 1, 0), field<N>(angle)});
        EXPECT_TRUE(looks || angle == 1) << angle;
        if (NarrowFixed<N> && looks) {
            EXPECT_EQ(camera.right.x, 0) << angle;
            EXPECT_EQ(camera.down.y, 0) << angle;
        }
    }
}

// All that moves, by so many eighths from where it is at first; the ball's radius is that.
std::string shapes(int x, int y, int z, int radius)
{
    const auto at = [&](int dx, int dy, int dz) { return text_of(x + 8 * dx, y + 8 * dy, z + 8 * dz); };
    return "s " + at(1, 2, -3) + eighths(radius) + "\ndisc " + at(-2, 1, 0) + "0 1 0 1.5\nc " + at(0, 0, 0) + "1 "
        + at(0, 2, 0) + "0.5\np 4 " + at(0, 0, 0) + at(2, 0, 0) + at(2, 2, 0) + at(0, 2, 0) + "\npp 3 "
        + at(1, 1, 1) + "0 0 1 " + at(3, 1, 1)
        + "0 1 1 " + at(1, 3, 1) + "1 0 1\n";
}
std::string lights(int x, int y, int z)
{
    return "l " + text_of(x + 24, y + 32, z + 40) + "\npanel 2 " + text_of(x, y + 40, z) + "1 0 0 0 0 1";
}

template <class N>
std::string emitted()
{
    std::string text;
    scene::Source out([](void* to, const char* bytes, size_t size) {
        static_cast<std::string*>(to)->append(bytes, size);
        return true;
    }, &text);
    scene::Emitter<N>(storage<N>(), out).emit("", "", "scene");
    EXPECT_TRUE(out.finish());
    return text;
}

// Where motion takes all that was loaded; in place.
template <class N>
bool move_all(const Motion<N>& motion)
{
    auto& s = storage<N>();
    const Corners<N> corners{s.vertices.data, s.normals.data};
    const MovedCorners<N> moved{s.vertices.data, s.normals.data};
    bool all = true;
#define QRAY_MOVE(Type, name, table) \
    for (uint32_t i = 0; i < s.table.count; i++) \
        all = move(s.table.data[i], corners, motion, s.table.data[i], moved) && all;
    QRAY_SHAPES(QRAY_MOVE)
#undef QRAY_MOVE
#define QRAY_MOVE(Type, name, table) \
    for (uint32_t i = 0; i < s.table.count; i++) \
        all = move(s.table.data[i], motion, s.table.data[i]) && all;
    QRAY_LIGHTS(QRAY_MOVE)
#undef QRAY_MOVE
    return all;
}

// Every number of every table is that of the text with the other numbers.
TYPED_TEST(MovingTest, WhatIsShiftedIsAsInTheText)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text(any_view, shapes(13, -7, 11, 9), lights(13, -7, 11)), moving()));
    const std::string expected = emitted<N>();
    ASSERT_TRUE(loaded<N>(scene_text(any_view, shapes(0, 0, 0, 9), lights(0, 0, 0)), moving()));
    EXPECT_NE(emitted<N>(), expected);
    // The lamp of scene_text stays.
    const Light<N> lamp = storage<N>().lights.data[0];
    Motion<N> motion(storage<N>().frame);
    motion.shift(place_of<N>(13, -7, 11));
    EXPECT_TRUE(move_all(motion));
    storage<N>().lights.data[0] = lamp;
    EXPECT_EQ(emitted<N>(), expected);
}

TYPED_TEST(MovingTest, WhatIsPlacedIsAsInTheText)
{
    using N = TypeParam;
    for (const int radius : {1, 3, 8, 20, 36}) {
        ASSERT_TRUE(loaded<N>(scene_text(any_view, shapes(-9, 5, 2, radius)), moving()));
        const std::string expected = emitted<N>();
        auto& s = storage<N>();
        Sphere<N> ball = s.spheres.data[0];
        ASSERT_TRUE(place(s.spheres.data[0], s.frame, place_of<N>(1, 2, 3), coordinate<N>(3, 8)));
        ASSERT_TRUE(place(s.lights.data[0], s.frame, place_of<N>(3, 2, 1)));
        EXPECT_NE(emitted<N>(), expected);
        ASSERT_TRUE(place(s.spheres.data[0], s.frame, place_of<N>(-9 + 8, 5 + 16, 2 - 24), coordinate<N>(radius, 8)));
        ASSERT_TRUE(place(s.lights.data[0], s.frame, place_of<N>(8, 16, 24)));
        EXPECT_EQ(emitted<N>(), expected);
        // A scale does the same, but for the sub-ulp rounding of the centre.
        if (radius < 20) {
            Motion<N> twice(s.frame);
            twice.about(s.frame.place(ball.centre)).scale(coordinate<N>(2));
            ASSERT_TRUE(move(ball, twice, s.spheres.data[0]));
            Sphere<N> doubled{};
            ASSERT_TRUE(place(doubled, s.frame, s.frame.place(ball.centre), coordinate<N>(2 * radius, 8)));
            EXPECT_EQ(doubled.radius, s.spheres.data[0].radius);
            EXPECT_EQ(doubled.centre, s.spheres.data[0].centre);
            EXPECT_EQ(doubled.fine, s.spheres.data[0].fine);
        }
    }
    // Lamps far outside.
    auto& s = storage<N>();
    for (const int far : {40, 300, 2000}) {
        ASSERT_TRUE(loaded<N>(scene_text(any_view, "s 0 0 0 1", "l 0 " + std::to_string(far) + " 1"), moving()));
        const Light<N> expected = s.lights.data[1];
        ASSERT_TRUE(place(s.lights.data[0], s.frame, place_of<N>(0, 8 * far, 8)));
        EXPECT_EQ(s.lights.data[0].at, expected.at);
        EXPECT_EQ(s.lights.data[0].shift, expected.shift);
    }
}

// A sun's direction and a material's colour; in q16 and q32 every number, in floating point but for the last bit.
TYPED_TEST(MovingTest, SunsAndColoursAreAsInTheText)
{
    using N = TypeParam;
    const auto text = [](const std::string& sun, const std::string& colour) {
        return "v\n" + std::string(any_view) + "\nangle 40\nhither 0\nresolution 16 12\nsun " + sun
            + " 0.5 0.5 0.5\nmaterial colour " + colour + "\ns 0 0 0 1\n";
    };
    auto& s = storage<N>();
    ASSERT_TRUE(loaded<N>(text("1 2 -3", "1 0.25 0.125"), moving()));
    const std::string expected = emitted<N>();
    const Direction<N> from = s.suns.data[0].from;
    ASSERT_TRUE(loaded<N>(text("0 1 0", "0.5 0.5 0.5"), moving()));
    EXPECT_NE(emitted<N>(), expected);
    EXPECT_TRUE(place(s.suns.data[0], place_of<N>(8, 16, -24)));
    EXPECT_TRUE(paint(s.mattes.data[0], place_of<N>(8, 2, 1)));
    EXPECT_FALSE(paint(s.mattes.data[0], place_of<N>(9, 2, 1)));
    EXPECT_FALSE(paint(s.mattes.data[0], place_of<N>(8, -1, 1)));
    EXPECT_FALSE(place(s.suns.data[0], place_of<N>(0, 0, 0)));
    if constexpr (!N::is_fixed) {
        EXPECT_LE(distance(value(s.suns.data[0].from), value(from)), 2 * make<N>::unit_ulp());
        s.suns.data[0].from = from;
    }
    EXPECT_EQ(emitted<N>(), expected);
}

TYPED_TEST(MovingTest, TurnsAreTurns)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text(any_view, shapes(0, 0, 0, 9), lights(0, 0, 0)), moving()));
    auto& s = storage<N>();
    const Sphere<N> first = s.spheres.data[0];
    const Cone<N> cone = s.cones.data[0];
    Random random(3);
    double worst = 0, worst_axis = 0;
    for (int i = 0; i < 1000; i++) {
        const Vec3 axis = random.direction();
        const auto angle = static_cast<uint32_t>(random.bits());
        Motion<N> motion(s.frame);
        const ScenePoint<N> exact{coordinate<N>(int(axis.x * 3000)), coordinate<N>(int(axis.y * 3000)),
            coordinate<N>(int(axis.z * 3000))};
        motion.about(place_of<N>(4, -4, 8)).turn(exact, angle);
        Sphere<N> turned{};
        Cone<N> turned_cone{};
        ASSERT_TRUE(move(first, motion, turned));
        ASSERT_TRUE(move(cone, motion, turned_cone));
        const Vec3 u = unit(value(exact)), pivot = value(s.frame.point(place_of<N>(4, -4, 8)));
        const double turns = 2 * M_PI * std::ldexp(angle, -32), c = std::cos(turns), sine = std::sin(turns);
        const auto about = [&](const Vec3& v) { // Rodrigues
            const Vec3 across{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
            return v * c + across * sine + u * ((1 - c) * (u.x * v.x + u.y * v.y + u.z * v.z));
        };
        const double off = distance(value(turned.centre), pivot + about(value(first.centre) - pivot));
        const double off_axis = distance(value(turned_cone.axis), about(value(cone.axis)));
        // Sines have 30 bits in double, too.
        worst = std::fmax(worst, off / std::fmax(make<N>::length_ulp(16), 0x1p-26));
        worst_axis = std::fmax(worst_axis, off_axis / std::fmax(make<N>::unit_ulp(), 0x1p-30));
    }
    EXPECT_LE(worst, 1.5);
    EXPECT_LE(worst_axis, 3);
    // A thousand turns by a thousandth of a circle, each from where it was at first, end there.
    Sphere<N> now = first;
    for (uint32_t k = 1; k <= 1000; k++) {
        Motion<N> motion(s.frame);
        motion.about(place_of<N>(4, -4, 8)).turn(place_of<N>(1, 2, 3), part_of_turn(k, 1000));
        ASSERT_TRUE(move(first, motion, now));
        EXPECT_EQ(now.centre == first.centre, k == 1000);
    }
    // In place, an ulp a turn at most adds up.
    now = first;
    for (uint32_t k = 0; k < 1000; k++) {
        Motion<N> motion(s.frame);
        motion.about(place_of<N>(4, -4, 8)).turn(place_of<N>(1, 2, 3), part_of_turn(1, 1000));
        ASSERT_TRUE(move(now, motion, now));
    }
    const double drift = distance(value(now.centre), value(first.centre)) / std::fmax(make<N>::length_ulp(16), 0x1p-26);
    EXPECT_LE(drift, 1000);
}

// A tree that was refitted tells no other shapes than none does.
template <class N>
bool refitted_tree_tells_all()
{
    constexpr Effects with_tree = flat();
    constexpr Effects without = [] {
        Effects e = flat();
        e.flat_tree = false;
        return e;
    }();
    auto& s = storage<N>();
    refit(s.template view<with_tree>(), s.entries.data);
    return draw<N, with_tree>() == draw<N, without>();
}

TYPED_TEST(MovingTest, TreesFollow)
{
    using N = TypeParam;
    std::string text;
    Random random(5);
    for (int i = 0; i < 12; i++) {
        const auto part = [&] { return static_cast<int>(random.bits() % 33) - 16; };
        text += shapes(part(), part(), part(), 1 + i);
    }
    ASSERT_TRUE(loaded<N>(scene_text("from 1 2 9\nat 0 0 0\nup 0 1 0", text), moving()));
    auto& s = storage<N>();
    ASSERT_GT(s.entries.count, 20u);
    EXPECT_EQ(s.triangles.count + s.smooth_triangles.count, 0u);
    for (uint32_t k = 0; k < 4; k++) {
        Motion<N> motion(s.frame);
        motion.turn(place_of<N>(1, 2, 3), k << 29).shift(place_of<N>(1, -2, 1));
        const auto corners = Corners<N>{s.vertices.data, s.normals.data};
        for (uint32_t i = k % 2; i < s.spheres.count; i += 2)
            ASSERT_TRUE(move(s.spheres.data[i], motion, s.spheres.data[i]));
        for (uint32_t i = 0; i < s.cones.count; i += 2)
            ASSERT_TRUE(move(s.cones.data[i], motion, s.cones.data[i]));
        for (uint32_t i = 0; i < s.discs.count; i += 2)
            ASSERT_TRUE(move(s.discs.data[i], motion, s.discs.data[i]));
        for (uint32_t i = 0; i < s.patches.count; i += 3)
            ASSERT_TRUE(move(s.patches.data[i], corners, motion, s.patches.data[i], {s.vertices.data, s.normals.data}));
        for (uint32_t i = 0; i < s.polygons.count; i += 3)
            ASSERT_TRUE(move(s.polygons.data[i], corners, motion, s.polygons.data[i],
                {s.vertices.data, s.normals.data}));
        EXPECT_TRUE(refitted_tree_tells_all<N>()) << k;
    }
}

// Where one of two triangles that share corners was moved, the other's plane may be met anywhere: in floating point far
// outside of the world, whose tree a ray from there must not leave.
TYPED_TEST(MovingTest, RaysFromOutsideOfTheWorldMeetNothing)
{
    using N = TypeParam;
    if constexpr (!N::is_fixed) {
        constexpr Effects effects = [] {
            Effects e;
            e.sphere = e.flat_tree = e.moving = true;
            return e;
        }();
        std::string balls;
        for (int i = 0; i < 40; i++)
            balls += "s " + text_of(i, i * i % 64, 0) + "0.5\n";
        ASSERT_TRUE(loaded<N>(scene_text(any_view, balls), moving()));
        const auto scene = storage<N>().template view<effects>();
        ASSERT_GT(scene.entries.count, 0u);
        const auto meets = [&](const Point<N>& origin, const Direction<N>& direction) {
            Hit<N> hit;
            return nearest(scene, Ray<N>{origin, direction, {Tag::none}, false}, hit);
        };
        const Point<N>& ball = scene.spheres[0].centre;
        EXPECT_TRUE(meets({ball.x, ball.y, 60}, {0, 0, -1}));
        using Length = typename N::Length;
        for (const Length far : {Length(129), Length(300), Length(1e30)})
            for (const typename N::Unit d : {typename N::Unit(-1), typename N::Unit(1)}) {
                EXPECT_FALSE(meets({far, 0, 0}, {d, 0, 0})) << far;
                EXPECT_FALSE(meets({0, -far, 0}, {0, d, 0})) << far;
                EXPECT_FALSE(meets({0, 0, far}, {d, 0, 0})) << far;
            }
    }
}

// A polygon whose corners are not in one plane is met beside them by rays that are flat to it.
TYPED_TEST(MovingTest, TreesFollowUnevenPolygons)
{
    using N = TypeParam;
    for (const int seed : {1, 2, 5}) { // without what a box is wider by, these differed
        Random random(static_cast<uint64_t>(seed) + 1);
        const auto part = [&](int from, uint64_t range) { return static_cast<int>(random.bits() % range) + from; };
        std::string text;
        for (int i = 0; i < 48; i++) {
            const int x = part(-48, 97), z = part(-72, 81), y = part(-4, 9);
            const int beside = part(-48, 97), behind = part(-72, 81);
            text += "p 4 " + text_of(x, y, z) + text_of(x + 8, y, z) + text_of(x + 8, y + 1 + seed % 5, z + 8)
                + text_of(x, y, z + 8) + "\n";
            if (i % 2 != 0) // a wall
                text += "p 4 " + text_of(beside, -8, behind) + text_of(beside + 8, -8, behind)
                    + text_of(beside + 8, 8, behind) + text_of(beside, 8, behind) + "\n";
        }
        ASSERT_TRUE(loaded<N>("v\nfrom 0 " + eighths(seed) + " 9\nat 0 0 0\nup 0 1 0\nangle 60\nhither 0\n"
                                  + "resolution 96 72\nl 1 2 3\nf 1 1 1 1 0 0 0 1\n" + text, moving()));
        EXPECT_TRUE(move_all(Motion<N>(storage<N>().frame)));
        EXPECT_TRUE(refitted_tree_tells_all<N>()) << seed;
    }
}

// Whatever is asked: false, and nothing changed, or a picture.
TYPED_TEST(MovingTest, HostileMoves)
{
    using N = TypeParam;
    constexpr Effects effects = flat();
    ASSERT_TRUE(loaded<N>(scene_text(any_view, shapes(0, 0, 0, 9) + shapes(3, 4, 5, 6) + shapes(-9, -8, 7, 4)
        + shapes(8, 8, 8, 1) + shapes(-3, 5, 1, 2)
                                     + shapes(2, -9, 0, 3) + shapes(5, 0, -8, 4) + shapes(-5, -5, 8, 3)
                                     + "plane 0 -2 0 0 1 0\ns 0 0 0 6\ndisc 0 0 0 1 0 0 8\nc -6 0 0 3 6 0 0 3",
                                         lights(0, 0, 0)), moving()));
    auto& s = storage<N>();
    ASSERT_GT(s.entries.count, 0u);
    Random random(11);
    const auto part = [&]() -> Coordinate<N> {
        const uint64_t bits = random.bits(), kind = bits >> 60;
        if constexpr (N::is_fixed) {
            constexpr int32_t extremes[] = {INT32_MAX, INT32_MIN, 0, 1, -1, 1 << 16, INT32_MIN + 1};
            if (kind < 4)
                return {extremes[bits % 7]};
            return {static_cast<int32_t>(bits) >> (kind < 8 ? bits >> 40 & 31 : 12 + (bits >> 40 & 3))};
        } else {
            using F = typename N::Length;
            const F huge = std::numeric_limits<F>::max(), infinite = std::numeric_limits<F>::infinity();
            const F extremes[] = {huge, -huge, infinite, -infinite, std::numeric_limits<F>::quiet_NaN(),
                                  std::numeric_limits<F>::denorm_min(), -0.0f, 0};
            if (kind < 4)
                return extremes[bits % 8];
            return static_cast<F>(std::ldexp(random.uniform(-1, 1), kind < 8 ? static_cast<int>(bits % 200) - 100 : 3));
        }
    };
    const auto somewhere = [&] { return ScenePoint<N>{part(), part(), part()}; };
    const Light<N> lamp = s.lights.data[0];
    const Sun<N> sun{};
    int moved = 0, looked = 0;
    for (int i = 0; i < QRAY_MOVES; i++) {
        Motion<N> motion(s.frame);
        if (random.bits() & 1)
            motion.about(somewhere());
        if (random.bits() & 1)
            motion.turn(somewhere(),
                        static_cast<uint32_t>(random.bits()) & ((random.bits() & 3) == 0 ? 0xc000'0000 : ~0u));
        if ((random.bits() & 3) == 0)
            motion.scale(part());
        if (random.bits() & 1)
            motion.shift(somewhere());
        moved += move_all(motion);
        if ((random.bits() & 3) == 0)
            moved += place(s.spheres.data[0], s.frame, somewhere(), part());
        Light<N> light = lamp;
        if (place(light, s.frame, somewhere()))
            s.lights.data[0] = light;
        Sun<N> other = sun;
        if (place(other, somewhere())) {
            EXPECT_NEAR(length(value(other.from)), 1, NarrowFixed<N> ? 3e-4 : 1e-5);
        }
        paint(s.mattes.data[0], somewhere());
        const View<N> view{somewhere(), somewhere(), somewhere(),
                           random.bits() & 1 ? field<N>(static_cast<uint32_t>(random.bits()))
                               : field_of_tangent<N>(part())};
        looked += look_at(s.camera, s.frame, view);
        refit(s.template view<effects>(), s.entries.data);
        if (i % 8 == 0)
            light_at<N, effects>(static_cast<uint32_t>(i) % 16, static_cast<uint32_t>(i) % 12);
    }
    EXPECT_GT(moved, 10);
    EXPECT_GT(looked, 10);
}

} // namespace
