// A scene's tables: what an effect set does not hold is not stored. Materials (material.hpp) are such tables alone.
#include <qray/scene/scene.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct SceneTest : ::testing::Test {};
TYPED_TEST_SUITE(SceneTest, NumberSystems, SystemNames);

TEST(Table, GivesItsEntries)
{
    static constexpr int entries[] = {4, 5, 6};
    constexpr Table<int, true> table{entries, 3};
    static_assert(table[0] == 4 && table[2] == 6);
    EXPECT_EQ(table.count, 3u);
}

TEST(Table, IsEmptyWhereItIsAbsent)
{
    EXPECT_TRUE((std::is_empty_v<Table<int, false>>));
    EXPECT_TRUE((std::is_empty_v<Maybe<double, false>>));
    EXPECT_FALSE((std::is_empty_v<Table<int, true>>));
    EXPECT_FALSE((std::is_empty_v<Maybe<double, true>>));
}

template <class N, Effects E>
constexpr size_t size_with = sizeof(Scene<N, E>);

// What always is there: the camera, the background, the exposure and the matte parts.
template <class N>
struct Core {
    Camera<N> camera;
    Rgb<N> background;
    int32_t exposure;
    Table<Matte<N>, true> mattes;
};

constexpr Effects only(bool Effects::* flag)
{
    Effects e;
    e.*flag = true;
    return e;
}

TYPED_TEST(SceneTest, HoldsNothingThatItsEffectsDoNotCallFor)
{
    using N = TypeParam;
    constexpr size_t least = size_with<N, Effects{}>;
    // Empty members take no room of their own, but each one of a kind an address.
    EXPECT_LE(least, sizeof(Core<N>) + sizeof(void*));
    constexpr size_t table = sizeof(Table<int, true>);
    EXPECT_LE((size_with<N, only(&Effects::sphere)>), least + table + sizeof(void*));
    EXPECT_GE((size_with<N, only(&Effects::sphere)>), least + table - sizeof(void*));
    EXPECT_LE((size_with<N, only(&Effects::checker)>), least + 2 * table + sizeof(void*)); // and which material has it
    EXPECT_LE((size_with<N, only(&Effects::light)>), least + table + sizeof(void*));
    EXPECT_GT((size_with<N, everything(5)>), least + 20 * table);
}

TYPED_TEST(SceneTest, IsAConstant)
{
    using N = TypeParam;
    // A compiled scene: constant tables, of a constant scene.
    constexpr Effects e = only(&Effects::sphere);
    static constexpr Sphere<N> spheres[2]{};
    static constexpr Matte<N> mattes[1]{};
    constexpr Scene<N, e> scene = [] {
        Scene<N, e> s{};
        s.camera.width = 4;
        s.spheres = {spheres, 2};
        s.mattes = {mattes, 1};
        return s;
    }();
    static_assert(scene.spheres.count == 2 && scene.mattes.count == 1 && scene.camera.width == 4);
    EXPECT_EQ(scene.spheres.data, spheres);
}

} // namespace
