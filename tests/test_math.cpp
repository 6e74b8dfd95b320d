#include "../include/qray/number/math.hpp"
#include "../include/qray/number/power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace qray;
using i128 = __int128;
using u128 = unsigned __int128;

constexpr uint32_t uint_max = std::numeric_limits<uint32_t>::max();
constexpr uint32_t one = uint32_t{1} << 30;

static_assert(isqrt(uint64_t{17}) == 4 && isqrt(uint32_t{21}) == 5 && isqrt(~uint64_t{0}) == uint_max);
static_assert(divide(7, 2, 0) == 4 && divide(1, 3, 31) == 715827883);
static_assert(pow_unit(one / 4, {1, uint32_t{1} << 31}) == one / 8);

// Uniform in the number of bits.
uint64_t any_length(std::mt19937_64& random) {
    const int bits = static_cast<int>(random() % 65);
    return bits == 0 ? 0 : random() >> (64 - bits);
}

// sqrt(x) rounds to root exactly if root^2 - root < x <= root^2 + root, in integers.
void expect_nearest_root(uint64_t x, uint32_t root) {
    const u128 r = root;
    ASSERT_TRUE(root == 0 ? x == 0 : r * r - r < x) << "sqrt " << x << " is less than " << root;
    ASSERT_TRUE(root == uint_max || x <= r * r + r) << "sqrt " << x << " is more than " << root;
}
// As this machine does it, and as machines without a square root do.
void expect_nearest_roots(uint64_t x) {
    expect_nearest_root(x, isqrt(x));
    if (x >> 63 == 0)
        expect_nearest_root(x, isqrt(static_cast<int64_t>(x)));
    expect_nearest_root(x, detail::isqrt_by_rsqrt(x));
}

TEST(Math, RootOf64BitsIsNearest) {
    std::mt19937_64 random(1);
    for (uint64_t x = 0; x < 100000; x++)
        expect_nearest_roots(x);
    for (int i = 0; i < 200000; i++) {
        const uint64_t root = any_length(random) & uint_max;
        for (const uint64_t x : {root * root - 1, root * root, root * root + 1, root * root + root - 1,
                                 root * root + root, root * root + root + 1, root * root + 2 * root})
            expect_nearest_roots(x);
        expect_nearest_roots(any_length(random));
    }
}

TEST(Math, RootOf64BitsAtPowersOfTwoAndAtTheEnd) {
    for (int bit = 0; bit < 64; bit++) {
        const uint64_t power = uint64_t{1} << bit;
        for (uint64_t off = 0; off < 300; off++) {
            expect_nearest_roots(power + off);
            expect_nearest_roots(power - off);
        }
    }
    EXPECT_EQ(isqrt(uint64_t{0}), 0u);
    EXPECT_EQ(isqrt(~uint64_t{0}), uint_max);
    EXPECT_EQ(isqrt(uint64_t{uint_max} * uint_max + uint_max), uint_max);
    EXPECT_EQ(isqrt(uint64_t{uint_max} * uint_max - uint_max), uint_max - 1);
}

TEST(Math, RootOf32BitsIsNearest) {
    for (uint64_t root = 0; root <= 0xffff; root++) {
        for (const uint64_t x : {root * root - 1, root * root, root * root + root, root * root + root + 1})
            expect_nearest_root(x & uint_max, isqrt(static_cast<uint32_t>(x)));
    }
    std::mt19937_64 random(2);
    for (int i = 0; i < 1000000; i++) {
        const uint32_t x = static_cast<uint32_t>(any_length(random));
        expect_nearest_root(x, isqrt(x));
    }
    EXPECT_EQ(isqrt(uint_max), 0x10000u);
    EXPECT_EQ(isqrt(uint32_t{0}), 0u);
}

