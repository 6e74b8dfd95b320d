// Whole pictures through parser, builder and tracer, where the light has a closed form.
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct ImageTest : ::testing::Test {};
TYPED_TEST_SUITE(ImageTest, NumberSystems, SystemNames);

// Looks from (0, 0, 5) at the origin; h = tan(45 degrees / 2) at the plane z = 0 spans 2 * 5 h.
std::string view(const std::string& resolution = "9 9", const std::string& angle = "45")
{
    return "v from 0 0 5 at 0 0 0 up 0 1 0 angle " + angle + " hither 1 resolution " + resolution + "\n";
}

// The direction of pixel (i, j) of such a view, and the point of it on z = plane.
struct Seen {
    Vec3 d, q;
};
Seen seen(uint32_t i, uint32_t j, uint32_t width, uint32_t height, double angle = 45, double plane = 0)
{
    const double h = std::tan(angle * M_PI / 360);
    const Vec3 along{h * width / height * (2 * (i + 0.5) / width - 1), h * (1 - 2 * (j + 0.5) / height), -1};
    return {unit(along), Vec3{0, 0, 5} + along * (5 - plane)};
}

TYPED_TEST(ImageTest, BackgroundAloneFillsThePicture)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("7 5") + "b 0.25 0.5 1"));
    const Picture p = draw<N>();
    ASSERT_EQ(p.width, 7u);
    ASSERT_EQ(p.height, 5u);
    ASSERT_EQ(p.rgb.size(), 7u * 5 * 3);
    for (uint32_t j = 0; j < 5; j++)
        for (uint32_t i = 0; i < 7; i++) {
            EXPECT_EQ(p.at(i, j).r, 64); // 63.75
            EXPECT_EQ(p.at(i, j).g, 128); // 127.5
            EXPECT_EQ(p.at(i, j).b, 255);
        }
}

TYPED_TEST(ImageTest, BrightBackgroundIsClampedNotWrapped)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("3 3") + "b 64 1.5 0"));
    expect_light(light_at<N>(1, 1), {64, 1.5, 0}, 64 * light_tolerance<N>());
    const Picture p = draw<N>();
    EXPECT_EQ(p.at(1, 1).r, 255);
    EXPECT_EQ(p.at(1, 1).g, 255);
    EXPECT_EQ(p.at(1, 1).b, 0);
}

TYPED_TEST(ImageTest, AmbientLightAloneIsTheColourTimesItTimesTheCoefficient)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "ambientlight 0.5 0.25 1\n"
                                   "material colour 0.5 1 0.75 ambient 0.5\n s 0 0 0 100"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            expect_light(light_at<N>(i, j), {0.125, 0.125, 0.375}, light_tolerance<N>());
}

// Beside the ambient light, without lamps, and in a mirror: also where it is far brighter than what can be seen.
TYPED_TEST(ImageTest, EmissionIsTheColourTimesIt)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "ambientlight 0.5 0.25 1\n"
                                   "material colour 0.5 1 0.25 ambient 0.5 emission 0.25\n s 0 0 0 100"));
    expect_light(light_at<N>(4, 4), {0.5 * (0.25 + 0.25), 0.125 + 0.25, 0.25 * (0.5 + 0.25)}, light_tolerance<N>());
    ASSERT_TRUE(loaded<N>(view() + "material colour 0.25 0.5 1 emission 64 ambient 0\n disc 0 0 -1 0 0 1 50"));
    expect_light(light_at<N>(4, 4), {16, 32, 64}, 64 * light_tolerance<N>());
    ASSERT_TRUE(loaded<N>(view() + "ambientlight 0 0 0 material mirror 0.0078125 disc 0 0 0 0 0 1 50\n"
                                   "material colour 0.25 0.5 1 emission 64\n disc 0 0 50 0 0 1 100"));
    expect_light(light_at<N>(4, 4), {0.125, 0.25, 0.5}, 16 * light_tolerance<N>());
}

// A disc seen head on, lit by a sun along the line of sight: every pixel has A ambient + cos 0.
TYPED_TEST(ImageTest, PlaneLitBySunIsUniform)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "sun 0 0 1 0.5 0.5 0.5\n ambientlight 0.2 0.4 0\n"
                                   "material colour 1 0.5 0.25 ambient 0.5 diffuse 0.75\n disc 0 0 0 0 0 1 50"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            expect_light(light_at<N>(i, j), {0.1 + 0.375, 0.5 * (0.2 + 0.375), 0.25 * 0.375}, light_tolerance<N>());
}

TYPED_TEST(ImageTest, PlaneLitByASlantingSunHasItsCosine)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "sun 3 0 4 1 1 1\n ambientlight 0 0 0\n material colour 1 0.5 0.25\n"
                                   "plane 0 0 0 0 0 -1")); // two-sided
    for (uint32_t j = 0; j < 9; j += 2)
        for (uint32_t i = 0; i < 9; i += 2)
            expect_light(light_at<N>(i, j), {0.8, 0.4, 0.2}, light_tolerance<N>());
}

