// Energy and bounds: random scenes of hostile numbers, as the parser takes them, never draw light below 0 or, where
// surfaces conserve energy, above 1; never trace more rays than a tree of their depth has; and break no rule of the
// language, as the sanitized build of this test sees. `make soak-scenes` draws a million.
#include "hostile/draw_random.hpp"
#include "number_helpers.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

using namespace hostile;

constexpr uint64_t scenes = 5000; // of either kind in each number system

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

// Scenes that `make soak-scenes` found, with balls so small that their radius has no square in float.
TEST(Bounds, BallWithoutASquareInFloatDoesNotShine)
{
    qray::scene::Settings settings;
    settings.depth = 6;
    settings.cutoff = 0;
    SceneTally t;
    const auto folder = std::filesystem::path(__FILE__).parent_path() / "hostile" / "small_balls";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream in(entry.path());
        const std::string text((std::istreambuf_iterator<char>(in)), {});
        draw_scene<qray::Float>(entry.path().string(), text, settings, true, t);
    }
    EXPECT_EQ(t.accepted, 8u);
    EXPECT_EQ(t.negative, 0u) << t.first_fault;
    EXPECT_EQ(t.brighter, 0u) << t.first_fault;
}

// Light from beyond the square root of the greatest float: the same as from infinitely far, n.l = 0.6 of 0.5.
TEST(Bounds, LightTooFarForASquareInFloatIsSeen)
{
    using namespace qray;
    const std::string text = "v from 0 0 5e-9 at 0 0 0 up 0 1 0 angle 10 hither 1 resolution 1 1\n"
                             "l 0 4e14 3e14 0.5 0.5 0.5\n"
                             "material colour 1 1 1 ambient 0 diffuse 1 highlight 0 shine 1 mirror 0 transmit 0 ior 1\n"
                             "disc 0 0 0 0 0 1 2e-9\n";
    scene::Error error;
    auto& description = qray::test::kept<scene::Description>();
    auto& storage = qray::test::kept<scene::Storage<Float>>();
    ASSERT_TRUE(scene::parse("far light", text.data(), text.size(), description, error)) << error.text;
    ASSERT_TRUE(scene::Builder<Float>(description, {}, storage).build(error)) << error.text;
    const auto s = storage.view<scene::desktop_effects()>();
    test::RayCount rays;
    EXPECT_NEAR(trace(s, s.camera.ray(s.camera.row(0)), rays, EyeSample{}).x, 0.3f, 1e-6f);
}

} // namespace
