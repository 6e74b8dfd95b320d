// Whole pictures that must not change, or change in a known way, and pictures that must not speckle.
#include "hard_scenes.hpp"
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct Metamorphic : ::testing::Test {};
TYPED_TEST_SUITE(Metamorphic, NumberSystems, SystemNames);

constexpr int size = 96;

using Write = void (*)(SceneText&);

template <class N>
Picture picture(Write write, const World& world = {}, const scene::Settings& settings = {})
{
    SceneText s(world);
    write(s);
    EXPECT_TRUE(loaded<N>(s.text(), settings)) << s.text();
    return draw<N>();
}

// Every kind of shape and of light, mirrors and glass.
void everything_scene(SceneText& s)
{
    s.view({0.3, 2.2, 7}, {0.1, 0.7, 0}, 44, size);
    s.light({4, 6, 5}, 0.6);
    s.sun({-2, 3, 1}, 0.4);
    s.background(0.2, 0.3, 0.5);
    s.matte(0.8, 0.7, 0.4);
    s.polygon({{-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}});
    s.fill({0.9, 0.9, 0.9}, 0.2, 0.6, 30, 0.7, 0, 1);
    s.sphere({-1.6, 1, 0}, 1);
    s.fill({0.9, 1, 0.9}, 0.1, 0.5, 60.5, 0.1, 0.85, 1.5);
    s.sphere({0.9, 0.8, 1.4}, 0.8);
    s.fill({0.9, 0.3, 0.2}, 0.8, 0.4, 10, 0.1, 0, 1);
    s.cone({1.8, 0, -1}, 0.9, {1.8, 2, -1.2}, 0.3);
    s.disc({1.8, 2, -1.2}, {0, 1, -0.1}, 0.3);
    s.cone({-0.4, 0, 1.8}, 0.25, {-0.3, 0.6, 1.9}, 0.25);
    s.fill({0.3, 0.4, 0.9}, 0.9, 0.5, 20, 0, 0, 1);
    s.patch({{-3, 0, -2}, {3, 0, -2.5}, {2.5, 3, -2.2}, {-2.5, 3, -2.4}},
            {{-0.4, 0, 1}, {0.4, 0, 1}, {0.3, 0.2, 1}, {-0.3, 0.2, 1}});
    // concave, in the plane z = 2.5 + x / 2 + y / 4
    s.polygon({{-2.5, 0.25, 1.3125}, {-1.75, 0.25, 1.6875}, {-2.25, 0.5, 1.5}, {-2.25, 1, 1.625}});
}

size_t differing(const Picture& a, const Picture& b, int levels)
{
    EXPECT_EQ(a.rgb.size(), b.rgb.size());
    size_t count = 0;
    for (size_t i = 0; i + 2 < a.rgb.size() && i + 2 < b.rgb.size(); i += 3)
        for (size_t k = 0; k < 3; k++)
            if (std::abs(a.rgb[i + k] - b.rgb[i + k]) > levels) {
                count++;
                break;
            }
    return count;
}

// Pixels that may differ by more than one level: on silhouettes and edges, where a sample falls on one side or the
// other. An ulp of q16 is here a 250th of a pixel, along a thousand pixels of edges, some of them seen in a mirror.
template <class N>
size_t few_pixels()
{
    return std::is_same_v<N, Double> ? 0 : std::is_same_v<N, Float> || NarrowFixed<N> ? 24 : 4;
}

template <class N>
void expect_same(const Picture& a, const Picture& b)
{
    EXPECT_LE(differing(a, b, 1), few_pixels<N>());
}

TYPED_TEST(Metamorphic, Shifted)
{
    const Picture p = picture<TypeParam>(everything_scene);
    expect_same<TypeParam>(p, picture<TypeParam>(everything_scene, {1, {0.3, -0.7, 0.1}}));
    expect_same<TypeParam>(p, picture<TypeParam>(everything_scene, {1, {1000.1, -2000.3, 3000.7}}));
}

TYPED_TEST(Metamorphic, ScaledByThree)
{
    expect_same<TypeParam>(picture<TypeParam>(everything_scene), picture<TypeParam>(everything_scene, {3, {}}));
}

// The builder's scale is a power of two: not one byte changes.
TYPED_TEST(Metamorphic, ScaledByPowersOfTwo)
{
    const Picture p = picture<TypeParam>(everything_scene);
    EXPECT_EQ(p, picture<TypeParam>(everything_scene, {0x1p-10, {}}));
    EXPECT_EQ(p, picture<TypeParam>(everything_scene, {0x1p20, {}}));
}

