// Point lights; a sun (sun.hpp) is data alone.
#include <qray/light/light.hpp>
#include <qray/light/sun.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct LightTest : ::testing::Test {};
TYPED_TEST_SUITE(LightTest, NumberSystems, SystemNames);

// In units of 2^shift where the system is fixed.
template <class N>
Light<N> make_light(const Vec3& at, int shift)
{
    if constexpr (N::is_fixed)
        return {make<N>::point(at * std::ldexp(1, -shift)), shift, make<N>::rgb(1, 1, 1)};
    else
        return {make<N>::point(at), 0, make<N>::rgb(1, 1, 1)};
}

TYPED_TEST(LightTest, GivesADirectionAndADistance)
{
    using N = TypeParam;
    using M = make<N>;
    Direction<N> l{};
    typename N::Length distance{};
    ASSERT_TRUE(towards(make_light<N>({4, -2, 7}, 0), M::point(4, 1, 3), l, distance));
    expect_near(value(l), {0, -0.6, 0.8}, 2 * M::unit_ulp());
    EXPECT_NEAR(value(distance), 5, 4 * M::length_ulp(5));
    ASSERT_TRUE(towards(make_light<N>({4, -2, 7}, 0), M::point(-8, -2, 7), l, distance));
    expect_near(value(l), {1, 0, 0}, M::unit_ulp());
    EXPECT_NEAR(value(distance), 12, 2 * M::length_ulp(12));
}

TYPED_TEST(LightTest, GivesNothingAtItsOwnPlace)
{
    using N = TypeParam;
    using M = make<N>;
    Direction<N> l{};
    typename N::Length distance{};
    EXPECT_FALSE(towards(make_light<N>({4, -2, 7}, 0), M::point(4, -2, 7), l, distance));
    EXPECT_FALSE(towards(make_light<N>({0, 0, 0}, 0), M::point(0, 0, 0), l, distance));
}

TYPED_TEST(LightTest, AgreesWithTheSubtraction)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(96);
    double worst = 0, worst_distance = 0;
    for (int i = 0; i < 5000; i++) {
        const auto light = make_light<N>(random.point(12), 0);
        const auto q = M::point(random.point(12));
        const auto v = real(light.at) - real(q);
        if (length(v) < 0.5)
            continue;
        Direction<N> l{};
        typename N::Length distance{};
        ASSERT_TRUE(towards(light, q, l, distance));
        worst = std::fmax(worst, test::distance(value(l), rounded(unit(v))));
        worst_distance =
            std::fmax(worst_distance, static_cast<double>(std::fabs(value(distance) - length(v))) / M::length_ulp(24));
    }
    EXPECT_LE(worst, 2 * M::unit_ulp() + (N::is_fixed ? 0 : 1) * M::unit_ulp(24));
    EXPECT_LE(worst_distance, N::is_fixed ? 2 : 4); // v, l and their dot product round
}

TYPED_TEST(LightTest, MayStandFarOutside)
{
    using N = TypeParam;
    using M = make<N>;
    for (int shift : {1, 4, 9, 20, 30, 31}) {
        const double far = std::ldexp(48, shift);
        const auto light = make_light<N>({far, 0, -far}, shift);
        const auto q = M::point(3, -5, 2);
        Direction<N> l{};
        typename N::Length distance{};
        ASSERT_TRUE(towards(light, q, l, distance));
        const Vec3 v{far - 3, 5, -far - 2};
        // In fixed point q is rounded to 2^shift steps, of which the distance has 2^24 * 68.
        expect_near(value(l), unit(v), 3 * M::unit_ulp());
        if constexpr (N::is_fixed)
            EXPECT_EQ(distance, N::length_max); // beyond everything
        else
            EXPECT_NEAR(value(distance), length(v), 3 * M::length_ulp(length(v)));
    }
}

// From one corner of the world to the other: 180 lengths, where the largest is 128. q16's world is the ball of 62.5,
// across which a distance still fits.
TYPED_TEST(LightTest, DistanceIsClampedNotWrapped)
{
    using N = TypeParam;
    using M = make<N>;
    const double reach = NarrowFixed<N> ? 62 / std::sqrt(3) : 60;
    for (double side : {-1.0, 1.0}) {
        const auto light = make_light<N>({reach, side * reach, reach}, 0);
        for (double k : {0.25, 0.5, 0.75}) { // 130, 156 and 182 away
            Direction<N> l{};
            typename N::Length distance{};
            ASSERT_TRUE(towards(light, M::point(-k * reach, -k * side * reach, -k * reach), l, distance));
            const double exact = std::sqrt(3) * reach * (1 + k), most = value(N::length_max); // 77 to 109 in q16
            // In q24 the unit vector's length counts, too, which is known to less than 1.43 ulp of its own.
            const double off = is_split<N> ? 1.43 * M::unit_ulp() * exact : 0;
            EXPECT_NEAR(value(distance), std::fmin(exact, most), 4 * M::length_ulp(exact) + off);
            expect_near(value(l), unit({1, side, 1}), 3 * M::unit_ulp());
        }
    }
}

TYPED_TEST(LightTest, JustOutsideItsDistanceIsKept)
{
    using N = TypeParam;
    using M = make<N>;
    const auto light = make_light<N>({0, 70, 0}, 1);
    Direction<N> l{};
    typename N::Length distance{};
    ASSERT_TRUE(towards(light, M::point(0, -30, 0), l, distance));
    EXPECT_NEAR(value(distance), 100, 4 * M::length_ulp(100));
    ASSERT_TRUE(towards(light, M::point(24, 60, 0), l, distance));
    EXPECT_NEAR(value(distance), 26, 4 * M::length_ulp(26));
    expect_near(value(l), {-12. / 13, 5. / 13, 0}, 4 * M::unit_ulp());
}

} // namespace