// 1 / sqrt(x), of which the tracer's roots are made; x = 0 is taken for 1.
struct InverseRoot { // mantissa * 2^exponent
    uint32_t mantissa;
    int exponent;
};
InverseRoot rsqrt(uint64_t x) {
    const detail::Normal v = detail::normalise_even(x);
    return {detail::rsqrt_mantissa(v.high, v.low), v.half - 63};
}

void expect_inverse_root(uint64_t x) {
    const InverseRoot r = rsqrt(x);
    ASSERT_GE(r.mantissa, 0x80000000u) << x;
    const long double error = std::ldexp(static_cast<long double>(r.mantissa), r.exponent)
            * std::sqrt(static_cast<long double>(x)) - 1;
    ASSERT_LE(std::fabs(error), std::exp2(-31.7L)) << x;
    // And of 64 bits at once.
    const uint64_t v = x << (2 * (count_leading_zeros(x) / 2));
    ASSERT_EQ(detail::rsqrt_mantissa(v), r.mantissa) << x;
}

TEST(Math, InverseRootIsWithinItsBound) {
    std::mt19937_64 random(3);
    for (uint64_t x = 1; x < 100000; x++)
        expect_inverse_root(x);
    for (int i = 0; i < 1000000; i++) {
        expect_inverse_root(any_length(random) | 1);
        expect_inverse_root(random() | uint64_t{1} << 62);
    }
    // The ends of each interval of the table, odd and even powers, and the largest x.
    for (uint64_t segment = 16; segment < 64; segment++) {
        for (int bit = 0; bit <= 58; bit++) {
            const uint64_t x = segment << bit;
            for (uint64_t off = 0; off < 4; off++) {
                expect_inverse_root(x + off);
                expect_inverse_root(x - 1 - off);
            }
        }
    }
    expect_inverse_root(~uint64_t{0});
}

TEST(Math, InverseRootOfZeroIsThatOfOne) {
    EXPECT_EQ(rsqrt(0).mantissa, uint_max);
    EXPECT_EQ(rsqrt(0).exponent, -32);
    EXPECT_EQ(rsqrt(1).mantissa, uint_max);
    EXPECT_EQ(rsqrt(1).exponent, -32);
}

void expect_unit_vector(int32_t x, int32_t y, int32_t z) {
    int32_t u[3] = {};
    ASSERT_TRUE(unit_vector(x, y, z, u));
    const long double lx = x, ly = y, lz = z;
    const long double scale = one / std::sqrt(lx * lx + ly * ly + lz * lz);
    ASSERT_LE(std::fabs(u[0] - lx * scale), 0.81L) << x << ' ' << y << ' ' << z;
    ASSERT_LE(std::fabs(u[1] - ly * scale), 0.81L) << x << ' ' << y << ' ' << z;
    ASSERT_LE(std::fabs(u[2] - lz * scale), 0.81L) << x << ' ' << y << ' ' << z;
}

TEST(Math, UnitVectorIsWithinItsBound) {
    std::mt19937_64 random(9);
    const int32_t most = std::numeric_limits<int32_t>::max();
    const int32_t least = std::numeric_limits<int32_t>::min();
    const std::vector<int32_t> ends = {0, 1, -1, 2, -2, 3, -4, most, -most, least, 1 << 30, -(1 << 30)};
    for (const int32_t x : ends) {
        for (const int32_t y : ends) {
            for (const int32_t z : ends) {
                if (x != 0 || y != 0 || z != 0)
                    expect_unit_vector(x, y, z);
            }
        }
    }
    for (int i = 0; i < 300000; i++) {
        const auto pick = [&] { return static_cast<int32_t>(random()) >> (random() % 32); };
        expect_unit_vector(pick(), pick(), pick() | 1);
    }
}

