// Triangles in little room: what shares corners, what is left as it was, and that pictures are those of
// polygons and patches.
#include "scene_helpers.hpp"

#include <random>

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct LeanTest : ::testing::Test {};
TYPED_TEST_SUITE(LeanTest, NumberSystems, SystemNames);

std::string enough_for_a_tree()
{
    std::string text;
    for (uint32_t i = 0; i < scene::least_for_tree<q16>; i++)
        text += "s 0 0 9 0.25\n"; // behind the eye
    return text;
}

const std::string view = "v from 1 2 9 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 40 30\nl 5 9 7 l -6 2 4\n"
    + enough_for_a_tree();

// The six corners of an octahedron, as text: x, -x, y, -y, z, -z; smooth, each with the normal along its axis.
std::string octahedron(bool smooth, const char* scale = "1")
{
    const auto corner = [&](int axis, bool negative) {
        std::string place, normal;
        for (int i = 0; i < 3; i++) {
            place += i == axis ? std::string(negative ? " -" : " ") + scale : " 0";
            normal += i == axis ? negative ? " -1" : " 1" : " 0";
        }
        return place + (smooth ? normal : "");
    };
    std::string text;
    for (int i = 0; i < 8; i++)
        text += std::string(smooth ? "pp" : "p") + " 3" + corner(0, i & 1) + corner(1, i & 2) + corner(2, i & 4) + "\n";
    return text;
}

TYPED_TEST(LeanTest, EqualCornersAreStoredOnce)
{
    using N = TypeParam;
    const auto& s = storage<N>();
    ASSERT_TRUE(loaded<N>(view + octahedron(true), compiled()));
    EXPECT_EQ(s.smooth_triangles.count, 8u);
    EXPECT_EQ(s.vertices.count, 6u);
    EXPECT_EQ(s.normals.count, 6u);
    EXPECT_EQ(s.patches.count, 0u);
    // Flat ones at the same places share them, and need no normals.
    ASSERT_TRUE(loaded<N>(view + octahedron(false) + octahedron(true) + octahedron(false, "2"), compiled()));
    EXPECT_EQ(s.triangles.count, 16u);
    EXPECT_EQ(s.smooth_triangles.count, 8u);
    EXPECT_EQ(s.vertices.count, 12u);
    EXPECT_EQ(s.normals.count, 6u);
    EXPECT_EQ(s.polygons.count, 0u);
    // Other normals at the same place make other corners.
    ASSERT_TRUE(loaded<N>(view + octahedron(true) + "pp 3 1 0 0 0 1 0  0 1 0 0 1 0  0 0 1 0 0 1", compiled()));
    EXPECT_EQ(s.vertices.count, 7u);
    // On a desktop all stay as they are.
    ASSERT_TRUE(loaded<N>(view + octahedron(true) + octahedron(false)));
    EXPECT_EQ(s.triangles.count + s.smooth_triangles.count, 0u);
    EXPECT_EQ(s.vertices.count, 48u);
}

// A tag's place has 16 bits there, and a material 8; figures of more corners have none.
TYPED_TEST(LeanTest, WhatDoesNotFitIsLeft)
{
    using N = TypeParam;
    const auto& s = storage<N>();
    std::string text = view + "p 4 -1 0 0 0 -1 0 1 0 0 0 1 0\n" + octahedron(false);
    for (int i = 0; i < 257; i++)
        text += "material shine " + std::to_string(i) + " s 5 0 0 1\n";
    text += octahedron(true); // of material 256, for shine 1 is the first's
    ASSERT_TRUE(loaded<N>(text, compiled()));
    EXPECT_EQ(s.polygons.count, 1u);
    EXPECT_EQ(s.triangles.count, 8u);
    EXPECT_EQ(s.patches.count, 8u);
    if (!WideFixed<N>) // the same for all
        return;
    std::string many = view;
    for (uint32_t i = scene::least_for_tree<q16>; i < 65532; i++)
        many += "s 0 0 0 1\n";
    ASSERT_TRUE(loaded<N>(many + octahedron(false), compiled()));
    EXPECT_EQ(s.triangles.count, 4u);
    EXPECT_EQ(s.polygons.count, 4u);
    EXPECT_EQ(s.vertices.count, 5u + 4 * 3);
}