// Lambert and Phong by hand, pixel by pixel.
TYPED_TEST(ImageTest, PlaneLitByAPointLightHasLambertAndPhong)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("11 7") + "l 1 2 3 0.75 0.5 1\n ambientlight 0.25 0.25 0.25\n"
                                         "material colour 0.5 1 0.25 ambient 0.5 diffuse 0.6 highlight 0.7 shine 12\n"
                                         "plane 0 0 0 0 0 1\n far 40"));
    for (uint32_t j = 0; j < 7; j++)
        for (uint32_t i = 0; i < 11; i++) {
            const Seen s = seen(i, j, 11, 7);
            const Vec3 l = unit(Vec3{1, 2, 3} - s.q), n{0, 0, 1};
            const Vec3 r = n * (2 * dot(n, l)) - l;
            const double diffuse = 0.6 * dot(n, l), highlight = 0.7 * std::pow(std::fmax(0, -dot(r, s.d)), 12);
            const auto channel = [&](double light, double m) {
                return m * 0.25 * 0.5 + light * (m * diffuse + highlight);
            };
            expect_light(light_at<N>(i, j), {channel(0.75, 0.5), channel(0.5, 1), channel(1, 0.25)},
                         4 * light_tolerance<N>());
        }
}

TYPED_TEST(ImageTest, FractionalShineIsExact)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("5 5") + "l 0 0 3 1 1 1\n ambientlight 0 0 0\n"
                                        "material diffuse 0 highlight 1 shine 3.0827\n plane 0 0 0 0 0 1\n far 40"));
    for (uint32_t j = 0; j < 5; j++)
        for (uint32_t i = 0; i < 5; i++) {
            const Seen s = seen(i, j, 5, 5);
            const Vec3 l = unit(Vec3{0, 0, 3} - s.q);
            const double c = std::pow(-dot(Vec3{-l.x, -l.y, l.z}, s.d), 3.0827);
            expect_light(light_at<N>(i, j), {c, c, c}, 4 * light_tolerance<N>());
        }
}

TYPED_TEST(ImageTest, LightsWithoutAColourShareOneByTheRootOfTheirNumber)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "sun 0 0 1\n sun 3 0 4\n l 0 0 50\n sun 0 0 -1\n ambientlight 0 0 0\n"
                                   "disc 0 0 0 0 0 1 50\n shadows off"));
    // 1/2 each: cosines 1 and 0.8, and at the centre 1; the fourth is behind.
    const double c = 0.5 * (1 + 0.8 + 1);
    expect_light(light_at<N>(4, 4), {c, c, c}, 2 * light_tolerance<N>());
}

TYPED_TEST(ImageTest, SixteenLightsSaturateAndNeverWrap)
{
    using N = TypeParam;
    std::string text = view("3 3");
    for (int i = 0; i < 16; i++)
        text += "sun 0 0 1 1 1 1\n";
    ASSERT_TRUE(loaded<N>(text + "ambientlight 0 0 0\n material highlight 1 shine 5\n disc 0 0 0 0 0 1 50"));
    expect_light(light_at<N>(1, 1), {32, 32, 32}, 32 * light_tolerance<N>());
    const Picture p = draw<N>();
    for (uint8_t byte : p.rgb)
        EXPECT_EQ(byte, 255);
}

TYPED_TEST(ImageTest, MirrorShowsTheBackgroundTimesItsWeight)
{
    using N = TypeParam;
    ASSERT_TRUE(
        loaded<N>(view() + "b 0.5 0.25 1\n ambientlight 0 0 0\n material mirror 0.75\n plane 0 0 0 0 0 1\n far 60"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            expect_light(light_at<N>(i, j), {0.375, 0.1875, 0.75}, light_tolerance<N>());
}

// A vertical mirror: what it shows is the other half of the scene, weighted.
TYPED_TEST(ImageTest, MirrorShowsWhatStandsBesideIt)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "ambientlight 1 1 1\n material colour 0 0 0 mirror 0.5\n disc 0 0 0 1 0 1 20\n"
                                   "material colour 0.25 0.5 1\n disc 10 0 0 1 0 0 20"));
    // The view direction (0, 0, -1) is turned to (1, 0, 0), and meets the disc at x = 10.
    expect_light(light_at<N>(4, 4), {0.125, 0.25, 0.5}, light_tolerance<N>());
}

TYPED_TEST(ImageTest, BallInsideAUniformlyLitBallIsInvisible)
{
    using N = TypeParam;
    ASSERT_TRUE(
        loaded<N>(view("33 33") + "ambientlight 0.5 0.5 0.5\n material colour 0.5 0.25 1\n s 0 0 0 20\n s 0 0 0 1"));
    const Picture p = draw<N>();
    for (uint32_t j = 0; j < 33; j++)
        for (uint32_t i = 0; i < 33; i++) {
            ASSERT_EQ(p.at(i, j).r, 64);
            ASSERT_EQ(p.at(i, j).g, 32);
            ASSERT_EQ(p.at(i, j).b, 128);
        }
}

