// Windows only leave out what a ray cannot meet: with them and without them every picture is the same. And they leave
// out most of it: their places are those of closed forms, but for a pixel or two.
#include "scene_helpers.hpp"

#include "../src/scene/window_builder.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct WindowsTest : ::testing::Test {};
using Floating = ::testing::Types<Float, Double>;
TYPED_TEST_SUITE(WindowsTest, Floating, SystemNames);

constexpr Effects effects(bool windows)
{
    Effects e;
    e.sphere = e.disc = e.cone = e.polygon = e.patch = e.checker = true;
    e.light = e.sun = e.shadow = e.see_through = e.highlight = e.mirror = e.transmit = e.grid = true;
    e.windows = windows;
    e.depth = 5;
    return e;
}

template <class N>
std::vector<uint8_t> drawn(const Scene<N, effects(true)>& scene)
{
    std::vector<uint8_t> rgb(size_t{scene.camera.width} * scene.camera.height * 3);
    for (uint32_t j = 0; j < scene.camera.height; j++)
        render_row<Rgb888>(scene, j, &rgb[size_t{j} * scene.camera.width * 3]);
    return rgb;
}

// The set that a ray of pixel (i, j) starts with: `which` 0 for the eye, 1 in the floor, 2 before a light.
template <class N>
bool in_sight(const scene::WindowBuilder<N>& builder, uint32_t i, uint32_t j, uint32_t shape, uint32_t which)
{
    struct {
        struct {
            Windows value;
        } windows;
    } scene{{builder.windows()}};
    return Sweep<true>(scene, j).at(i).sets >> (31 - shape - set_capacity * which) & 1;
}

std::string numbers(std::initializer_list<double> list)
{
    std::string text;
    for (double v : list)
        text += " " + std::to_string(v);
    return text;
}

std::string random_scene(Random& random)
{
    const auto in = [&random](double low, double high) { return random.uniform(low, high); };
    std::string text = "v from" + numbers({in(-3, 3), random.bits() % 8 ? in(0.2, 4) : in(0.0005, 0.05), in(4, 9)}) + " at" + numbers({in(-1, 1), in(-1, 2), 0})
        + " up" + numbers({in(-0.3, 0.3), 1, in(-0.3, 0.3)}) + " angle" + numbers({in(20, random.bits() % 8 ? 100 : 170)})
        + " hither 0 resolution 29 23\n b 0.3 0.4 0.5\n";
    const double far = random.bits() % 4 ? 1 : std::pow(10, in(0, 9));
    for (uint64_t lights = 1 + random.bits() % 2; lights > 0; lights--)
        text += random.bits() % 2 ? "l" + numbers({in(-6, 6) * far, in(0.5, 8) * far, in(-6, 6) * far, 0.8, 0.7, 0.6}) + "\n"
                                  : "sun" + numbers({in(-1, 1), in(-0.2, 1), in(-1, 1), 0.6, 0.6, 0.7}) + "\n";
    if (random.bits() % 4 != 0)
        text += "material colour 0.8 0.8 0.8 diffuse 0.7 mirror 0.4 texture checker 0.1 0.1 0.1 0.7\n"
            + (random.bits() % 2 ? std::string("plane 0 0 0 0 1 0\n")
                                 : "disc" + numbers({0, 0, 0, in(-0.5, 0.5), 1, in(-0.5, 0.5), in(1, 8)}) + "\n");
    for (uint64_t shapes = random.bits() % 9; shapes > 0; shapes--) {
        text += "material colour" + numbers({in(0, 1), in(0, 1), in(0, 1)}) + " diffuse 0.6 highlight 0.5 shine 20 mirror"
            + numbers({random.bits() % 2 ? 0.0 : in(0, 0.8)})
            + (random.bits() % 3 ? "\n" : " transmit" + numbers({in(0, 0.2)}) + " ior 1.4\n");
        const double r = random.bits() % 4 ? in(0.05, 1) : std::pow(10, in(-3, 0));
        const Vec3 p = random.point(2), q = p + random.direction() * r, s = p + random.direction() * r;
        switch (random.bits() % 9) {
        case 0: text += "disc" + numbers({p.x, p.y, p.z, q.x - p.x, q.y - p.y, q.z - p.z, r}); break;
        case 1: text += "c" + numbers({p.x, p.y, p.z, r * 0.5, q.x, q.y, q.z, r * 0.25}); break;
        case 2: text += "p 3" + numbers({p.x, p.y, p.z, q.x, q.y, q.z, s.x, s.y, s.z}); break;
        // Corners of no plane: it is met far outside of them, too.
        case 4: text += "p 4" + numbers({p.x, p.y, p.z, q.x, q.y, q.z, s.x, s.y, s.z, p.x + r, p.y - r, p.z + r}); break;
        case 3: text += "pp 3" + numbers({p.x, p.y, p.z, 0, 0, 1, q.x, q.y, q.z, 0, 1, 0, s.x, s.y, s.z, 1, 0, 0}); break;
        // On the floor, or anywhere.
        default: text += "s" + numbers({p.x, random.bits() % 2 ? r : p.y, p.z, r});
        }
        text += "\n";
    }
    return text;
}

