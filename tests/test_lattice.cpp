#include <qray/texture/lattice.hpp>

#include "texture_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct LatticeTest : ::testing::Test {};
TYPED_TEST_SUITE(LatticeTest, NumberSystems, SystemNames);

TYPED_TEST(LatticeTest, CellsAreFloors)
{
    using N = TypeParam;
    using M = make<N>;
    const auto axis = make_axis<N>({}, {1, 0, 0}, 0, true);
    const double x[] = {0, 0.25, 0.75, 1, 1.5, 3, 7.75, -0.25, -1, -1.5, -7, -7.75};
    for (double v : x) {
        const Cell<N> c = axis.cell(M::point(v, 5, -3));
        EXPECT_EQ(c.index, static_cast<uint32_t>(static_cast<int32_t>(std::floor(v)))) << v;
        EXPECT_EQ(value(c.inside), v - std::floor(v)) << v;
    }
}

TYPED_TEST(LatticeTest, OneStepBelowAnIntegerIsInTheCellBelow)
{
    using N = TypeParam;
    using M = make<N>;
    const auto axis = make_axis<N>({}, {0, 1, 0}, 0, true);
    for (double v : {-4.0, 0.0, 1.0, 6.0}) {
        const double below = v - std::fmax(M::length_ulp(v), N::is_fixed ? 0 : 0x1p-20);
        EXPECT_EQ(axis.cell(M::point(0, below, 0)).index, static_cast<uint32_t>(static_cast<int32_t>(v) - 1)) << v;
        EXPECT_EQ(axis.cell(M::point(0, v, 0)).index, static_cast<uint32_t>(static_cast<int32_t>(v))) << v;
    }
}

TYPED_TEST(LatticeTest, OffsetsShiftTheCells)
{
    using N = TypeParam;
    using M = make<N>;
    const auto axis = make_axis<N>({}, {0, 0, 1}, 0.0009765625, true);
    EXPECT_EQ(axis.cell(M::point(0, 0, 3 - 0.00048828125)).index, 3u);
    EXPECT_EQ(axis.cell(M::point(0, 0, 3 - 0.0029296875)).index, 2u);
    EXPECT_EQ(axis.cell(M::point(0, 0, -0.00048828125)).index, 0u);
}

TYPED_TEST(LatticeTest, FarCellsAreRight)
{
    using N = TypeParam;
    using M = make<N>;
    // 2^20 cells out, by a small size and by a far origin; 3/4 inside each.
    for (double sign : {-1.0, 1.0}) {
        const auto small = make_axis<N>({0x1p-16}, {1, 0, 0}, 0.25, true);
        const Cell<N> a = small.cell(M::point(16 * sign, 0, 0));
        EXPECT_EQ(a.index, sign > 0 ? 0x100000u : 0xfff00000u);
        EXPECT_EQ(value(a.inside), 0.25);
        const auto far = make_axis<N>({1, {sign * 0x1p20, 0, 0}, 1}, {1, 0, 0}, 0, true);
        const Cell<N> b = far.cell(M::point(2.75, 0, 0));
        EXPECT_EQ(b.index, sign > 0 ? 0x100002u : 0xfff00002u);
        EXPECT_EQ(value(b.inside), 0.75);
        // Cells are counted modulo 2^32.
        const auto beyond = make_axis<N>({1, {sign * 0x1p32 + 5, 0, 0}, 1}, {1, 0, 0}, 0, true);
        EXPECT_EQ(beyond.cell(M::point(2.75, 0, 0)).index, 7u);
    }
}

TYPED_TEST(LatticeTest, AgreesWithTheDivision)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(70);
    double worst = 0;
    int wrong = 0;
    for (int i = 0; i < 20000; i++) {
        const Placing at{std::exp2(random.uniform(NarrowFixed<N> ? -3 : -8, 5)), random.point(20),
                         std::ldexp(1, static_cast<int>(random.bits() % 7) - 3)};
        const Vec3 along = i % 2 == 0 ? Vec3{1, 0, 0} : random.direction();
        const auto axis = make_axis<N>(at, along, 0, true);
        const auto q = M::point(random.point(30));
        const Real p = dot(texture_point<N>(at, q), real(along));
        const double bound = place_tolerance<N>(at, static_cast<double>(length(real(q))));
        if (from_integer(p) < bound)
            continue;
        const Cell<N> c = axis.cell(q);
        wrong += c.index != static_cast<uint32_t>(static_cast<int64_t>(std::floor(p)));
        worst = std::fmax(worst, static_cast<double>(std::fabs(value(c.inside) - (p - std::floor(p)))) / bound);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(worst, 1);
}