TYPED_TEST(Metamorphic, Mirrored)
{
    const Picture p = picture<TypeParam>(everything_scene);
    World world;
    world.mirrored = true;
    Picture q = picture<TypeParam>(everything_scene, world);
    for (uint32_t j = 0; j < q.height; j++)
        for (uint32_t i = 0; i < q.width / 2; i++)
            for (uint32_t k = 0; k < 3; k++)
                std::swap(q.rgb[(size_t{j} * q.width + i) * 3 + k],
                          q.rgb[(size_t{j} * q.width + q.width - 1 - i) * 3 + k]);
    expect_same<TypeParam>(p, q);
}

// Pixels in which two surfaces are met at the same t, so that their order decides: one in five thousand in q16, whose
// steps of t are a millimetre in a metre.
template <class N>
constexpr size_t ties = NarrowFixed<N> ? 2 : 0;

TYPED_TEST(Metamorphic, ObjectsInTheOtherOrder)
{
    World world;
    world.reversed = true;
    const Picture p = picture<TypeParam>(everything_scene), q = picture<TypeParam>(everything_scene, world);
    EXPECT_LE(differing(p, q, 0), ties<TypeParam>); // no two objects of this scene touch in a plane
}

// Four views, each of a quarter of the picture, hold the bytes of the whole.
TYPED_TEST(Metamorphic, QuartersMakeTheWhole)
{
    using N = TypeParam;
    const Picture whole = picture<N>(everything_scene);
    const Camera<N> full = storage<N>().camera;
    for (int32_t y = 0; y < 2; y++)
        for (int32_t x = 0; x < 2; x++) {
            Camera<N>& c = storage<N>().camera;
            c = full;
            c.width = c.height = size / 2;
            const int32_t step = size / 2;
            c.centre = full.centre + full.right * (x == 0 ? -step : step) + full.down * (y == 0 ? -step : step);
            const Picture part = draw<N>();
            size_t wrong = 0;
            for (uint32_t j = 0; j < part.height; j++)
                for (uint32_t i = 0; i < part.width; i++)
                    for (int k = 0; k < 3; k++) {
                        const size_t at =
                            ((j + static_cast<size_t>(y * step)) * whole.width + i + static_cast<size_t>(x * step)) * 3;
                        const size_t in_part = (size_t{j} * part.width + i) * 3;
                        wrong += std::abs(whole.rgb[at + static_cast<size_t>(k)]
                                          - part.rgb[in_part + static_cast<size_t>(k)])
                            > (N::is_fixed ? 0 : 1);
                    }
            EXPECT_LE(wrong, N::is_fixed ? 0 : 3 * few_pixels<N>());
        }
}

// The pixels of a picture are those in the middle of each 3 x 3 of one three times as fine.
TYPED_TEST(Metamorphic, FinerPicturesHoldTheCoarser)
{
    using N = TypeParam;
    scene::Settings fine;
    fine.width = fine.height = 3 * size;
    const Picture p = picture<N>(everything_scene), q = picture<N>(everything_scene, {}, fine);
    Picture middle = p;
    for (uint32_t j = 0; j < p.height; j++)
        for (uint32_t i = 0; i < p.width; i++)
            for (uint32_t k = 0; k < 3; k++)
                middle.rgb[(size_t{j} * p.width + i) * 3 + k] =
                    q.rgb[(size_t{3 * j + 1} * q.width + 3 * i + 1) * 3 + k];
    expect_same<N>(p, middle);
}

// Speckle: pixels that differ from each of their 8 neighbours by more than 24 levels. Where sampling itself makes such
// pixels (a checkered floor near its horizon) they are in the double picture too; for double, in that of the scene
// elsewhere.
bool isolated(const Picture& p, uint32_t i, uint32_t j)
{
    for (uint32_t y = j - 1; y <= j + 1; y++)
        for (uint32_t x = i - 1; x <= i + 1; x++) {
            if (x == i && y == j)
                continue;
            int most = 0;
            for (uint32_t k = 0; k < 3; k++)
                most = std::max(
                    most,
                    std::abs(p.rgb[(size_t{j} * p.width + i) * 3 + k] - p.rgb[(size_t{y} * p.width + x) * 3 + k]));
            if (most <= 24)
                return false;
        }
    return true;
}
size_t speckles(const Picture& p, const Picture& reference)
{
    size_t count = 0;
    for (uint32_t j = 1; j + 1 < p.height; j++)
        for (uint32_t i = 1; i + 1 < p.width; i++)
            count += isolated(p, i, j) && !isolated(reference, i, j);
    return count;
}

