#include "../include/qray/number/root.hpp"
#include "../include/qray/number/wide.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace qray;
using i128 = __int128;
using u128 = unsigned __int128;

constexpr int32_t int_min = std::numeric_limits<int32_t>::min();
constexpr int32_t int_max = std::numeric_limits<int32_t>::max();
constexpr uint32_t uint_max = std::numeric_limits<uint32_t>::max();

// Also usable where an array has its size: in constant expressions.
static_assert(wide_mul(int32_t{-3}, int32_t{5}) == -15);
static_assert(wide_mul(uint_max, uint_max) == 0xfffffffe00000001u);
static_assert(wide_square(int_min) == uint64_t{1} << 62);
static_assert(count_leading_zeros(uint32_t{1}) == 31 && count_leading_zeros(uint64_t{1}) == 63);
static_assert(sqrt_float(9.0f) == 3.0f && sqrt_double(2.25) == 1.5);

// Every length of operand, both signs, and the ends.
std::vector<uint32_t> operands() {
    std::vector<uint32_t> values = {0, 1, 2, 0xffff, 0x10000, 0x10001, 0x7fff, 0x8000, 0x7fffffff,
                                    0x80000000, 0x80000001, 0xffff0000, 0xfffeffff, 0xffffffff};
    std::mt19937 random(1);
    for (int length = 1; length <= 32; length++) {
        for (int i = 0; i < 8; i++) {
            const uint32_t value = static_cast<uint32_t>(random()) >> (32 - length);
            values.push_back(value);
            values.push_back(0 - value);
        }
    }
    return values;
}

TEST(Base, CountsLeadingZeros) {
    EXPECT_EQ(count_leading_zeros(uint32_t{0}), 32);
    EXPECT_EQ(count_leading_zeros(uint64_t{0}), 64);
    EXPECT_EQ(detail::soft_clz(0), 32);
    std::mt19937_64 random(2);
    for (int bit = 0; bit < 64; bit++) {
        const uint64_t top = uint64_t{1} << bit;
        for (const uint64_t x : {top, top | (top - 1), top | (random() & (top - 1))}) {
            EXPECT_EQ(count_leading_zeros(x), std::countl_zero(x)) << x;
            if (bit < 32) {
                const uint32_t small = static_cast<uint32_t>(x);
                EXPECT_EQ(count_leading_zeros(small), std::countl_zero(small)) << x;
                EXPECT_EQ(detail::soft_clz(small), std::countl_zero(small)) << x;
                EXPECT_EQ(leading_zero_pairs(small), std::countl_zero(small) / 2) << x;
                EXPECT_EQ(detail::soft_zero_pairs(small), std::countl_zero(small) / 2) << x;
            }
        }
    }
}

TEST(Base, ProductsAreExact) {
    for (const uint32_t a : operands()) {
        const int32_t sa = static_cast<int32_t>(a);
        ASSERT_TRUE(u128{wide_square(sa)} == static_cast<u128>(i128{sa} * sa)) << sa;
        ASSERT_EQ(square_high(a), static_cast<uint32_t>(u128{a} * a >> 32)) << a;
        for (const uint32_t b : operands()) {
            const int32_t sb = static_cast<int32_t>(b);
            ASSERT_TRUE(i128{wide_mul(sa, sb)} == i128{sa} * sb) << sa << " * " << sb;
            ASSERT_TRUE(u128{wide_mul(a, b)} == u128{a} * b) << a << " * " << b;
            ASSERT_EQ(mul_high(a, b), static_cast<uint32_t>(u128{a} * b >> 32)) << a << " * " << b;
        }
    }
}

