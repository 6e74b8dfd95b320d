// Adaptive sampling against coverages and counts worked out by hand from scenes/README.md, section 5.
#include "scene_helpers.hpp"

#include <qray/picture/adaptive.hpp>

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct AdaptiveTest : ::testing::Test {};
TYPED_TEST_SUITE(AdaptiveTest, NumberSystems, SystemNames);

scene::Settings adaptive(uint32_t levels, double threshold = 1.0 / 16)
{
    scene::Settings s;
    s.levels = levels;
    s.threshold = threshold;
    return s;
}

// At the plane z = 0 a pixel of this view is 1 x 1, and the picture's corner is at (0, 0).
std::string view(int width, int height)
{
    char text[200];
    const double x = width / 2.0, y = -height / 2.0;
    snprintf(text, sizeof text, "v from %g %g 5 at %g %g 0 up 0 1 0 angle %.17g hither 1 resolution %d %d\n",
             x, y, x, y, std::atan(height / 10.0) * 360 / M_PI, width, height);
    return text;
}

// A rectangle from the upper left corner down to (right, bottom), that shines by itself.
std::string lit(const std::string& colour, double right, double bottom, double left = -9, double top = 9)
{
    char text[200];
    snprintf(text, sizeof text,
             "ambientlight 1 1 1\n material colour %s diffuse 0\n p 4 %g %g 0 %g %g 0 %g %g 0 %g %g 0\n",
             colour.c_str(), left, top, left, bottom, right, bottom, right, top);
    return text;
}

template <class N, Effects E = scene::desktop_effects()>
Pixel pixel(uint32_t i, uint32_t j, uint64_t* samples)
{
    const Scene<N, E> s = storage<N>().template view<E>();
    RayCount count;
    const Pixel p = render_pixel(s, i, j, count);
    *samples = count[RayKind::camera];
    return p;
}

TYPED_TEST(AdaptiveTest, FlatPixelsTakeFourSamples)
{
    using N = TypeParam;
    for (uint32_t levels = 1; levels <= 6; levels++) {
        ASSERT_TRUE(loaded<N>(view(5, 3) + "b 0.2 0.5 1", adaptive(levels, 0)));
        for (uint32_t j = 0; j < 3; j++)
            for (uint32_t i = 0; i < 5; i++) {
                uint64_t samples = 0;
                const Pixel p = pixel<N>(i, j, &samples);
                EXPECT_EQ(samples, 4u);
                EXPECT_EQ(p.r, 51);
                EXPECT_EQ(p.g, 128);
                EXPECT_EQ(p.b, 255);
            }
    }
}

// A pixel that is white up to 0.34 of its width. At each level the two columns of squares around the edge are
// cut further, for as long as their samples fall on both sides of it.
TYPED_TEST(AdaptiveTest, AnEdgeIsFollowedDownThePixel)
{
    using N = TypeParam;
    const double coverage[] = {1.0 / 2, 1.0 / 4, 3.0 / 8, 5.0 / 16, 11.0 / 32, 11.0 / 32};
    const uint64_t samples[] = {4, 4 + 16, 4 + 16 + 32, 4 + 16 + 32 + 64, 4 + 16 + 32 + 64 + 128,
                                4 + 16 + 32 + 64 + 128 + 256};
    for (uint32_t levels = 1; levels <= 6; levels++) {
        ASSERT_TRUE(loaded<N>(view(3, 2) + lit("1 1 1", 1.34, -9), adaptive(levels)));
        uint64_t taken = 0;
        EXPECT_EQ(pixel<N>(1, 0, &taken).g, std::floor(255 * coverage[levels - 1] + 0.5)) << levels;
        EXPECT_EQ(taken, samples[levels - 1]) << levels;
        EXPECT_EQ(pixel<N>(0, 1, &taken).g, 255) << levels;
        EXPECT_EQ(taken, 4u);
        EXPECT_EQ(pixel<N>(2, 1, &taken).g, 0) << levels;
        EXPECT_EQ(taken, 4u);
    }
}

