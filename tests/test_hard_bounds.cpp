// Energy and bounds: random scenes of hostile numbers, as the parser takes them, never draw light below 0 or, where
// surfaces conserve energy, above 1; never trace more rays than a tree of their depth has; and break no rule of the
// language, as the sanitized build of this test sees. `make soak-scenes` draws a million.
#include "hostile/draw_random.hpp"
#include "number_helpers.hpp"

namespace {

using namespace hostile;

constexpr uint64_t scenes = 10000; // of either kind in each number system

template <class N>
struct BoundsTest : ::testing::Test {};
TYPED_TEST_SUITE(BoundsTest, qray::test::NumberSystems, qray::test::SystemNames);

template <class N>
void expect_bounded(uint64_t seed, bool energy)
{
    SceneTally t;
    draw_random<N>(seed, scenes, energy, t);
    EXPECT_EQ(t.scenes, scenes);
    EXPECT_GT(t.accepted, scenes * 8 / 10);
    EXPECT_EQ(t.negative, 0u) << t.first_fault;
    EXPECT_EQ(t.brighter, 0u) << t.first_fault;
    EXPECT_EQ(t.too_many_rays, 0u) << t.first_fault;
    if (energy) {
        EXPECT_GT(t.most, 0.99) << "no scene comes near the bound";
    }
}

TYPED_TEST(BoundsTest, HostileScenesStayInRange) { expect_bounded<TypeParam>(1, false); }
TYPED_TEST(BoundsTest, EnergyDoesNotGrow) { expect_bounded<TypeParam>(2, true); }

} // namespace
