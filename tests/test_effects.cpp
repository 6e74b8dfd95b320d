#include <qray/scene/effects.hpp>

#include <gtest/gtest.h>

namespace {

using namespace qray;

// Every flag there is. One more in the header makes the first test fail.
constexpr bool Effects::* flags[] = {
    &Effects::sphere, &Effects::disc, &Effects::cone, &Effects::polygon, &Effects::patch,
    &Effects::checker, &Effects::stripes, &Effects::gradient, &Effects::rings, &Effects::noise,
    &Effects::marble, &Effects::wood, &Effects::brick,
    &Effects::light, &Effects::sun, &Effects::shadow, &Effects::see_through, &Effects::highlight,
    &Effects::fractional_shine, &Effects::mirror, &Effects::transmit, &Effects::eye_surface,
    &Effects::light_surface, &Effects::grid, &Effects::adaptive, &Effects::tree,
};

TEST(Effects, AreFlagsAndADepth)
{
    EXPECT_EQ(sizeof(Effects), sizeof flags / sizeof flags[0] + sizeof(Effects::depth));
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
    EXPECT_EQ(all.shapes(), 5);
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
    for (bool Effects::* shape : {&Effects::sphere, &Effects::disc, &Effects::cone, &Effects::polygon, &Effects::patch})
        EXPECT_EQ(only(shape).shapes(), 1);
    for (bool Effects::* texture : {&Effects::checker, &Effects::stripes, &Effects::gradient, &Effects::rings, &Effects::noise,
                                    &Effects::marble, &Effects::wood, &Effects::brick})
        EXPECT_TRUE(only(texture).texture());
    EXPECT_TRUE(only(&Effects::mirror).spawns());
    EXPECT_TRUE(only(&Effects::transmit).spawns());
    EXPECT_TRUE(only(&Effects::light).lights());
    EXPECT_TRUE(only(&Effects::sun).lights());
    EXPECT_FALSE(only(&Effects::see_through).texture() || only(&Effects::see_through).spawns() || only(&Effects::see_through).lights());
}

} // namespace
