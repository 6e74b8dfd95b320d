#include <qray/number/floating.hpp>
#include <qray/number/q16.hpp>
#include <qray/number/q24.hpp>
#include <qray/number/q32.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct NumberTest : ::testing::Test {};
TYPED_TEST_SUITE(NumberTest, NumberSystems, SystemNames);

TYPED_TEST(NumberTest, ConstantsStandForTheirNumbers)
{
    using N = TypeParam;
    EXPECT_EQ(value(N::one), 1);
    EXPECT_EQ(value(N::zero), 0);
    EXPECT_EQ(value(N::black), 0);
    EXPECT_EQ(value(N::length_zero), 0);
    EXPECT_TRUE(N::ulp > N::length_zero);
    // The tracer's distances: 2^7 in fixed point, the whole range in floating point; in q16 and q24 twice the world,
    // and t d fits 32 bits even for a d that is longer than 1 by 2^-11, with what rounding it adds.
    if constexpr (NarrowFixed<N>) {
        EXPECT_GT(value(N::length_max), 2 * 62.5);
        EXPECT_LE((int64_t{N::length_max.raw} * (N::one.raw + (N::one.raw >> 11)) >> N::dropped) + N::one.raw / 2,
                  INT32_MAX);
    } else if constexpr (N::is_fixed)
        EXPECT_EQ(N::length_max.raw, INT32_MAX);
    else
        EXPECT_GT(value(N::length_max), 1e38);
}

TYPED_TEST(NumberTest, ProductsAndSumsKeepTheirUnits)
{
    using N = TypeParam;
    using M = make<N>;
    const auto l = M::length(3.5), m = M::length(-2);
    const auto u = M::unit(0.25), v = M::unit(-0.75);
    const auto c = M::colour(1.5);
    EXPECT_EQ(value(l * m), -7);
    EXPECT_EQ(value(N::length(l * u + m * v)), 2.375);
    EXPECT_EQ(value(N::unit(u * v)), -0.1875);
    EXPECT_EQ(value(N::colour(c * u)), 0.375);
    EXPECT_EQ(value(N::dot(l, m, l, u, v, u)), 3.25);
    EXPECT_EQ(value(N::norm2(l, m, l)), 28.5);
}

TYPED_TEST(NumberTest, SquareRootsAreNearest)
{
    using N = TypeParam;
    using M = make<N>;
    // q24 squares no more than 5.65, and has their roots in eighths of its squares' steps.
    const double reach = is_split<N> ? 3.5 : 7;
    for (double root : {0.0, 0.25, 0.5, 1.0, 1.5, 3.0, is_split<N> ? 5.5 : 6.5, is_split<N> ? 5.625 : 11.0}) {
        EXPECT_EQ(value(N::sqrt(M::length(root) * M::length(root))), root);
        if (root <= 1) {
            EXPECT_EQ(value(N::sqrt_unit(M::unit(root) * M::unit(root))), root);
        }
    }
    Random random(10);
    double worst = 0, worst_unit = 0;
    for (int i = 0; i < 20000; i++) {
        const auto a = M::length(random.uniform(0, reach));
        const auto b = M::length(std::exp2(random.uniform(-20, is_split<N> ? 2 : 3)));
        const auto area = a * a + b * b;
        const double root = std::sqrt(value(area));
        worst = std::fmax(worst, std::fabs(value(N::sqrt(area)) - root) / M::length_ulp(root));
        const auto x = M::unit(random.uniform(0, 0.7)), y = M::unit(std::exp2(random.uniform(-20, -1)));
        const auto square = x * x + y * y;
        const double cosine = std::sqrt(value(square));
        worst_unit = std::fmax(worst_unit, std::fabs(value(N::sqrt_unit(square)) - cosine) / M::unit_ulp(cosine));
    }
    EXPECT_LE(worst, (is_split<N> ? 1 : 0.5) + 1e-6); // the expected value is itself a rounded double
    EXPECT_LE(worst_unit, 0.5 + 1e-6);
}

// t = 2^k num / den with num a Moment and den a Cosine, as a plane has them.
// How far a quotient may be off: 2 ulp; in q16, of which it knows 14 bits, 2^-14 of itself and half an ulp.
template <class N>
double quotient_tolerance(double exact)
{
    return ShortFixed<N> ? std::fabs(exact) * 0x1p-14 + make<N>::length_ulp() / 2 : 2 * make<N>::length_ulp(exact);
}