TEST(Math, UnitVectorsAlongTheAxesAreExact) {
    for (int32_t length : {1, 2, 3, 12345, 1 << 24, 1 << 30, std::numeric_limits<int32_t>::max()}) {
        int32_t u[3] = {};
        ASSERT_TRUE(unit_vector(length, 0, 0, u));
        EXPECT_EQ(u[0], static_cast<int32_t>(one)) << length;
        EXPECT_EQ(u[1], 0);
        ASSERT_TRUE(unit_vector(0, 0, -length, u));
        EXPECT_EQ(u[2], -static_cast<int32_t>(one)) << length;
        EXPECT_EQ(u[0], 0);
    }
    int32_t untouched[3] = {1, 2, 3};
    EXPECT_FALSE(unit_vector(0, 0, 0, untouched));
    EXPECT_EQ(untouched[0] + untouched[1] + untouched[2], 6);
}

// |mantissa - 2^63 / d| <= 1, in integers; d is x with its highest bit set.
void expect_reciprocal(uint32_t x) {
    const uint32_t d = x << std::countl_zero(x), mantissa = detail::reciprocal_mantissa(d);
    ASSERT_GE(mantissa, 0x80000000u) << x;
    const i128 excess = i128{mantissa} * d - (i128{1} << 63);
    ASSERT_TRUE(excess <= i128{d} && -excess <= i128{d}) << x;
}

TEST(Math, ReciprocalIsWithinOneUnit) {
    std::mt19937_64 random(4);
    for (uint32_t x = 1; x < 100000; x++) {
        expect_reciprocal(x);
        expect_reciprocal(0 - x);
    }
    for (int bit = 0; bit < 32; bit++) {
        for (uint32_t off = 0; off < 200; off++) {
            expect_reciprocal((uint32_t{1} << bit) + off);
            expect_reciprocal(((uint32_t{1} << bit) - off) | 1);
        }
    }
    for (int i = 0; i < 1000000; i++)
        expect_reciprocal(static_cast<uint32_t>(any_length(random)) | 1);
}

int32_t nearest_quotient(int64_t num, uint32_t den, int shift) {
    const int32_t limit = std::numeric_limits<int32_t>::max();
    if (den == 0)
        return num < 0 ? -limit : limit;
    const u128 n = (num < 0 ? -static_cast<u128>(num) : static_cast<u128>(num)) << shift;
    const u128 q = (2 * n + den) / (u128{2} * den);
    const int32_t magnitude = q > static_cast<u128>(limit) ? limit : static_cast<int32_t>(q);
    return num < 0 ? -magnitude : magnitude;
}

// As 32-bit machines do it.
int32_t divide_without_division(int64_t num, uint32_t den, int shift) {
    const uint64_t n = num < 0 ? 0 - static_cast<uint64_t>(num) : static_cast<uint64_t>(num);
    const int32_t magnitude = static_cast<int32_t>(detail::divide_by_reciprocal(n, den, shift));
    return num < 0 ? -magnitude : magnitude;
}

#define ASSERT_QUOTIENT(num, den, shift) \
    ASSERT_EQ(divide(num, den, shift), nearest_quotient(num, den, shift)) \
        << (num) << " * 2^" << (shift) << " / " << (den); \
    ASSERT_EQ(divide_without_division(num, den, shift), nearest_quotient(num, den, shift)) \
        << (num) << " * 2^" << (shift) << " / " << (den)

TEST(Math, QuotientIsNearest) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 1000000; i++) {
        const uint32_t den = static_cast<uint32_t>(any_length(random));
        const int shift = static_cast<int>(random() % 33);
        const int64_t num = static_cast<int64_t>(any_length(random));
        ASSERT_QUOTIENT(num, den, shift);
        ASSERT_QUOTIENT(-(num & std::numeric_limits<int64_t>::max()), den, shift);
        // A quotient that fits, next to an integer or to a half.
        const i128 target = i128{2} * static_cast<int32_t>(random() >> (random() % 31 + 32)) + (i & 1);
        const int64_t near = static_cast<int64_t>((target * den / 2) >> shift);
        for (int64_t off = -2; off <= 2; off++) {
            ASSERT_QUOTIENT(near + off, den, shift);
        }
    }
}