// A furnace: in a ball that shines evenly, a ball that keeps nothing to itself (mirror + transmit = 1) cannot be seen.
TYPED_TEST(ImageTest, LosslessGlassInAFurnaceVanishes)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 40;
    settings.cutoff = 0;
    ASSERT_TRUE(loaded<N>(view("21 21")
                              + "ambientlight 1 1 1\n material colour 1 1 1\n s 0 0 0 20\n"
                                "material ambient 0 diffuse 0 mirror 0.25 transmit 0.75 ior 1.5\n s 0 0 0 1",
                          settings));
    // Each internal hit passes 3/4 on and keeps 1/4 inside: after 40 of them less than 1e-20 is missing.
    for (uint32_t j = 0; j < 21; j++)
        for (uint32_t i = 0; i < 21; i++)
            expect_light(light_at<N>(i, j), {1, 1, 1}, 8 * light_tolerance<N>());
}

TYPED_TEST(ImageTest, EnergyNeverGrows)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 12;
    // Walls that shine with 1/2 and objects that pass on at most 1/2 more: nothing exceeds 1.
    ASSERT_TRUE(loaded<N>(view("24 24")
                              + "ambientlight 1 1 1\n b 1 1 1\n"
                                "material ambient 0.5 diffuse 0 mirror 0.25 transmit 0.25 ior 1.5\n"
                                "s 0 0 0 1\n s 1.2 0.3 0.5 0.7\n c -1 -1 0 0.5 -1 1 0 0.25\n disc 0 -1 0 0 1 0.2 3\n"
                                "p 3 -2 0 1 2 0 1 0 2 1\n",
                          settings));
    double most = 0;
    for (uint32_t j = 0; j < 24; j++)
        for (uint32_t i = 0; i < 24; i++) {
            const Vec3 c = light_at<N>(i, j);
            most = std::fmax(most, std::fmax(c.x, std::fmax(c.y, c.z)));
        }
    EXPECT_LE(most, 1 + light_tolerance<N>());
    EXPECT_GT(most, 0.9);
}

// A disc of radius 1 at height 2 under a light at height 4 casts a shadow of radius 2.
std::string shadow_scene(const std::string& disc)
{
    return "v from 0 20 0 at 0 0 0 up 0 0 1 angle 30 hither 1 resolution 41 41\n l 0 4 0 1 1 1\n ambientlight 0 0 0\n"
           "material colour 1 1 1\n plane 0 0 0 0 1 0\n far 40\n" + disc + " disc 0 2 0 0 1 0 1\n";
}

template <class N>
void expect_shadow(double through)
{
    const double h = std::tan(15 * M_PI / 180);
    for (uint32_t j = 0; j < 41; j++)
        for (uint32_t i = 0; i < 41; i++) {
            const double x = 20 * h * (2 * (i + 0.5) / 41 - 1), y = 20 * h * (1 - 2 * (j + 0.5) / 41);
            const double rho = std::hypot(x, y);
            // Hidden by the disc itself up to 10/9; the shadow's edge is at 2.
            if (rho < 1.2 || std::fabs(rho - 2) < 1e-3)
                continue;
            const double c = 4 / std::hypot(4, rho) * (rho < 2 ? through : 1);
            expect_light(light_at<N>(i, j), {c, c, c}, 8 * light_tolerance<N>());
        }
}

TYPED_TEST(ImageTest, ShadowOfAnOpaqueDiscIsBlackAndAsWideAsItShouldBe)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(shadow_scene("material")));
    expect_shadow<N>(0);
}

TYPED_TEST(ImageTest, ShadowOfASeeThroughDiscLetsItsShareThrough)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(shadow_scene("material transmit 0.625")));
    expect_shadow<N>(0.625);
}

TYPED_TEST(ImageTest, SharesOfSeveralSurfacesMultiply)
{
    using N = TypeParam;
    // Through a disc, in and out of a ball whose shadow has a radius of 2.6, and then through ten discs more, whose
    // shadows have a radius of 2.
    std::string text = shadow_scene("material transmit 0.5") + "material transmit 0.75\n s 0 3 0 0.55\n";
    const auto expect_share = [](double share) {
        const double h = std::tan(15 * M_PI / 180);
        int measured = 0;
        for (uint32_t i = 0; i < 41; i++) {
            const double x = 20 * h * (2 * (i + 0.5) / 41 - 1);
            if (std::fabs(x) < 1.2 || std::fabs(x) > 1.9)
                continue;
            measured++;
            EXPECT_NEAR(light_at<N>(i, 20).x, share * 4 / std::hypot(4, x), 8 * light_tolerance<N>());
        }
        EXPECT_GE(measured, 4);
    };
    ASSERT_TRUE(loaded<N>(text));
    expect_share(0.5 * 0.75 * 0.75);
    text += "material transmit 0.875\n";
    for (int i = 0; i < 10; i++)
        text += "disc 0 " + std::to_string(3.0 + 0.03125 * i) + " 0 0 1 0 0.5\n";
    ASSERT_TRUE(loaded<N>(text));
    expect_share(0.5 * 0.75 * 0.75 * std::pow(0.875, 10));
    ASSERT_TRUE(loaded<N>(text + "material\n disc 0 3.5 0 0 1 0 0.5\n")); // an opaque one among them
    expect_share(0);
}

TYPED_TEST(ImageTest, ShadowsCanBeTurnedOff)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(shadow_scene("material") + "shadows off"));
    expect_shadow<N>(1);
}

