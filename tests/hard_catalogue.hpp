// The hard cases whose answers are exact, for desktop and boards alike: test_hard_catalogue.cpp runs them
// under GoogleTest, firmware/catalogue.cpp on a board. Coordinates and directions are rational numbers that a
// number system holds, or rounds once; whether a ray meets a shape follows from integers. So nothing here
// needs a library, and what decides is never the code under test.
#pragma once

#include <qray/shape/cone.hpp>
#include <qray/shape/disc.hpp>
#include <qray/texture/lattice.hpp>
#include <qray/surface/mirror.hpp>
#include <qray/shape/polygon.hpp>
#include <qray/shape/sphere.hpp>
#include <qray/surface/transmit.hpp>

#include "random.hpp"

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
    // The block scale of what is no larger than num / den.
    static constexpr int32_t fine(int64_t num, int64_t den)
    {
        int32_t bits = 0;
        if constexpr (N::is_fixed)
            while (bits < 10 && (num << (bits + 1)) <= 32 * den)
                bits++;
        return bits;
    }
    static constexpr Sphere<N> sphere(const Point<N>& centre, int64_t r, int64_t over = 1,
                                      Tag tag = make_tag(0, 0))
    {
        const int32_t up = fine(r, over);
        const Length radius = number<Length>(r << up, over);
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
        const int32_t up = fine(bound, 1);
        return {point({0, 0, middle}),
                direction(axes[0]),
                direction(axes[1]),
                direction(axes[2]),
                number<Length>((r * c) << up, 5 * r_over),
                number<Length>(half << up),
                number<Length>(bound << up),
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

// --- Sphere

// One hit, at 5; the next coordinate out is a miss.
QRAY_CASE(SphereTouchedByATangentOfIntegers)
{
    QRAY_NAMES;
    for (int64_t over : List{1, 4, 128})
        for (int64_t r : List{1, 3})
            for (int i = 0; i < 3; i++)
                for (int k = 1; k <= 2; k++)
                    for (int64_t sign : List{-1, 1}) {
                        // In 128ths: the centre is (2, -1, 1/2), the ray starts at 5 before it.
                        const Triple c{256, -128, 64}, side = axes[(i + k) % 3] * (r * sign * 128 / over);
                        const Direction<N> d = M::direction(axes[i] * sign);
                        const Sphere<N> s = M::sphere(M::point(c, 128), r, over);
                        Point<N> o = M::point(c + side - axes[i] * (sign * 640), 128);
                        QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t == number<Length>(5));
                        const Triple out = axes[(i + k) % 3] * sign;
                        o = o + M::point(out, int64_t{1} << steps_at_5<N>);
                        QRAY_HOLDS(!meets(check, s, M::ray(o, d), t));
                    }
}

QRAY_CASE(SphereAimedAMillionthOfItsRadiusBesideItsEdge)
{
    QRAY_NAMES;
    // 16 2^-24 = 0.95e-6; in q16 a step.
    const Length off = power_of_two<Length>(NarrowFixed<N> ? -10 : -20), one = number<Length>(1);
    for (int64_t sign : List{-1, 1})
        for (int64_t far : List{2, 10, 55}) {
            const Sphere<N> s = M::sphere(M::point({0, 0, 0}), 1);
            const Direction<N> d = M::direction({sign, 0, 0});
            for (const Length edge : List{one - off, -one + off}) {
                const Point<N> o{number<Length>(-far * sign), edge, Length{}};
                QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t <= number<Length>(far)
                           && t > number<Length>(far - 1));
                QRAY_HOLDS(meets(check, s, M::ray({o.x, o.z, o.y}, d), t));
            }
            for (const Length edge : List{one + off, -one - off}) {
                const Point<N> o{number<Length>(-far * sign), edge, Length{}};
                QRAY_HOLDS(!meets(check, s, M::ray(o, d), t));
                QRAY_HOLDS(!meets(check, s, M::ray({o.x, o.z, o.y}, d), t));
            }
        }
}

// A radius of 0.005 is 83886.08 steps of 2^-24, seen from 55 away; one of 0.05 is 51.2 of 2^-10.
QRAY_CASE(SphereOfAnEleventhousandthOfItsDistance)
{
    QRAY_NAMES;
    const Sphere<N> s = M::sphere(M::point({30, 7, -9}), NarrowFixed<N> ? 50 : 5, 1000);
    const int64_t edge = NarrowFixed<N> ? 51 : 83886, over = int64_t{1} << (NarrowFixed<N> ? 10 : 24);
    // A float of 7 ends at 2^-21: from a centre of 0 only.
    const Sphere<N> at_zero = M::sphere(M::point({30, 0, 0}), NarrowFixed<N> ? 50 : 5, 1000);
    for (int64_t sign : List{-1, 1})
        for (int64_t out : List{0, 1}) {
            const Length y = number<Length>(sign * (edge + out), over);
            const Direction<N> d = M::direction({1, 0, 0});
            QRAY_HOLDS(meets(check, at_zero, M::ray({number<Length>(-25), y, Length{}}, d), t) == (out == 0));
            if (N::is_fixed || sizeof(Length) == 8) {
                const Ray<N> ray = M::ray({number<Length>(-25), number<Length>(7), number<Length>(-9) + y}, d);
                QRAY_HOLDS(meets(check, s, ray, t) == (out == 0));
            }
        }
}

// 128 bits without a sign: a board's compiler has none.
struct Wide128 {
    uint64_t high, low;

    static constexpr Wide128 product(uint64_t a, uint64_t b)
    {
        constexpr uint64_t mask = 0xffffffff;
        const uint64_t ah = a >> 32, al = a & mask, bh = b >> 32, bl = b & mask;
        const uint64_t bottom = al * bl, one = ah * bl + (bottom >> 32), other = al * bh + (one & mask);
        return {ah * bh + (one >> 32) + (other >> 32), (other << 32) | (bottom & mask)};
    }
    friend constexpr Wide128 operator-(Wide128 a, Wide128 b)
    {
        return {a.high - b.high - (a.low < b.low), a.low - b.low};
    }
    friend constexpr bool operator<(Wide128 a, Wide128 b)
    {
        return a.high < b.high || (a.high == b.high && a.low < b.low);
    }
    constexpr Wide128 shifted(int by) const
    {
        return by == 0 ? *this : Wide128{(high << by) | (low >> (64 - by)), low << by};
    }
};

// Does the line of a ray pass within r of a centre: is r^2 |d|^2 more than |v|^2 |d|^2 - (v.d)^2, in 128 bits
// on the numbers as stored? Not `certain` within so much of r: half a 2^-25 in q32, four steps in q16.
template <class N>
    requires N::is_fixed