TYPED_TEST(LatticeTest, ClampedIsBetweenZeroAndOne)
{
    using N = TypeParam;
    using M = make<N>;
    const auto axis = make_axis<N>({4}, {1, 0, 0}, 0.25, false);
    for (double x : {-60.0, -5.0, -1.0, 0.0, 1.0, 2.5, 3.0, 8.0, 60.0})
        EXPECT_EQ(value(axis.clamped(M::point(x, 1, 2))), std::fmin(1, std::fmax(0, x / 4 + 0.25))) << x;
    // A steep one, far from where it rises.
    const auto steep = make_axis<N>({0x1p-30, {5, 0, 0}, 1}, {1, 0, 0}, 0, false);
    EXPECT_EQ(value(steep.clamped(M::point(60, 0, 0))), 1);
    EXPECT_EQ(value(steep.clamped(M::point(-60, 0, 0))), 0);
}

// How far the distance of two coordinates may be off: a root of 31 bits in q32; in q16 one of 15 bits, to which both
// are cut before; two roundings of a number of that size in floating point.
template <class N>
double radial_tolerance(double a, double b)
{
    const double most = std::fmax(std::fabs(a), std::fabs(b));
    if (NarrowFixed<N>)
        return (std::sqrt(2) + 1) * most * 0x1p-14 + make<N>::unit_ulp();
    return N::is_fixed ? std::hypot(a, b) * 0x1p-30 + make<N>::unit_ulp() : 4 * make<N>::unit_ulp(most * std::sqrt(2));
}

TYPED_TEST(LatticeTest, RadialCellsAreFloorsOfTheDistance)
{
    using N = TypeParam;
    using M = make<N>;
    const auto x = make_axis<N>({}, {1, 0, 0}, 0, false), z = make_axis<N>({}, {0, 0, 1}, 0, false);
    const auto cell = [&](double a, double b, bool epsilon) {
        const auto q = M::point(a, 0, b);
        return radial_cell<N>(x.bounded(q), z.bounded(q), epsilon);
    };
    EXPECT_EQ(cell(0, 0, false).index, 0u);
    EXPECT_EQ(value(cell(0, 0, false).inside), 0);
    EXPECT_EQ(cell(2.5, 0, false).index, 2u);
    EXPECT_NEAR(value(cell(-2.5, 0, false).inside), 0.5, 4 * M::unit_ulp(2));
    EXPECT_EQ(cell(3, -4, true).index, 5u); // on a ring: epsilon decides
    EXPECT_EQ(cell(6, 8, true).index, 10u);
    EXPECT_EQ(cell(2.998, -4, true).index, 4u);
    Random random(71);
    for (int i = 0; i < 5000; i++) {
        const Vec3 p = value(M::point(random.point(30)));
        const double rho = std::hypot(p.x, p.z);
        if (from_integer(rho) < std::fmax(0.001, radial_tolerance<N>(p.x, p.z)))
            continue;
        ASSERT_EQ(cell(p.x, p.z, false).index, static_cast<uint32_t>(rho));
        ASSERT_NEAR(value(cell(p.x, p.z, false).inside), rho - std::floor(rho), radial_tolerance<N>(p.x, p.z));
    }
}

TYPED_TEST(LatticeTest, FarRingsAreRight)
{
    using N = TypeParam;
    using M = make<N>;
    const auto x = make_axis<N>({0x1p-10}, {1, 0, 0}, 0, false), z = make_axis<N>({0x1p-10}, {0, 0, 1}, 0, false);
    const auto q = M::point(24, 0, 32); // 40 lengths, 40960 cells
    EXPECT_EQ(radial_cell<N>(x.bounded(q), z.bounded(q), true).index, 40960u);
    const auto r = M::point(24, 0, 31.9375);
    const double rho = std::hypot(24, 31.9375) * 1024;
    if constexpr (NarrowFixed<N>) // whose 15 bits are four of these cells
        EXPECT_NEAR(radial_cell<N>(x.bounded(r), z.bounded(r), true).index, rho,
                    radial_tolerance<N>(24 * 1024, 32 * 1024));
    else
        EXPECT_EQ(radial_cell<N>(x.bounded(r), z.bounded(r), true).index, static_cast<uint32_t>(rho));
}

TYPED_TEST(LatticeTest, BlendIsLinear)
{
    using N = TypeParam;
    using M = make<N>;
    const auto a = M::vector(0.25, 1, 0), b = M::vector(0.75, 0, 1);
    EXPECT_EQ(value(blend<N>(a, b, M::unit(0))), value(a));
    EXPECT_EQ(value(blend<N>(a, b, M::unit(1))), value(b));
    EXPECT_EQ(value(blend<N>(a, b, M::unit(0.25))), (Vec3{0.375, 0.75, 0.25}));
}

} // namespace