TYPED_TEST(NumberTest, QuotientIsWithinItsBound)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(11);
    double worst = 0;
    int fitted = 0;
    for (int i = 0; i < 50000; i++) {
        const auto num = M::length(random.uniform(-60, 60)) * M::unit(random.uniform(-1, 1));
        auto den = M::unit(random.uniform(-1, 1)) * M::unit(std::exp2(random.uniform(-10, 0)));
        const double exact = value(num) / value(den);
        typename N::Length t{};
        if (!(std::fabs(exact) < 127) || (!N::is_fixed && value(den) == 0))
            continue;
        ASSERT_TRUE(N::quotient(num, den, 0, t)) << exact;
        fitted++;
        worst = std::fmax(worst, std::fabs(value(t) - exact) / quotient_tolerance<N>(exact));
    }
    EXPECT_GT(fitted, 10000);
    EXPECT_LE(worst, 1);
}

// A cone's roots: Moments over Cosines and Areas over Moments, and k bits that block scaling took.
TYPED_TEST(NumberTest, QuotientTakesPowersOfTwo)
{
    using N = TypeParam;
    using M = make<N>;
    if constexpr (N::is_fixed) {
        Random random(12);
        double worst = 0;
        for (int i = 0; i < 50000; i++) {
            const int k = static_cast<int>(random.bits() % (N::most_headroom + 1));
            const double exact = random.uniform(-60, 60) / (is_split<N> ? 2 : 1);
            const auto den = M::length(random.uniform(0.5, 8)) * M::unit(random.uniform(0.1, 1));
            const auto num = make<N>::template number<typename N::Length>(exact) * M::length(1);
            // Shrink the numerator by 2^k, as the block scale did.
            const typename N::Area small{static_cast<typename N::Area::Rep>(num.raw >> k)};
            typename N::Length t{};
            const double expected = std::ldexp(value(small), k) / value(den);
            if (std::fabs(expected) > 127)
                continue;
            ASSERT_TRUE(N::quotient(small, den, k, t)) << expected << " " << k;
            worst = std::fmax(worst, std::fabs(value(t) - expected) / quotient_tolerance<N>(expected));
        }
        EXPECT_LE(worst, 1);
    }
}

TYPED_TEST(NumberTest, QuotientRefusesWhatDoesNotFit)
{
    using N = TypeParam;
    using M = make<N>;
    typename N::Length t{};
    const auto num = M::length(8) * M::unit(1);
    EXPECT_FALSE(N::quotient(num, M::unit(0) * M::unit(1), 0, t));
    EXPECT_FALSE(N::quotient(-num, M::unit(0) * M::unit(1), 0, t));
    if constexpr (N::is_fixed) {
        using Moment = typename N::Moment;
        using Cosine = typename N::Cosine;
        constexpr auto most = std::numeric_limits<typename Moment::Rep>::max();
        for (Cosine den : {Cosine{1}, Cosine{-1}, Cosine{3}, Cosine{-5}}) {
            EXPECT_FALSE(N::quotient(num, den, 0, t));
            EXPECT_FALSE(N::quotient(-num, den, 0, t));
            EXPECT_FALSE(N::quotient(Moment{most}, den, 30, t));
            EXPECT_FALSE(N::quotient(Moment{-most - 1}, den, 30, t));
        }
        // 128 does not fit, 127 does.
        EXPECT_FALSE(N::quotient(M::length(64) * M::unit(1), M::unit(0.5) * M::unit(1), 0, t));
        EXPECT_FALSE(N::quotient(M::length(64) * M::unit(-1), M::unit(0.5) * M::unit(1), 0, t));
        ASSERT_TRUE(N::quotient(M::length(63.5) * M::unit(1), M::unit(0.5) * M::unit(1), 0, t));
        EXPECT_NEAR(value(t), 127, 2 * M::length_ulp());
    }
}