bool passes_within(const Sphere<N>& s, const Ray<N>& ray, bool& certain)
{
    const auto square = [](int64_t x, int64_t y, int64_t z) {
        return static_cast<uint64_t>(x * x + y * y + z * z);
    };
    const Point<N> c = s.centre, o = ray.origin;
    const Direction<N> d = ray.direction;
    const int64_t x = c.x.raw - o.x.raw, y = c.y.raw - o.y.raw, z = c.z.raw - o.z.raw;
    const int64_t b = x * d.x.raw + y * d.y.raw + z * d.z.raw;
    const uint64_t d2 = square(d.x.raw, d.y.raw, d.z.raw), along = static_cast<uint64_t>(b < 0 ? -b : b);
    const Wide128 coarse = Wide128::product(square(x, y, z), d2) - Wide128::product(along, along);
    const Wide128 across = coarse.shifted(2 * s.fine);
    const uint64_t r = static_cast<uint64_t>(s.radius.raw);
    const Wide128 reach = Wide128::product(r * r, d2);
    const bool inside = across < reach;
    const Wide128 off = inside ? reach - across : across - reach;
    const uint64_t r_fine = r << s.fine;
    certain = Wide128::product(NarrowFixed<N> ? r_fine * 8 : r_fine / 2, d2) < off;
    return inside;
}

// Rays of any direction that pass the edge of a sphere of r at 55 within some steps.
template <class N>
void aim_at_the_edge(Check& check, int64_t num, int64_t den, int64_t steps)
{
    QRAY_NAMES;
    Random random{71};
    int hits = 0, misses = 0;
    for (int i = 0; i < 400; i++) {
        Direction<N> d{}, n{};
        const auto any = [&random] {
            return M::point({random.in(-99, 99), random.in(-99, 99), random.in(1, 99)}, 4);
        };
        normalise<N>(any(), d);
        // Across d: other - (other.d) d, but for roundings, which do not matter.
        const Point<N> other = any();
        const Point<N> aside = other - along<N>(N::length(dot<N>(other, d)), d);
        if (norm2<N>(aside) < number<Length>(1) * number<Length>(1) || !normalise<N>(aside, n))
            continue;
        const Triple centre{random.in(-9, 9), random.in(-9, 9), random.in(-9, 9)};
        const Sphere<N> s = M::sphere(M::point(centre), num, den);
        Length away = number<Length>(num, den);
        const int64_t beside = random.in(-steps, steps);
        away = away + number<Length>(beside, int64_t{1} << (NarrowFixed<N> ? 10 : N::is_fixed ? 24 : 14));
        const Point<N> foot = s.centre + along<N>(away, n);
        const Ray<N> ray = M::ray(foot - along<N>(number<Length>(N::is_fixed ? 55 : 5), d), d);
        bool certain = beside > 8 || beside < -8, expected = beside < 0;
        if constexpr (N::is_fixed)
            expected = passes_within<N>(s, ray, certain);
        if (!certain)
            continue;
        QRAY_HOLDS(meets(check, s, ray, t) == expected);
        expected ? hits++ : misses++;
    }
    QRAY_HOLDS(hits > 50 && misses > 50);
}

QRAY_CASE(SphereSeenFromAnywhereBesideItsEdge) { aim_at_the_edge<N>(check, 1, 1, 24); }

// In q16 a tenth of a pixel: as small as half a hundred steps.
QRAY_CASE(SmallSphereSeenFromAnywhereBesideItsEdge)
{
    aim_at_the_edge<N>(check, NarrowFixed<N> ? 50 : 5, 1000, NarrowFixed<N> ? 40 : N::is_fixed ? 6 : 24);
}

QRAY_CASE(SphereSeenFromItsCentreIsItsRadiusAway)
{
    QRAY_NAMES;
    for (int64_t over : List{1, 2, 64})
        for (const Exact& e : directions) {
            const Sphere<N> s = M::sphere(M::point({-7, 11, 3}), 3, over);
            QRAY_HOLDS(meets(check, s, M::ray(M::point({-7, 11, 3}), M::direction(e.d, e.over)), t));
            QRAY_HOLDS(near<N>(t, number<Length>(3, over), e.over == 1 ? Length{} : ulp + ulp));
        }
}

QRAY_CASE(SphereBehindIsNotMet)
{
    QRAY_NAMES;
    const Sphere<N> s = M::sphere(M::point({1, 2, 3}), 1);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1})
            for (int64_t away : List{513, 1024, 20480}) { // in 512ths
                const Point<N> o = M::point(Triple{512, 1024, 1536} + axes[i] * (sign * away), 512);
                QRAY_HOLDS(!meets(check, s, M::ray(o, M::direction(axes[i] * sign)), t));
                QRAY_HOLDS(meets(check, s, M::ray(o, M::direction(axes[i] * -sign)), t)
                           && t == number<Length>(away - 512, 512));
            }
}

QRAY_CASE(ConcentricSpheresAMillionthApartAreMetInOrder)
{
    QRAY_NAMES;
    const int64_t thin = NarrowFixed<N> ? 64 : 1 << 20;
    const Point<N> centre = M::point({3, 4, 5});
    const Sphere<N> inner = M::sphere(centre, 1), outer = M::sphere(centre, thin + 1, thin);
    const int64_t far = WideFixed<N> ? 50 : 2;
    for (const Exact& e : directions)
        for (int beside = 0; beside < 4; beside++) {
            const Triple aside = axes[beside % 3] * (e.over * (beside > 0));
            const Triple from = Triple{3, 4, 5} * (4 * e.over) - e.d * (4 * far) + aside;
            const Ray<N> ray = M::ray(M::point(from, 4 * e.over), M::direction(e.d, e.over));
            Length t_outer{};
            QRAY_HOLDS(meets(check, inner, ray, t) && meets(check, outer, ray, t_outer) && t_outer < t);
            const Ray<N> back = M::ray(M::point({3, 4, 5}), ray.direction);
            QRAY_HOLDS(meets(check, inner, back, t) && meets(check, outer, back, t_outer) && t < t_outer);
        }
}

// A ray that enters the outer one meets the inner, then what is left is the outer's far side.
QRAY_CASE(ShellOfAMillionthIsCrossedFaceByFace)
{
    QRAY_NAMES;
    const int64_t thin = NarrowFixed<N> ? 64 : 1 << 20;
    const Tag tag = make_tag(1, 0);
    const Sphere<N> inner = M::sphere(M::point({0, 0, 0}), 1);
    const Sphere<N> outer = M::sphere(M::point({0, 0, 0}), thin + 1, thin, tag);
    const Length little = number<Length>(4, int64_t{1} << fine_steps<N>);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Point<N> o = M::point(axes[i] * (sign * (thin + 1)), thin);
            const Ray<N> ray = M::ray(o, M::direction(axes[i] * -sign), tag);
            QRAY_HOLDS(meets(check, inner, ray, t) && near<N>(t, number<Length>(1, thin), little));
            QRAY_HOLDS(meets(check, outer, ray, t) && near<N>(t, number<Length>(2 * thin + 2, thin), little));
        }
}