TEST(Base, SumsOfProductsAreExact) {
    const std::vector<uint32_t> values = operands();
    std::mt19937 random(3);
    const auto pick = [&] { return static_cast<int32_t>(values[random() % values.size()]); };
    int fitting = 0;
    for (int i = 0; i < 100000; i++) {
        const int32_t a[3] = {pick(), pick(), pick()};
        const int32_t b[3] = {pick(), pick(), pick()};
        const i128 dot = i128{a[0]} * b[0] + i128{a[1]} * b[1] + i128{a[2]} * b[2];
        if (dot >= std::numeric_limits<int64_t>::min() && dot <= std::numeric_limits<int64_t>::max()) {
            fitting++;
            ASSERT_TRUE(i128{wide_dot(a[0], a[1], a[2], b[0], b[1], b[2])} == dot);
        }
        const i128 norm2 = i128{a[0]} * a[0] + i128{a[1]} * a[1] + i128{a[2]} * a[2];
        ASSERT_TRUE(i128{wide_norm2(a[0], a[1], a[2])} == norm2);
    }
    EXPECT_GT(fitting, 50000);
    EXPECT_EQ(wide_norm2(int_min, int_min, int_min), uint64_t{3} << 62);
    // The sum fits although its first two terms do not: 2^62 + 2^62 - 2^62 + 2^31.
    EXPECT_EQ(wide_dot(int_min, int_min, int_min, int_min, int_min, int_max),
              (int64_t{1} << 62) + (int64_t{1} << 31));
}

// The only double that is nearest to sqrt(x): with x = X 4^e and root = R 2^e, where X and R are integers
// and R has 53 bits, (2R - 1)^2 < 4X < (2R + 1)^2.
bool is_nearest_root(double x, double root) {
    int exponent = 0;
    double fraction = std::frexp(x, &exponent);
    if (exponent % 2 != 0) {
        fraction /= 2;
        exponent++;
    }
    const u128 square = static_cast<u128>(std::ldexp(fraction, 53 + 2)) << (106 - 53);
    const double scaled = std::ldexp(root, 53 - exponent / 2);
    const u128 doubled = static_cast<u128>(scaled) * 2;
    return scaled == std::floor(scaled) && (doubled - 1) * (doubled - 1) < square
        && square < (doubled + 1) * (doubled + 1);
}

// As above for 24 bits of root.
bool is_nearest_root(float x, float root) {
    int exponent = 0;
    double fraction = std::frexp(static_cast<double>(x), &exponent);
    if (exponent % 2 != 0) {
        fraction /= 2;
        exponent++;
    }
    const uint64_t square = static_cast<uint64_t>(std::ldexp(fraction, 48 + 2));
    const double scaled = std::ldexp(static_cast<double>(root), 24 - exponent / 2);
    const uint64_t doubled = static_cast<uint64_t>(scaled) * 2;
    return scaled == std::floor(scaled) && (doubled - 1) * (doubled - 1) < square
        && square < (doubled + 1) * (doubled + 1);
}

float soft_root(float x) {
    return std::bit_cast<float>(detail::sqrt_bits<uint32_t, 23>(std::bit_cast<uint32_t>(x)));
}

double soft_root(double x) {
    return std::bit_cast<double>(detail::sqrt_bits<uint64_t, 52>(std::bit_cast<uint64_t>(x)));
}

TEST(Base, FloatRootsAreNearest) {
    std::mt19937 random(4);
    for (int i = 0; i < 400000; i++) {
        const float x = std::bit_cast<float>(static_cast<uint32_t>((random() & 0x7fffffff) % 0x7f800000));
        if (x == 0)
            continue;
        ASSERT_TRUE(is_nearest_root(x, sqrt_float(x))) << x;
        ASSERT_TRUE(is_nearest_root(x, soft_root(x))) << x;
    }
}

TEST(Base, DoubleRootsAreNearest) {
    std::mt19937_64 random(5);
    for (int i = 0; i < 200000; i++) {
        const double x = std::bit_cast<double>((random() & ~(uint64_t{1} << 63)) % 0x7ff0000000000000u);
        if (x == 0)
            continue;
        ASSERT_TRUE(is_nearest_root(x, sqrt_double(x))) << x;
        ASSERT_TRUE(is_nearest_root(x, soft_root(x))) << x;
    }
}