TYPED_TEST(NumberTest, RatioIsAQuotientOfLengths)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(13);
    double worst = 0;
    for (int i = 0; i < 20000; i++) {
        const auto r = M::length(std::exp2(random.uniform(-7, is_split<N> ? 2.4 : 5)));
        if (!(r > N::length_zero))
            continue;
        const auto v = M::length(value(r) * random.uniform(-1, 1));
        const double exact = value(v) / value(r);
        worst = std::fmax(worst, std::fabs(value(N::ratio(v, M::inverse(r))) - exact) / M::unit_ulp());
    }
    EXPECT_LE(worst, is_split<N> ? 48 : 1); // in q24 of half a unit of v / r's 16 bits, and of its mantissa's 14
}

TYPED_TEST(NumberTest, HeadroomIsTheLargestShiftThatStaysBelowOne)
{
    using N = TypeParam;
    using M = make<N>;
    if constexpr (N::is_fixed) {
        Random random(14);
        for (int i = 0; i < 20000; i++) {
            typename N::Cosine w[3];
            double largest = 0;
            for (auto& c : w) {
                c = M::unit(random.uniform(-1, 1)) * M::unit(std::exp2(random.uniform(-25, 0)));
                largest = std::fmax(largest, std::fabs(value(c)));
            }
            if (largest == 0)
                continue;
            const int k = N::headroom(w[0], w[1], w[2]);
            ASSERT_LT(std::ldexp(largest, k), 1);
            ASSERT_GE(std::ldexp(largest, k + 1), 1);
            for (const auto& c : w)
                ASSERT_EQ(value(N::shifted(c, k)),
                          k >= 0 ? std::ldexp(value(c), k)
                                 : std::ldexp(std::floor(std::ldexp(static_cast<double>(c.raw), k)), -N::Cosine::frac));
        }
        // 1 and -1 themselves have none to spare, a power of two below has its exponent's less one.
        const auto one = M::unit(1) * M::unit(1), none = M::unit(0) * M::unit(1);
        EXPECT_EQ(N::headroom(one, none, none), -1);
        EXPECT_EQ(N::headroom(none, -one, none), -1);
        EXPECT_EQ(N::headroom(none, none, M::unit(0.25) * M::unit(-0.5)), 2);
    } else {
        EXPECT_EQ(N::headroom(N::one, N::zero, N::zero), 0);
        EXPECT_EQ(value(N::shifted(N::one, 0)), 1);
    }
}

TYPED_TEST(NumberTest, BentScalesByARatioOfIndicesAndIsClampedAboveOne)
{
    using N = TypeParam;
    using M = make<N>;
    for (double eta : {0.125, 0.5, 1.0, 1.5, 2.5, 8.0})
        for (double x : {-1.0, -0.375, 0.0, 0.125, 0.375, 1.0}) {
            const double exact = eta * x;
            const double got = value(N::bent(M::eta(eta), M::unit(x)));
            if (std::fabs(exact) <= 1.25 || !N::is_fixed)
                EXPECT_EQ(got, exact);
            else
                EXPECT_EQ(got, std::copysign(1.25, exact)); // beyond 1 is total reflection, by how much is of no use
        }
    Random random(15);
    for (int i = 0; i < 2000; i++) {
        const auto eta = M::eta(random.uniform(0.125, 2));
        const auto x = M::unit(random.uniform(-0.6, 0.6));
        const double exact = value(eta) * value(x);
        ASSERT_NEAR(value(N::bent(eta, x)), exact, (is_split<N> ? 1.51 : 0.51) * M::unit_ulp(exact));
    }
}

// An area as edge functions have it: in q16 they take 64 bits.
template <class N>
auto area_of(typename N::Length a, typename N::Length b)
{
    if constexpr (NarrowFixed<N>)
        return Wide<N::Area::frac, 32>{int64_t{a.raw} * b.raw};
    else
        return a * b;
}

TYPED_TEST(NumberTest, WeightsAreInTheProportionOfTheAreas)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(16);
    for (int i = 0; i < 5000; i++) {
        const double sign = i % 2 == 0 ? 1 : -1, size = std::exp2(random.uniform(-3, 3));
        decltype(area_of<N>({}, {})) area[3];
        double sum = 0;
        for (auto& a : area) {
            a = area_of<N>(M::length(sign * size), M::length(random.uniform(0, 1)));
            sum += value(a);
        }
        if (std::fabs(sum) < 0.001)
            continue;
        typename N::Unit w[3];
        ASSERT_TRUE(N::weights(area[0], area[1], area[2], w[0], w[1], w[2]));
        const double total = value(w[0]) + value(w[1]) + value(w[2]);
        ASSERT_GE(total, 0.49);
        for (int k = 0; k < 3; k++)
            ASSERT_NEAR(value(w[k]) / total, value(area[k]) / sum, (is_split<N> ? 64 * 5 : 5) * M::unit_ulp());
    }
}

