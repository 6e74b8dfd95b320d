// Random numbers, vectors in an oracle's arithmetic, and the way between a number system and the reals.
#pragma once

#include <cmath>
#include <cstdint>

#include <qray/surface/reflection.hpp>

#include "../random.hpp"
#include "../reals.hpp"
#include "scene/convert.hpp"

namespace hostile {

using Wide = long double;
using Quad = __float128;

struct Random : SplitMix {
    explicit Random(uint64_t seed) : SplitMix{seed} {}
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double in(double low, double high) { return low + (high - low) * unit(); }
    double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>((bits() >> 32) * n >> 32); }
    bool chance(double p) { return unit() < p; }
};

template <class R>
using Vec3 = qray::Vec<R>;
using qray::test::operator*;
using qray::test::cross;
using qray::test::dot;
using qray::test::length;
using qray::test::root;
template <class R>
R size(R v)
{
    return v < 0 ? -v : v;
}
using Double3 = qray::scene::Vec3d;

inline Double3 direction(Random& random)
{
    for (;;) {
        const Double3 d{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
        const double l = length(d);
        if (l <= 1 && l > 0.01)
            return d * (1 / l);
    }
}
inline Double3 in_ball(Random& random, double radius)
{
    for (;;) {
        const Double3 d{random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)};
        if (length(d) <= 1)
            return d * radius;
    }
}
// A unit vector across n.
inline Double3 across(Random& random, const Double3& n)
{
    using namespace qray::scene;
    for (;;) {
        const Double3 d = direction(random);
        const Double3 a = d - n * dot(d, n);
        if (length(a) > 0.1)
            return unit(a);
    }
}

// The exact value of a number.
template <class R, class T>
R exact(T v)
{
    if constexpr (requires { v.raw; })
        return static_cast<R>(v.raw) / static_cast<R>(int64_t{1} << T::frac);
    else
        return static_cast<R>(v);
}
template <class R, class T>
Vec3<R> exact3(const qray::Vec<T>& v)
{
    return {exact<R>(v.x), exact<R>(v.y), exact<R>(v.z)};
}

template <class R>
R two_to(int power)
{
    return power >= 0 ? R(int64_t{1} << power) : R(1) / R(int64_t{1} << -power);
}

// The centre of a curved shape, of which `point` is the rounding.
template <class R, class N, class Shape>
Vec3<R> exact_centre(const qray::Point<N>& point, [[maybe_unused]] const Shape& shape)
{
    Vec3<R> c = exact3<R>(point);
    if constexpr (requires { shape.rounded.x; }) {
        const R step = R(1) / (R(int64_t{1} << N::Length::frac) * two_to<R>(shape.fine));
        c = c - Vec3<R>{R(shape.rounded.x), R(shape.rounded.y), R(shape.rounded.z)} * step;
    }
    return c;
}

// The spacing of lengths as they occur in a world of +-62: of float and double, of numbers of 32 to 64.
template <class N>
constexpr double ulp()
{
    if constexpr (N::is_fixed)
        return 1.0 / static_cast<double>(int64_t{1} << N::Length::frac);
    else
        return sizeof(typename N::Length) == 4 ? 0x1p-18 : 0x1p-47;
}

template <class N>
qray::Point<N> to_point(const Double3& p)
{
    return qray::scene::Convert<N>::point(p);
}
template <class N>
qray::Direction<N> to_direction(const Double3& d)
{
    return qray::scene::Convert<N>::direction(qray::scene::unit(d));
}
// A direction as a tracer has it: made unit by the number system, and now and then mirrored 16 times.
template <class N>
qray::Direction<N> made_direction(Random& random, const Double3& d)
{
    using namespace qray::scene;
    Double3 from = unit(d);
    Double3 mirrors[16];
    const int bounces = random.chance(0.125) ? 16 : 0;
    for (int i = 0; i < bounces; i++) {
        mirrors[i] = direction(random);
        from = from - mirrors[i] * (2 * dot(from, mirrors[i]));
    }
    qray::Direction<N> u = Convert<N>::direction(from * random.in(0.5, 1));
    qray::normalise<N>(u, u);
    for (int i = bounces - 1; i >= 0; i--) {
        const auto n = to_direction<N>(mirrors[i]);
        u = qray::mirrored<N>(u, n, N::unit(qray::dot<N>(u, n)));
    }
    return u;
}

// How rays are thrown at a shape. Needles are figures up to 10^5 times as long as they are wide.
enum class Regime { ordinary, small_far, grazing, needle };
inline constexpr const char* regime_names[4] = {"ordinary", "small and far", "grazing", "needle"};

template <class N>
qray::Ray<N> free_ray(Random& random, const Double3& from, const Double3& towards)
{
    return {to_point<N>(from), made_direction<N>(random, towards), {qray::Tag::none}, false};
}

// All points lie in a ball of this radius.
inline constexpr double world = 62;

// The meetings of a line with a surface without its rims: how many, at which t, how far within the rims (negative:
// outside them), and how steeply: the sine of the angle at which the line goes through, so that a surface that is off
// by h is met h / steep sooner or later.
template <class R>
struct Meetings {
    int count = 0;
    R t[2]{};
    R within[2]{};
    R steep[2]{};
    void add(R at, R inside, R sine)
    {
        t[count] = at;
        within[count] = inside;
        steep[count] = sine;
        count++;
    }
    void sort()
    {
        if (count == 2 && t[1] < t[0]) {
            std::swap(t[0], t[1]);
            std::swap(within[0], within[1]);
            std::swap(steep[0], steep[1]);
        }
    }
    // Is meeting i within the rims or without them, and ahead or behind, whatever errors of a few ulp do?
    bool certain(int i, R few) const
    {
        const R along = few * (1 + 1 / (steep[i] > few ? steep[i] : few));
        return size(within[i]) > along && size(t[i]) > along;
    }
};

} // namespace hostile