// Of a scene: its picture with its windows, and by the same tracer, told of every shape. False if it has no windows.
template <class N>
bool pictures(const std::string& text, const scene::Settings& settings, std::vector<uint8_t>& narrow,
              std::vector<uint8_t>& wide)
{
    EXPECT_TRUE(loaded<N>(text, settings)) << text;
    scene::WindowBuilder<N> builder;
    if (!builder.build(storage<N>()))
        return false;
    auto scene = storage<N>().template view<effects(true)>();
    scene.windows.value = builder.windows();
    narrow = drawn(scene);
    const Edge all[] = {{0, UINT32_MAX}, {UINT32_MAX, 0}};
    uint32_t octants[set_capacity][8];
    for (auto& set : octants)
        for (uint32_t& sets : set)
            sets = every_shape;
    scene.windows.value = {all, all, octants[0], octants, {Tag::none}};
    wide = drawn(scene);
    return true;
}

TYPED_TEST(WindowsTest, PicturesAreThoseWithoutThem)
{
    using N = TypeParam;
    Random random(283); // with a light so far away that its shadows have no form in double
    int with_windows = 0;
    for (int k = 0; k < 150; k++) {
        const std::string text = random_scene(random);
        scene::Settings settings;
        settings.grid = k % 5 == 0 ? 2 : 1;
        std::vector<uint8_t> narrow, wide;
        if (!pictures<N>(text, settings, narrow, wide))
            continue;
        with_windows++;
        EXPECT_EQ(narrow, wide) << text;
    }
    EXPECT_GE(with_windows, 100);
}

// A polygon whose corners are no plane's is met by rays almost along that plane, far out of its ball.
TYPED_TEST(WindowsTest, PolygonOfNoPlaneIsMetWhereverItWas)
{
    const std::string text = "v from -1.383094 3.021225 8.400671 at -0.667939 0.005335 0.000000 up -0.117627 1.000000 -0.238729 angle 23.989654 hither 0 resolution 29 23\n"
                             "b 0.3 0.4 0.5\n"
                             "l 5.535416 6.362180 0.341534 0.800000 0.700000 0.600000\n"
                             "sun -0.009798 0.966169 0.660989 0.600000 0.600000 0.700000\n"
                             "material colour 0.8 0.8 0.8 diffuse 0.7 mirror 0.4 texture checker 0.1 0.1 0.1 0.7\n"
                             "plane 0 0 0 0 1 0\n"
                             "material colour 0.767806 0.727571 0.864060 diffuse 0.6 highlight 0.5 shine 20 mirror 0.336192\n"
                             "p 4 -0.035048 -0.489002 -0.803320 -0.379248 -0.476849 -0.567549 -0.404623 -0.663124 -0.717854 0.382336 -0.906385 -0.385936\n"
                             "material colour 0.432919 0.349116 0.588117 diffuse 0.6 highlight 0.5 shine 20 mirror 0.781501\n"
                             "s 0.130159 0.917073 1.442174 0.917073\n"
                             "material colour 0.337897 0.416090 0.170507 diffuse 0.6 highlight 0.5 shine 20 mirror 0.407098\n"
                             "p 3 -0.965895 1.730944 0.317449 -0.980750 1.646998 0.430015 -0.983096 1.594598 0.349892\n";
    std::vector<uint8_t> narrow, wide;
    scene::Settings settings;
    settings.width = 87, settings.height = 69;
    ASSERT_TRUE(pictures<TypeParam>(text, settings, narrow, wide));
    EXPECT_EQ(narrow, wide);
}

TYPED_TEST(WindowsTest, WithNothingInSightThereIsNothingToSee)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 3 2\n b 0 1 0.5\n s 0 0 0 9\n"));
    auto scene = storage<N>().template view<effects(true)>();
    const Edge nothing[] = {{UINT32_MAX, 0}};
    const uint32_t octants[1][8] = {};
    scene.windows.value = {nothing, nothing, octants[0], octants, {Tag::none}};
    EXPECT_EQ(drawn(scene), (std::vector<uint8_t>{0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128}));
}

constexpr const char* view = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 53.13010235415598 hither 0 resolution 100 100\n"
                             "l 0 0 5 1 1 1\n"; // 10 pixels a unit at a distance of 5... tan(angle / 2) is 1/2