TYPED_TEST(NumberTest, WeightsTakeATraceOfTheWrongSignForZero)
{
    using N = TypeParam;
    using M = make<N>;
    typename N::Unit a{}, b{}, c{};
    const auto big = area_of<N>(M::length(2), M::length(2)), trace = area_of<N>(M::length(0.03125), M::length(0.03125));
    const auto none = big - big;
    ASSERT_TRUE(N::weights(big, -trace, none, a, b, c));
    EXPECT_GT(value(a), 0.49);
    EXPECT_EQ(value(b), 0);
    EXPECT_EQ(value(c), 0);
    ASSERT_TRUE(N::weights(trace, none, -big, a, b, c));
    EXPECT_EQ(value(a), 0);
    EXPECT_EQ(value(b), 0);
    EXPECT_GT(value(c), 0.49);
    ASSERT_TRUE(N::weights(none, -big, -big, a, b, c));
    EXPECT_EQ(value(a), 0);
    EXPECT_EQ(value(b), value(c));
    EXPECT_GT(value(b), 0.49);
    EXPECT_FALSE(N::weights(none, none, none, a, b, c));
}

TEST(Number, AreasTooSmallForAReciprocalHaveNoWeights)
{
    float a{}, b{}, c{};
    EXPECT_FALSE(Float::weights(1e-39f, 1e-39f, 0, a, b, c));
    EXPECT_TRUE(Float::weights(1e-36f, -1e-39f, 1e-36f, a, b, c));
    EXPECT_NEAR(a + b + c, 1, 1e-3);
    double x{}, y{}, z{};
    EXPECT_FALSE(Double::weights(1e-310, 1e-310, 0, x, y, z));
    EXPECT_TRUE(Double::weights(1e-300, 0, 0, x, y, z));
    EXPECT_NEAR(x, 1, 1e-15);
}

TYPED_TEST(NumberTest, NormaliseWorksForLengthsOfEverySize)
{
    using N = TypeParam;
    using M = make<N>;
    if constexpr (WideFixed<N>) {
        Random random(17);
        double worst = 0;
        for (int i = 0; i < 50000; i++) {
            // 64-bit components of 1 to 61 bits. Vectors that are shorter than 2^32 are taken without their lowest bit.
            const int bits = 1 + static_cast<int>(random.bits() % 61);
            int64_t v[3];
            for (auto& c : v)
                c = static_cast<int64_t>(random.bits()) >> (64 - bits);
            const bool low =
                (v[0] >> 32) == (v[0] >> 63) && (v[1] >> 32) == (v[1] >> 63) && (v[2] >> 32) == (v[2] >> 63);
            typename N::Unit x{}, y{}, z{};
            const bool any = N::normalise(v[0], v[1], v[2], x, y, z);
            if (low)
                for (auto& c : v)
                    c >>= 1;
            ASSERT_EQ(any, (v[0] | v[1] | v[2]) != 0);
            if (!any)
                continue;
            const Vec3 exact = unit({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
            worst = std::fmax(worst, distance({value(x), value(y), value(z)}, exact));
        }
        EXPECT_LE(worst, 1.81 * M::unit_ulp()); // 0.81 of 31 bits (math.hpp), and 1 for what is cut off
    } else if constexpr (is_split<N>) {
        Random random(18);
        double worst = 0, worst_length = 0;
        for (int i = 0; i < 50000; i++) {
            const int bits = 1 + static_cast<int>(random.bits() % 30);
            int32_t v[3];
            for (auto& c : v)
                c = static_cast<int32_t>(static_cast<int64_t>(random.bits()) >> (63 - bits));
            typename N::Unit x{}, y{}, z{};
            const bool any = N::normalise(v[0], v[1], v[2], x, y, z);
            ASSERT_EQ(any, (v[0] | v[1] | v[2]) != 0);
            if (!any)
                continue;
            const Vec3 exact = unit({static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])});
            worst = std::fmax(worst, distance({value(x), value(y), value(z)}, exact));
            worst_length = std::fmax(worst_length, std::fabs(length(Vec3{value(x), value(y), value(z)}) - 1));
        }
        // (x, y, z) and m to 21 bits, the result, and what products drop: see q24.hpp.
        EXPECT_LE(worst, (1.5 + 0x1p-5) * M::unit_ulp());
        EXPECT_LE(worst_length, (0.5 + (0.5 + 0x1p-5) * std::sqrt(3)) * M::unit_ulp());
    }
}

