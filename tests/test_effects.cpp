#include <qray/scene/effects.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "../src/scene/numbers.hpp"

namespace {

using namespace qray;

// Every flag there is. One that is in the header, and in none of its lists, makes the first test fail.
#define QRAY_FLAG(Type, name, table) &Effects::name,
constexpr bool Effects::* flags[] = {QRAY_EFFECTS(QRAY_FLAG)};
constexpr bool Effects::* shapes[] = {QRAY_SHAPES(QRAY_FLAG)};
constexpr bool Effects::* textures[] = {QRAY_TEXTURES(QRAY_FLAG)};
constexpr bool Effects::* lights[] = {QRAY_LIGHTS(QRAY_FLAG)};
#undef QRAY_FLAG

TEST(Effects, AreFlagsAndADepth)
{
    EXPECT_EQ(sizeof(Effects),
              std::size(flags) + sizeof(Effects::depth) + sizeof(Effects::moving) + sizeof(Effects::light_bits));
}

TEST(Effects, AreInTheListOfTheirKind)
{
    const auto holds = [](const auto& list, bool Effects::* flag) {
        return std::count(std::begin(list), std::end(list), flag);
    };
    for (bool Effects::* flag : flags)
        EXPECT_EQ(holds(flags, flag), 1);
    for (bool Effects::* shape : {&Effects::sphere, &Effects::disc, &Effects::cone, &Effects::polygon, &Effects::patch})
        EXPECT_EQ(holds(shapes, shape), 1);
    for (bool Effects::* texture : {&Effects::checker, &Effects::stripes, &Effects::gradient, &Effects::rings,
                                    &Effects::noise, &Effects::marble, &Effects::wood, &Effects::brick,
                                    &Effects::image, &Effects::globe})
        EXPECT_EQ(holds(textures, texture), 1);
    for (bool Effects::* light : {&Effects::light, &Effects::sun, &Effects::panel})
        EXPECT_EQ(holds(lights, light), 1);
    for (bool Effects::* other : {&Effects::shadow, &Effects::see_through, &Effects::highlight,
                                  &Effects::fractional_shine, &Effects::mirror, &Effects::transmit,
                                  &Effects::eye_surface, &Effects::light_surface, &Effects::grid, &Effects::adaptive,
                                  &Effects::tree, &Effects::light_map})
        EXPECT_EQ(holds(flags, other), 1);
}

TEST(Effects, NoneAreSetToBeginWith)
{
    constexpr Effects none;
    for (bool Effects::* flag : flags)
        EXPECT_FALSE(none.*flag);
    EXPECT_EQ(none.shapes(), 0);
    EXPECT_FALSE(none.texture() || none.spawns() || none.lights());
}

TEST(Effects, EverythingIsEverything)
{
    constexpr Effects all = everything(7);
    for (bool Effects::* flag : flags)
        EXPECT_TRUE(all.*flag);
    EXPECT_EQ(all.depth, 7);
    EXPECT_EQ(all.shapes(), std::size(shapes));
    EXPECT_TRUE(all.texture() && all.spawns() && all.lights());
}

TEST(Effects, HoldOthersFlagByFlag)
{
    const Effects none, all = everything(5);
    EXPECT_TRUE(all.holds(none));
    EXPECT_TRUE(all.holds(all));
    for (bool Effects::* flag : flags) {
        Effects one = none, most = all;
        one.*flag = true;
        most.*flag = false;
        EXPECT_FALSE(none.holds(one));
        EXPECT_TRUE(one.holds(one));
        EXPECT_TRUE(all.holds(one));
        EXPECT_FALSE(most.holds(one));
        EXPECT_FALSE(most.holds(all));
        EXPECT_TRUE(all.holds(most));
    }
}

TEST(Effects, HoldNoGreaterDepth)
{
    EXPECT_TRUE(everything(5).holds(everything(4)));
    EXPECT_TRUE(everything(5).holds(everything(5)));
    EXPECT_FALSE(everything(5).holds(everything(6)));
}

TEST(Effects, GroupsFollowTheirFlags)
{
    const auto only = [](bool Effects::* flag) {
        Effects e;
        e.*flag = true;
        return e;
    };
    for (bool Effects::* shape : shapes)
        EXPECT_EQ(only(shape).shapes(), 1);
    for (bool Effects::* texture : textures)
        EXPECT_TRUE(only(texture).texture());
    for (bool Effects::* light : lights)
        EXPECT_TRUE(only(light).lights());
    // What is made of corners, and what has normals of its own.
    EXPECT_TRUE(only(&Effects::polygon).corners() && only(&Effects::patch).corners());
    EXPECT_FALSE(only(&Effects::sphere).corners() || only(&Effects::disc).corners() || only(&Effects::cone).corners());
    EXPECT_TRUE(only(&Effects::triangle).corners() && only(&Effects::smooth_triangle).corners());
    EXPECT_TRUE(only(&Effects::patch).smooth() && only(&Effects::smooth_triangle).smooth());
    EXPECT_FALSE(only(&Effects::polygon).smooth() || only(&Effects::triangle).smooth()
                 || only(&Effects::sphere).smooth());
    EXPECT_TRUE(only(&Effects::mirror).spawns());
    EXPECT_TRUE(only(&Effects::transmit).spawns());
    EXPECT_TRUE(only(&Effects::see_through).transmits() && only(&Effects::transmit).transmits());
    EXPECT_FALSE(only(&Effects::see_through).texture() || only(&Effects::see_through).spawns()
                 || only(&Effects::see_through).lights());
}

} // namespace

