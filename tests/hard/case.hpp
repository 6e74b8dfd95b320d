// What the hard cases are made with, and how one says what it found.
#pragma once

#include <qray/shape/cone.hpp>
#include <qray/shape/disc.hpp>
#include <qray/texture/lattice.hpp>
#include <qray/surface/mirror.hpp>
#include <qray/shape/polygon.hpp>
#include <qray/shape/sphere.hpp>
#include <qray/surface/transmit.hpp>

#include "../random.hpp"

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wdouble-promotion"
#endif

namespace catalogue {

using namespace qray;

// What a case found.
struct Check {
    uint32_t checks = 0, failures = 0, first = 0; // the line of the first failure

    void operator()(bool holds, uint32_t line)
    {
        checks++;
        if (!holds && failures++ == 0)
            first = line;
    }
};
#define QRAY_HOLDS(condition) check((condition), __LINE__)

// For loops over some values: not every compiler of a board has <initializer_list>.
template <class T, size_t N>
struct List {
    T at[N];
    constexpr const T* begin() const { return at; }
    constexpr const T* end() const { return at + N; }
};
template <class T, class... Others>
List(T, Others...) -> List<T, 1 + sizeof...(Others)>;

// The compiler may not know what is in v.
template <class T>
void hide(T& v)
{
    asm volatile("" : : "r"(&v) : "memory");
}

// num / den, rounded once.
template <class T>
constexpr T number(int64_t num, int64_t den = 1)
{
    if constexpr (requires { T::frac; }) {
        const int64_t scaled = num * (int64_t{1} << T::frac) * 2 + den, twice = 2 * den;
        return {static_cast<int32_t>(scaled / twice - (scaled % twice < 0))};
    } else {
        return static_cast<T>(num) / static_cast<T>(den);
    }
}
// 2^power.
template <class T>
constexpr T power_of_two(int power)
{
    return power >= 0 ? number<T>(int64_t{1} << power) : number<T>(1, int64_t{1} << -power);
}

// The steps of lengths: the finest that a system holds near 1, and between neighbours near 5.
template <class N>
constexpr int fine_steps = 24;
template <>
inline constexpr int fine_steps<q16> = 10;
template <>
inline constexpr int fine_steps<q24> = 16;
template <>
inline constexpr int fine_steps<Float> = 22;
template <class N>
constexpr int steps_at_5 = fine_steps<N>;
template <>
inline constexpr int steps_at_5<Float> = 21;
template <>
inline constexpr int steps_at_5<Double> = 50;
template <class N>
constexpr int unit_bits = 30; // of a component of a unit vector
template <>
inline constexpr int unit_bits<q16> = 14;
template <>
inline constexpr int unit_bits<q24> = 20;
template <>
inline constexpr int unit_bits<Float> = 23;

// What the cases are made of: steps of 2^-this, and of directions; in fixed point its own, in floating point q32's.
template <class N>
constexpr int grain = N::is_fixed ? fine_steps<N> : 24;
template <class N>
constexpr int slope = N::is_fixed ? unit_bits<N> : 30;

struct Triple {
    int64_t x, y, z;
    friend constexpr Triple operator+(Triple a, Triple b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Triple operator-(Triple a, Triple b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Triple operator*(Triple a, int64_t k) { return {a.x * k, a.y * k, a.z * k}; }
    constexpr Triple turned(int by) const
    {
        return by == 0 ? *this : by == 1 ? Triple{y, z, x} : Triple{z, x, y};
    }
};
inline constexpr Triple axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
// Of length 1 over a whole number.
struct Exact {
    Triple d;
    int64_t over;
};
inline constexpr Exact directions[] = {{{1, 0, 0}, 1},  {{0, -1, 0}, 1},  {{0, 0, 1}, 1},   {{3, 0, -4}, 5},
                                       {{-3, 4, 0}, 5}, {{1, 2, 2}, 3},   {{-2, 1, -2}, 3}, {{2, 3, -6}, 7},
                                       {{-6, 2, 3}, 7}, {{-4, -4, 7}, 9}, {{8, -1, 4}, 9},  {{-2, -10, -11}, 15}};

template <class N>
struct Make {
    using Length = typename N::Length;
    using Unit = typename N::Unit;

    static constexpr Point<N> point(Triple p, int64_t over = 1)
    {
        return {number<Length>(p.x, over), number<Length>(p.y, over), number<Length>(p.z, over)};
    }
    static constexpr Direction<N> direction(Triple d, int64_t over = 1)
    {
        return {number<Unit>(d.x, over), number<Unit>(d.y, over), number<Unit>(d.z, over)};
    }
    static constexpr Ray<N> ray(const Point<N>& from, const Direction<N>& along, Tag left = {Tag::none},
                                bool outward = false)
    {
        return {from, along, left, outward};
    }
    static constexpr typename N::Scale inverse(Length r)
    {
        if constexpr (!N::is_fixed) {
            return Length(1) / r;
        } else {
            const int zeros = count_leading_zeros(static_cast<uint32_t>(r.raw));
            const int room = ShortFixed<N> ? 17 : NarrowFixed<N> ? 14 : 1, shift = zeros > room ? zeros - room : 0;
            const int64_t mantissa = (int64_t{1} << ((NarrowFixed<N> ? 46 - room : 61) - shift)) / r.raw;
            return {mantissa < INT32_MAX ? static_cast<int32_t>(mantissa) : INT32_MAX, shift};
        }
    }
    // num / den in a block scale.
    static constexpr Length scaled(int64_t num, int64_t den, int32_t fine)
    {
        return fine < 0 ? number<Length>(num, den << -fine) : number<Length>(num << fine, den);
    }
    static constexpr Sphere<N> sphere(const Point<N>& centre, int64_t r, int64_t over = 1,
                                      Tag tag = make_tag(0, 0))
    {
        const int32_t up = block_scale<N>(number<Length>(r, over), &Blocks::ball);
        const Length radius = scaled(r, over, up);
        return {centre, radius, inverse(radius), up, tag, {}};
    }
    static constexpr Disc<N> disc(Triple centre, Triple normal, int64_t r)
    {
        return {point(centre), direction(normal), number<Length>(r), make_tag(0, 0)};
    }
    // Around the z axis from z = -half to half; r at the middle, growing by s / c; c and s over 5. `bound` >=
    // the distance of a rim.
    static constexpr Cone<N> cone(int64_t middle, int64_t r, int64_t r_over, int64_t c, int64_t s, int64_t half,
                                  int64_t bound, Tag tag = make_tag(0, 0))
    {
        const int32_t up = block_scale<N>(number<Length>(bound), &Blocks::cone);
        return {point({0, 0, middle}),
                direction(axes[0]),
                direction(axes[1]),
                direction(axes[2]),
                scaled(r * c, 5 * r_over, up),
                scaled(half, 1, up),
                scaled(bound, 1, up),
                number<Unit>(c, 5),
                number<Unit>(s, 5),
                up,
                tag,
                {}};
    }
    static constexpr Cone<N> cylinder(int64_t half, int64_t bound) { return cone(0, 1, 1, 5, 0, half, bound); }
};

#define QRAY_CASE(name) \
    template <class N>  \
    void name([[maybe_unused]] Check& check)
#define QRAY_NAMES                                           \
    using M [[maybe_unused]] = Make<N>;                      \
    using Length [[maybe_unused]] = typename N::Length;      \
    using Unit [[maybe_unused]] = typename N::Unit;          \
    [[maybe_unused]] const Length ulp = power_of_two<Length>(-steps_at_5<N>); \
    [[maybe_unused]] Length t{}

template <class N>
bool near(typename N::Length a, typename N::Length b, typename N::Length by)
{
    return a - b <= by && b - a <= by;
}

// As a scene's shapes are asked: a cheap reject, then the test that relies on it. The test that does not must
// agree.
template <class S, class N>
bool meets(Check& check, S shape, Ray<N> ray, typename N::Length& t, typename N::Length limit = N::length_max)
{
    hide(shape);
    hide(ray);
    typename N::Length other{};
    Local<N> local{};
    const bool alone = intersect(shape, Corners<N>{}, ray, limit, other, local);
    const bool after =
        !surely_missed(shape, RejectRay<N>(ray)) && intersect<true>(shape, Corners<N>{}, ray, limit, t, local);
    QRAY_HOLDS(alone == after && (!alone || other == t));
    return after;
}

struct Random : SplitMix {
    // In [low, high], of a span below 2^32.
    int64_t in(int64_t low, int64_t high)
    {
        return low + static_cast<int64_t>((bits() >> 32) * static_cast<uint64_t>(high - low + 1) >> 32);
    }
};

} // namespace catalogue