// At a cosine of 2^-17 (q16: 2^-14): known as the surface that the ray left, and not.
QRAY_CASE(SphereLeftAlmostAlongItsTangentIsNotMetAgain)
{
    QRAY_NAMES;
    const Tag tag = make_tag(3, 0);
    const int64_t flat = NarrowFixed<N> ? 1 << 14 : 1 << 17;
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Sphere<N> s = M::sphere(M::point({9, -5, 2}), 2, 1, tag);
            const Direction<N> g = M::direction(axes[i] * sign);
            Ray<N> ray = M::ray(M::point(Triple{9, -5, 2} + axes[i] * (sign * 2)),
                                M::direction(axes[i] * sign + axes[(i + 1) % 3] * flat, flat), tag, true);
            QRAY_HOLDS(!meets(check, s, ray, t));
            ray.origin = step_off<N>(ray.origin, g, true);
            QRAY_HOLDS(!meets(check, s, ray, t));
            if (NarrowFixed<N>) // whose directions are longer or shorter than 1 by more than that
                continue;
            ray.from = {Tag::none};
            QRAY_HOLDS(!meets(check, s, ray, t));
        }
}

QRAY_CASE(SphereEnteredIsMetAtTheFarEndOfTheChord)
{
    QRAY_NAMES;
    const Tag tag = make_tag(3, 0);
    const Length little = number<Length>(16, int64_t{1} << fine_steps<N>);
    for (int i = 0; i < 3; i++)
        for (int64_t sign : List{-1, 1}) {
            const Sphere<N> s = M::sphere(M::point({0, 0, 0}), 2, 1, tag);
            const Point<N> o = M::point(axes[i] * (sign * 2));
            Direction<N> d = M::direction(axes[i] * -sign);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && t == number<Length>(4));
            // Down at a sine of 3/5: 2 r 3/5.
            d = M::direction(axes[i] * (-3 * sign) + axes[(i + 2) % 3] * 4, 5);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && near<N>(t, number<Length>(12, 5), little));
            // And at 2^-17: the chord is 2^-15 long, if the origin were on the ball exactly; it has another
            // end.
            d = M::direction(axes[i] * -sign + axes[(i + 1) % 3] * (1 << 17), 1 << 17);
            QRAY_HOLDS(meets(check, s, M::ray(o, d, tag), t) && t > Length{} && t <= number<Length>(1, 4));
        }
}

// --- Plane and disc

QRAY_CASE(PlaneParallelToTheRayIsMissed)
{
    QRAY_NAMES;
    for (int64_t height : List{0, 1 << 20, -(1 << 20), 1}) {
        Disc<N> s = M::disc({0, 0, 0}, axes[1], 60);
        s.centre.y = number<Length>(height, 1 << 20);
        QRAY_HOLDS(!meets(check, s, M::ray(M::point({-1, 0, 2}), M::direction({1, 0, 0})), t));
        QRAY_HOLDS(!meets(check, s, M::ray(M::point({-1, 0, 2}), M::direction({3, 0, -4}, 5)), t));
    }
}

// 64 away at a slope of 2^-30 (q16: 2^-14); from a height of 1 it is out of reach.
QRAY_CASE(PlaneAtASlopeOfABillionthIsMetWhereItShouldBe)
{
    QRAY_NAMES;
    const Disc<N> s = M::disc({0, 0, 0}, axes[1], 100);
    const int bits = NarrowFixed<N> ? 14 : 30;
    const Length slack = NarrowFixed<N> ? number<Length>(5, 1024) : Length{}; // a quotient of 14 bits
    for (int64_t side : List{-1, 1}) {
        Ray<N> ray = M::ray(M::point({-60, side, 0}), M::direction({1, 0, 0}));
        ray.direction.y = number<Unit>(-side, int64_t{1} << bits);
        QRAY_HOLDS(!meets(check, s, ray, t));
        ray.origin.y = number<Length>(side * 64, int64_t{1} << bits);
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(64), slack));
        ray.direction.y = number<Unit>(side, int64_t{1} << bits);
        QRAY_HOLDS(!meets(check, s, ray, t));
    }
}

QRAY_CASE(DiscExactlyAtTheLimitIsMet)
{
    QRAY_NAMES;
    const Disc<N> s = M::disc({0, 0, 0}, axes[2], 3);
    const Ray<N> ray = M::ray(M::point({1, 1, 5}), M::direction({0, 0, -1}));
    QRAY_HOLDS(meets(check, s, ray, t, number<Length>(5)) && t == number<Length>(5));
    QRAY_HOLDS(!meets(check, s, ray, t, number<Length>(5) - ulp));
}

QRAY_CASE(PlaneThroughTheOriginOfARayIsNotMet)
{
    QRAY_NAMES;
    for (int i = 0; i < 3; i++)
        for (const Exact& e : directions)
            for (int64_t x : List{-19, 0, 7}) {
                const Disc<N> s = M::disc({0, 0, 0}, axes[i], 60);
                const Triple o = axes[(i + 1) % 3] * x + axes[(i + 2) % 3] * 13;
                QRAY_HOLDS(!meets(check, s, M::ray(M::point(o), M::direction(e.d, e.over)), t));
            }
}

// (3, 4) is 5 from the centre.
QRAY_CASE(DiscHoldsItsRimAndNothingBeyond)
{
    QRAY_NAMES;
    for (int i = 0; i < 3; i++)
        for (const Triple& at : List{Triple{3, 4, 7}, Triple{-3, 4, 7}, Triple{4, -3, 7}, Triple{-4, -3, 7}}) {
            const Disc<N> s = M::disc({0, 0, 0}, Triple{0, 0, 1}.turned(i), 5);
            const Direction<N> d = M::direction(Triple{0, 0, -1}.turned(i));
            const Point<N> o = M::point(at.turned(i));
            const Triple out{at.x < 0 ? -1 : 1, 0, 0};
            QRAY_HOLDS(meets(check, s, M::ray(o, d), t) && t == number<Length>(7));
            const Point<N> beyond_it = o + M::point(out.turned(i), int64_t{1} << steps_at_5<N>);
            QRAY_HOLDS(!meets(check, s, M::ray(beyond_it, d), t));
        }
}

// --- Polygon

struct Flat {
    int64_t x, y;
};

// Corners across the z axis, x in steps of 1 / x_over and y of 1 / y_over.
template <class N>
struct Figure {
    static constexpr uint32_t most = 144;
    Point<N> at[most];
    Polygon<N> shape;
    uint32_t count;
    int64_t x_over, y_over;