// Few speckles may lie on edges where one sample falls on either side; a surface that shadows itself makes hundreds.
template <class N>
void expect_clean(Write write, size_t most = 0, const scene::Settings& settings = {})
{
    const Picture p = picture<N>(write, {}, settings);
    const World elsewhere{3, {66, -126, 192}}; // by even numbers of cells;
    const Picture reference = std::is_same_v<N, Double> ? picture<Double>(write, elsewhere, settings)
                                                        : picture<Double>(write, {}, settings);
    EXPECT_LE(speckles(p, reference), most);
    // Nor are there blots: most of the picture is that of double.
    EXPECT_LE(differing(p, reference, 8), p.rgb.size() / 3 / 50) << "of " << p.rgb.size() / 3;
}

void facing_mirrors(SceneText& s)
{
    s.view({0, 1, 2.8}, {0, 0.9, -3}, 60, size);
    s.light({0.5, 1.8, 0}, 1);
    s.fill({0.9, 0.9, 1}, 0.05, 0, 1, 0.9, 0, 1);
    s.polygon({{-2, 0, -3}, {2, 0, -3}, {2, 2, -3}, {-2, 2, -3}});
    s.polygon({{2, 0, 3}, {-2, 0, 3}, {-2, 2, 3}, {2, 2, 3}});
    s.matte(0.8, 0.5, 0.3);
    s.polygon({{-2, 0, 3}, {2, 0, 3}, {2, 0, -3}, {-2, 0, -3}});
    s.sphere({-0.6, 0.4, -1}, 0.4);
    s.cone({0.8, 0, -0.5}, 0.3, {0.8, 0.9, -0.5}, 0);
}
TYPED_TEST(Metamorphic, FacingMirrorsDoNotSpeckle)
{
    scene::Settings deep;
    deep.depth = 40;
    expect_clean<TypeParam>(facing_mirrors, 2, deep);
}

void glass_in_glass(SceneText& s)
{
    s.view({0, 0.5, 6}, {0, 0, 0}, 30, size);
    s.light({3, 5, 4}, 1);
    s.background(0.3, 0.5, 0.9);
    s.fill({1, 1, 1}, 0.05, 0.5, 80, 0.1, 0.9, 1.5);
    s.sphere({0, 0, 0}, 1.2);
    s.fill({1, 1, 1}, 0.05, 0.5, 80, 0.1, 0.9, 1.2);
    s.sphere({0.2, 0.1, 0.1}, 0.7);
    s.matte(0.8, 0.3, 0.2);
    s.polygon({{-4, -1.3, 3}, {4, -1.3, 3}, {4, -1.3, -5}, {-4, -1.3, -5}});
}
TYPED_TEST(Metamorphic, GlassInGlassDoesNotSpeckle) { expect_clean<TypeParam>(glass_in_glass, 1); }

void air_bubble(SceneText& s)
{
    s.view({0, 0.5, 6}, {0, 0, 0}, 30, size);
    s.light({3, 5, 4}, 1);
    s.background(0.3, 0.5, 0.9);
    s.fill({1, 1, 1}, 0.05, 0.5, 80, 0.1, 0.9, 1.5);
    s.sphere({0, 0, 0}, 1.2);
    s.fill({1, 1, 1}, 0, 0, 1, 0.1, 0.95, 1 / 1.5);
    s.sphere({0, 0, 0}, 1.1);
    s.matte(0.8, 0.3, 0.2);
    s.polygon({{-4, -1.3, 3}, {4, -1.3, 3}, {4, -1.3, -5}, {-4, -1.3, -5}});
}
TYPED_TEST(Metamorphic, AirBubbleDoesNotSpeckle) { expect_clean<TypeParam>(air_bubble, 1); }