// A square in each quarter of a pixel, towards each of its corners: it holds the quarter's centre, one in four
// samples at level 2 and one in four at level 3, and then all of a square. Only what holds it stands out.
TYPED_TEST(AdaptiveTest, ASmallSquareIsFoundInEveryQuarter)
{
    using N = TypeParam;
    const double coverage[] = {1.0 / 4, 1.0 / 16, 1.0 / 64, 1.0 / 64};
    for (uint32_t levels = 1; levels <= 4; levels++)
        for (int quarter = 0; quarter < 4; quarter++)
            for (int corner = 0; corner < 4; corner++) {
                const double x = quarter & 1 ? 1.75 : 1.25, y = quarter & 2 ? -1.75 : -1.25;
                const double left = x - (corner & 1 ? 0.05 : 0.15), bottom = y - (corner & 2 ? 0.15 : 0.05);
                ASSERT_TRUE(loaded<N>(view(3, 3) + lit("1 0 0.5", left + 0.2, bottom, left, bottom + 0.2),
                                      adaptive(levels, 0.4)));
                uint64_t taken = 0;
                const Pixel p = pixel<N>(1, 1, &taken);
                EXPECT_EQ(taken, 4 * levels) << levels << " " << quarter << " " << corner;
                EXPECT_EQ(p.r, std::floor(255 * coverage[levels - 1] + 0.5))
                    << levels << " " << quarter << " " << corner;
                EXPECT_EQ(p.g, 0);
                EXPECT_EQ(p.b, std::floor(255 * coverage[levels - 1] / 2 + 0.5));
            }
}

// One quarter of 1/2 and three of 0: it differs by 1/2 from the mean of the others, they by 1/6.
TYPED_TEST(AdaptiveTest, AQuarterIsCutAboveTheThresholdNotAtIt)
{
    using N = TypeParam;
    const struct {
        double threshold;
        uint64_t samples;
    } cases[] = {{1, 4}, {0.5, 4}, {0.4999, 8}, {0.1667, 8}, {0.1666, 20}, {0, 20}};
    for (const char* colour : {"0.5 0 0", "0 0.5 0", "0 0 0.5"})
        for (const auto& c : cases) {
            ASSERT_TRUE(loaded<N>(view(3, 3) + lit(colour, 1.49, -1.49), adaptive(2, c.threshold)));
            uint64_t taken = 0;
            const Pixel p = pixel<N>(1, 1, &taken);
            EXPECT_EQ(taken, c.samples) << colour << " " << c.threshold;
            EXPECT_EQ(p.r + p.g + p.b, 32); // 1/8, as every sample of that quarter is 1/2
        }
}

// A gradient in which no two samples are alike: everything is cut, and the mean is the value at the centre.
TYPED_TEST(AdaptiveTest, SamplesAreBounded)
{
    using N = TypeParam;
    const std::string gradient = "ambientlight 1 1 1\n material colour 0.1 0.9 0.25 diffuse 0\n"
                                 "texture gradient 0.9 0.3 0.25 8 2 1 0\n p 4 -9 9 0 -9 -9 0 9 -9 0 9 9 0\n";
    for (uint32_t levels = 1; levels <= 6; levels++) {
        ASSERT_TRUE(loaded<N>(view(5, 3) + gradient, adaptive(levels, 0)));
        uint64_t taken = 0;
        const Pixel p = pixel<N>(3, 1, &taken);
        EXPECT_EQ(taken, ((uint64_t{4} << 2 * levels) - 4) / 3);
        const double along = (2 * 3.5 - 1.5) / std::sqrt(5.0) / 8;
        EXPECT_TRUE(is_byte_of(p.r, 0.1 + 0.8 * along, light_tolerance<N>())) << int{p.r};
        EXPECT_TRUE(is_byte_of(p.g, 0.9 - 0.6 * along, light_tolerance<N>())) << int{p.g};
        EXPECT_EQ(p.b, 64);
    }
}

// Firmware has adaptive sampling alone; a desktop's kernel for everything also has the grid.
TYPED_TEST(AdaptiveTest, TheSetOfEffectsDoesNotMatter)
{
    using N = TypeParam;
    constexpr Effects alone = [] {
        Effects e;
        e.polygon = e.adaptive = true;
        e.depth = 1;
        return e;
    }();
    ASSERT_TRUE(loaded<N>(view(4, 3) + lit("1 0.3 0.1", 1.34, -1.7), adaptive(3)));
    EXPECT_EQ((draw<N, alone>()), draw<N>());
}

} // namespace