    Figure(const Flat* corners, uint32_t n, int64_t over_x, int64_t over_y)
        : count(n), x_over(over_x), y_over(over_y)
    {
        using Length = typename N::Length;
        Flat low = corners[0], high = corners[0];
        for (uint32_t i = 0; i < n; i++) {
            const Flat& c = corners[i];
            at[i] = {number<Length>(c.x, x_over), number<Length>(c.y, y_over), Length{}};
            low = {c.x < low.x ? c.x : low.x, c.y < low.y ? c.y : low.y};
            high = {c.x > high.x ? c.x : high.x, c.y > high.y ? c.y : high.y};
        }
        const Length w = number<Length>(high.x - low.x, x_over), h = number<Length>(high.y - low.y, y_over);
        const Length middle_x = number<Length>(low.x + high.x, 2 * x_over);
        const Length middle_y = number<Length>(low.y + high.y, 2 * y_over);
        // More than the half of a square's diagonal, 0.70711 of its edge.
        const Length wider = w > h ? w : h;
        const typename N::Unit share = number<typename N::Unit>(182, 256);
        const Length bound = N::length(wider * share) + number<Length>(8, int64_t{1} << fine_steps<N>);
        shape = {Make<N>::direction(axes[2]), {middle_x, middle_y, Length{}}, bound, 0, n, make_tag(0, 0)};
    }
    bool hit(Ray<N> ray, typename N::Length& t)
    {
        hide(*this);
        hide(ray);
        Local<N> local{};
        return !surely_missed(shape, RejectRay<N>(ray))
            && intersect<true>(shape, Corners<N>{at, nullptr}, ray, N::length_max, t, local);
    }
};

// By crossings in integers, below 2^62. Not `certain` on an edge, whose owner is another question, and where
// two rounded products of floats do not tell: 3 epsilon of their sum (Shewchuk 1997).
template <class N>
bool inside_exactly(const Flat* corners, uint32_t count, Flat p, bool& certain)
{
    const auto size = [](int64_t v) { return v < 0 ? -v : v; };
    constexpr bool is_float = !N::is_fixed && sizeof(typename N::Length) == 4;
    bool inside = false;
    certain = true;
    for (uint32_t i = 0; i < count; i++) {
        const Flat a = corners[i], b = corners[i + 1 < count ? i + 1 : 0];
        const int64_t u = (a.x - p.x) * (b.y - p.y), v = (b.x - p.x) * (a.y - p.y);
        if (u == v && (a.x - p.x) * (b.x - p.x) <= 0 && (a.y - p.y) * (b.y - p.y) <= 0)
            certain = false;
        if ((a.y > p.y) == (b.y > p.y))
            continue;
        inside = inside != (b.y > p.y ? u > v : u < v);
        if (is_float && size(u - v) <= (size(u) + size(v)) >> 22)
            certain = false;
    }
    return inside;
}

constexpr int figure_rays = sizeof(void*) == 8 ? 20000 : 2000; // a board is slower

template <class N>
void compare_with_integers(Check& check, const Flat* corners, uint32_t count, int64_t x_over, int64_t y_over,
                           int rays, Flat low, Flat high)
{
    QRAY_NAMES;
    Figure<N> s(corners, count, x_over, y_over);
    Random random{79};
    int hits = 0, decided = 0;
    for (int i = 0; i < rays; i++) {
        const Flat p{random.in(low.x, high.x), random.in(low.y, high.y)};
        bool certain = false;
        const bool expected = inside_exactly<N>(corners, count, p, certain);
        if (!certain)
            continue;
        const Point<N> o{number<Length>(p.x, x_over), number<Length>(p.y, y_over), number<Length>(3)};
        const bool hit = s.hit(M::ray(o, M::direction({0, 0, -1})), t);
        QRAY_HOLDS(hit == expected);
        QRAY_HOLDS(!hit || t == number<Length>(3));
        hits += hit;
        decided++;
    }
    QRAY_HOLDS(hits > rays / 10 && decided > rays * 8 / 10);
}

// The owner of a ray through a corner or an edge is decided without any rounding.
QRAY_CASE(RayThroughACornerOfSixTrianglesHasOneOwner)
{
    QRAY_NAMES;
    constexpr Triple ring[6] = {{4, 1, 0}, {1, 3, 0}, {-3, 2, 0}, {-4, -2, 0}, {0, -5, 0}, {3, -2, 0}};
    for (int turned = 0; turned < 3; turned++) {
        Point<N> at[18];
        Polygon<N> fan[6];
        for (uint32_t i = 0; i < 6; i++) {
            at[3 * i] = M::point({0, 0, 0});
            at[3 * i + 1] = M::point(ring[i].turned(turned));
            at[3 * i + 2] = M::point(ring[(i + 1) % 6].turned(turned));
            const Direction<N> normal = M::direction(axes[2].turned(turned));
            fan[i] = {normal, at[3 * i], number<Length>(8), 3 * i, 3, make_tag(i, 0)};
        }
        hide(at);
        // Through the common corner and the middles of the edges, from every side. Directions are exact:
        // 16ths, of any length, which is none that the cheap reject is made for.
        for (int64_t x = -3; x <= 3; x++)
            for (int64_t y = -3; y <= 3; y++)
                for (int edge = -1; edge < 6; edge++)
                    for (int64_t side : List{-8, 8}) {
                        const Triple twice = edge < 0 ? Triple{0, 0, 0} : ring[edge], away{x, y, side};
                        Ray<N> ray = M::ray(M::point((twice + away * 2).turned(turned), 2),
                                            M::direction((away * -1).turned(turned), 16));
                        hide(ray);
                        int owners = 0;
                        Local<N> local{};
                        for (const Polygon<N>& f : fan)
                            owners += intersect(f, Corners<N>{at, nullptr}, ray, N::length_max, t, local);
                        QRAY_HOLDS(owners == 1);
                    }
    }
}

// 168 steps of 2^-24 are 1.0014e-5; in q16 of 2^-10.
QRAY_CASE(SliverOf50ByAHundredthousandthIsExact)
{
    constexpr Flat corners[] = {{-25 * 1024, 0}, {25 * 1024, 0}, {7 * 1024, 168}};
    const int64_t over = int64_t{1} << (NarrowFixed<N> ? 10 : 24);
    compare_with_integers<N>(check, corners, 3, 1024, over, figure_rays, {-25600, -6}, {25599, 173});
}