void tangent_balls(SceneText& s)
{
    s.view({0, 2, 6}, {0, 0.4, 0}, 36, size);
    s.light({3, 5, 4}, 0.8);
    s.matte(0.7, 0.7, 0.7);
    s.plane({0, 0, 0}, {0, 1, 0});
    s.far(30);
    s.fill({0.9, 0.4, 0.3}, 0.7, 0.4, 20, 0.3, 0, 1);
    s.sphere({-0.7, 0.7, 0}, 0.7);
    s.sphere({0.7, 0.7, 0}, 0.7);
    s.sphere({0, 0.35, 1.1}, 0.35);
    s.cone({0, 0, -1.5}, 0.4, {0, 1.5, -1.5}, 0.4);
    s.sphere({0, 1.9, -1.5}, 0.4);
}
TYPED_TEST(Metamorphic, TangentBallsDoNotSpeckle) { expect_clean<TypeParam>(tangent_balls, 1); }

// The light is 0.01 over a floor of 20, and there are balls and a cone that it grazes.
void grazing_light(SceneText& s)
{
    s.view({0, 3, 9}, {0, 0, 0}, 50, size);
    s.light({-9.5, 0.01, 0}, 1);
    s.sun({1, 0.002, 0.5}, 0.5);
    s.matte(0.9, 0.9, 0.9);
    s.polygon({{-10, 0, 10}, {10, 0, 10}, {10, 0, -10}, {-10, 0, -10}});
    s.disc({0, 0.5, -3}, {0.001, 1, 0}, 2);
    s.sphere({-1.5, 1, 0}, 1);
    s.cone({2, 0, 0}, 1, {2, 2, 0}, 0);
    s.cone({4, 0.5, -2}, 0.5, {4, 0.5, 2}, 0.5);
}
TYPED_TEST(Metamorphic, GrazingLightDoesNotSpeckle) { expect_clean<TypeParam>(grazing_light, 2); }

template <int Far>
void checkered_horizon(SceneText& s)
{
    s.view({0.5, 1, 4}, {0.4, 0.95, 0}, 60, size);
    s.light({5, 9, 5}, 1);
    s.background(0.4, 0.6, 1);
    s.matte(1, 1, 1);
    s.checker({0.1, 0.1, 0.1}, 1);
    s.plane({0, 0, 0}, {0, 1, 0});
    s.far(Far);
}
// A floor to 1000 leaves q16 an ulp of a 64th of a square: its floor ends at 60.
TYPED_TEST(Metamorphic, CheckeredFloorToTheHorizon)
{
    expect_clean<TypeParam>(checkered_horizon<NarrowFixed<TypeParam> ? 60 : 1000>, 2);
}

// Every object twice, in the same place.
void once(SceneText& s)
{
    s.view({0.3, 2.2, 7}, {0.1, 0.7, 0}, 44, size);
    s.light({4, 6, 5}, 0.6);
    s.sun({-2, 3, 1}, 0.4);
    s.background(0.2, 0.3, 0.5);
}
void objects(SceneText& s)
{
    s.matte(0.8, 0.7, 0.4);
    s.polygon({{-6, 0, 6}, {6, 0, 6}, {6, 0, -6}, {-6, 0, -6}});
    s.fill({0.9, 0.9, 0.9}, 0.2, 0.6, 30, 0.7, 0, 1);
    s.sphere({-1.6, 1, 0}, 1);
    s.fill({0.9, 0.3, 0.2}, 0.8, 0.4, 10, 0.3, 0, 1);
    s.sphere({0.9, 0.8, 1.4}, 0.8);
    s.cone({1.8, 0, -1}, 0.9, {1.8, 2, -1.2}, 0.3);
    s.disc({1.8, 2, -1.2}, {0, 1, -0.1}, 0.3);
    s.cone({-0.4, 0, 1.8}, 0.25, {-0.3, 0.6, 1.9}, 0.25);
    s.fill({0.3, 0.4, 0.9}, 0.9, 0.5, 20, 0, 0, 1);
    s.patch({{-3, 0, -2}, {3, 0, -2.5}, {2.5, 3, -2.2}, {-2.5, 3, -2.4}},
            {{-0.4, 0, 1}, {0.4, 0, 1}, {0.3, 0.2, 1}, {-0.3, 0.2, 1}});
}
TYPED_TEST(Metamorphic, EveryObjectTwiceIsTheSamePicture)
{
    const Picture one = picture<TypeParam>([](SceneText& s) {
        once(s);
        objects(s);
    });
    const Picture two = picture<TypeParam>([](SceneText& s) {
        once(s);
        objects(s);
        objects(s);
    });
    EXPECT_LE(differing(one, two, 0), ties<TypeParam>);
}

} // namespace
