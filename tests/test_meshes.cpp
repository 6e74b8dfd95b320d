// Watertight meshes: rays aimed at the corners and edges of closed meshes, from inside and from outside, must cross
// them: an odd number of times from inside, an even one from outside, whatever the number system. Each shared edge
// has one owner, or these parities would be wrong. With and without the tree.
#include "hostile/mesh.hpp"
#include "number_helpers.hpp"
#include "tracer.hpp"

namespace {

using namespace hostile;
using qray::scene::operator*;
using qray::scene::operator+;

#if defined(__SANITIZE_ADDRESS__)
constexpr uint64_t rays = 200, bounces = 2000;
#else
constexpr uint64_t rays = 2500, bounces = 100000;
#endif

template <class N>
struct MeshTest : ::testing::Test {};
TYPED_TEST_SUITE(MeshTest, qray::test::NumberSystems, qray::test::SystemNames);

template <class N>
void expect_watertight(const Mesh& mesh, uint32_t faces)
{
    MeshBench<N> bench(mesh);
    ASSERT_GE(bench.faces(), faces);
    ASSERT_EQ(bench.vanished(), 0u);
    const MeshTally t = bench.shoot(17, rays);
    EXPECT_EQ(t.rays, rays);
    EXPECT_EQ(t.leaks, 0u) << "rays through nothing";
    EXPECT_EQ(t.odd, 0u) << "wrong crossing parities";
    EXPECT_EQ(t.pruned, 0u) << "hits that the tree lost";
}

Mesh turned_body(uint32_t slices = 40, uint32_t stacks = 40)
{
    Random random(5);
    return turned_body(random, slices, stacks, 1);
}

TYPED_TEST(MeshTest, BodyOfTrianglesAndQuads)
{
    Random random(1);
    Mesh m = turned_body();
    const Turn turn(random);
    m.move([&](const Double3& c) { return turn(c) * 10; });
    m.room = 1;
    expect_watertight<TypeParam>(m, 2000);
}

TYPED_TEST(MeshTest, StretchedHundredToOne)
{
    Random random(2);
    Mesh m = turned_body();
    const Turn turn(random);
    m.move([&](const Double3& c) { return turn({c.x * 30, c.y * 3, c.z * 0.3}); });
    m.room = 0.03;
    expect_watertight<TypeParam>(m, 2000);
}

TYPED_TEST(MeshTest, FarFromTheOrigin)
{
    Random random(3);
    Mesh m = turned_body();
    const Turn turn(random);
    m.move([&](const Double3& c) { return turn(c) * 2 + Double3{31, -32, 30}; });
    m.room = 0.2;
    expect_watertight<TypeParam>(m, 2000);
}

// Faces of 4e-4 to 1e-3: in float 100 to 250 units in the last place of their coordinates; 20 to 50 in q16, where they
// are 50 times as large.
TYPED_TEST(MeshTest, SmallAndFarFromTheOrigin)
{
    Random random(4);
    Mesh m = turned_body();
    const Turn turn(random);
    const double size = qray::ShortFixed<TypeParam> ? 0.5 : 0.01;
    m.move([&](const Double3& c) { return turn(c) * size + Double3{31, -32, 30}; });
    m.room = size / 10;
    expect_watertight<TypeParam>(m, 2000);
}

TYPED_TEST(MeshTest, DisplacedSphere)
{
    Random random(5);
    Mesh m = displaced_sphere(random, 40, 40, 1);
    const Turn turn(random);
    m.move([&](const Double3& c) { return turn(c) * 10; });
    m.room = 1;
    expect_watertight<TypeParam>(m, 3000);
}

// Around its poles a flat body of 200 slices has triangles 0.02 wide and 6 long, along its rim others of 0.6 by 6e-3.
// In q16 it is ten times as thick: mirrors turn the aim of some rays by more than half of 0.02 at its distance.
TYPED_TEST(MeshTest, Needles)
{
    Random random(6);
    Mesh m = displaced_sphere(random, 200, 10, 1);
    const Turn turn(random);
    const double thick = qray::ShortFixed<TypeParam> ? 0.2 : 0.02;
    m.move([&](const Double3& c) { return turn({c.x * 20, c.y * thick, c.z * 20}); });
    m.room = thick / 10;
    expect_watertight<TypeParam>(m, 3000);
}

TYPED_TEST(MeshTest, ConcaveFacesOf144Corners)
{
    Random random(7);
    Mesh m = star_prism(72, 0.3);
    const Turn turn(random);
    m.move([&](const Double3& c) { return turn(c) * 20; });
    m.room = 0.2;
    expect_watertight<TypeParam>(m, 146);
}

// Along the axes, where edges and rays have exact zeros.
TYPED_TEST(MeshTest, ConcaveFacesAlongTheAxes)
{
    Mesh m = star_prism(72, 0.3);
    m.move([&](const Double3& c) { return c * 16; });
    m.room = 0.2;
    expect_watertight<TypeParam>(m, 146);
}

// Light that bounces about inside, 4 or 8 ulp off each face that it leaves, never gets out: no dihedral angle of these
// bodies is acute. In q16, which steps off by 2 ulp, a hit 40 lengths away is known to 3: some 20 in a million get out;
// and of q24, which steps off by 4, some 10.
TYPED_TEST(MeshTest, NothingGetsOut)
{
    Random random(8);
    const Turn turn(random);
    Mesh body = turned_body();
    body.move([&](const Double3& c) { return turn(c) * 10; });
    body.room = 1;
    Mesh star = star_prism(4, 0.3, 0.75); // tips of 97 degrees
    star.move([&](const Double3& c) { return turn(c) * 20; });
    star.room = 0.2;
    Mesh sharp = star_prism(72, 0.3); // tips of 12 degrees, where 14 or 24 bits put a point beyond the other side
    sharp.move([&](const Double3& c) { return turn(c) * 20; });
    sharp.room = 0.2;
    constexpr bool is_precise = std::is_same_v<TypeParam, qray::q32> || std::is_same_v<TypeParam, qray::Double>;
    for (const Mesh* m : {&body, &star, &sharp}) {
        if (m == &sharp && !is_precise)
            continue;
        const MeshTally t = MeshBench<TypeParam>(*m).bounce(19, bounces);
        EXPECT_EQ(t.bounces, bounces);
        EXPECT_LE(t.escapes, qray::NarrowFixed<TypeParam> ? 1 + bounces / (qray::ShortFixed<TypeParam> ? 20000 : 100000)
                                                          : 0);
    }
}

} // namespace