// 3355 steps of 2^-24 are 2e-4; and so in a corner of the world.
QRAY_CASE(TriangleOfAFiveThousandthIsExact)
{
    constexpr Flat corners[] = {{0, 0}, {3355, 17}, {1211, 2903}};
    const int64_t over = int64_t{1} << (NarrowFixed<N> ? 10 : 24);
    compare_with_integers<N>(check, corners, 3, over, over, figure_rays, {-100, -100}, {3500, 3000});
    if constexpr (N::is_fixed) {
        const int64_t far = 30 * over;
        const Flat there[] = {{far, -far}, {far + 3355, 17 - far}, {far + 1211, 2903 - far}};
        compare_with_integers<N>(check, there, 3, over, over, figure_rays, {far - 100, -far - 100},
                                 {far + 3500, 3000 - far});
    }
}

QRAY_CASE(TriangleAsLargeAsTheWorldIsExact)
{
    constexpr int64_t n = NarrowFixed<N> ? 1024 : 4096;
    constexpr Flat corners[] = {{-62 * n, -62 * n + 1}, {62 * n, -61 * n}, {5, 62 * n - 3}};
    compare_with_integers<N>(check, corners, 3, n, n, figure_rays, {-62 * n, -62 * n}, {62 * n, 62 * n});
}

// A star between two squares on their corners.
QRAY_CASE(ConcavePolygonOf144CornersIsExact)
{
    constexpr int64_t n = NarrowFixed<N> ? 1024 : 4096;
    Flat star[144];
    for (int i = 0; i < 144; i++) {
        const int64_t reach = (i % 2 == 0 ? 40 : 17) * n, along = reach * (i % 36) / 36;
        const Flat p{reach - along, along};
        star[i] = i < 36 ? p : i < 72 ? Flat{-p.y, p.x} : i < 108 ? Flat{-p.x, -p.y} : Flat{p.y, -p.x};
    }
    compare_with_integers<N>(check, star, 144, n, n, figure_rays / 4, {-40 * n, -40 * n}, {40 * n, 40 * n});
}

// Corners in a line, and doubled ones: no parity is odd, whatever the ray.
QRAY_CASE(PolygonWithoutAreaIsNeverMet)
{
    QRAY_NAMES;
    constexpr Flat line[] = {{-4, -2}, {0, 0}, {4, 2}}, pairs[] = {{1, 1}, {3, 2}, {3, 2}, {1, 1}};
    Figure<N> in_a_line(line, 3, 1, 1), doubled(pairs, 4, 1, 1);
    for (int64_t x = -10; x <= 10; x++)
        for (int64_t y = -5; y <= 5; y++) {
            const Ray<N> ray = M::ray(M::point({x, y, 8}, 2), M::direction({0, 0, -1}));
            QRAY_HOLDS(!in_a_line.hit(ray, t));
            QRAY_HOLDS(!doubled.hit(ray, t));
        }
}

// Seen exactly edge on a polygon is a line, of which even parity is all there is.
QRAY_CASE(PolygonIsNotMetByARayInItsPlane)
{
    QRAY_NAMES;
    constexpr Flat corners[] = {{-4, -4}, {-4, 4}, {4, 4}, {4, -4}};
    Figure<N> s(corners, 4, 1, 1);
    for (int64_t x = -6; x <= 6; x++)
        for (int64_t y = -6; y <= 6; y++) {
            QRAY_HOLDS(!s.hit(M::ray(M::point({x, y, 0}), M::direction({1, 0, 0})), t));
            QRAY_HOLDS(!s.hit(M::ray(M::point({x, y, 0}), M::direction({4, -3, 0}, 5)), t));
        }
}

// Seen at 2^-30 (q16: 2^-14) from edge on: between its nearest and its farthest corner, if at all.
QRAY_CASE(PolygonAlmostEdgeOnIsMetWithinItself)
{
    QRAY_NAMES;
    constexpr Flat corners[] = {{-4, -4}, {-4, 4}, {4, 4}, {4, -4}};
    Figure<N> s(corners, 4, 1, 1);
    for (int64_t i = -100; i <= 100; i++) {
        Ray<N> ray = M::ray(M::point({-20, 1, 0}), M::direction({1, 0, 0}));
        ray.origin.z = number<Length>(i, int64_t{1} << (NarrowFixed<N> ? 10 : 24));
        ray.direction.z = number<Unit>(i < 0 ? 1 : -1, int64_t{1} << (NarrowFixed<N> ? 14 : 30));
        QRAY_HOLDS(!s.hit(ray, t) || (t >= number<Length>(16) && t <= number<Length>(24)));
    }
}

// --- Cylinder and cone

QRAY_CASE(CylinderIsNotMetAlongItsAxis)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(3, 4);
    for (int64_t x : List{0, 256, 511, 513, 1024}) // in 512ths
        for (int64_t z : List{-10, 0, 10})
            for (int64_t sign : List{-1, 1}) {
                const Ray<N> ray = M::ray(M::point({x, 0, z * 512}, 512), M::direction({0, 0, sign}));
                QRAY_HOLDS(!meets(check, s, ray, t));
            }
}

// In q16 a 256th.
QRAY_CASE(CylinderGrazedAFourmillionthInsideAndOutside)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(2, 3);
    const Length off = power_of_two<Length>(NarrowFixed<N> ? -8 : -22), one = number<Length>(1);
    for (int64_t z : List{-2, 0, 1})
        for (int64_t sign : List{-1, 1})
            for (bool inside : List{true, false}) {
                const Length edge = inside ? one - off : one + off;
                const Point<N> o{number<Length>(-5), sign < 0 ? -edge : edge, number<Length>(z, 2)};
                QRAY_HOLDS(meets(check, s, M::ray(o, M::direction({1, 0, 0})), t) == inside);
                QRAY_HOLDS(!inside || (t < number<Length>(5) && t > number<Length>(9, 2)));
            }
}

QRAY_CASE(CylinderHoldsItsRimsAndNothingBeyond)
{
    QRAY_NAMES;
    const Cone<N> s = M::cylinder(2, 3);
    for (int64_t sign : List{-1, 1}) {
        Point<N> o = M::point({-20, 1, 8 * sign}, 4);
        QRAY_HOLDS(meets(check, s, M::ray(o, M::direction({1, 0, 0})), t));
        o.z = sign < 0 ? o.z - ulp : o.z + ulp;
        QRAY_HOLDS(!meets(check, s, M::ray(o, M::direction({1, 0, 0})), t));
    }
}

// The cone of 3, 4 and 5: r = 3 at z = 0, the apex at 4.
template <class N>
constexpr Cone<N> cone345(Tag tag = make_tag(0, 0))
{
    return Make<N>::cone(2, 3, 2, 4, -3, 2, 4, tag);
}

