#include <qray/surface/transmit.hpp>

#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct TransmitTest : ::testing::Test {};
TYPED_TEST_SUITE(TransmitTest, NumberSystems, SystemNames);

template <class N>
bool bend(const Direction<N>& d, const Direction<N>& n, double eta, Direction<N>& out)
{
    return refracted<N>(d, n, N::unit(qray::dot<N>(d, n)), make<N>::eta(eta), out);
}

TYPED_TEST(TransmitTest, FollowsSnell)
{
    using N = TypeParam;
    using M = make<N>;
    for (double ior : {0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.4375, 4.0, 8.0})
        for (double angle : {0.0, 0.1, 0.5, 1.0, 1.3}) {
            const double eta = value(M::eta(1 / ior)), sine = eta * std::sin(angle);
            Direction<N> out{};
            const auto d = M::direction({std::sin(angle), -std::cos(angle), 0});
            if (sine > 0.99) {
                if (sine > 1.01) {
                    EXPECT_FALSE(bend<N>(d, M::direction({0, 1, 0}), eta, out)) << ior << " " << angle;
                }
                continue;
            }
            ASSERT_TRUE(bend<N>(d, M::direction({0, 1, 0}), eta, out)) << ior << " " << angle;
            // The error of d counts eta times across, and once more by the slope of the cosine.
            const double cosine = std::sqrt(1 - sine * sine);
            const double tolerance = (2 + 2 * eta * (1 + sine / cosine)) * 2 * M::unit_ulp();
            expect_near(value(out), {sine, -cosine, 0}, tolerance);
        }
}

TYPED_TEST(TransmitTest, GoesStraightWhereTheIndicesAreEqual)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(94);
    double worst = 0;
    for (int i = 0; i < 5000; i++) {
        const auto n = M::direction(random.direction());
        auto d = M::direction(random.direction());
        if (dot(value(n), value(d)) > 0)
            d = -d;
        const double cosine = -dot(value(n), value(d));
        if (cosine < 0.05)
            continue;
        Direction<N> out{};
        ASSERT_TRUE(bend<N>(d, n, 1, out));
        worst = std::fmax(worst, distance(value(out), value(d)) * cosine);
    }
    EXPECT_LE(worst, 4 * M::unit_ulp());
}

TYPED_TEST(TransmitTest, LeavesASlabAsItCame)
{
    using N = TypeParam;
    using M = make<N>;
    for (double ior : {0.8, 1.5, 2.4})
        for (double angle : {0.0, 0.4, 0.8, 60 * M_PI / 180}) {
            const auto n = M::direction({1, 2, -2});
            const Vec3 across = unit(cross(value(n), {0, 1, 0}));
            const auto d = M::direction(across * std::sin(angle) - value(n) * std::cos(angle));
            Direction<N> inside{}, out{};
            if (std::sin(angle) / ior > 0.99)
                continue;
            ASSERT_TRUE(bend<N>(d, n, 1 / ior, inside));
            ASSERT_TRUE(bend<N>(inside, n, ior, out));
            // eta and 1/eta are rounded, and the cosines' slopes grow with the angle.
            expect_near(value(out), value(d), 24 * M::unit_ulp());
        }
}

TYPED_TEST(TransmitTest, IsTotallyReflectedBeyondTheCriticalAngle)
{
    using N = TypeParam;
    using M = make<N>;
    Direction<N> out{};
    const auto n = M::direction({0, 0, 1});
    for (double ior : {1.25, 1.5, 2.0, 8.0}) {
        const double critical = std::asin(1 / ior);
        for (double off : {-0.1, -0.01, -0.001, 0.001, 0.01, 0.1}) {
            const double angle = critical + off;
            EXPECT_EQ(bend<N>(M::direction({0, std::sin(angle), -std::cos(angle)}), n, ior, out), off < 0)
                << ior << " " << off;
        }
        // Along the surface, almost: e would be as long as ior.
        EXPECT_FALSE(bend<N>(M::direction({1, 0, -0.001}), n, ior, out));
    }
}

TYPED_TEST(TransmitTest, IsUnitAndInThePlaneOfIncidence)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(95);
    double worst_length = 0, worst_plane = 0, worst_sine = 0;
    for (int i = 0; i < 10000; i++) {
        const auto n = M::direction(random.direction());
        auto d = M::direction(random.direction());
        if (dot(value(n), value(d)) > 0)
            d = -d;
        const double eta = value(M::eta(random.uniform(0.4, 2)));
        const double sine = static_cast<double>(length(cross(real(d), real(n))));
        Direction<N> out{};
        if (eta * sine > 0.95)
            continue;
        ASSERT_TRUE(bend<N>(d, n, eta, out));
        ASSERT_LT(dot(value(out), value(n)), 0); // on to the other side
        worst_length = std::fmax(worst_length, std::fabs(static_cast<double>(length(real(out))) - 1));
        worst_plane = std::fmax(worst_plane, static_cast<double>(std::fabs(dot(real(out), cross(real(d), real(n))))));
        worst_sine =
            std::fmax(worst_sine, std::fabs(static_cast<double>(length(cross(real(out), real(n)))) - eta * sine));
    }
    EXPECT_LE(worst_length, 3 * M::unit_ulp());
    EXPECT_LE(worst_plane, 8 * M::unit_ulp());
    EXPECT_LE(worst_sine, 8 * M::unit_ulp());
}

// A lossless box under a white sky: whatever a ray meets, white comes back. The one through this pixel touches the
// box's outline, where it meets the face that it would enter and the one that it would leave at the same t.
TYPED_TEST(TransmitTest, LosesNoLightAtAnOutline)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("b 1 1 1 v from 3 2.3 5 at 0 0 0 up 0 1 0 angle 35 hither 1 resolution 121 121\n"
                          "material colour 0 0 0 diffuse 0 ambient 0 transmit 1 ior 1.5\n"
                          "p 4 -1 -1 -1 -1 -1 1 -1 1 1 -1 1 -1 p 4 1 -1 -1 1 1 -1 1 1 1 1 -1 1\n"
                          "p 4 -1 -1 -1 1 -1 -1 1 -1 1 -1 -1 1 p 4 -1 1 -1 -1 1 1 1 1 1 1 1 -1\n"
                          "p 4 -1 -1 -1 -1 1 -1 1 1 -1 1 -1 -1 p 4 -1 -1 1 1 -1 1 1 1 1 -1 1 1\n"));
    for (uint32_t i = 0; i < 121; i++)
        expect_light(light_at<N>(i, 45), {1, 1, 1}, 0.002);
}

} // namespace