// Light and object in opposite corners of what a number system spans.
TYPED_TEST(ImageTest, LightFromTheFarCornerIsBlocked)
{
    using N = TypeParam;
    for (double light = 10; light < 200; light *= 1.25) {
        const std::string text =
            "v from -20 -30 -30 at -30 -30 -30 up 0 1 0 angle 1 hither 1 resolution 1 1\n ambientlight 0 0 0\n l "
            + std::to_string(light) + " " + std::to_string(light) + " " + std::to_string(light)
            + " 1 1 1\n s -30 -30 -30 0.5\n";
        ASSERT_TRUE(loaded<N>(text + "material\n s 0 0 0 25\n shadows off"));
        EXPECT_GT(light_at<N>(0, 0).x, 0.5) << light;
        ASSERT_TRUE(loaded<N>(text + "material\n s 0 0 0 25\n"));
        EXPECT_EQ(light_at<N>(0, 0), (Vec3{0, 0, 0})) << light;
    }
}

TYPED_TEST(ImageTest, LightBehindTheFloorGivesNothing)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 20 0 at 0 0 0 up 0 0 1 angle 30 hither 1 resolution 5 5\n l 0 -4 0 1 1 1\n"
                          "ambientlight 0.25 0.25 0.25\n material highlight 1 shine 2\n plane 0 0 0 0 1 0\n far 40"));
    for (uint32_t i = 0; i < 5; i++)
        expect_light(light_at<N>(i, 2), {0.25, 0.25, 0.25}, light_tolerance<N>());
}

TYPED_TEST(ImageTest, OccluderJustBeyondTheLightDoesNotBlockIt)
{
    using N = TypeParam;
    for (const char* height : {"4.001", "4.1", "8"}) {
        ASSERT_TRUE(loaded<N>("v from 0 3 10 at 0 0 0 up 0 1 0 angle 20 hither 1 resolution 5 5\n l 0 4 0 1 1 1\n"
                              "ambientlight 0 0 0\n plane 0 0 0 0 1 0\n far 40\n disc 0 "
                              + std::string(height) + " 0 0 1 0 20"));
        expect_light(light_at<N>(2, 2), {1, 1, 1}, 4 * light_tolerance<N>());
    }
}

TYPED_TEST(ImageTest, LightOnASurfaceIsNotBlockedByIt)
{
    using N = TypeParam;
    // The light lies on a ball's lowest point, and in a disc.
    for (const char* object :
         {"s 0 5 0 1", "disc 0 4 0 0 1 0 3", "c -3 4.5 0 0.5 3 4.5 0 0.5", "p 3 -3 4 -3 3 4 -3 0 4 6"}) {
        ASSERT_TRUE(loaded<N>("v from 0 3 10 at 0 0 0 up 0 1 0 angle 20 hither 1 resolution 5 5\n l 0 4 0 1 1 1\n"
                              "ambientlight 0 0 0\n plane 0 0 0 0 1 0\n far 40\n" + std::string(object)));
        expect_light(light_at<N>(2, 2), {1, 1, 1}, 4 * light_tolerance<N>());
    }
}

TYPED_TEST(ImageTest, LightInsideAnOpaqueBallStaysThere)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 3 10 at 0 0 0 up 0 1 0 angle 20 hither 1 resolution 5 5\n l 0 4 0 1 1 1\n"
                          "ambientlight 0 0 0\n plane 0 0 0 0 1 0\n far 40\n s 0 4 0 0.5"));
    EXPECT_EQ(light_at<N>(2, 2), (Vec3{0, 0, 0}));
}

// Eye and light in the middle of a ball: everything is lit squarely, whatever bits the radius has.
TYPED_TEST(ImageTest, BallLitFromItsMiddleIsUniform)
{
    using N = TypeParam;
    for (double r = 16; r < 64; r += 1.5) {
        ASSERT_TRUE(loaded<N>("v from 0 0 0 at 0 0 -1 up 0 1 0 angle 40 hither 1 resolution 5 5\n l 0 0 0 1 1 1\n"
                              "ambientlight 0 0 0\n s 0 0 0 " + std::to_string(r)));
        for (uint32_t i = 0; i < 5; i++)
            expect_light(light_at<N>(i, 2), {1, 1, 1}, 4 * light_tolerance<N>());
    }
}

// Two facing mirrors, each with ambient light a: after d rays, a (1 + m + m^2 + ...).
std::string mirrors(const std::string& weight)
{
    return "v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 3 3\n ambientlight 0.125 0.125 0.125\n"
           "b 1 1 1\n material mirror " + weight + "\n disc 0 0 0 0 0 1 20\n disc 0 0 2 0 0 1 20";
}

TYPED_TEST(ImageTest, DepthLimitEndsTheGeometricSeries)
{
    using N = TypeParam;
    for (uint32_t depth : {1u, 2u, 3u, 5u, 8u, 64u}) {
        scene::Settings settings;
        settings.depth = depth;
        settings.cutoff = 0;
        ASSERT_TRUE(loaded<N>(mirrors("0.75"), settings));
        const double sum = 0.125 * (1 - std::pow(0.75, depth)) / 0.25;
        RayCount count;
        expect_light(light_at<N>(1, 1, &count), {sum, sum, sum}, 2 * light_tolerance<N>());
        EXPECT_EQ(count[RayKind::camera], 1u);
        EXPECT_EQ(count[RayKind::mirrored], depth - 1);
        EXPECT_EQ(count[RayKind::refracted], 0u);
    }
}

