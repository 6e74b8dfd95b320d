#include <qray/scene/camera.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct CameraTest : ::testing::Test {};
TYPED_TEST_SUITE(CameraTest, NumberSystems, SystemNames);

template <class N>
Pencil<N> pencil(const Vec3& v)
{
    if constexpr (N::is_fixed) {
        using Whole = decltype(Pencil<N>::x);
        const auto scaled = [](double c) {
            return static_cast<Whole>(std::llrint(std::ldexp(c, sizeof(Whole) == 4 ? 28 : 59)));
        };
        return {scaled(v.x), scaled(v.y), scaled(v.z)};
    } else {
        using F = typename N::Length;
        return {static_cast<F>(v.x), static_cast<F>(v.y), static_cast<F>(v.z)};
    }
}

// Looks along -z from (1, 2, 3) with a field of 2 atan(h) across `height` pixels.
template <class N>
Camera<N> make_camera(uint16_t width, uint16_t height, uint16_t grid, double h)
{
    const double step = h / (grid * height);
    return {make<N>::point(1, 2, 3), pencil<N>({0, 0, -1}), pencil<N>({step, 0, 0}), pencil<N>({0, -step, 0}),
            width, height, grid};
}

// scenes/README.md, section 2, for sample offset (a, b) of pixel (i, j).
Vec3 expected(int i, int j, double a, double b, int width, int height, double h)
{
    const double x = h * width / height * (2 * (i + a) / width - 1), y = h * (1 - 2 * (j + b) / height);
    return unit(Vec3{x, y, -1});
}

TYPED_TEST(CameraTest, MiddleOfThePictureIsTheViewDirection)
{
    using N = TypeParam;
    using M = make<N>;
    const auto camera = make_camera<N>(3, 3, 1, 0.5);
    const Ray<N> ray = camera.ray(camera.row(0) + camera.right * 0);
    EXPECT_EQ(value(ray.origin), (Vec3{1, 2, 3}));
    expect_near(value(ray.direction), {0, 0, -1}, M::unit_ulp());
    EXPECT_TRUE(ray.from == Tag{Tag::none}); // leaves no surface
}

TYPED_TEST(CameraTest, PixelsAndSamplesAreWhereTheyShouldBe)
{
    using N = TypeParam;
    using M = make<N>;
    const struct {
        int width, height, grid;
        double h;
    } views[] = {{8, 6, 1, 0.5}, {5, 9, 3, 1.75}, {160, 120, 2, 0.25}, {1, 1, 4, 1}};
    for (const auto& v : views) {
        const auto camera = make_camera<N>(static_cast<uint16_t>(v.width), static_cast<uint16_t>(v.height),
                                           static_cast<uint16_t>(v.grid), v.h);
        // What rounding a pencil's steps to 2^-28 adds up to at the picture's corner.
        const double steps = NarrowFixed<N> ? std::hypot(v.width, v.height) * v.grid * 0x1p-29 : 0;
        for (int j = 0; j < v.height; j += v.height > 20 ? 17 : 1)
            for (int i = 0; i < v.width; i += v.width > 20 ? 17 : 1)
                for (int k = 0; k < v.grid; k++)
                    for (int l = 0; l < v.grid; l++) {
                        const int x = 2 * v.grid * i + 2 * k + 1 - v.grid * v.width;
                        const int y = 2 * v.grid * j + 2 * l + 1 - v.grid * v.height;
                        const auto ray = camera.ray(camera.row(y) + camera.right * x);
                        const Vec3 d = expected(i, j, (k + 0.5) / v.grid, (l + 0.5) / v.grid, v.width, v.height, v.h);
                        ASSERT_LE(distance(value(ray.direction), d), (N::is_fixed ? 1.5 : 4) * M::unit_ulp() + steps);
                    }
    }
}

TYPED_TEST(CameraTest, LargestPictureReachesItsCorners)
{
    using N = TypeParam;
    using M = make<N>;
    const int n = 32768;
    const auto camera = make_camera<N>(n, n, 1, 1);
    for (int x : {1 - n, n - 1})
        for (int y : {1 - n, n - 1}) {
            const double at = (n - 1.) / n;
            const Vec3 d = unit(Vec3{x < 0 ? -at : at, y < 0 ? at : -at, -1});
            EXPECT_LE(distance(value(camera.ray(camera.row(y) + camera.right * x).direction), d), 4 * M::unit_ulp());
        }
}

TYPED_TEST(CameraTest, DirectionsAreUnit)
{
    using N = TypeParam;
    using M = make<N>;
    const auto camera = make_camera<N>(640, 480, 1, 3.7);
    double worst = 0;
    for (int y = -479; y < 480; y += 14)
        for (int x = -639; x < 640; x += 14)
            worst = std::fmax(
                worst,
                std::fabs(static_cast<double>(length(real(camera.ray(camera.row(y) + camera.right * x).direction)))
                          - 1));
    EXPECT_LE(worst, 2 * M::unit_ulp());
}

} // namespace
