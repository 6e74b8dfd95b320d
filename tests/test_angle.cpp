// Angles in turns against atan2 and asin of __float128: error bounds, order, and where they wrap.
#include "number_helpers.hpp"

#include <qray/number/angle.hpp>

#include <quadmath.h>

namespace {

using namespace qray;
using namespace qray::test;

constexpr uint32_t quarter = uint32_t{1} << 30, half = uint32_t{1} << 31;

template <bool Narrow>
constexpr double bound = Narrow ? 0x1p-17 : 0x1p-26;
template <bool Narrow>
constexpr int bits = Narrow ? 16 : 32;

const __float128 two_pi = 8 * atanq(1);
double turns(__float128 radians) { return static_cast<double>(radians / two_pi); }
double signed_turns(uint32_t angle) { return std::ldexp(static_cast<int32_t>(angle), -32); }

template <class Width>
struct AngleTest : ::testing::Test {
    static constexpr bool is_narrow = Width::value;
};
using Widths = ::testing::Types<std::true_type, std::false_type>;
TYPED_TEST_SUITE(AngleTest, Widths);

TEST(ArcTangents, AreToTheNearest)
{
    for (int i = 0; i < 131; i++)
        EXPECT_NEAR(detail::arc_tangents.value[i], std::ldexp(turns(atanq(__float128(i) / 128)), 32), 0.51) << i;
}

// Of every size, so that quotients of every size are met, and those beside 0 and 1.
template <bool Narrow, class F>
void many_pairs(F f)
{
    Random random(301);
    for (int i = 0; i < 100'000; i++) {
        const auto some = [&random] {
            const auto all = static_cast<uint32_t>(random.bits() >> (64 - bits<Narrow>));
            return all >> (random.bits() % bits<Narrow>);
        };
        const uint32_t x = some(), y = some();
        if (x == 0 || y == 0)
            continue;
        f(y, x);
        f(x, x);
        f(x + (x + 1 != 0 && !Narrow), x);
        f(0, x);
        f(y, 0);
    }
}

TYPED_TEST(AngleTest, ArcTangentIsWithinItsBound)
{
    constexpr bool narrow = TestFixture::is_narrow;
    many_pairs<narrow>([](uint32_t y, uint32_t x) {
        const double exact = x == 0 && y == 0 ? 0 : turns(atan2q(y, x));
        ASSERT_NEAR(std::ldexp(arc_tangent<narrow>(y, x), -32), exact, bound<narrow>) << y << " / " << x;
    });
}

TYPED_TEST(AngleTest, EighthsAndQuartersAreExact)
{
    constexpr bool narrow = TestFixture::is_narrow;
    EXPECT_EQ(arc_tangent<narrow>(0, 0), 0u);
    for (uint32_t x = 1; x < 0x8000; x = 2 * x + 1) {
        EXPECT_EQ(arc_tangent<narrow>(0, x), 0u);
        EXPECT_EQ(arc_tangent<narrow>(x, x), quarter / 2);
        EXPECT_EQ(arc_tangent<narrow>(x, 0), quarter);
        const int32_t s = static_cast<int32_t>(x);
        EXPECT_EQ(arc_tangent2<narrow>(s, s), quarter / 2);
        EXPECT_EQ(arc_tangent2<narrow>(s, -s), half - quarter / 2);
        EXPECT_EQ(arc_tangent2<narrow>(-s, -s), half + quarter / 2);
        EXPECT_EQ(arc_tangent2<narrow>(-s, s), 0 - quarter / 2);
        EXPECT_EQ(arc_tangent2<narrow>(s, 0), quarter);
        EXPECT_EQ(arc_tangent2<narrow>(-s, 0), 0 - quarter);
        EXPECT_EQ(arc_tangent2<narrow>(0, s), 0u);
        EXPECT_EQ(arc_tangent2<narrow>(0, -s), half); // the seam
        EXPECT_EQ(arc_sine<narrow>(0, s, 0), static_cast<int32_t>(quarter)); // the poles
        EXPECT_EQ(arc_sine<narrow>(0, -s, 0), -static_cast<int32_t>(quarter));
        EXPECT_EQ(arc_sine<narrow>(s, 0, -s), 0);
    }
    EXPECT_EQ(arc_tangent2<narrow>(0, 0), 0u);
    EXPECT_EQ(arc_sine<narrow>(0, 0, 0), 0);
}

// Neighbours that differ by as little as they can, around all places where what is computed changes: segments, eighths.
TYPED_TEST(AngleTest, ArcTangentNeverFallsWhereTheAngleGrows)
{
    constexpr bool narrow = TestFixture::is_narrow;
    const uint32_t x = narrow ? 0xffff : 0xffffffff;
    const auto step_through = [&](uint32_t from, uint32_t steps) {
        uint32_t last = arc_tangent<narrow>(from, x);
        for (uint32_t y = from + 1; y != from + steps && y <= x && y != 0; y++) {
            const uint32_t next = arc_tangent<narrow>(y, x);
            ASSERT_LE(last, next) << y;
            last = next;
        }
    };
    if constexpr (narrow) {
        step_through(0, 0x10000);
        for (uint32_t down = 0xffff; down > 0; down--)
            ASSERT_LE(arc_tangent<narrow>(0xffff, down), arc_tangent<narrow>(0xffff, down - 1)) << down;
    } else {
        Random random(302);
        for (uint32_t segment = 0; segment <= 64; segment++) {
            const uint32_t at = segment << 26;
            step_through(at < 1000 ? 0 : at - 1000, 2000);
            step_through(at + static_cast<uint32_t>(random.bits() >> 38), 20'000);
        }
        step_through(0xffffffff - 2000, 2000);
        for (uint32_t down = 0xffffffff; down > 0xffffffff - 2000; down--)
            ASSERT_LE(arc_tangent<narrow>(0xffffffff, down), arc_tangent<narrow>(0xffffffff, down - 1)) << down;
    }
}

// Of pairs in the order of their quotients.
TYPED_TEST(AngleTest, RandomPairsKeepTheirOrder)
{
    constexpr bool narrow = TestFixture::is_narrow;
    uint32_t last_y = 0, last_x = 1;
    many_pairs<narrow>([&](uint32_t y, uint32_t x) {
        const uint64_t here = uint64_t{y} * last_x, there = uint64_t{last_y} * x;
        const uint32_t a = arc_tangent<narrow>(y, x), b = arc_tangent<narrow>(last_y, last_x);
        ASSERT_TRUE(here < there || a >= b) << y << " / " << x;
        ASSERT_TRUE(here > there || a <= b) << y << " / " << x;
        last_y = y;
        last_x = x;
    });
}

// Once around: it grows by one turn, and only at the seam from the greatest to the least.
TYPED_TEST(AngleTest, ArcTangent2GoesAroundOnce)
{
    constexpr bool narrow = TestFixture::is_narrow;
    const double r = narrow ? 0x7fff : 0x7fffffff;
    uint32_t last = half, sum = 0;
    for (int i = 0; i <= 20'000; i++) {
        const double a = (i / 10'000.0 - 1) * M_PI;
        const int32_t y = static_cast<int32_t>(std::lrint(r * std::sin(a)));
        const int32_t x = static_cast<int32_t>(std::lrint(r * std::cos(a)));
        const uint32_t angle = arc_tangent2<narrow>(y, x);
        const double exact = turns(atan2q(y, x));
        ASSERT_NEAR(std::remainder(signed_turns(angle) - exact, 1), 0, bound<narrow>);
        ASSERT_LT(angle - last, half / 100); // forward, and not far
        sum += angle - last;
        last = angle;
    }
    EXPECT_EQ(sum, 0u); // one whole turn
}

TYPED_TEST(AngleTest, ArcSineIsWithinItsBoundAndNeverFallsTowardsAPole)
{
    constexpr bool narrow = TestFixture::is_narrow;
    Random random(303);
    const double r = narrow ? 0x7fff : 0x3fffffff;
    for (int i = 0; i < 20'000; i++) {
        const Vec3 d = random.direction() * (r * std::exp2(-random.uniform(0, narrow ? 6 : 20)));
        const int32_t x = static_cast<int32_t>(d.x), y = static_cast<int32_t>(d.y), z = static_cast<int32_t>(d.z);
        const double most = std::fmax(std::abs(x), std::fmax(std::abs(y), std::abs(z)));
        if (most < 1)
            continue;
        const __float128 across = sqrtq(__float128(x) * x + __float128(z) * z);
        ASSERT_NEAR(std::ldexp(arc_sine<narrow>(x, y, z), -32), turns(atan2q(y, across)), bound<narrow> + 0.125 / most);
    }
    // Along a meridian of a ball, by the smallest steps, through both poles.
    int32_t last = -static_cast<int32_t>(quarter);
    const int32_t radius = narrow ? 0x7fff : 0x3fffffff, step = narrow ? 1 : 0x8001;
    for (int32_t y = -radius; y < radius - step; y += step) {
        const int32_t x = static_cast<int32_t>(sqrtq(__float128(radius) * radius - __float128(y) * y));
        const int32_t angle = arc_sine<narrow>(x, y, 0);
        ASSERT_GE(angle, last) << y;
        last = angle;
    }
    EXPECT_EQ(arc_sine<narrow>(0, radius, 0), static_cast<int32_t>(quarter));
}

} // namespace