TYPED_TEST(NumberTest, NormaliseKeepsTheSignAtTheEndsOfItsRange)
{
    using N = TypeParam;
    using M = make<N>;
    if constexpr (WideFixed<N>) {
        typename N::Unit x{}, y{}, z{};
        for (int32_t v :
             {INT32_MIN, INT32_MIN + 1, -0x40000001, -0x40000000, -1, 1, 0x3fffffff, 0x40000000, INT32_MAX}) {
            ASSERT_TRUE(N::normalise(0, v, 0, x, y, z));
            EXPECT_NEAR(value(y), v < 0 ? -1 : 1, M::unit_ulp()) << v;
            EXPECT_EQ(value(x), 0);
        }
        // Just below and at every power of two, where a rounded component may need one bit more.
        for (int bit = 2; bit <= 61; bit++)
            for (int64_t below : {int64_t{1}, int64_t{0}}) {
                const int64_t v = (int64_t{1} << bit) - below;
                ASSERT_TRUE(N::normalise(v, int64_t{0}, int64_t{0}, x, y, z));
                EXPECT_NEAR(value(x), 1, M::unit_ulp()) << "2^" << bit << " - " << below;
                ASSERT_TRUE(N::normalise(int64_t{0}, int64_t{0}, -v, x, y, z));
                EXPECT_NEAR(value(z), -1, M::unit_ulp()) << "-(2^" << bit << " - " << below << ")";
            }
    }
}

TYPED_TEST(NumberTest, NearlyZeroIsSymmetricAndSmall)
{
    using N = TypeParam;
    using M = make<N>;
    const auto none = M::unit(0) * M::unit(1);
    EXPECT_TRUE(N::nearly_zero(none));
    for (double c : {0.25, 0.125, 1.0}) {
        EXPECT_FALSE(N::nearly_zero(M::unit(c) * M::unit(1)));
        EXPECT_FALSE(N::nearly_zero(M::unit(-c) * M::unit(1)));
    }
}

TYPED_TEST(NumberTest, WholePowers)
{
    using N = TypeParam;
    using M = make<N>;
    // Powers of two are exact in every system that holds them.
    EXPECT_EQ(value(N::power_whole(M::unit(0.5), M::shine(1))), 0.5);
    EXPECT_EQ(value(N::power_whole(M::unit(0.5), M::shine(5))), 0.03125);
    EXPECT_EQ(value(N::power_whole(M::unit(1), M::shine(1e6))), 1);
    for (double x : {0.0, 0.25, 0.7071, 1.0})
        EXPECT_EQ(value(N::power_whole(M::unit(x), M::shine(0))), 1) << x << "^0";
    for (double e : {1.0, 2.0, 1e6})
        EXPECT_EQ(value(N::power_whole(M::unit(0), M::shine(e))), 0) << "0^" << e;
}

// q32 states 2^-28 absolute (math.hpp), q16 and q24 to be as exact as 14 bits of x; floating point doubles its relative
// error with each squaring, so that it stays below `exponent` ulp.
template <class N>
double power_tolerance(double x, double exponent)
{
    const double exact = std::pow(x, exponent), ulp = NarrowFixed<N> ? 0x1p-14 : make<N>::unit_ulp();
    if constexpr (NarrowFixed<N>) {
        const double off = is_split<N> ? ulp : ulp / 2; // q24 first rounds x to q16's bits
        return ulp
            + std::fmax(std::pow(std::fmin(1, x + off), exponent) - exact,
                        exact - std::pow(std::fmax(0, x - off), exponent));
    } else if constexpr (N::is_fixed)
        return 0x1p-28;
    else
        return (exponent + 64) * value(N::epsilon) * exact + 1e-37;
}

