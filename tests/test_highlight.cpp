#include <qray/surface/highlight.hpp>

#include "number_helpers.hpp"

#include "../src/scene/convert.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct HighlightTest : ::testing::Test {};
TYPED_TEST_SUITE(HighlightTest, NumberSystems, SystemNames);

template <class N>
double cosine(const Direction<N>& n, const Direction<N>& l, const Direction<N>& d)
{
    return value(mirrored_cosine<N>(l, d, N::unit(qray::dot<N>(n, l)), N::unit(qray::dot<N>(n, d))));
}

TYPED_TEST(HighlightTest, IsOneWhereTheMirroredLightReachesTheEye)
{
    using N = TypeParam;
    using M = make<N>;
    // Seen at the angle at which the light falls in, on the other side.
    for (double angle : {0.0, 0.3, 0.8, 1.2}) {
        const Vec3 l{std::sin(angle), std::cos(angle), 0}, v{-std::sin(angle), std::cos(angle), 0};
        const double c = cosine<N>(M::direction({0, 1, 0}), M::direction(l), M::direction(-v));
        EXPECT_NEAR(c, 1, 4 * M::unit_ulp());
        EXPECT_LE(c, 1);
    }
}

TYPED_TEST(HighlightTest, FallsWithTheAngleAndIsZeroBeyondNinetyDegrees)
{
    using N = TypeParam;
    using M = make<N>;
    const auto n = M::direction({0, 0, 1}), l = M::direction({0, 0, 1});
    for (double angle : {0.1, 0.5, 1.0, 1.5}) {
        const Vec3 v{std::sin(angle), 0, std::cos(angle)};
        EXPECT_NEAR(cosine<N>(n, l, M::direction(-v)), std::cos(angle), 4 * M::unit_ulp());
    }
    // Light from one side, seen from the same side: 120 degrees between the mirrored light and the eye.
    const Vec3 side{std::sqrt(0.75), 0, 0.5};
    EXPECT_EQ(cosine<N>(n, M::direction(side), M::direction(-side)), 0);
}

TYPED_TEST(HighlightTest, AgreesWithItsFormula)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(90);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        const auto n = M::direction(random.direction()), l = M::direction(random.direction());
        auto d = M::direction(random.direction());
        if (dot(value(n), value(l)) <= 0)
            continue;
        if (dot(value(n), value(d)) > 0)
            d = -d;
        const auto r = real(n) * (2 * dot(real(n), real(l))) - real(l);
        const double exact = std::fmin(1, std::fmax(0, static_cast<double>(-dot(r, real(d)))));
        worst = std::fmax(worst, std::fabs(cosine<N>(n, l, d) - exact));
    }
    // n.l and n.d rounded once each and doubled in the product, and the sum rounded.
    EXPECT_LE(worst, (N::is_fixed ? 3 : 8) * M::unit_ulp());
}

// 0^0 = 1, where a shine is 0 by the text alone.
TYPED_TEST(HighlightTest, ShineNextToNoneIsNotNone)
{
    using N = TypeParam;
    using M = make<N>;
    const auto power = [](double x, double shine) {
        return value(N::power(M::unit(x), scene::Convert<N>::shine(shine)));
    };
    EXPECT_EQ(power(0, 0), 1);
    for (double shine = 0.01; shine > 0; shine *= 0.1) {
        EXPECT_EQ(power(0, shine), 0) << shine;
        const double off = NarrowFixed<N> ? 0x1p-12 : 4 * M::unit_ulp(); // of 14 bits
        EXPECT_NEAR(power(0.5, shine), std::pow(0.5, shine), off) << shine;
        EXPECT_EQ(power(1, shine), 1) << shine;
    }
}

} // namespace