TYPED_TEST(WindowsTest, BallIsInItsCircleOfPixels)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view + std::string("s 1 0 0 0.6\n")));
    scene::WindowBuilder<N> builder;
    ASSERT_TRUE(builder.build(storage<N>()));
    // Seen from 0 0 5 the ball's edges are at atan(1/5) -+ asin(0.6 / sqrt(26)); up and down it fills less than it
    // would at the nearest point of the axis to it.
    const double middle = std::atan(1.0 / 5), half = std::asin(0.6 / std::sqrt(26.0));
    const double left = 50 + 100 * std::tan(middle - half), right = 50 + 100 * std::tan(middle + half);
    const double up = 50 - 100 * 0.6 / std::sqrt(25 - 0.36), down = 100 - up;
    for (uint32_t k = 0; k < 100; k++) {
        // A pixel more on either side, and what the slack adds: less than a tenth of one.
        EXPECT_EQ(in_sight(builder, k, 50, 0, 0), k >= std::floor(left) - 1 && k <= std::floor(right) + 1) << k;
        if (k < up - 2.2 || k > down + 1.2) {
            EXPECT_FALSE(in_sight(builder, 60, k, 0, 0)) << k;
        }
        if (k > up - 1 && k < down) {
            EXPECT_TRUE(in_sight(builder, 60, k, 0, 0)) << k;
        }
    }
}

TYPED_TEST(WindowsTest, FloorShowsAnImageAndAShadow)
{
    using N = TypeParam;
    // The eye is 1 above the floor and looks level. A ball of 0.25 that hovers at 1 has its image as far below the floor; a
    // sun overhead puts its shadow right below it, a circle of 0.25 around (0, -1, 0).
    ASSERT_TRUE(loaded<N>("v from 0 0 5 at 0 0 0 up 0 1 0 angle 53.13010235415598 hither 0 resolution 100 100\n sun 0 1 0\n"
                          "material colour 1 1 1 mirror 0.5\n plane 0 -1 0 0 1 0\n s 0 0 0 0.25\n"));
    scene::WindowBuilder<N> builder;
    ASSERT_TRUE(builder.build(storage<N>()));
    const auto row = [](double y, double z) { return 50 + 100 * -y / (5 - z); };
    const double image_up = row(-2 + 0.25, 0), image_down = row(-2 - 0.25, 0), far = row(-1, -0.25), near = row(-1, 0.25);
    for (uint32_t j = 0; j < 100; j++) {
        if (j > image_up + 1 && j < image_down - 2) {
            EXPECT_TRUE(in_sight(builder, 50, j, 0, 1)) << j;
        }
        if (j < image_up - 3 || j > image_down + 3) {
            EXPECT_FALSE(in_sight(builder, 50, j, 0, 1)) << j;
        }
        EXPECT_EQ(in_sight(builder, 50, j, 0, 2), j >= std::floor(far) - 1 && j <= std::floor(near) + 1) << j;
        EXPECT_EQ(in_sight(builder, 50, j, 1, 0), j >= 49) << j; // the plane itself, below the horizon
        EXPECT_FALSE(in_sight(builder, 50, j, 1, 1) || in_sight(builder, 50, j, 1, 2)) << j;
    }
}

TYPED_TEST(WindowsTest, SphereKnowsWhatIsBeforeItsLightAndWhereItsNeighboursAre)
{
    using N = TypeParam;
    // Balls in a row from left to right, and a light above the second: the third and the second are before none.
    ASSERT_TRUE(loaded<N>("v from 0 0 50 at 0 0 0 up 0 1 0 angle 10 hither 0 resolution 10 10\n l 0 10 0 1 1 1\n"
                          "s -5 0 0 1\n s 0 0 0 1\n s 5 0 0 1\n s 0 5 0 1\n"));
    scene::WindowBuilder<N> builder;
    ASSERT_TRUE(builder.build(storage<N>()));
    EXPECT_EQ(builder.blockers[0], 0u);
    EXPECT_EQ(builder.blockers[1], set_of(3));
    EXPECT_EQ(builder.blockers[2], 0u);
    EXPECT_EQ(builder.blockers[3], 0u);
    // To the right, up and to the front; to the left, down and to the back: in y and z each reaches the others.
    EXPECT_EQ(builder.octants[0][0] >> 22, (set_of(1) | set_of(2) | set_of(3)) >> 22);
    EXPECT_EQ(builder.octants[0][7] >> 22, 0u);
    EXPECT_EQ(builder.octants[2][0] >> 22, 0u);
    EXPECT_EQ(builder.octants[2][7] >> 22, (set_of(0) | set_of(1)) >> 22);
    EXPECT_EQ(builder.octants[1][2] >> 22, set_of(2) >> 22); // to the right and down
    EXPECT_EQ(builder.octants[1][0] >> 22, (set_of(2) | set_of(3)) >> 22);
    for (int k = 0; k < 8; k++)
        EXPECT_EQ(builder.octants[0][k] & unasked, unasked);
}

TYPED_TEST(WindowsTest, AreOfTenShapesAtMost)
{
    using N = TypeParam;
    std::string text = view;
    scene::WindowBuilder<N> builder;
    ASSERT_TRUE(loaded<N>(text));
    EXPECT_FALSE(builder.build(storage<N>()));
    for (int k = 1; k <= 11; k++) {
        text += "s" + numbers({0.1 * k, 0, 0, 0.1}) + "\n";
        ASSERT_TRUE(loaded<N>(text));
        EXPECT_EQ(builder.build(storage<N>()), k <= 10) << k;
    }
}

} // namespace