// A little below the apex it is as wide as it takes, and above it there is nothing.
QRAY_CASE(ConeEndsAtItsApex)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length below = power_of_two<Length>(NarrowFixed<N> ? -5 : -10);
    const Length above = power_of_two<Length>(NarrowFixed<N> ? -5 : -16);
    for (const Triple& d : List{Triple{5, 0, 0}, Triple{0, -5, 0}, Triple{3, 4, 0}, Triple{-4, 3, 0}}) {
        Ray<N> ray = M::ray(M::point(Triple{0, 0, 4} - d), M::direction(d, 5));
        ray.origin.z = number<Length>(4) - below;
        QRAY_HOLDS(meets(check, s, ray, t) && t < number<Length>(5) && t > number<Length>(9, 2));
        ray.origin.z = number<Length>(4) + above;
        QRAY_HOLDS(!meets(check, s, ray, t));
    }
}

// A ray in the surface: it may be met or not, but then on the generator.
QRAY_CASE(ConeSeenAlongAGeneratorIsMetOnItOrNot)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    for (const Triple& base : List{Triple{3, 0, 0}, Triple{-3, 0, 0}, Triple{0, 3, 0}, Triple{0, -3, 0}}) {
        const Triple d = Triple{0, 0, 4} - base;
        const bool hit = meets(check, s, M::ray(M::point(base - d), M::direction(d, 5)), t);
        QRAY_HOLDS(!hit || (t >= number<Length>(499, 100) && t <= number<Length>(1001, 100)));
    }
}

// Parallel to a generator the quadratic is a line: from (3, 0, -2) through the base to the far wall, 25/4.
QRAY_CASE(ConeSeenParallelToAGenerator)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length little = number<Length>(256, int64_t{1} << fine_steps<N>);
    for (int turn = 0; turn < 4; turn++) {
        const int64_t x = turn == 0 ? 1 : turn == 1 ? -1 : 0, y = turn == 2 ? 1 : turn == 3 ? -1 : 0;
        const Ray<N> ray = M::ray(M::point({3 * x, 3 * y, -2}), M::direction({-3 * x, -3 * y, 4}, 5));
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(25, 4), little));
    }
}

QRAY_CASE(OtherNappeIsNeverMet)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    for (int64_t z : List{65, 72, 96, 128}) // in 16ths
        for (int64_t y : List{-8, 0, 3}) {
            QRAY_HOLDS(!meets(check, s, M::ray(M::point({-96, y, z}, 16), M::direction({1, 0, 0})), t));
            QRAY_HOLDS(!meets(check, s, M::ray(M::point({96, y, z}, 16), M::direction({-1, 0, 0})), t));
        }
}

// At z = 1 it is 9/4 wide.
QRAY_CASE(ConeSeenFromInsideIsMetOnce)
{
    QRAY_NAMES;
    const Cone<N> s = cone345<N>();
    const Length little = number<Length>(32, int64_t{1} << fine_steps<N>);
    for (const Triple& d : List{Triple{5, 0, 0}, Triple{0, -5, 0}, Triple{3, 4, 0}, Triple{-4, 3, 0}}) {
        const Ray<N> ray = M::ray(M::point({0, 0, 1}), M::direction(d, 5));
        QRAY_HOLDS(meets(check, s, ray, t) && near<N>(t, number<Length>(9, 4), little));
        QRAY_HOLDS(crossings(s, Corners<N>{}, ray, N::length_max) == 1);
    }
    QRAY_HOLDS(!meets(check, s, M::ray(M::point({0, 0, 1}), M::direction({0, 0, -1})), t));
}

// From the wall at z = 1 inward: across, up to the far wall, and down out of the open end.
QRAY_CASE(ConeEnteredFromBelowAndFromAbove)
{
    QRAY_NAMES;
    const Tag tag = make_tag(4, 0);
    const Cone<N> s = cone345<N>(tag);
    const Length little = number<Length>(64, int64_t{1} << fine_steps<N>);
    for (int turn = 0; turn < 4; turn++) {
        const int64_t x = turn == 0 ? 1 : turn == 1 ? -1 : 0, y = turn == 2 ? 1 : turn == 3 ? -1 : 0;
        const Point<N> wall = M::point({9 * x, 9 * y, 4}, 4);
        const auto inward = [&](int64_t across, int64_t up) {
            return M::ray(wall, M::direction({-across * x, -across * y, up}, 5), tag, false);
        };
        QRAY_HOLDS(meets(check, s, inward(5, 0), t) && near<N>(t, number<Length>(9, 2), little));
        QRAY_HOLDS(meets(check, s, inward(4, 3), t) && near<N>(t, number<Length>(18, 5), little));
        QRAY_HOLDS(!meets(check, s, inward(3, -4), t));
        Ray<N> out = inward(-5, 0);
        out.outward = true;
        QRAY_HOLDS(!meets(check, s, out, t));
    }
}

// --- Refraction and reflection

template <class N>
bool bend(Direction<N> d, Direction<N> n, int64_t eta, int64_t over, Direction<N>& out)
{
    auto ratio = number<typename N::Eta>(eta, over);
    hide(d);
    hide(n);
    hide(ratio);
    return refracted<N>(d, n, N::unit(dot<N>(d, n)), ratio, out);
}

// Out of 5/4, whose critical angle has a sine of 4/5: a millionth of a radian to either side; 1e-5 in float,
// a 64th in q16, whose directions do not tell less apart.
QRAY_CASE(RefractionAMillionthOffTheCriticalAngle)
{
    QRAY_NAMES;
    constexpr int64_t over = 1000000000;
    int64_t sines[2] = {799999400, 800000600}, cosines[2] = {600000800, 599999200};
    if (NarrowFixed<N>) {
        sines[0] = 790527720, cosines[0] = 612426250;
        sines[1] = 809276960, cosines[1] = 587427270;
    } else if (sizeof(Unit) == 4 && !N::is_fixed) {
        sines[0] = 799994000, cosines[0] = 600008000;
        sines[1] = 800006000, cosines[1] = 599992000;
    }
    for (int i = 0; i < 3; i++)
        for (int beyond_it = 0; beyond_it < 2; beyond_it++)
            for (int64_t sign : List{-1, 1}) {
                const Triple d = axes[i] * (-sign * cosines[beyond_it]) + axes[(i + 1) % 3] * sines[beyond_it];
                Direction<N> out{};
                const bool bent = bend<N>(M::direction(d, over), M::direction(axes[i] * sign), 5, 4, out);
                QRAY_HOLDS(bent == (beyond_it == 0));
            }
}

// In and out of a slab of index 2, with ratios that are exact.
QRAY_CASE(SlabLetsOutWhatCameInParallel)
{
    QRAY_NAMES;
    const Unit little = number<Unit>(8, int64_t{1} << unit_bits<N>);
    for (const Exact& e : directions) {
        const Direction<N> d = M::direction(e.d, e.over), n = M::direction(axes[0] * (e.d.x < 0 ? 1 : -1));
        if (e.d.x * e.d.x * 2 < e.over * e.over) // to 45 degrees
            continue;
        Direction<N> inside{}, out{};
        QRAY_HOLDS(bend<N>(d, n, 1, 2, inside) && bend<N>(inside, n, 2, 1, out));
        const Direction<N> off = out - d;
        QRAY_HOLDS(off.x <= little && -off.x <= little && off.y <= little && -off.y <= little && off.z <= little
                   && -off.z <= little);
    }
}