TYPED_TEST(ImageTest, CutoffEndsTheGeometricSeries)
{
    using N = TypeParam;
    for (double cutoff : {0.6, 0.5, 0.3, 0.1, 0.0014}) {
        scene::Settings settings;
        settings.depth = 60;
        settings.cutoff = cutoff;
        ASSERT_TRUE(loaded<N>(mirrors("0.5"), settings));
        double sum = 0, weight = 1;
        unsigned rays = 0;
        for (; weight >= cutoff; weight /= 2, rays++)
            sum += 0.125 * weight;
        RayCount count;
        expect_light(light_at<N>(1, 1, &count), {sum, sum, sum}, 2 * light_tolerance<N>());
        EXPECT_EQ(count[RayKind::mirrored], rays - 1) << cutoff;
    }
}

TYPED_TEST(ImageTest, FacingMirrorsOfWeightOneKeepEverything)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 64;
    ASSERT_TRUE(loaded<N>("v from 0 0 1 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 3 3\n"
                          "ambientlight 0.0078125 0.0078125 0.0078125\n b 1 1 1\n material mirror 1\n disc 0 0 0 0 0 1 "
                          "20\n disc 0 0 2 0 0 1 20",
                          settings));
    expect_light(light_at<N>(1, 1), {0.5, 0.5, 0.5}, 4 * light_tolerance<N>()); // 64 / 128
}

// Through a pane whose index is that of its surroundings: nothing is bent, and each of its sides takes its share.
TYPED_TEST(ImageTest, ThinPaneShowsTheBackgroundTimesItsShare)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view()
                          + "b 0.5 1 0.25\n ambientlight 0 0 0\n material transmit 0.5 ior 1\n disc 0 0 0 0 0 1 20\n "
                            "disc 0 0 -1 0 0 1 20"));
    for (uint32_t j = 0; j < 9; j++)
        for (uint32_t i = 0; i < 9; i++)
            expect_light(light_at<N>(i, j), {0.125, 0.25, 0.0625}, light_tolerance<N>());
}

// From inside a slab of index 2 at 45 degrees to its wall: beyond the critical angle of 30.
TYPED_TEST(ImageTest, TotalInternalReflectionGivesTheMirrorBothShares)
{
    using N = TypeParam;
    const struct {
        const char* material;
        double weight;
    } cases[] = {
        {"transmit 0.5", 0.5}, {"transmit 0.5 mirror 0.25", 0.75}, {"transmit 0.75 mirror 0.5", 1}, {"transmit 1", 1}};
    for (const auto& c : cases) {
        scene::Settings settings;
        settings.depth = 2;
        // The outward normal points away from the eye, so that it is inside.
        ASSERT_TRUE(
            loaded<N>("v from 0 0 5 at 0 0 0 up 0 1 0 angle 2 hither 1 resolution 3 3\n b 0 0 0\n ambientlight 1 1 1\n"
                      "material colour 0 0 0 ior 2 "
                          + std::string(c.material)
                          + "\n disc 0 0 0 1 0 -1 3\n"
                            "material colour 1 0.5 0.25\n disc -10 0 0 1 0 0 5\n disc 0 0 -10 0 0 1 5",
                      settings));
        RayCount count;
        const Vec3 light = light_at<N>(1, 1, &count);
        expect_light(light, {c.weight, 0.5 * c.weight, 0.25 * c.weight}, 4 * light_tolerance<N>());
        EXPECT_EQ(count[RayKind::mirrored], 1u);
        EXPECT_EQ(count[RayKind::refracted], 0u);
    }
}

// The same with the normal towards the eye: the ray enters, bent towards the normal, and is not mirrored.
TYPED_TEST(ImageTest, RefractedRayGoesWhereSnellSays)
{
    using N = TypeParam;
    scene::Settings settings;
    settings.depth = 2;
    ASSERT_TRUE(
        loaded<N>("v from -3 0 4 at 0 0 0 up 0 1 0 angle 2 hither 1 resolution 3 3\n b 0 0 0\n ambientlight 1 1 1\n"
                  "material colour 0 0 0 ior 2 transmit 0.5\n disc 0 0 0 0 0 1 3\n"
                  "material colour 1 1 1\n texture gradient 0 0 0 16 1 0 0\n disc 0 0 -4 0 0 1 5",
                  settings));
    // sin 0.6 outside, 0.3 inside: at 4 below the surface it is 4 tan = 1.2579 to the right.
    const double x = 4 * 0.3 / std::sqrt(1 - 0.09), level = 0.5 * (1 - x / 16);
    expect_light(light_at<N>(1, 1), {level, level, level}, 8 * light_tolerance<N>());
}

TYPED_TEST(ImageTest, IndexOfOneChangesNothingBehindABall)
{
    using N = TypeParam;
    const std::string wall = "l 3 4 5 1 1 1\n ambientlight 0.25 0.25 0.25\n shadows off\n material diffuse 0.75\n"
                             "texture gradient 0 0.5 1 8 1 1 0\n disc 0 0 -5 0 0 1 20\n";
    ASSERT_TRUE(loaded<N>(view("15 15") + wall));
    std::vector<Vec3> bare;
    for (uint32_t i = 0; i < 15; i++)
        bare.push_back(light_at<N>(i, 7));
    ASSERT_TRUE(loaded<N>(view("15 15") + wall + "material ambient 0 diffuse 0 transmit 1 ior 1\n s 0 0 0 1.5"));
    for (uint32_t i = 0; i < 15; i++)
        expect_light(light_at<N>(i, 7), bare[i], 16 * light_tolerance<N>());
}