TYPED_TEST(NumberTest, PowersOfEveryShine)
{
    using N = TypeParam;
    using M = make<N>;
    const double shines[] = {1, 2, 3.0827, 3.5, 7, 10.25, 27.0078125, 64.999, 100, 1000.5, 65536, 100000, 1e6};
    Random random(18);
    for (double shine : shines) {
        for (int i = 0; i < 400; i++) {
            // Places where the power is neither 0 nor 1 too.
            const double y = random.uniform(0.001, 1);
            const auto x = M::unit(i % 2 == 0 ? y : std::pow(y, 1 / shine));
            const double exact = std::pow(value(x), shine);
            // The fraction of the exponent is itself rounded to 2^-32, or to the float's ulp.
            ASSERT_NEAR(value(N::power(x, M::shine(shine))), exact, power_tolerance<N>(value(x), shine))
                << value(x) << "^" << shine;
            if (shine == std::floor(shine)) {
                ASSERT_NEAR(value(N::power_whole(x, M::shine(shine))), exact, power_tolerance<N>(value(x), shine))
                    << value(x) << "^" << shine;
            }
        }
    }
}

TYPED_TEST(NumberTest, FractionalPowersAtTheEnds)
{
    using N = TypeParam;
    using M = make<N>;
    for (double shine : {0.5, 0.25, 3.0827}) {
        EXPECT_EQ(value(N::power(M::unit(0), M::shine(shine))), 0) << "0^" << shine;
        EXPECT_EQ(value(N::power(M::unit(1), M::shine(shine))), 1) << "1^" << shine;
    }
    EXPECT_NEAR(value(N::power(M::unit(0.25), M::shine(0.5))), 0.5, power_tolerance<N>(0.25, 0.5));
    EXPECT_NEAR(value(N::power(M::unit(0.0625), M::shine(0.25))), 0.5, power_tolerance<N>(0.0625, 0.25));
    EXPECT_NEAR(value(N::power(M::unit(0.25), M::shine(1.5))), 0.125, power_tolerance<N>(0.25, 1.5));
}

// The last roots are found by counting down to 1, where roots are slow.
TEST(FloatTest, FractionalPowersAreProductsOfRoundedRoots)
{
    const auto expect = [](float x, float f) {
        float root = x, product = 1, rest = f;
        for (int bit = 0; bit < 24; bit++) {
            root = std::sqrt(root);
            rest *= 2;
            if (rest >= 1) {
                product *= root;
                rest -= 1;
            }
        }
        ASSERT_EQ(Float::power(x, {0, f}), product) << x << "^" << f;
    };
    constexpr uint32_t one = 0x3f800000;
    for (float f : {0.5f, 0.81884f, 1 - 0x1p-24f, 0x1p-24f, 0x1p-30f}) {
        for (uint32_t bits = 1; bits <= one; bits += 65521)
            expect(__builtin_bit_cast(float, bits), f);
        for (uint32_t power = 0; power < one; power += 1 << 23)
            for (uint32_t bits : {power + 1, power + (1 << 23) - 1, power + (1 << 23)})
                expect(__builtin_bit_cast(float, bits), f);
    }
}

TYPED_TEST(NumberTest, SaturatingOperationsAreSumsWithinRange)
{
    using N = TypeParam;
    using M = make<N>;
    EXPECT_EQ(value(N::saturating_sub(M::length(3), M::length(5.5))), -2.5);
    EXPECT_EQ(value(N::saturating_add(M::colour(0.5), M::colour(1.25))), 1.75);
    if constexpr (NarrowFixed<N>) { // differences fit; light is clamped where it is white by far
        using Colour = typename N::Colour;
        constexpr Colour most{int32_t{1} << 24};
        EXPECT_GT(value(most), 1000);
        EXPECT_EQ(N::saturating_add(most, most), most);
        EXPECT_EQ(N::saturating_add(most, Colour{-1}), Colour{most.raw - 1});
    } else if constexpr (N::is_fixed) {
        using Length = typename N::Length;
        using Colour = typename N::Colour;
        EXPECT_EQ(N::saturating_sub(Length{INT32_MAX}, Length{-1}).raw, INT32_MAX);
        EXPECT_LE(N::saturating_sub(Length{INT32_MIN + 1}, Length{5}).raw, INT32_MIN + 1);
        EXPECT_EQ(N::saturating_add(Colour{INT32_MAX}, Colour{INT32_MAX}).raw, INT32_MAX);
    }
}

} // namespace