// |d|^2 stays within 2e-7 of 1; in q16 and float within some units of the last place.
QRAY_CASE(ThousandBouncesKeepTheDirectionUnit)
{
    QRAY_NAMES;
    Random random{93};
    Direction<N> d = M::direction({1, 2, 2}, 3);
    const auto one = N::one * N::one;
    const int64_t float_has = sizeof(Unit) == 4 && !N::is_fixed ? 20 : 2;
    const Unit little = NarrowFixed<N> ? number<Unit>(3, 1 << 14) : number<Unit>(float_has, 10000000);
    const auto most = N::one * little;
    for (int i = 0; i < 1000; i++) {
        Direction<N> n = d;
        const Point<N> to = M::point({random.in(-999, 999), random.in(-999, 999), random.in(1, 999)}, 64);
        QRAY_HOLDS(normalise<N>(to, n));
        hide(d);
        d = mirrored<N>(d, n, N::unit(dot<N>(d, n)));
        const auto square = d.x * d.x + d.y * d.y + d.z * d.z;
        QRAY_HOLDS(square - one <= most && one - square <= most);
    }
}

// Back and forth between two balls, along the line of their centres, from a direction that is too long by
// some steps: what a normal takes over from a direction must not grow.
QRAY_CASE(ThousandBouncesBetweenTwoBallsKeepTheDirectionUnit)
{
    QRAY_NAMES;
    const Tag tags[2] = {make_tag(0, 0), make_tag(1, 0)};
    const Sphere<N> balls[2] = {M::sphere(M::point({-5, 0, 0}), 1, 1, tags[0]),
                                M::sphere(M::point({5, 0, 0}), 2, 1, tags[1])};
    const auto one = N::one * N::one;
    const int64_t float_has = sizeof(Unit) == 4 && !N::is_fixed ? 20 : 2;
    const Unit little = NarrowFixed<N> ? number<Unit>(5, 1 << 14) : number<Unit>(float_has, 10000000);
    Ray<N> ray = M::ray(M::point({0, 0, 0}), M::direction({1, 0, 0}));
    ray.direction.x = ray.direction.x + number<Unit>(2, int64_t{1} << unit_bits<N>);
    for (int i = 0; i < 1000; i++) {
        const Sphere<N>& s = balls[(i + 1) % 2];
        hide(ray);
        Local<N> local{};
        const bool hit = intersect(s, Corners<N>{}, ray, N::length_max, t, local);
        QRAY_HOLDS(hit);
        if (!hit)
            return;
        Point<N> q{};
        Direction<N> n{};
        surface_of(s, Corners<N>{}, ray, t, local, q, n);
        const auto n_d = N::unit(dot<N>(n, ray.direction));
        ray = M::ray(step_off<N>(q, n, true), mirrored<N>(ray.direction, n, n_d), tags[(i + 1) % 2], true);
        const auto d = ray.direction;
        const auto square = d.x * d.x + d.y * d.y + d.z * d.z;
        QRAY_HOLDS(square - one <= N::one * little && one - square <= N::one * little);
    }
}

// --- Texture

// Cells of 2^-15 (q16: 1), at lattice points and one step before them, up to 2^20 cells away.
QRAY_CASE(TextureCellsAMillionAwayAreRight)
{
    QRAY_NAMES;
    LatticeAxis<N> axis{};
    int cells = 15;
    if constexpr (NarrowFixed<N>) {
        axis.row_x = 1;
        axis.frac = 10;
        cells = 0;
    } else if constexpr (N::is_fixed) {
        axis.row_x = 1 << 30;
        axis.shift = -7;
    } else {
        axis.row_x = power_of_two<Length>(cells);
    }
    hide(axis);
    constexpr int most = 1 << 20;
    for (int64_t cell : List{0, 1, -1, 2, -2, 3, -7, 1000, -1000, 65535, -65536, most, -most, most - 1}) {
        if (NarrowFixed<N> && (cell > 62 || cell < -62))
            continue;
        Point<N> q{number<Length>(cell, int64_t{1} << cells), Length{}, Length{}};
        hide(q);
        const Cell<N> here = axis.cell(q);
        QRAY_HOLDS(here.index == static_cast<uint32_t>(cell) && here.inside == Unit{});
        if (!N::is_fixed)
            continue;
        q.x = q.x - ulp;
        QRAY_HOLDS(axis.cell(q).index == static_cast<uint32_t>(cell - 1));
    }
}

// --- Range

QRAY_CASE(MostNegativeIntegers)
{
    int32_t least = INT32_MIN, most = INT32_MAX, one = 1;
    hide(least);
    hide(most);
    hide(one);
    QRAY_HOLDS(q32::magnitude(least) == 0x80000000u);
    QRAY_HOLDS(wide_mul(least, least) == int64_t{1} << 62);
    QRAY_HOLDS(wide_mul(least, most) == -(int64_t{1} << 62) + (int64_t{1} << 31));
    QRAY_HOLDS(wide_mul(most, most) == (int64_t{1} << 62) - (int64_t{1} << 32) + 1);
    QRAY_HOLDS(wide_mul(least, -one) == int64_t{1} << 31);
    QRAY_HOLDS(wide_square(least) == uint64_t{1} << 62);
    QRAY_HOLDS(saturating_sub(least, most) == INT32_MIN + 1); // whose negative is a number
    QRAY_HOLDS(saturating_sub(0, least) == INT32_MAX);
    QRAY_HOLDS(saturating_add(least, least) == INT32_MIN + 1);
    int64_t longest = INT64_MIN;
    hide(longest);
    QRAY_HOLDS(q32::magnitude(longest) == uint64_t{1} << 63);
    QRAY_HOLDS(divide(longest, 1, 0) == -INT32_MAX);
    QRAY_HOLDS(divide(longest, 0xffffffffu, 32) == -INT32_MAX);
    QRAY_HOLDS(divide(int64_t{one}, 0, 0) == INT32_MAX);
}

QRAY_CASE(DotsOfThreeMaxima)
{
    int32_t least = INT32_MIN, most = INT32_MAX, third = 619925131; // 2^30 / sqrt 3
    hide(least);
    hide(most);
    hide(third);
    QRAY_HOLDS(wide_norm2(least, least, least) == uint64_t{3} << 62);
    QRAY_HOLDS(wide_norm2(most, most, most) == 3 * ((uint64_t{1} << 62) - (uint64_t{1} << 32) + 1));
    // 3 (2^31 - 1) 2^30 / sqrt 3 < 2^63
    const int64_t expected = 3 * ((int64_t{619925131} << 31) - 619925131);
    QRAY_HOLDS(wide_dot(most, most, most, third, third, third) == expected);
    QRAY_HOLDS(wide_dot(-most, -most, -most, third, third, third) == -expected);
}