TEST(Math, QuotientSaturates) {
    const int32_t limit = std::numeric_limits<int32_t>::max();
    const int64_t most = std::numeric_limits<int64_t>::max();
    const int64_t least = std::numeric_limits<int64_t>::min();
    for (int shift = 0; shift <= 32; shift++) {
        EXPECT_EQ(divide(1, 0, shift), limit);
        EXPECT_EQ(divide(0, 0, shift), limit);
        EXPECT_EQ(divide(-1, 0, shift), -limit);
        EXPECT_EQ(divide(0, 1, shift), 0);
        for (const uint32_t den : {1u, 2u, 3u, 0x7fffffffu, 0x80000000u, uint_max}) {
            EXPECT_EQ(divide(most, den, shift), limit);
            EXPECT_EQ(divide(least, den, shift), -limit);
            // Around the largest quotient that fits.
            const i128 edge = (i128{limit} * den) >> shift;
            for (int64_t off = -3; off <= 3; off++) {
                ASSERT_QUOTIENT(static_cast<int64_t>(edge) + off, den, shift);
                ASSERT_QUOTIENT(-static_cast<int64_t>(edge) + off, den, shift);
            }
        }
    }
}

TEST(Math, QuotientRoundsHalvesAwayFromZero) {
    EXPECT_EQ(divide(1, 2, 0), 1);
    EXPECT_EQ(divide(-1, 2, 0), -1);
    EXPECT_EQ(divide(3, 2, 0), 2);
    EXPECT_EQ(divide(5, 10, 0), 1);
    EXPECT_EQ(divide(4, 9, 0), 0);
    EXPECT_EQ(divide(uint_max / 2, uint_max, 0), 0);
    EXPECT_EQ(divide(uint_max / 2 + 1, uint_max, 0), 1);
}

// x^n for x as Q2.30, with relative error n 2^-112.
__float128 exact_power(uint32_t x, uint32_t n) {
    __float128 base = static_cast<__float128>(x) / one;
    __float128 power = 1;
    for (; n != 0; n >>= 1) {
        if (n & 1)
            power *= base;
        base *= base;
    }
    return power;
}

double error_of_whole(uint32_t x, uint32_t n) {
    return std::fabs(static_cast<double>(static_cast<__float128>(pow_whole(x, n)) / one - exact_power(x, n)));
}

// A base whose n-th power is neither near 0 nor near 1.
uint32_t interesting_base(std::mt19937_64& random, uint32_t n) {
    const double depth = static_cast<double>(random() % 16384) / 1024;
    return static_cast<uint32_t>(std::exp(-depth / n) * one);
}

TEST(Math, WholePowersAreWithinTheirBound) {
    std::mt19937_64 random(6);
    for (int i = 0; i < 300000; i++) {
        const uint32_t n = static_cast<uint32_t>(any_length(random) % 1000001);
        ASSERT_LE(error_of_whole(interesting_base(random, n + 1), n), 0x1p-29) << n;
        ASSERT_LE(error_of_whole(static_cast<uint32_t>(random() % one), n), 0x1p-29) << n;
        ASSERT_LE(error_of_whole(one - static_cast<uint32_t>(random() % 4096), n), 0x1p-29) << n;
    }
    // Many factors: all bits of n set.
    for (uint32_t n = 1; n <= 0xfffff; n = 2 * n + 1) {
        for (uint32_t i = 0; i < 3000; i++)
            ASSERT_LE(error_of_whole(interesting_base(random, n), n), 0x1p-29) << n;
    }
}

