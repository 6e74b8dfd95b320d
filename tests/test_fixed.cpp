#include <qray/number/fixed.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using test::Random;

constexpr int32_t extremes[] = {INT32_MIN, INT32_MIN + 1, -0x40000000, -65537,   -1, 0, 1,
                                3,         65536,         0x3fffffff,  INT32_MAX};

TEST(Fixed, AddsSubtractsAndNegatesRawValues)
{
    using F = Fixed<24>;
    constexpr F a{3 << 24}, b{-(1 << 23)};
    static_assert((a + b).raw == 5 << 23);
    static_assert((a - b).raw == 7 << 23);
    static_assert((-b).raw == 1 << 23);
    F sum = a;
    sum += b;
    EXPECT_EQ(sum.raw, 5 << 23);
}

TEST(Fixed, OrdersAsItsRawValuesDo)
{
    using F = Fixed<30>;
    for (int32_t a : extremes)
        for (int32_t b : extremes) {
            EXPECT_EQ(F{a} == F{b}, a == b);
            EXPECT_EQ(F{a} != F{b}, a != b);
            EXPECT_EQ(F{a} < F{b}, a < b);
            EXPECT_EQ(F{a} > F{b}, a > b);
            EXPECT_EQ(F{a} <= F{b}, a <= b);
            EXPECT_EQ(F{a} >= F{b}, a >= b);
        }
}

TEST(Fixed, ProductsAreExactAndAddTheirFractions)
{
    static_assert(decltype(Fixed<24>{1} * Fixed<30>{1})::frac == 54);
    static_assert(decltype(Fixed<8, 16>{1} * Fixed<14, 16>{1})::frac == 22);
    for (int32_t a : extremes)
        for (int32_t b : extremes)
            EXPECT_TRUE((Fixed<24>{a} * Fixed<30>{b}).raw == static_cast<__int128>(a) * b) << a << " * " << b;
    Random random(1);
    for (int i = 0; i < 20000; i++) {
        const auto a = static_cast<int32_t>(random.bits()), b = static_cast<int32_t>(random.bits());
        ASSERT_TRUE((Fixed<24>{a} * Fixed<24>{b}).raw == static_cast<__int128>(a) * b) << a << " * " << b;
    }
}

TEST(Fixed, SixteenBitProductsFitThirtyTwoBits)
{
    for (int32_t a : {-32768, -32767, -1, 0, 1, 255, 32767})
        for (int32_t b : {-32768, -32767, -1, 0, 1, 255, 32767}) {
            const auto p = Fixed<8, 16>{a} * Fixed<14, 16>{b};
            static_assert(sizeof p == 4);
            EXPECT_EQ(p.raw, static_cast<int64_t>(a) * b);
        }
}

TEST(Wide, AddsSubtractsNegatesAndOrders)
{
    using W = Wide<48>;
    constexpr W a{int64_t{5} << 40}, b{-(int64_t{1} << 61)};
    static_assert((a + b).raw == (int64_t{5} << 40) - (int64_t{1} << 61));
    static_assert((a - b).raw == (int64_t{5} << 40) + (int64_t{1} << 61));
    static_assert((-b).raw == int64_t{1} << 61);
    EXPECT_TRUE(b < a && a > b && b <= a && a >= b && a <= a && a >= a && a == a);
    EXPECT_FALSE(a < b || b > a || a <= b || b >= a || a == b || a < a || a > a);
}

// Quarters to halves, and halves to wholes.
TEST(RoundTo, NearestWithTiesUpward)
{
    const int64_t raw[] = {-7, -6, -5, -4, -3, -2, -1, 0, 1, 2, 3, 4, 5, 6, 7};
    const int32_t halves[] = {-3, -3, -2, -2, -1, -1, 0, 0, 1, 1, 2, 2, 3, 3, 4};
    const int32_t wholes[] = {-2, -1, -1, -1, -1, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2};
    for (int i = 0; i < 15; i++) {
        EXPECT_EQ(round_to<Fixed<1>>(Wide<2>{raw[i]}).raw, halves[i]) << raw[i] << " quarters";
        EXPECT_EQ(round_to<Fixed<0>>(Wide<2>{raw[i]}).raw, wholes[i]) << raw[i] << " quarters";
    }
}

template <class To, int Frac>
void expect_nearest(int64_t raw)
{
    constexpr int shift = Frac - To::frac;
    // 2 |result 2^shift - raw| <= 2^shift, and on a tie the result is the upper one.
    const __int128 off = 2 * ((static_cast<__int128>(round_to<To>(Wide<Frac>{raw}).raw) << shift) - raw);
    const __int128 whole = static_cast<__int128>(1) << shift;
    ASSERT_TRUE(off <= whole && off > -whole) << raw;
}

TEST(RoundTo, IsNearestForEveryPairOfFormats)
{
    Random random(2);
    for (int i = 0; i < 20000; i++) {
        const auto bits = static_cast<int64_t>(random.bits());
        expect_nearest<Fixed<24>, 54>(bits >> 4); // a Moment to a Length: |w| < 2^59
        expect_nearest<Fixed<30>, 60>(bits >> 3);
        expect_nearest<Fixed<28>, 58>(bits >> 3);
        expect_nearest<Fixed<24>, 48>(bits >> 9);
    }
    expect_nearest<Fixed<24>, 48>((int64_t{INT32_MAX} << 24) + (1 << 23) - 1);
    expect_nearest<Fixed<24>, 48>(-(int64_t{1} << 55));
}

TEST(Saturating, SumsAndDifferencesStopAtTheRange)
{
    const auto clamped = [](int64_t v) { return v > INT32_MAX ? INT32_MAX : v < INT32_MIN ? -INT32_MAX : v; };
    for (int32_t a : extremes)
        for (int32_t b : extremes) {
            EXPECT_EQ(saturating_add(a, b), clamped(int64_t{a} + b)) << a << " + " << b;
            EXPECT_EQ(saturating_sub(a, b), clamped(int64_t{a} - b)) << a << " - " << b;
        }
    static_assert(saturating_add(INT32_MAX, 1) == INT32_MAX);
    static_assert(saturating_sub(INT32_MIN, 1) < -0x7ffffffe);
}

} // namespace
