// Nearest hits, shadow rays (shadow.hpp, see_through.hpp) and the loop over rays, on scenes of a few lines.
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct TraceTest : ::testing::Test {};
TYPED_TEST_SUITE(TraceTest, NumberSystems, SystemNames);

constexpr Effects shapes()
{
    Effects e;
    e.sphere = e.disc = e.cone = e.polygon = e.patch = true;
    return e;
}
constexpr Effects see_through()
{
    Effects e = shapes();
    e.light = e.shadow = e.see_through = true;
    return e;
}

// Eye and box at the origin, so that the builder moves and scales nothing but by a power of two.
const std::string view = "v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3\n";

// A length of the text, as the builder scales it.
template <class N>
double scaled(double v)
{
    return v * value(storage<N>().camera.eye.z) / 8;
}
template <class N>
Ray<N> ray(const Vec3& from, const Vec3& along)
{
    return make<N>::ray({scaled<N>(from.x), scaled<N>(from.y), scaled<N>(from.z)}, along);
}

// Functions of their own, so that what they ask is compiled once for all who call them.
template <class N>
bool found(const Ray<N>& along, Hit<N>& hit)
{
    return nearest(storage<N>().template view<shapes()>(), along, hit);
}
template <class N>
bool blocked(const Ray<N>& along, typename N::Length before)
{
    return light_blocked(storage<N>().template view<shapes()>(), along, before);
}

TYPED_TEST(TraceTest, NearestIsTheNearestOfAllKindsInAnyOrder)
{
    using N = TypeParam;
    // At z = 1, 2, 3, 4, 5, and their places in the file.
    const char* objects[] = {"s 0 0 0 1\n", "disc 0 0 2 0 0 1 1\n", "c 0 -2 2 1 0 2 2 1\n",
                             "p 3 -1 -1 4 1 -1 4 0 1 4\n", "pp 3 -1 -1 5 0 0 1 1 -1 5 0 0 1 0 1 5 0 0 1\n"};
    for (int first = 0; first < 5; first++) {
        std::string text = view;
        for (int k = 0; k < 5; k++)
            text += objects[(first + k) % 5];
        ASSERT_TRUE(loaded<N>(text));
        Hit<N> hit{};
        for (double from : {8.0, 4.5, 3.5, 2.5, 1.5}) {
            ASSERT_TRUE(found<N>(ray<N>({0, 0, from}, {0, 0, -1}), hit));
            // Inside the cylinder its far wall is at z = 1, the sphere at 1 too.
            const double z = from == 8 ? 5 : std::floor(from);
            EXPECT_NEAR(value(hit.t), scaled<N>(from - z), 4 * make<N>::length_ulp(32)) << from;
            EXPECT_LT(hit.tag.place(), 5u);
        }
        ASSERT_FALSE(found<N>(ray<N>({0, 0, 6}, {0, 0, 1}), hit));
        EXPECT_FALSE(found<N>(ray<N>({6, 6, 8}, {0, 0, -1}), hit));
    }
}

TYPED_TEST(TraceTest, NearestNamesTheMaterialAndThePlace)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view + "material colour 1 0 0\n s 0 0 0 1\n material colour 0 1 0\n s 0 0 3 1\n"
                                 "material colour 1 0 0\n s 0 0 -4 1\n"));
    const auto scene = storage<N>().template view<shapes()>();
    Hit<N> hit{};
    ASSERT_TRUE(found<N>(ray<N>({0, 0, 8}, {0, 0, -1}), hit));
    EXPECT_EQ(hit.tag.place(), 1u);
    EXPECT_EQ(hit.kind, Kind::sphere);
    EXPECT_EQ(value(scene.mattes[hit.tag.material()].colour), (Vec3{0, 1, 0}));
    ASSERT_TRUE(found<N>(ray<N>({0, 0, -8}, {0, 0, 1}), hit));
    EXPECT_EQ(hit.tag.place(), 2u);
    EXPECT_EQ(value(scene.mattes[hit.tag.material()].colour), (Vec3{1, 0, 0}));
    EXPECT_EQ(scene.mattes.count, 2u); // repeated materials are stored once
}