TEST(Base, HardRootsAreNearest) {
    // Neighbours of squares and of squares of midpoints, powers of two, the ends and the denormals.
    for (int exponent = -149; exponent < 128; exponent++) {
        for (const uint32_t mantissa : {0u, 1u, 2u, 0x400000u, 0x7ffffeu, 0x7fffffu, 0x200000u}) {
            const float base = std::ldexp(1.0f, exponent);
            const float x = std::bit_cast<float>(std::bit_cast<uint32_t>(base) | mantissa);
            ASSERT_TRUE(is_nearest_root(x, sqrt_float(x))) << x;
            ASSERT_TRUE(is_nearest_root(x, soft_root(x))) << x;
        }
    }
    std::mt19937 random(6);
    for (int i = 0; i < 100000; i++) {
        const double root = 1 + std::ldexp(static_cast<double>(random()), -32);
        for (const double x : {root * root, std::nextafter(root * root, 0), std::nextafter(root * root, 4),
                               4 * root * root, std::ldexp(root * root, -1060), root * root * 0x1p1000}) {
            ASSERT_TRUE(is_nearest_root(x, sqrt_double(x))) << x;
            ASSERT_TRUE(is_nearest_root(x, soft_root(x))) << x;
        }
    }
    EXPECT_EQ(soft_root(std::numeric_limits<double>::denorm_min()), 0x1p-537);
    EXPECT_EQ(soft_root(1.0 - 0x1p-53), 1.0 - 0x1p-53);
    EXPECT_EQ(soft_root(1.0f - 0x1p-24f), 1.0f - 0x1p-24f);
}

TEST(Base, RootsOfWhatHasNone) {
    const double infinity = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    errno = 0;
    for (const double x : {-0.0, 0.0, -1.0, -1e-310, -infinity, nan, -nan}) {
        const float narrow = static_cast<float>(x);
        for (const double root : {sqrt_double(x), soft_root(x)})
            EXPECT_EQ(std::bit_cast<uint64_t>(root), 0u) << x;
        for (const float root : {sqrt_float(narrow), soft_root(narrow)})
            EXPECT_EQ(std::bit_cast<uint32_t>(root), 0u) << x;
    }
    EXPECT_EQ(sqrt_double(infinity), infinity);
    EXPECT_EQ(soft_root(infinity), infinity);
    EXPECT_EQ(sqrt_float(static_cast<float>(infinity)), static_cast<float>(infinity));
    EXPECT_EQ(soft_root(static_cast<float>(infinity)), static_cast<float>(infinity));
    EXPECT_EQ(errno, 0);
}

TEST(Base, ProductsOf64BitsAreComparedExactly) {
    std::mt19937_64 random(8);
    constexpr int64_t most = std::numeric_limits<int64_t>::max(), least = std::numeric_limits<int64_t>::min();
    std::vector<int64_t> ends{
        0, 1, -1, 2, int64_t{1} << 31, int64_t{1} << 32, -(int64_t{1} << 32), (int64_t{1} << 32) - 1, most, least};
    const auto check = [](int64_t a, int64_t b, int64_t c, int64_t d) {
        const i128 first = i128{a} * b, second = i128{c} * d;
        return compare_products(a, b, c, d) == (first > second) - (first < second);
    };
    for (int64_t a : ends)
        for (int64_t b : ends)
            for (int64_t c : ends)
                for (int64_t d : ends)
                    ASSERT_TRUE(check(a, b, c, d)) << a << " " << b << " " << c << " " << d;
    for (int i = 0; i < 200000; i++) {
        const auto any = [&random] { return static_cast<int64_t>(random()) >> (random() % 64); };
        const int64_t a = any() >> 1, b = any() >> 1;
        ASSERT_TRUE(check(a, b, any(), any()));
        ASSERT_TRUE(check(a, b, a + static_cast<int64_t>(random() % 3) - 1, b)); // next to each other
        ASSERT_TRUE(check(a, b, -b, -a));
    }
}

} // namespace
