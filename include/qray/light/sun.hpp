// Directional lights.
#pragma once

#include "../vector/motion.hpp"

namespace qray {

template <class N>
struct Sun {
    static constexpr bool has_place = false;

    Direction<N> from; // unit, towards the light
    Rgb<N> colour;
};

template <class N>
QRAY_INLINE constexpr bool towards(const Sun<N>& sun, const Point<N>&, Direction<N>& l, typename N::Length& distance)
{
    l = sun.from;
    distance = N::length_max;
    return true;
}

// The sun that the text has in this direction. False, and nothing changes, where that is none.
template <class N>
constexpr bool place(Sun<N>& sun, const ScenePoint<N>& from)
{
    Direction<N> d{};
    if constexpr (N::is_fixed) {
        int32_t u[3]{};
        if (!unit_vector(from.x.raw, from.y.raw, from.z.raw, u)) // Q2.30
            return false;
        constexpr int down = 30 - N::Unit::frac;
        const auto unit = [](int32_t v) { return typename N::Unit{(v + (1 << down >> 1)) >> down}; };
        d = {unit(u[0]), unit(u[1]), unit(u[2])};
    } else if (!normalise_short<N>(from, d) || !(norm2<N>(d) > N::one / 2)) {
        return false;
    }
    sun.from = d;
    return true;
}

template <class N>
constexpr bool move(const Sun<N>& from, const Motion<N>& motion, Sun<N>& to)
{
    if (!motion.valid())
        return false;
    to = {motion.direction(from.from), from.colour};
    return true;
}

} // namespace qray
