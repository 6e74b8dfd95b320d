// Point lights.
#pragma once

#include "../vector/ray.hpp"

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

} // namespace qray