// A shape that forgets a constant or a function is none.
namespace forgetful {

using namespace qray;

struct Asked {
    Tag tag;
};
template <bool Near, class N>
bool intersect(const Asked&, const Corners<N>&, const Ray<N>&, typename N::Length, typename N::Length&, Local<N>&);
template <bool Near, class N>
int crossings(const Asked&, const Corners<N>&, const Ray<N>&, typename N::Length);
template <class N>
void surface_of(const Asked&, const Corners<N>&, const Ray<N>&, typename N::Length, const Local<N>&, Point<N>&,
                Direction<N>&);
template <class N>
bool surely_missed(const Asked&, const RejectRay<N>&);
template <class S, class N>
    requires std::is_base_of_v<Asked, S>
bool move(const S&, const Corners<N>&, const Motion<N>&, S&, const MovedCorners<N>&);
template <class N>
BoundingBox<N> box_of(const Asked&, const Corners<N>&);

struct Whole : Asked {
    static constexpr bool has_corners = false, keeps_local = false, is_smooth = false, is_short = false;
};
#define QRAY_IS_IN(Type, name) &&ShapeIn<Whole, Type>
static_assert(true QRAY_NUMBERS(QRAY_IS_IN));
#undef QRAY_IS_IN

struct NoCorners : Asked {
    static constexpr bool keeps_local = false, is_smooth = false, is_short = false;
};
struct NoCurved : Asked {
    static constexpr bool has_corners = false, is_smooth = false, is_short = false;
};
struct NoSmooth : Asked {
    static constexpr bool has_corners = false, keeps_local = false, is_short = false;
};
struct NoShort : Asked {
    static constexpr bool has_corners = false, keeps_local = false, is_smooth = false;
};
static_assert(!ShapeIn<NoCorners, q32> && !ShapeIn<NoCurved, q32> && !ShapeIn<NoSmooth, q32> && !ShapeIn<NoShort, q32>);

struct NoIntersect : Whole {};
template <bool Near, class N>
bool intersect(const NoIntersect&, const Corners<N>&, const Ray<N>&, typename N::Length, typename N::Length&,
               Local<N>&) = delete;
struct NoCrossings : Whole {};
template <bool Near, class N>
int crossings(const NoCrossings&, const Corners<N>&, const Ray<N>&, typename N::Length) = delete;
struct NoSurface : Whole {};
template <class N>
void surface_of(const NoSurface&, const Corners<N>&, const Ray<N>&, typename N::Length, const Local<N>&, Point<N>&,
                Direction<N>&) = delete;
struct NoReject : Whole {};
template <class N>
bool surely_missed(const NoReject&, const RejectRay<N>&) = delete;
static_assert(!ShapeIn<NoIntersect, q32> && !ShapeIn<NoCrossings, q32>);
static_assert(!ShapeIn<NoSurface, q32> && !ShapeIn<NoReject, q32>);

struct Smooth : Asked {
    static constexpr bool has_corners = false, keeps_local = false, is_smooth = true, is_short = false;
};
static_assert(!ShapeIn<Smooth, q32>); // without a shading_normal()
struct Cornered : Asked {
    static constexpr bool has_corners = true, keeps_local = false, is_smooth = false, is_short = false;
};
static_assert(!ShapeIn<Cornered, q32>); // without a normal_of()

} // namespace forgetful