TYPED_TEST(ImageTest, SamplesAreTheCentresOfTheirCells)
{
    using N = TypeParam;
    // A picture of n x n the size with one sample each holds the samples; its means are clamped and rounded.
    const std::string scene =
        "l 3 4 5 1 1 1\n b 0.2 0.3 0.4\n f 0.9 0.7 0.5 0.8 0.2 20 0 1\n s 0 0 0 1\n s 1 1 -1 0.5\n";
    for (uint32_t n : {2u, 3u, 4u}) {
        scene::Settings settings;
        settings.grid = n;
        ASSERT_TRUE(loaded<N>(view("12 10") + scene, settings));
        const Picture p = draw<N>();
        settings.grid = 1;
        settings.width = 12 * n;
        settings.height = 10 * n;
        ASSERT_TRUE(loaded<N>(view("12 10") + scene, settings));
        for (uint32_t j = 0; j < 10; j++)
            for (uint32_t i = 0; i < 12; i++) {
                Vec3 sum{0, 0, 0};
                for (uint32_t k = 0; k < n * n; k++) {
                    const Vec3 c = light_at<N>(n * i + k % n, n * j + k / n);
                    sum = sum + Vec3{std::fmin(1, c.x), std::fmin(1, c.y), std::fmin(1, c.z)};
                }
                const Pixel q = p.at(i, j);
                const Vec3 mean = sum * (1. / (n * n));
                const double slack = 8 * light_tolerance<N>();
                ASSERT_TRUE(is_byte_of(q.r, mean.x, slack) && is_byte_of(q.g, mean.y, slack)
                            && is_byte_of(q.b, mean.z, slack))
                    << i << " " << j << " of " << n;
            }
    }
}

TYPED_TEST(ImageTest, ManySamplesOfWhiteAreWhite)
{
    using N = TypeParam;
    for (uint32_t n : {8u, 64u}) {
        scene::Settings settings;
        settings.grid = n;
        ASSERT_TRUE(loaded<N>(view("2 2") + "b 1 1 0", settings));
        const Picture p = draw<N>();
        for (uint32_t i = 0; i < 2; i++) {
            EXPECT_EQ(p.at(i, i).r, 255);
            EXPECT_EQ(p.at(i, i).g, 255);
            EXPECT_EQ(p.at(i, i).b, 0);
        }
    }
}

TYPED_TEST(ImageTest, CheckerHasItsParityAtEveryPixel)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 20 0 at 0 0 0 up 0 0 -1 angle 30 hither 1 resolution 40 40\n ambientlight 1 1 1\n"
                          "material colour 1 0.5 0\n texture checker 0 0.25 1 0.75\n plane 0 0 0 0 1 0\n far 40"));
    const double h = std::tan(15 * M_PI / 180);
    for (uint32_t j = 0; j < 40; j++)
        for (uint32_t i = 0; i < 40; i++) {
            // Looking down with -z up: x to the right, z down the picture.
            const double x = 20 * h * (2 * (i + 0.5) / 40 - 1), z = 20 * h * (2 * (j + 0.5) / 40 - 1);
            const double e = 1. / 1024;
            const auto cells = static_cast<long>(std::floor(x / 0.75 + e) + std::floor(z / 0.75 + e));
            expect_light(light_at<N>(i, j), cells % 2 == 0 ? Vec3{1, 0.5, 0} : Vec3{0, 0.25, 1}, light_tolerance<N>());
        }
}

// The picture of a scene mirrored in x = 0 is the mirrored picture, to the byte: nothing depends on a sign.
TYPED_TEST(ImageTest, MirroredSceneIsTheMirroredPicture)
{
    using N = TypeParam;
    const std::string head = "v from 0 1 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 40 30\n b 0.1 0.2 0.3\n";
    const auto body = [](const char* s) {
        const std::string m = s;
        return "l " + m + "3 4 5 1 1 1\n f 0.9 0.7 0.5 0.6 0.3 20 0 1\n s " + m + "0.75 0 0 0.5\n"
            "f 0.5 0.7 0.9 0.6 0.3 7 0.5 1.5\n s " + m + "-0.5 0.25 0.5 0.375\n"
            "f 0.5 0.9 0.5 0.6 0 7 0 1\n disc 0 -0.75 0 0 1 0 4\n";
    };
    ASSERT_TRUE(loaded<N>(head + body("")));
    const Picture p = draw<N>();
    std::string mirrored = body("-");
    for (size_t at; (at = mirrored.find("--")) != std::string::npos;)
        mirrored.erase(at, 2);
    ASSERT_TRUE(loaded<N>(head + mirrored));
    const Picture q = draw<N>();
    int off = 0;
    for (uint32_t j = 0; j < 30; j++)
        for (uint32_t i = 0; i < 40; i++) {
            const Pixel a = p.at(i, j), b = q.at(39 - i, j);
            off += std::abs(a.r - b.r) > 1 || std::abs(a.g - b.g) > 1 || std::abs(a.b - b.b) > 1;
        }
    EXPECT_EQ(off, 0);
}

