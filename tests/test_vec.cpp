#include <qray/vector/vec.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct VecTest : ::testing::Test {};
TYPED_TEST_SUITE(VecTest, NumberSystems, SystemNames);

TYPED_TEST(VecTest, AddsSubtractsAndNegatesByComponent)
{
    using M = make<TypeParam>;
    const auto a = M::point(1, -2, 0.5), b = M::point(0.25, 3, -4);
    EXPECT_EQ(value(a + b), (Vec3{1.25, 1, -3.5}));
    EXPECT_EQ(value(a - b), (Vec3{0.75, -5, 4.5}));
    EXPECT_EQ(value(-a), (Vec3{-1, 2, -0.5}));
}

TYPED_TEST(VecTest, IsEqualWhereAllComponentsAre)
{
    using M = make<TypeParam>;
    EXPECT_TRUE(M::point(1, 2, 3) == M::point(1, 2, 3));
    EXPECT_FALSE(M::point(1, 2, 3) == M::point(1.5, 2, 3));
    EXPECT_FALSE(M::point(1, 2, 3) == M::point(1, 2.5, 3));
    EXPECT_FALSE(M::point(1, 2, 3) == M::point(1, 2, 3.5));
}

TYPED_TEST(VecTest, DotSumsProductsOfAnyTwoQuantities)
{
    using N = TypeParam;
    using M = make<N>;
    // Values of few bits, so that floating point is exact too.
    if constexpr (!is_split<N>) { // which has no sums of these
        EXPECT_EQ(value(qray::dot<N>(M::point(1, -2, 0.5), M::point(4, 3, -2))), -3);
    }
    EXPECT_EQ(value(qray::dot<N>(M::point(4, -8, 2), M::vector(0.5, 0.25, -1))), -2);
    EXPECT_EQ(value(qray::dot<N>(M::vector(0.5, 0.25, -1), M::vector(-0.5, 1, 0.25))), -0.25);
    EXPECT_EQ(value(norm2<N>(M::point(1, -2, 2))), 9);
}

// Or misses what three products drop, in q24: of 12 bits less than 32 steps each.
TYPED_TEST(VecTest, DotIsExactInFixedPoint)
{
    using N = TypeParam;
    if constexpr (N::is_fixed) {
        using Length = typename N::Length;
        using Unit = typename N::Unit;
        constexpr int32_t reach = N::one.raw; // 64 in q32
        Random random(3);
        for (int i = 0; i < 20000; i++) {
            int32_t l[3], u[3];
            for (int k = 0; k < 3; k++) {
                l[k] = static_cast<int32_t>(random.uniform(-reach, reach));
                u[k] = static_cast<int32_t>(random.uniform(-N::one.raw, N::one.raw));
            }
            const __int128 exact = static_cast<__int128>(l[0]) * u[0] + static_cast<__int128>(l[1]) * u[1]
                + static_cast<__int128>(l[2]) * u[2];
            const Vec<Length> a{{l[0]}, {l[1]}, {l[2]}};
            const Vec<Unit> b{{u[0]}, {u[1]}, {u[2]}};
            const __int128 step = is_split<N> ? 1 << 12 : 1, dropped = exact - qray::dot<N>(a, b).raw * step;
            ASSERT_TRUE(dropped >= 0 && dropped < (is_split<N> ? 3 * 32 * step : 1));
        }
    }
}

// In ulp: half of one, and an eighth that q24's product dropped.
template <class N>
constexpr double one_rounding = is_split<N> ? 0.625 : 0.51;

TYPED_TEST(VecTest, AlongIsOneRoundingAComponent)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(4);
    for (int i = 0; i < 1000; i++) {
        const auto t = M::length(random.uniform(0, 16));
        const auto d = M::direction(random.direction());
        const Vec3 exact = value(d) * value(t);
        expect_near(value(along<N>(t, d)), exact, one_rounding<N> * M::length_ulp(16));
    }
}

TYPED_TEST(VecTest, ScaledIsOneRoundingAComponent)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(5);
    for (int i = 0; i < 1000; i++) {
        const auto k = M::unit(random.uniform(-1, 1));
        const auto d = M::direction(random.direction());
        expect_near(value(scaled<N>(k, d)), value(d) * value(k), one_rounding<N> * M::unit_ulp());
        if constexpr (N::is_fixed) {
            const auto c = M::rgb(random.uniform(0, 1.9), random.uniform(0, 1.9), random.uniform(0, 1.9));
            const double share = is_split<N> ? 1.9 * 0x1p-14 : 0; // k has 14 bits for colours
            expect_near(value(scaled<N>(k, c)), value(c) * value(k), 0.51 * M::colour_ulp() + share);
        }
    }
}

// How far a component may be off: in floating point by a square root, a division and a product, half an ulp each, and
// the rounding of a sum of squares; in q24 as unit_split() says.
template <class N>
double unit_error()
{
    return (is_split<N> ? 1.54 : N::is_fixed ? 1 : 2) * make<N>::unit_ulp();
}

TYPED_TEST(VecTest, NormaliseGivesTheUnitVector)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(6);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        const Vec3 v = random.direction() * std::exp2(random.uniform(-6, 4));
        const auto given = M::point(v);
        if (given == M::point(0, 0, 0))
            continue;
        Direction<N> u{};
        ASSERT_TRUE(normalise<N>(given, u));
        worst = std::fmax(worst, distance(value(u), unit(value(given))));
    }
    EXPECT_LE(worst, unit_error<N>());
}

TYPED_TEST(VecTest, NormaliseKeepsAxesAndExactTriples)
{
    using N = TypeParam;
    using M = make<N>;
    Direction<N> u{};
    for (double size : {0.125, 1.0, 12.0}) {
        ASSERT_TRUE(normalise<N>(M::point(0, -size, 0), u));
        expect_near(value(u), {0, -1, 0}, unit_error<N>());
        EXPECT_EQ(value(u.x), 0);
        EXPECT_EQ(value(u.z), 0);
        ASSERT_TRUE(normalise<N>(M::point(2 * size, -size, 2 * size), u));
        expect_near(value(u), {2. / 3, -1. / 3, 2. / 3}, unit_error<N>());
    }
}

TYPED_TEST(VecTest, NormaliseRefusesZeroAndLeavesTheResultAlone)
{
    using N = TypeParam;
    using M = make<N>;
    Direction<N> u = M::vector(0.5, 0.25, -0.125);
    EXPECT_FALSE(normalise<N>(M::point(0, 0, 0), u));
    EXPECT_EQ(value(u), (Vec3{0.5, 0.25, -0.125}));
}

} // namespace
