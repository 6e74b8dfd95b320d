// Mirrored directions; a mirror (mirror.hpp) is data alone.
#include <qray/surface/mirror.hpp>
#include <qray/surface/reflection.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct ReflectionTest : ::testing::Test {};
TYPED_TEST_SUITE(ReflectionTest, NumberSystems, SystemNames);

template <class N>
Direction<N> reflect(const Direction<N>& d, const Direction<N>& n)
{
    return mirrored<N>(d, n, N::unit(qray::dot<N>(d, n)));
}

TYPED_TEST(ReflectionTest, TurnsAroundTheComponentAlongTheNormal)
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

TYPED_TEST(ReflectionTest, DoesNotCareWhichWayTheNormalPoints)
{
    using N = TypeParam;
    using M = make<N>;
    // In q24, whose products are rounded down, n.d of n and of -n may differ by a step (3/8 + 3/8 + 1 < 2), its product
    // with n then by two (1 + 1/8 + 1/8 + 1 < 3), which counts twice; sharpen() rounds once more.
    const double near = (is_split<N> ? 5 : 2) * M::unit_ulp();
    Random random(91);
    for (int i = 0; i < 200; i++) {
        const auto d = M::direction(random.direction()), n = M::direction(random.direction());
        expect_near(value(reflect<N>(d, n)), value(reflect<N>(d, -n)), near);
    }
}

TYPED_TEST(ReflectionTest, AgreesWithItsFormula)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(92);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        const auto d = M::direction(random.direction()), n = M::direction(random.direction());
        const auto exact = unit(real(d) - real(n) * (2 * dot(real(d), real(n))));
        worst = std::fmax(worst, distance(value(reflect<N>(d, n)), rounded(exact)));
    }
    // n.d and (n.d) n are rounded and doubled, and the result is made a unit vector again.
    EXPECT_LE(worst, (N::is_fixed ? 3 : 6) * M::unit_ulp());
}

TYPED_TEST(ReflectionTest, AThousandReflectionsKeepTheLength)
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