// A ball at distance D on the axis fills the cone of sin = r / D: on the picture a circle of tan.
TYPED_TEST(ImageTest, SilhouetteOfABallIsACircle)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("101 101") + "b 0 0 0\n ambientlight 1 1 1\n s 0 0 0 1.5"));
    const Picture p = draw<N>();
    const double h = std::tan(22.5 * M_PI / 180), edge = 1.5 / std::sqrt(25 - 2.25);
    for (uint32_t j = 0; j < 101; j++)
        for (uint32_t i = 0; i < 101; i++) {
            const double x = h * (2 * (i + 0.5) / 101 - 1), y = h * (1 - 2 * (j + 0.5) / 101);
            ASSERT_GT(std::fabs(std::hypot(x, y) - edge), 1e-7); // no pixel of this picture is that near
            ASSERT_EQ(p.at(i, j).r, std::hypot(x, y) < edge ? 255 : 0) << i << " " << j;
        }
}

// Off the axis it is an ellipse: the directions within the ball's angle.
TYPED_TEST(ImageTest, SilhouetteOfABallOffTheAxisIsAnEllipse)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view("101 81", "90") + "b 0 0 0\n ambientlight 1 1 1\n s 2.5 -1.5 1 0.75\n s -3 2 0 1"));
    const Picture p = draw<N>();
    const struct {
        Vec3 c;
        double r;
    } balls[] = {{{2.5, -1.5, -4}, 0.75}, {{-3, 2, -5}, 1}};
    unsigned lit = 0;
    for (uint32_t j = 0; j < 81; j++)
        for (uint32_t i = 0; i < 101; i++) {
            bool inside = false;
            for (const auto& b : balls) {
                const double sine = length(cross(seen(i, j, 101, 81, 90).d, unit(b.c)));
                ASSERT_GT(std::fabs(sine - b.r / length(b.c)), 1e-7);
                inside = inside || (sine < b.r / length(b.c) && dot(seen(i, j, 101, 81, 90).d, b.c) > 0);
            }
            lit += inside;
            ASSERT_EQ(p.at(i, j).r, inside ? 255 : 0) << i << " " << j;
        }
    EXPECT_GT(lit, 100u);
}

// A plane that ends at `far` is a disc around the foot of the scene box's centre.
TYPED_TEST(ImageTest, PlaneEndsInACircleAtFar)
{
    using N = TypeParam;
    // The box is around eye and at: its centre is (0, 10, 0); a sphere of radius 12.5 cuts y = 0 at 7.5.
    ASSERT_TRUE(loaded<N>("v from 0 20 0 at 0 0 0 up 0 0 1 angle 60 hither 1 resolution 61 61\n b 0 0 0\n"
                          "ambientlight 1 1 1\n plane 3 0 -5 0 2 0\n far 12.5"));
    const Picture p = draw<N>();
    const double h = std::tan(30 * M_PI / 180);
    for (uint32_t j = 0; j < 61; j++)
        for (uint32_t i = 0; i < 61; i++) {
            const double x = 20 * h * (2 * (i + 0.5) / 61 - 1), y = 20 * h * (1 - 2 * (j + 0.5) / 61);
            ASSERT_EQ(p.at(i, j).r, std::hypot(x, y) < 7.5 ? 255 : 0) << i << " " << j;
        }
}

TYPED_TEST(ImageTest, FarDefaultsToSixteenSceneRadii)
{
    using N = TypeParam;
    // Box from (0, 0, 0) to (0, 2, 0): radius 1, centre (0, 1, 0): the plane ends at sqrt(16^2 - 1).
    ASSERT_TRUE(loaded<N>("v from 0 2 0 at 0 0 0 up 0 0 1 angle 166 hither 1 resolution 61 61\n b 0 0 0\n"
                          "ambientlight 1 1 1\n plane 0 0 0 0 1 0"));
    const Picture p = draw<N>();
    const double h = std::tan(83 * M_PI / 180), edge = std::sqrt(255);
    unsigned beyond = 0;
    for (uint32_t j = 0; j < 61; j++)
        for (uint32_t i = 0; i < 61; i++) {
            const double x = 2 * h * (2 * (i + 0.5) / 61 - 1), y = 2 * h * (1 - 2 * (j + 0.5) / 61);
            beyond += std::hypot(x, y) > edge;
            ASSERT_EQ(p.at(i, j).r, std::hypot(x, y) < edge ? 255 : 0) << i << " " << j;
        }
    EXPECT_GT(beyond, 100u);
}

TYPED_TEST(ImageTest, PlaneBeyondFarIsNotThere)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(view() + "b 0.25 0.25 0.25\n ambientlight 1 1 1\n plane 0 0 -40 0 0 1\n far 30"));
    expect_light(light_at<N>(4, 4), {0.25, 0.25, 0.25}, light_tolerance<N>());
}

