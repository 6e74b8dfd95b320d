#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct PatchTest : ::testing::Test {};
TYPED_TEST_SUITE(PatchTest, NumberSystems, SystemNames);

const std::vector<Vec3> triangle{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
const std::vector<Vec3> flat{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};

TYPED_TEST(PatchTest, IsHitWhereItsTriangleIs)
{
    QRAY_SHAPE_TEST;
    const PatchOf<N> s(triangle, flat);
    const auto down = [](double x, double y) { return M::ray({x, y, 4}, {0, 0, -1}); };
    ASSERT_TRUE(s.hit(down(0.5, 0.5), limit, t));
    EXPECT_EQ(value(t), 4);
    ASSERT_TRUE(s.hit(M::ray({0.5, 0.5, -3}, {0, 0, 1}), limit, t));
    EXPECT_EQ(value(t), 3);
    EXPECT_FALSE(s.hit(down(1.0625, 1), limit, t));
    EXPECT_FALSE(s.hit(down(-0.0625, 1), limit, t));
    EXPECT_FALSE(s.hit(down(1, -0.0625), limit, t));
    EXPECT_FALSE(s.hit(down(0.5, 0.5), M::length(3.875), t));
    EXPECT_FALSE(s.hit(M::ray({0.5, 0.5, 4}, {0, 0, 1}), limit, t));
}

TYPED_TEST(PatchTest, TakesItsCornersFromTheTable)
{
    QRAY_SHAPE_TEST;
    // A fan of five corners: the second triangle is corners 0, 2, 3 from the fan's first.
    ShapeOf<Patch, N> s({{9, 9, 9}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, make_tag(0, 0));
    s.shape.normal = M::vector(0, 0, 1);
    s.shape.first = 1;
    s.shape.second = 3;
    EXPECT_TRUE(s.hit(M::ray({0.5, 1.5, 4}, {0, 0, -1}), limit, t));
    EXPECT_FALSE(s.hit(M::ray({1.5, 0.5, 4}, {0, 0, -1}), limit, t));
}

TYPED_TEST(PatchTest, ShadingNormalIsTheBarycentricBlend)
{
    QRAY_SHAPE_TEST;
    Random random(60);
    double worst = 0;
    for (int i = 0; i < 2000; i++) {
        const std::vector<Vec3> c{random.point(3), random.point(3), random.point(3)};
        const Vec3 g = cross(c[1] - c[0], c[2] - c[0]);
        if (length(g) < 2)
            continue;
        std::vector<Vec3> normals;
        for (int k = 0; k < 3; k++)
            normals.push_back(unit(g) + random.direction() * 0.5);
        for (Vec3& n : normals)
            n = unit(n);
        const PatchOf<N> s(c, normals);
        const double v = random.uniform(0.1, 0.45), w = random.uniform(0.1, 0.45);
        const Vec3 at = c[0] * (1 - v - w) + c[1] * v + c[2] * w;
        const Vec3 from = at + unit(unit(g) * (i % 2 == 0 ? 1 : -1) + random.direction() * 0.5) * 5;
        const auto ray = M::ray(from, at - from);
        if (!s.hit(ray, limit, t)) {
            ADD_FAILURE();
            continue;
        }
        const Vec3 expected = unit(normals[0] * (1 - v - w) + normals[1] * v + normals[2] * w);
        worst = std::fmax(worst, distance(s.shading(ray), expected));
    }
    // The point itself is off by an ulp or so of Length, in a triangle of height 1.
    EXPECT_LE(worst, 8 * M::length_ulp(8) + 4 * M::unit_ulp());
}

TYPED_TEST(PatchTest, ShadingNormalAtACornerIsTheCorners)
{
    QRAY_SHAPE_TEST;
    const std::vector<Vec3> normals{unit({-1, -1, 2}), unit({1, 0, 2}), unit({0, 1, 1})};
    const PatchOf<N> s(triangle, normals);
    for (int k = 0; k < 3; k++) {
        const Vec3 at = triangle[static_cast<size_t>(k)];
        expect_near(s.shading(M::ray({at.x, at.y, 4}, {0, 0, -1})), normals[static_cast<size_t>(k)], 4 * M::unit_ulp());
    }
}

TYPED_TEST(PatchTest, CornerNormalsNeedNotBeUnit)
{
    QRAY_SHAPE_TEST;
    // Given (0, 0, 1/4) and (1/2, 0, 0) at two corners: halfway between them the blend is along (2, 0, 1).
    PatchOf<N> s(triangle, flat);
    s.normals = {M::vector(0, 0, 0.25), M::vector(0.5, 0, 0), M::vector(0, 0, 1)};
    expect_near(s.shading(M::ray({1, 0, 4}, {0, 0, -1})), unit({2, 0, 1}), 4 * M::unit_ulp());
}

TYPED_TEST(PatchTest, WhereTheBlendVanishesTheTrianglesOwnNormalStands)
{
    QRAY_SHAPE_TEST;
    PatchOf<N> s(triangle, flat);
    s.normals = {M::vector(0, 0, 0), M::vector(0, 0, 0), M::vector(0, 0, 0)};
    EXPECT_EQ(s.shading(M::ray({0.5, 0.5, 4}, {0, 0, -1})), (Vec3{0, 0, 1}));
    // Opposite normals at the two ends of an edge cancel in its middle.
    s.normals = {M::vector(1, 0, 0), M::vector(-1, 0, 0), M::vector(0, 0, 1)};
    EXPECT_EQ(s.shading(M::ray({1, 0, 4}, {0, 0, -1})), (Vec3{0, 0, 1}));
}

TYPED_TEST(PatchTest, IsNotMetByARayThatLeavesItAndBlocksLightBehindIt)
{
    QRAY_SHAPE_TEST;
    const PatchOf<N> s(triangle, flat, make_tag(4, 2));
    EXPECT_FALSE(s.hit(ray_from<N>({0.5, 0.5, 0}, {0.5, 0, 0.5}, s.shape.tag, true), limit, t));
    EXPECT_FALSE(s.hit(ray_from<N>({0.5, 0.5, -0.001}, {0, 0, 1}, s.shape.tag, true), limit, t));
    const auto ray = M::ray({0.5, 0.5, 4}, {0, 0, -1});
    EXPECT_EQ(s.crossings(ray, M::length(3)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(4)), 0);
    EXPECT_EQ(s.crossings(ray, M::length(4.5)), 1);
}

} // namespace