QRAY_CASE(NormaliseOfASingleRawUnit)
{
    QRAY_NAMES;
    const Unit little = number<Unit>(1, int64_t{1} << unit_bits<N>);
    Length step = N::is_fixed ? N::ulp : power_of_two<Length>(-60);
    hide(step);
    const Point<N> off = {step, step, step};
    Direction<N> u{};
    QRAY_HOLDS(normalise<N>(Point<N>{step, Length{}, Length{}}, u) && u.x >= N::one - little && u.x <= N::one);
    QRAY_HOLDS(u.y == Unit{} && u.z == Unit{});
    QRAY_HOLDS(normalise<N>(Point<N>{Length{}, -step, Length{}}, u) && -u.y >= N::one - little
               && -u.y <= N::one);
    // 0.577350269189625...
    const Unit third = number<Unit>(577350269, 1000000000);
    QRAY_HOLDS(normalise<N>(off, u) && u.x == u.y && u.y == u.z && u.x - third <= little + little
               && third - u.x <= little + little);
}

QRAY_CASE(NormaliseOfZeroIsRefused)
{
    QRAY_NAMES;
    Direction<N> u = M::direction({0, 0, 1});
    Point<N> zero{};
    hide(zero);
    QRAY_HOLDS(!normalise<N>(zero, u) && u == M::direction({0, 0, 1}));
}

QRAY_CASE(RootsOfZeroAndOfTheLargestArea)
{
    QRAY_NAMES;
    for (int64_t root : List{0, 1, 2, 5, 11, 45, 120}) {
        if (root > (ShortFixed<N> ? 45 : NarrowFixed<N> ? 5 : 120)) // q16 squares no more than 46340 steps, q24 370727
            continue;
        Length r = number<Length>(root);
        hide(r);
        QRAY_HOLDS(N::sqrt(r * r) == r);
    }
}

// --- Colour

QRAY_CASE(PowersNearOneAndOfZero)
{
    QRAY_NAMES;
    const auto power = [](Unit x, uint32_t whole, bool half) {
        typename N::Shine e{};
        e.whole = whole;
        if constexpr (N::is_fixed)
            e.fraction = half ? uint32_t{1} << 31 : 0;
        else
            e.fraction = half ? Unit(0.5) : Unit(0);
        hide(x);
        hide(e);
        return N::power(x, e);
    };
    QRAY_HOLDS(power(Unit{}, 0, false) == N::one);
    QRAY_HOLDS(power(Unit{}, 1, false) == Unit{});
    QRAY_HOLDS(power(Unit{}, 0, true) == Unit{});
    for (int64_t x : List{0, 1, 100, 500, 1000})
        QRAY_HOLDS(power(number<Unit>(x, 1000), 0, false) == N::one);
    QRAY_HOLDS(power(N::one, 1000000, false) == N::one);
    QRAY_HOLDS(power(N::one, 1000000, true) == N::one);
    if constexpr (!NarrowFixed<N>) { // (1 - 2^-16)^10000 = 0.858482438578...
        const Unit found = power(N::one - power_of_two<Unit>(-16), 10000, false);
        const Unit expected = number<Unit>(858482439, 1000000000);
        const Unit fixed_little = power_of_two<Unit>(-28) + power_of_two<Unit>(-30);
        const Unit little = N::is_fixed ? fixed_little : number<Unit>(6, 10000);
        QRAY_HOLDS(found - expected <= little && expected - found <= little);
    }
}

// All of them.
#define QRAY_CATALOGUE(X)                            \
    X(SphereTouchedByATangentOfIntegers)             \
    X(SphereAimedAMillionthOfItsRadiusBesideItsEdge) \
    X(SphereOfAnEleventhousandthOfItsDistance)       \
    X(SphereSeenFromAnywhereBesideItsEdge)           \
    X(SmallSphereSeenFromAnywhereBesideItsEdge)      \
    X(SphereSeenFromItsCentreIsItsRadiusAway)        \
    X(SphereBehindIsNotMet)                          \
    X(ConcentricSpheresAMillionthApartAreMetInOrder) \
    X(ShellOfAMillionthIsCrossedFaceByFace)          \
    X(SphereLeftAlmostAlongItsTangentIsNotMetAgain)  \
    X(SphereEnteredIsMetAtTheFarEndOfTheChord)       \
    X(PlaneParallelToTheRayIsMissed)                 \
    X(PlaneAtASlopeOfABillionthIsMetWhereItShouldBe) \
    X(DiscExactlyAtTheLimitIsMet)                    \
    X(PlaneThroughTheOriginOfARayIsNotMet)           \
    X(DiscHoldsItsRimAndNothingBeyond)               \
    X(RayThroughACornerOfSixTrianglesHasOneOwner)    \
    X(SliverOf50ByAHundredthousandthIsExact)         \
    X(TriangleOfAFiveThousandthIsExact)              \
    X(TriangleAsLargeAsTheWorldIsExact)              \
    X(ConcavePolygonOf144CornersIsExact)             \
    X(PolygonWithoutAreaIsNeverMet)                  \
    X(PolygonIsNotMetByARayInItsPlane)               \
    X(PolygonAlmostEdgeOnIsMetWithinItself)          \
    X(CylinderIsNotMetAlongItsAxis)                  \
    X(CylinderGrazedAFourmillionthInsideAndOutside)  \
    X(CylinderHoldsItsRimsAndNothingBeyond)          \
    X(ConeEndsAtItsApex)                             \
    X(ConeSeenAlongAGeneratorIsMetOnItOrNot)         \
    X(ConeSeenParallelToAGenerator)                  \
    X(OtherNappeIsNeverMet)                          \
    X(ConeSeenFromInsideIsMetOnce)                   \
    X(ConeEnteredFromBelowAndFromAbove)              \
    X(RefractionAMillionthOffTheCriticalAngle)       \
    X(SlabLetsOutWhatCameInParallel)                 \
    X(ThousandBouncesKeepTheDirectionUnit)           \
    X(ThousandBouncesBetweenTwoBallsKeepTheDirectionUnit) \
    X(TextureCellsAMillionAwayAreRight)              \
    X(MostNegativeIntegers)                          \
    X(DotsOfThreeMaxima)                             \
    X(NormaliseOfASingleRawUnit)                     \
    X(NormaliseOfZeroIsRefused)                      \
    X(RootsOfZeroAndOfTheLargestArea)                \
    X(PowersNearOneAndOfZero)

} // namespace catalogue