TYPED_TEST(ImageTest, OfCoincidentSurfacesTheFirstInTheFileWins)
{
    using N = TypeParam;
    const std::string red = "material colour 1 0 0\n", green = "material colour 0 1 0\n";
    // Shapes of one kind, and of two, in either order.
    const struct {
        const char *a, *b;
    } pairs[] = {{"s 0 0 0 1\n", "s 0 0 0 1\n"},
                 {"disc 0 0 1 0 0 1 2\n", "disc 0 0 1 0 0 1 3\n"},
                 {"disc 0 0 1 0 0 1 2\n", "p 4 -2 -2 1 2 -2 1 2 2 1 -2 2 1\n"},
                 {"plane 0 0 1 0 0 1\n", "disc 0 0 1 0 0 1 2\n"},
                 {"p 3 -2 -2 1 3 -2 1 0 3 1\n", "pp 3 -2 -2 1 0 0 1 3 -2 1 0 0 1 0 3 1 0 0 1\n"}};
    for (const auto& pair : pairs) {
        if (NarrowFixed<N> && pair.a[0] == 'd'
            && pair.b[0] == 'p') // their distances, of 14 bits, are computed in two ways
            continue;
        const std::string head = view("3 3", "10") + "ambientlight 1 1 1\n b 0 0 1\n";
        ASSERT_TRUE(loaded<N>(head + red + pair.a + green + pair.b));
        expect_light(light_at<N>(1, 1), {1, 0, 0}, light_tolerance<N>());
        ASSERT_TRUE(loaded<N>(head + red + pair.b + green + pair.a));
        expect_light(light_at<N>(1, 1), {1, 0, 0}, light_tolerance<N>());
    }
}

TYPED_TEST(ImageTest, EveryShapeStandsWhereItsNumbersSay)
{
    using N = TypeParam;
    const std::string head =
        view("3 3", "10") + "b 0 0 0\n ambientlight 0 0 0\n sun 0 0 1 1 1 1\n shadows off\n far 40\n";
    // The cosine of each one's normal with the line of sight, and the point's distance by a gradient along z.
    const struct {
        const char* object;
        double z, cosine;
    } cases[] = {{"s 0 0 0 2", 2, 1},
                 {"s 0 0 0 -2", 2, 1},
                 {"disc 0 0 1.5 1 0 1 2", 1.5, std::sqrt(0.5)},
                 {"plane 0 0 1.5 0 3 4", 1.5, 0.8},
                 {"p 4 -1 -1 1 1 -1 1 1 1 1 -1 1 1", 1, 1},
                 {"pp 3 -2 -2 1 0 3 4 2 -2 1 0 3 4 0 4 1 0 3 4", 1, 0.8},
                 {"c 0 -2 0 1 0 2 0 1", 1, 1},
                 {"c 0 -2 0 3 0 2 0 0", 1.5, 0.8}};
    for (const auto& c : cases) {
        ASSERT_TRUE(loaded<N>(head + "texture gradient 0 0 0 4 0 0 1\n" + c.object));
        const double level = c.cosine * (1 - c.z / 4);
        expect_light(light_at<N>(1, 1), {level, level, level}, 8 * light_tolerance<N>());
    }
}

// By powers of two about the origin: the same picture, to the byte.
TYPED_TEST(ImageTest, ScaleOfAWholeSceneDoesNotMatter)
{
    using N = TypeParam;
    Picture first;
    for (double k : {1.0, 0x1p-20, 0x1p10, 0x1p40}) {
        char text[2000];
        snprintf(text, sizeof text,
                 "v from %.17g %.17g %.17g at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 32 24\n b 0.1 0.2 0.3\n l "
                 "%.17g %.17g %.17g\n"
                 "f 0.9 0.7 0.5 0.6 0.3 20 0 1\n s %.17g 0 0 %.17g\n f 0.5 0.7 0.9 0.6 0.3 7 0.5 1.5\n s %.17g 0 %.17g "
                 "%.17g\n"
                 "f 0.5 0.9 0.5 0.6 0.2 7 0 1\n texture checker 0 0 0.5 %.17g\n disc 0 %.17g 0 0 1 0 %.17g\n",
                 k, 2 * k, 5 * k, 3 * k, 4 * k, 5 * k, 0.75 * k, 0.5 * k, -0.5 * k, 0.5 * k, 0.375 * k, 0.5 * k,
                 -0.75 * k, 4 * k);
        ASSERT_TRUE(loaded<N>(text));
        const Picture p = draw<N>();
        if (k == 1)
            first = p;
        else
            EXPECT_TRUE(p == first) << k;
    }
}

TYPED_TEST(ImageTest, OddSizesAreDrawnWhole)
{
    using N = TypeParam;
    for (const char* size : {"1 1", "1 7", "7 1", "13 11"}) {
        ASSERT_TRUE(loaded<N>(view(size) + "b 1 1 1\n ambientlight 0 0 0\n s 0 0 0 0.01\n"));
        const Picture p = draw<N>(3);
        EXPECT_EQ(p.rgb.size(), size_t{p.width} * p.height * 3);
    }
    // The one sample of a single pixel is at its centre.
    ASSERT_TRUE(loaded<N>(view("1 1") + "b 1 1 1\n ambientlight 0 0 0\n s 0 0 0 0.01\n"));
    EXPECT_EQ(draw<N>().at(0, 0).r, 0);
}

} // namespace
