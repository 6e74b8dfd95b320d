// Point lights.
#pragma once

#include "../vector/motion.hpp"

namespace qray {

// A light that stands far outside has a scale of its own: `at` is in units of 2^shift lengths. It only gives a
// direction, and a distance beyond which nothing is in its way.
template <class N>
struct Light {
    static constexpr bool has_place = true; // it may lie on a surface

    Point<N> at;
    int32_t shift; // in [0, 30]; 0 in floating point
    Rgb<N> colour;
};

// The unit vector from q to the light, and its distance, clamped to the range of Length; false where the light
// stands at q itself.
template <class N>
QRAY_INLINE constexpr bool towards(const Light<N>& light, const Point<N>& q, Direction<N>& l,
                                   typename N::Length& distance)
{
    if constexpr (N::is_fixed) {
        const int s = light.shift;
        const Point<N> v = light.at - coarse<N>(q, s);
        if (!normalise<N>(v, l))
            return false;
        const typename N::Moment reach = dot<N>(v, l), most = N::length_max * N::one;
        const int32_t d = reach < most ? N::length(reach).raw : N::length_max.raw; // v may be longer than a Length
        distance = d > N::length_max.raw >> s ? N::length_max : typename N::Length{d << s};
        return true;
    } else {
        const Point<N> v = light.at - q;
        if (!normalise<N>(v, l))
            return false;
        distance = dot<N>(v, l);
        return true;
    }
}

// The lamp that the text has as `l` at this place. False, and nothing changes, where that is too far away.
template <class N>
constexpr bool place(Light<N>& light, const Frame<N>& frame, const ScenePoint<N>& at)
{
    using Length = typename N::Length;
    Point<N> p = frame.point(at);
    int32_t shift = 0;
    if constexpr (N::is_fixed) {
        constexpr int32_t world = 62 << Length::frac;
        const auto inside = [&p] {
            const auto fits = [](Length v) { return v.raw <= world && v.raw >= -world; };
            return NarrowFixed<N> ? wide_norm2(p.x.raw, p.y.raw, p.z.raw) <= wide_square(world)
                                  : fits(p.x) && fits(p.y) && fits(p.z);
        };
        for (; !inside(); p = frame.point(at, shift))
            if (++shift > 30)
                return false;
    } else {
        constexpr Length least = Length(1) / Length(int64_t{1} << 38), most = Length(int64_t{1} << 60);
        const auto off_zero = [](Length& v) {
            if (N::absolute(v) < least)
                v = N::negative(v) ? -least : least;
            return N::absolute(v) <= most;
        };
        if (sizeof(Length) == 4 ? !off_zero(p.x) || !off_zero(p.y) || !off_zero(p.z) : !(norm2<N>(p) <= most * most))
            return false;
    }
    light.at = p;
    light.shift = shift;
    return true;
}

// False, and nothing changes, where it leaves the world; also of one that stands outside of it: place() moves these.
template <class N>
constexpr bool move(const Light<N>& from, const Motion<N>& motion, Light<N>& to)
{
    const Point<N> at = motion(from.at);
    if (!motion.valid() || from.shift != 0 || !ball_in_world<N>(at))
        return false;
    to = from;
    to.at = at;
    return true;
}

} // namespace qray
