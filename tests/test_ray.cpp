#include <qray/trace/hit.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct RayTest : ::testing::Test {};
TYPED_TEST_SUITE(RayTest, NumberSystems, SystemNames);

TEST(Tag, HoldsAPlaceAndAMaterial)
{
    static_assert(make_tag(5, 3).place() == 5);
    static_assert(make_tag(5, 3).material() == 3);
    static_assert(make_tag(0xfffff, 0).material() == 0);
    static_assert(make_tag(0, 0xfff).place() == 0);
    static_assert(make_tag(0xffffe, 0xfff).place() == 0xffffe);
    static_assert(make_tag(0xffffe, 0xfff).material() == 0xfff);
    EXPECT_FALSE(make_tag(5, 3) == make_tag(5, 4));
    EXPECT_FALSE(make_tag(5, 3) == make_tag(6, 3));
    EXPECT_TRUE(make_tag(5, 3) == make_tag(5, 3));
    EXPECT_FALSE(make_tag(0, 0) == Tag{Tag::none});
}

TYPED_TEST(RayTest, KnowsOnWhichSideItLeavesASurface)
{
    Ray<TypeParam> ray = make<TypeParam>::ray({0, 0, 0}, {0, 0, 1});
    EXPECT_EQ(leaves(ray, make_tag(7, 1)), Leaves::no);
    ray.from = make_tag(7, 1);
    ray.outward = true;
    EXPECT_EQ(leaves(ray, make_tag(7, 1)), Leaves::outward);
    EXPECT_EQ(leaves(ray, make_tag(8, 1)), Leaves::no);
    ray.outward = false;
    EXPECT_EQ(leaves(ray, make_tag(7, 1)), Leaves::inward);
}

TYPED_TEST(RayTest, OfTwoHitsTheNearerOrElseTheFirstInTheFileComesBefore)
{
    using M = make<TypeParam>;
    Hit<TypeParam> hit{};
    hit.t = M::length(2);
    hit.tag = make_tag(5, 9);
    EXPECT_TRUE(hit.is_behind(M::length(1.5), make_tag(6, 0)));
    EXPECT_FALSE(hit.is_behind(M::length(2.5), make_tag(4, 0)));
    EXPECT_TRUE(hit.is_behind(M::length(2), make_tag(4, 4095))); // whatever the materials
    EXPECT_FALSE(hit.is_behind(M::length(2), make_tag(6, 0)));
    EXPECT_FALSE(hit.is_behind(M::length(2), make_tag(5, 9)));
}

} // namespace