// Triangles large and small, flat, smooth and along one another's edges, of glass and mirrors,
// before the eye and at it.
TYPED_TEST(LeanTest, PicturesAreThoseOfPolygonsAndPatches)
{
    using N = TypeParam;
    std::mt19937 random(3);
    const auto number = [&random](double size) {
        return std::to_string(size * (static_cast<double>(random() % 20001) / 10000 - 1)) + " ";
    };
    uint32_t triangles = 0, others = 0;
    for (int scene = 0; scene < 3; scene++) {
        std::string text = view;
        for (int i = 0; i < 120; i++) {
            if (i % 10 == 0)
                text += "material colour 0.9 0.7 0.5 diffuse 0.6 "
                    + std::string(i % 20 == 0 ? "mirror 0.5\n" : "transmit 0.5 ior 1.4\n");
            const double size = i % 12 == 0 ? 4 : i % 3 == 0 ? 1 : i % 7 == 0 ? 0.003 : 0.3;
            const bool smooth = i % 2 == 1;
            const std::string places[] = {number(2), number(2), number(2)};
            text += smooth ? "pp 3 " : "p 3 ";
            for (int corner = 0; corner < 3; corner++) {
                for (const std::string& place : places)
                    text += std::to_string(std::stod(place) + size * (static_cast<double>(random() % 2001) / 1000 - 1))
                        + " ";
                if (smooth)
                    text += number(0.5) + number(0.5) + "1 ";
            }
            text += "\n";
        }
        ASSERT_TRUE(loaded<N>(text));
        const Picture expected = draw<N>();
        const uint32_t all = storage<N>().polygons.count + storage<N>().patches.count;
        ASSERT_TRUE(loaded<N>(text, compiled()));
        const auto& s = storage<N>();
        EXPECT_EQ(s.polygons.count + s.patches.count + s.triangles.count + s.smooth_triangles.count, all);
        triangles += s.triangles.count + s.smooth_triangles.count;
        others += s.polygons.count + s.patches.count;
        EXPECT_EQ((draw<N, flat()>()), expected);
    }
    EXPECT_GT(triangles, 250u);
    if (N::is_fixed) // slivers, of which rounded corners say too little
        EXPECT_GT(others, 0u);
    else
        EXPECT_EQ(others, 0u);
}

// Of a fan, a sliver stays a patch, with all the corners of the fan, beside those that its other triangles share.
TYPED_TEST(LeanTest, AFanMayFitInPart)
{
    using N = TypeParam;
    std::string text = view;
    for (int i = 0; i < 40; i++) {
        const double x = 0.3 * (i % 8) - 1.2, y = 0.3 * (i / 8) - 0.6;
        const auto corner = [&](double u, double v) {
            char at[100];
            snprintf(at, sizeof at, " %.9f %.9f %.9f %.3f %.3f 1", x + u, y + v, 0.1 * u, u, v);
            return std::string(at);
        };
        text += "pp 4" + corner(0, 0) + corner(0.25, 0) + corner(0.25, 0.25)
            + corner(0.125 - 1e-5, 0.125 + 1e-5) + "\n";
    }
    ASSERT_TRUE(loaded<N>(text));
    const Picture expected = draw<N>();
    ASSERT_TRUE(loaded<N>(text, compiled()));
    const auto& s = storage<N>();
    EXPECT_EQ(s.vertices.count, s.normals.count);
    if (WideFixed<N>) {
        EXPECT_EQ(s.patches.count, 40u);
        EXPECT_EQ(s.smooth_triangles.count, 40u);
        EXPECT_GT(s.vertices.count, 160u); // more than the text has
    }
    EXPECT_EQ((draw<N, flat()>()), expected);
}

} // namespace