TYPED_TEST(TraceTest, SurfacesTurnTheirShadingNormalToTheViewer)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view + "disc 0 0 2 0 3 4 1\n s 0 0 0 1\n"));
    const auto scene = storage<N>().template view<shapes()>();
    const double near = 8 * make<N>::length_ulp(32);
    for (double side : {8.0, 1.5, 0.0}) {
        const auto r = ray<N>({0, 0, side}, {0, 0, side == 1.5 ? 1. : -1});
        Hit<N> hit{};
        ASSERT_TRUE(found<N>(r, hit));
        const Surface<N> s = surface_at(scene, r, hit);
        if (side > 0) {
            expect_near(value(s.geometric), {0, 0.6, 0.8}, near);
            expect_near(value(s.normal), side == 8 ? Vec3{0, 0.6, 0.8} : Vec3{0, -0.6, -0.8}, near);
            EXPECT_NEAR(value(s.n_d), -0.8, near);
            EXPECT_EQ(s.turned, side != 8);
            expect_near(value(s.point), {0, 0, scaled<N>(2)}, near);
        } else { // the sphere from inside
            expect_near(value(s.geometric), {0, 0, -1}, near);
            expect_near(value(s.normal), {0, 0, 1}, near);
            EXPECT_TRUE(s.turned);
        }
    }
}

TYPED_TEST(TraceTest, OpaqueSurfacesBlockLightBeforeItsDistanceOnly)
{
    using N = TypeParam;
    for (const char* object : {"s 0 0 0 1\n", "disc 0 0 0 0 0 1 1\n", "c 0 -1 0 1 0 1 0 1\n",
                               "p 3 -1 -1 0 1 -1 0 0 1 0\n", "pp 3 -1 -1 0 0 0 1 1 -1 0 0 0 1 0 1 0 0 0 1\n"}) {
        ASSERT_TRUE(loaded<N>(view + object));
        const auto r = ray<N>({0, 0, 6}, {0, 0, -1});
        EXPECT_FALSE(blocked<N>(r, make<N>::length(scaled<N>(4)))) << object;
        EXPECT_TRUE(blocked<N>(r, make<N>::length(scaled<N>(9)))) << object;
        EXPECT_TRUE(blocked<N>(r, N::length_max)) << object;
        EXPECT_FALSE(blocked<N>(ray<N>({0, 0, 6}, {0, 0, 1}), N::length_max)) << object;
        EXPECT_FALSE(blocked<N>(ray<N>({3, 0, 6}, {0, 0, -1}), N::length_max)) << object;
    }
}

TYPED_TEST(TraceTest, SharesOfLightMultiplyWhateverTheOrder)
{
    using N = TypeParam;
    // n discs, each with half of the light, and a ball with 3/4 for each of its two sides, in both orders.
    for (int n : {0, 1, 7, 8, 9, 16, 20})
        for (bool forward : {true, false}) {
            std::string text = view + "l 0 20 0\n";
            if (forward)
                text += "material transmit 0.75\n s 0 0 -6 1\n";
            text += "material transmit 0.5\n";
            for (int i = 0; i < n; i++)
                text += "disc 0 0 " + std::to_string((forward ? i : n - 1 - i) * 0.25) + " 0 0 1 1\n";
            if (!forward)
                text += "material transmit 0.75\n s 0 0 -6 1\n";
            ASSERT_TRUE(loaded<N>(text));
            const auto scene = storage<N>().template view<see_through()>();
            const auto r = ray<N>({0.1, 0, 7.9}, {0, 0, -1});
            // Each product rounds, so that equality needs the tolerance of n roundings.
            EXPECT_NEAR(value(light_through(scene, r, N::length_max)), 0.5625 * std::ldexp(1, -n),
                        (n + 2) * make<N>::unit_ulp());
            EXPECT_NEAR(value(light_through(scene, r, make<N>::length(scaled<N>(10)))), std::ldexp(1, -n),
                        (n + 2) * make<N>::unit_ulp());
            // An opaque surface among them.
            ASSERT_TRUE(loaded<N>(text + "material\n disc 0 0 -2 0 0 1 1"));
            EXPECT_EQ(value(light_through(storage<N>().template view<see_through()>(),
                                          ray<N>({0.1, 0, 7.9}, {0, 0, -1}), N::length_max)),
                      0);
        }
}

