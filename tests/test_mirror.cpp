#include <qray/mirror.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct MirrorTest : ::testing::Test {};
TYPED_TEST_SUITE(MirrorTest, NumberSystems, SystemNames);

template <class N>
Direction<N> reflect(const Direction<N>& d, const Direction<N>& n)
{
    return mirrored<N>(d, n, N::unit(qray::dot<N>(d, n)));
}

TYPED_TEST(MirrorTest, TurnsAroundTheComponentAlongTheNormal)
{
    using N = TypeParam;
    using M = make<N>;
    const double near = 2 * M::unit_ulp();
    expect_near(value(reflect<N>(M::vector(0.6, -0.8, 0), M::vector(0, 1, 0))), {0.6, 0.8, 0}, near);
    expect_near(value(reflect<N>(M::vector(0, 0, -1), M::vector(0, 0, 1))), {0, 0, 1}, near);
    expect_near(value(reflect<N>(M::vector(1, 0, 0), M::vector(0, 1, 0))), {1, 0, 0}, near); // grazing
    // 45 degrees: from along x to along y.
    expect_near(value(reflect<N>(M::vector(1, 0, 0), M::direction({-1, 1, 0}))), {0, 1, 0}, near);
}

TYPED_TEST(MirrorTest, DoesNotCareWhichWayTheNormalPoints)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(91);
    for (int i = 0; i < 200; i++) {
        const auto d = M::direction(random.direction()), n = M::direction(random.direction());
        expect_near(value(reflect<N>(d, n)), value(reflect<N>(d, -n)), 2 * M::unit_ulp());
    }
}

TYPED_TEST(MirrorTest, AgreesWithItsFormula)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(92);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        const auto d = M::direction(random.direction()), n = M::direction(random.direction());
        const auto exact = real(d) - real(n) * (2 * dot(real(d), real(n)));
        worst = std::fmax(worst, distance(value(reflect<N>(d, n)), rounded(exact)));
    }
    EXPECT_LE(worst, (N::is_fixed ? 2 : 6) * M::unit_ulp());
}

TYPED_TEST(MirrorTest, AThousandReflectionsKeepTheLength)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(93);
    auto d = M::direction(random.direction());
    for (int i = 0; i < 1000; i++) {
        const auto n = M::direction(random.direction());
        d = reflect<N>(d, n);
    }
    // NUMERICS: less than 1e-7 in q32. Elsewhere at most the normals' and the roundings' errors, all one way.
    const double drift = std::fabs(length(value(d)) - 1);
    EXPECT_LE(drift, M::unit_ulp() == 0x1p-30 ? 1e-7 : 1000 * 4 * M::unit_ulp());
}

} // namespace