TEST(Math, WholePowersInClosedForm) {
    for (const uint32_t x : {0u, 1u, 12345678u, one - 1, one})
        EXPECT_EQ(pow_whole(x, 0), one) << x;
    for (const uint32_t n : {1u, 2u, 7u, 1000000u}) {
        EXPECT_EQ(pow_whole(0, n), 0u) << n;
        EXPECT_EQ(pow_whole(one, n), one) << n;
    }
    for (uint32_t n = 1; n <= 30; n++)
        EXPECT_EQ(pow_whole(one / 2, n), one >> n) << n;
    for (uint32_t n = 32; n <= 1000000; n = n * 3 / 2)
        EXPECT_EQ(pow_whole(one / 2, n), 0u) << n;
    for (uint32_t x = 1; x < one; x = x * 3 / 2 + 1)
        EXPECT_EQ(pow_whole(x, 1), x) << x;
    // (1 - 2^-16)^10000 = exp(10000 ln(1 - 2^-16)) = 0.8584820254...
    EXPECT_NEAR(pow_whole(one - (one >> 16), 10000), std::exp(10000 * std::log1p(-0x1p-16)) * one, 4);
}

double error_of_fraction(uint32_t x, uint32_t fraction) {
    const long double exact = std::pow(static_cast<long double>(x) / one, std::ldexp(1.0L * fraction, -32));
    return static_cast<double>(std::fabs(static_cast<long double>(pow_fraction(x, fraction)) / one - exact));
}

TEST(Math, FractionalPowersAreWithinTheirBound) {
    std::mt19937_64 random(7);
    for (int i = 0; i < 300000; i++) {
        const uint32_t fraction = static_cast<uint32_t>(random() >> (random() % 32 + 32));
        ASSERT_LE(error_of_fraction(static_cast<uint32_t>(random() % one), fraction), 0x1p-29) << fraction;
        ASSERT_LE(error_of_fraction(one >> (random() % 31), fraction), 0x1p-29) << fraction;
        const uint32_t gap = static_cast<uint32_t>(any_length(random) % one);
        ASSERT_LE(error_of_fraction(one - gap, uint_max - fraction), 0x1p-29) << gap;
    }
    for (const uint32_t x : {1u, 2u, 3u, one / 2 - 1, one / 2, one / 2 + 1, one - 2, one - 1}) {
        for (const uint32_t fraction : {1u, 2u, 0x80000000u, 0x55555555u, uint_max - 1, uint_max})
            ASSERT_LE(error_of_fraction(x, fraction), 0x1p-29) << x << ' ' << fraction;
    }
}

TEST(Math, FractionalPowersInClosedForm) {
    for (const uint32_t x : {0u, 1u, 12345678u, one - 1, one})
        EXPECT_EQ(pow_fraction(x, 0), one) << x;
    EXPECT_EQ(pow_fraction(0, 1), 0u);
    EXPECT_EQ(pow_fraction(one, uint_max), one);
    // 4^-k to the power 1/2 is 2^-k.
    for (int k = 0; k <= 15; k++)
        EXPECT_EQ(pow_fraction(one >> (2 * k), 0x80000000u), one >> k) << k;
}

TEST(Math, PowersJoinBothParts) {
    std::mt19937_64 random(8);
    for (int i = 0; i < 200000; i++) {
        const Exponent e = {static_cast<uint32_t>(any_length(random) % 1000),
                            static_cast<uint32_t>(random())};
        const uint32_t x = interesting_base(random, e.whole + 1);
        const long double exact =
            std::pow(static_cast<long double>(x) / one, e.whole + std::ldexp(1.0L * e.fraction, -32));
        ASSERT_NEAR(static_cast<double>(pow_unit(x, e)), static_cast<double>(exact * one), 4) << e.whole;
    }
    EXPECT_EQ(pow_unit(0, {0, 0}), one);
    EXPECT_EQ(pow_unit(0, {0, 1}), 0u);
    EXPECT_EQ(pow_unit(one, {1000000, uint_max}), one);
    EXPECT_EQ(pow_unit(12345678, {1, 0}), 12345678u);
}

} // namespace
