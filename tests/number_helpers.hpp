// What the typed tests share: quantities of a number system from double and back, and its units in the last place.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <type_traits>

#include "../src/scene/numbers.hpp"
#include "random.hpp"
#include "reals.hpp"

#ifdef __clang__ // to long double too, which these tests mean
#pragma clang diagnostic ignored "-Wdouble-promotion"
#endif

namespace qray::test {

#ifdef QRAY_LANES_ALONE // tests of lanes: those that have them
using NumberSystems = ::testing::Types<q32, Float>;
#else
using NumberSystems = ::testing::Types<q16, q24, q32, Float, Double>;
#endif

// Products that keep their upper bits: of three that are summed less than 3/8 ulp of a Length or a Unit is dropped.
template <class N>
constexpr bool is_split = NarrowFixed<N> && !ShortFixed<N>;

struct SystemNames {
    template <class N>
    static std::string GetName(int)
    {
        return scene::number_names_of<N>().name;
    }
};

using Vec3 = Vec<double>;
inline Vec3 unit(const Vec3& a) { return unit<double>(a); }
inline double length(const Vec3& a) { return length<double>(a); }

// The real number that a quantity stands for: exact for all but a Wide of more than 53 bits.
template <int F, int B>
double value(Fixed<F, B> a)
{
    return std::ldexp(a.raw, -F);
}
template <int F, int B>
double value(Wide<F, B> a)
{
    return std::ldexp(static_cast<double>(a.raw), -F);
}
inline double value(double a) { return a; }
inline double value(float a) { return static_cast<double>(a); }
template <class T>
Vec3 value(const Vec<T>& a)
{
    return {value(a.x), value(a.y), value(a.z)};
}

// The same with more digits than any number system has, for expected values that are computed.
using Real = long double;
template <class T>
Vec<Real> real(const Vec<T>& a)
{
    return {value(a.x), value(a.y), value(a.z)};
}
inline Vec3 rounded(const Vec<Real>& a)
{
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}
// The nearest quantity; it must be in range. A `direction` is normalised first, a `vector` is not.
template <class N>
struct make {
    template <class T>
    static T number(double v)
    {
        if constexpr (std::is_floating_point_v<T>)
            return static_cast<T>(v);
        else
            return T{static_cast<int32_t>(std::llrint(std::ldexp(v, T::frac)))};
    }
    static typename N::Length length(double v) { return number<typename N::Length>(v); }
    static typename N::Unit unit(double v) { return number<typename N::Unit>(v); }
    static typename N::Colour colour(double v) { return number<typename N::Colour>(v); }
    static typename N::Eta eta(double v) { return number<typename N::Eta>(v); }

    static Point<N> point(double x, double y, double z) { return {length(x), length(y), length(z)}; }
    static Point<N> point(const Vec3& p) { return point(p.x, p.y, p.z); }
    static Vec<typename N::Unit> vector(double x, double y, double z) { return {unit(x), unit(y), unit(z)}; }
    static Direction<N> direction(const Vec3& d)
    {
        const Vec3 u = test::unit(d);
        return vector(u.x, u.y, u.z);
    }
    static Direction<N> direction(double x, double y, double z) { return direction(Vec3{x, y, z}); }
    static Rgb<N> rgb(double r, double g, double b) { return {colour(r), colour(g), colour(b)}; }

    static Ray<N> ray(const Vec3& origin, const Vec3& along)
    {
        return {point(origin), direction(along), {Tag::none}, false};
    }
    static typename N::Scale inverse(typename N::Length r)
    {
        if constexpr (NarrowFixed<N>) { // 16 bits
            constexpr int bits = ShortFixed<N> ? 15 : 18;
            const int zeros = __builtin_clz(static_cast<uint32_t>(r.raw));
            const int shift = zeros > 32 - bits ? zeros - (32 - bits) : 0;
            return {static_cast<int32_t>(std::lrint(std::ldexp(1, 14 + bits - shift) / r.raw)), shift};
        } else if constexpr (N::is_fixed) {
            const int shift = __builtin_clz(static_cast<uint32_t>(r.raw)) - 1;
            const double mantissa = std::ldexp(1, 61 - shift) / r.raw;
            return {mantissa < 2147483647.0 ? static_cast<int32_t>(std::llrint(mantissa)) : INT32_MAX, shift};
        } else {
            return 1 / r;
        }
    }
    static typename N::Shine shine(double e)
    {
        const double whole = std::floor(e);
        if constexpr (N::is_fixed)
            return {static_cast<uint32_t>(whole), static_cast<uint32_t>(std::ldexp(e - whole, 32))};
        else
            return {static_cast<uint32_t>(whole), static_cast<typename N::Unit>(e - whole)};
    }

    // The step between neighbours of type T around a number of that size.
    template <class T>
    static double step(double size)
    {
        if constexpr (std::is_floating_point_v<T>)
            return std::ldexp(1, std::ilogb(std::fmax(std::fabs(size), 0x1p-100)) - (sizeof(T) == 4 ? 23 : 52));
        else
            return std::ldexp(1, -T::frac);
    }
    static double length_ulp(double size = 1) { return step<typename N::Length>(size); }
    static double unit_ulp(double size = 1) { return step<typename N::Unit>(size); }
    static double colour_ulp(double size = 1) { return step<typename N::Colour>(size); }
};

// The largest difference of a component.
inline double distance(const Vec3& a, const Vec3& b)
{
    return std::fmax(std::fabs(a.x - b.x), std::fmax(std::fabs(a.y - b.y), std::fabs(a.z - b.z)));
}
inline void expect_near(const Vec3& a, const Vec3& b, double tolerance)
{
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

class Random : public SplitMix {
public:
    explicit Random(uint64_t seed) : SplitMix{seed} {}
    double uniform(double low, double high)
    {
        return low + (high - low) * std::ldexp(static_cast<double>(bits() >> 11), -53);
    }
    Vec3 point(double reach) { return {uniform(-reach, reach), uniform(-reach, reach), uniform(-reach, reach)}; }
    Vec3 direction()
    {
        for (;;) {
            const Vec3 v = point(1);
            const double l = length(v);
            if (l > 0.01 && l <= 1)
                return v * (1 / l);
        }
    }
};

} // namespace qray::test
