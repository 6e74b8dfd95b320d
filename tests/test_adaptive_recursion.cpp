// Adaptive sampling against the definition's recursion, on pictures of which every sample is known in closed form.
#include "scene_helpers.hpp"

#include <functional>

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct AdaptiveRecursionTest : ::testing::Test {};
TYPED_TEST_SUITE(AdaptiveRecursionTest, NumberSystems, SystemNames);

constexpr Effects effects()
{
    Effects e;
    e.sphere = e.disc = e.gradient = e.adaptive = true;
    return e;
}

// The page's words: a square is cut in four, with a sample at each quarter's centre; while levels remain, a quarter
// that differs from the mean of the other three by more than the threshold is cut in turn.
using Shade = std::function<Vec3(double, double)>;
Vec3 square(const Shade& shade, double x, double y, double edge, int levels, double threshold, unsigned& samples)
{
    const double q = edge / 4;
    const double qx[4] = {x - q, x + q, x - q, x + q}, qy[4] = {y - q, y - q, y + q, y + q};
    Vec3 own[4], sum{0, 0, 0};
    for (int k = 0; k < 4; k++) {
        own[k] = shade(qx[k], qy[k]);
        samples++;
    }
    for (int k = 0; k < 4; k++) {
        const Vec3 others = own[(k + 1) % 4] + own[(k + 2) % 4] + own[(k + 3) % 4];
        const bool cut = levels > 1 && distance(own[k] * 3, others) > 3 * threshold;
        sum = sum + (cut ? square(shade, qx[k], qy[k], edge / 2, levels - 1, threshold, samples) : own[k]);
    }
    return sum * 0.25;
}

template <class N>
void expect_recursion(const std::string& text, int levels, double threshold, const Shade& shade)
{
    scene::Settings settings;
    settings.levels = static_cast<uint32_t>(levels);
    settings.threshold = threshold;
    ASSERT_TRUE(loaded<N>(text, settings));
    const Scene<N, effects()> s = storage<N>().template view<effects()>();
    for (uint32_t j = 0; j < s.camera.height; j++)
        for (uint32_t i = 0; i < s.camera.width; i++) {
            unsigned samples = 0;
            const Vec3 expected = square(shade, i + 0.5, j + 0.5, 1, levels, threshold, samples);
            RayCount count;
            const Pixel p = render_pixel(s, i, j, count);
            ASSERT_EQ(count[RayKind::camera], samples) << i << " " << j << " with " << levels << " levels";
            const double slack = 64 * light_tolerance<N>();
            ASSERT_TRUE(is_byte_of(p.r, expected.x, slack) && is_byte_of(p.g, expected.y, slack)
                        && is_byte_of(p.b, expected.z, slack))
                << i << " " << j << ": " << int{p.r} << " for " << 255 * expected.x;
        }
}

const double h = std::tan(22.5 * M_PI / 180);
std::string view(const std::string& resolution)
{
    return "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution " + resolution + "\n ambientlight 1 1 1\n";
}

TYPED_TEST(AdaptiveRecursionTest, SilhouetteIsCutWhereItPasses)
{
    const double edge = 1.5 / std::sqrt(25 - 2.25);
    const Shade shade = [&](double x, double y) {
        const bool inside = std::hypot(h * (2 * x / 12 - 1), h * (1 - 2 * y / 12)) < edge;
        return inside ? Vec3{1, 0.5, 0} : Vec3{0, 0.25, 0.5};
    };
    for (int levels = 1; levels <= 6; levels++)
        expect_recursion<TypeParam>(view("12 12") + "b 0 0.25 0.5\n material colour 1 0.5 0\n s 0 0 0 1.5", levels,
                                    1.0 / 16, shade);
}

TYPED_TEST(AdaptiveRecursionTest, FlatPictureIsNotCutEvenByAThresholdOfZero)
{
    for (int levels = 1; levels <= 6; levels++)
        expect_recursion<TypeParam>(view("5 3") + "b 0.25 0.5 0.875\n", levels, 0,
                                    [](double, double) { return Vec3{0.25, 0.5, 0.875}; });
}

TYPED_TEST(AdaptiveRecursionTest, SlopeIsCutWhileItExceedsTheThreshold)
{
    // Black up to the middle, then a slope of 1/8 a pixel: quarters are 1/16 apart, each 1/24 from the mean of the
    // others.
    char text[200];
    snprintf(text, sizeof text, "material colour 0 0 0\n texture gradient 1 1 1 %.17g 1 0 0\n disc 0 0 0 0 0 1 20",
             10 * h);
    const Shade shade = [&](double x, double) {
        const double v = std::fmin(1, std::fmax(0, (x - 4) / 8));
        return Vec3{v, v, v};
    };
    for (double threshold : {0.05, 0.04, 0.03, 0.018, 0.01, 0.001})
        expect_recursion<TypeParam>(view("8 8") + text, 4, threshold, shade);
}

TYPED_TEST(AdaptiveRecursionTest, BallSmallerThanAPixelIsBounded)
{
    const double edge = 0.02 / std::sqrt(25 - 0.0004);
    const Shade shade = [&](double x, double y) {
        return std::hypot(h * (2 * x / 4 - 1), h * (1 - 2 * y / 4)) < edge ? Vec3{1, 1, 1} : Vec3{0, 0, 0};
    };
    for (int levels : {1, 3, 6})
        expect_recursion<TypeParam>(view("4 4") + "b 0 0 0\n s 0 0 0 0.02", levels, 1.0 / 16, shade);
}

} // namespace