// Between two panes that mirror m and pass T of the background B, with ambient light a on each: d hits of weight m^k,
// and behind all but the last a background of weight m^k T.
TYPED_TEST(TraceTest, PanesGiveTwoGeometricSeriesOnABoundedStack)
{
    using N = TypeParam;
    for (uint32_t depth : {1u, 2u, 5u, 64u}) {
        scene::Settings settings;
        settings.depth = depth;
        settings.cutoff = 0;
        ASSERT_TRUE(loaded<N>("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1 1\n b 0.5 0.25 1\n"
                              "ambientlight 0.125 0.125 0\n material mirror 0.75 transmit 0.25 ior 1.5\n disc 0 0 0 0 "
                              "0 1 9\n disc 0 0 2 0 0 1 9",
                              settings));
        const double m = 0.75, hits = (1 - std::pow(m, depth)) / (1 - m), through = 1 - std::pow(m, depth - 1);
        RayCount count;
        const Vec3 light = light_at<N>(0, 0, &count);
        expect_light(light, {0.125 * hits + 0.5 * through, 0.125 * hits + 0.25 * through, through},
                     4 * light_tolerance<N>());
        EXPECT_EQ(count[RayKind::mirrored], depth - 1);
        EXPECT_EQ(count[RayKind::refracted], depth - 1);
        EXPECT_EQ(count[RayKind::camera], 1u);
        EXPECT_EQ(count[RayKind::shadow], 0u);
    }
}

TYPED_TEST(TraceTest, WeightBelowTheCutoffIsNotTraced)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 3;
    for (double cutoff : {0.25, NarrowFixed<N> ? 0.25 + 0x1p-14 : 0.2500001}) {
        settings.cutoff = cutoff;
        ASSERT_TRUE(loaded<N>("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1 1\n b 1 1 1\n"
                              "ambientlight 0 0 0\n material mirror 0 transmit 0.25 ior 1\n disc 0 0 0 0 0 1 9\n",
                              settings));
        const double expected = cutoff <= 0.25 ? 0.25 : 0;
        expect_light(light_at<N>(0, 0), {expected, expected, expected}, light_tolerance<N>());
    }
}

// A surface that mirrors and passes on, hit 2^(d - 1) times at depth d: in a row of panes every ray meets one more.
TYPED_TEST(TraceTest, EveryRayOfABinaryTreeIsTraced)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 6;
    settings.cutoff = 0;
    std::string text =
        "v from 0 0 0 at 0 0 -1 up 0 1 0 angle 45 hither 1 resolution 1 1\n b 0 0 0\n ambientlight 1 1 1\n"
        "material ambient 0.03125 mirror 0.5 transmit 0.5 ior 1\n";
    for (int i = -8; i < 8; i++)
        text += "disc 0 0 " + std::to_string(i + 0.5) + " 0 0 1 9\n";
    ASSERT_TRUE(loaded<N>(text, settings));
    RayCount count;
    // 63 hits: those of depth d have the weight 2^(1 - d), 2^(d - 1) of them: 6 / 32.
    expect_light(light_at<N>(0, 0, &count), {0.1875, 0.1875, 0.1875}, 2 * light_tolerance<N>());
    EXPECT_EQ(count[RayKind::mirrored], 31u);
    EXPECT_EQ(count[RayKind::refracted], 31u);
}

TYPED_TEST(TraceTest, ShadowRaysAreAskedForOnlyWhereLightCanArrive)
{
    using N = TypeParam;
    // Two lights in front, one behind, and one that shines on nothing.
    ASSERT_TRUE(
        loaded<N>("v from 0 0 4 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1 1\n l 1 0 3\n l 0 1 2\n l 0 0 -2\n"
                  "material diffuse 1\n disc 0 0 0 0 0 1 9"));
    RayCount count;
    (void)light_at<N>(0, 0, &count);
    EXPECT_EQ(count[RayKind::shadow], 2u);
    ASSERT_TRUE(loaded<N>("v from 0 0 4 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1 1\n l 1 0 3\n"
                          "material diffuse 0\n disc 0 0 0 0 0 1 9"));
    (void)light_at<N>(0, 0, &count);
    EXPECT_EQ(count[RayKind::shadow], 0u);
}

} // namespace
