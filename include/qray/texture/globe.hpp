// Globe: texels by longitude, around an axis along y, and latitude, as seen from a centre.
#pragma once

#include "../number/angle.hpp"
#include "../vector/ray.hpp"
#include "texels.hpp"

namespace qray {

template <class N>
struct Globe {
    static constexpr TextureText text = TextureText::globe;

    Point<N> centre; // in units of 2^shift lengths
    int32_t shift;   // in [0, 30]; 0 in floating point
    Texels<N> texels;

    template <class Make>
    static Globe made(const Make& make)
    {
        const auto [centre, shift] = make.centre();
        return {centre, shift, make.texels()};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>&, const Point<N>& q) const
    {
        if constexpr (N::is_fixed) {
            // To 14 bits, or 30.
            const Point<N> v = coarse<N>(q, shift) - centre;
            const uint32_t all = magnitude(v.x.raw) | magnitude(v.y.raw) | magnitude(v.z.raw) | 1;
            const int up = count_leading_zeros(all) - (ShortFixed<N> ? 18 : 2), down = up < 0 ? -up : 0;
            const auto fitted = [up, down](int32_t c) { return up > 0 ? c * (1 << up) : c >> down; };
            return seen(fitted(v.x.raw), fitted(v.y.raw), fitted(v.z.raw));
        } else {
            Direction<N> e{};
            normalise<N>(q - centre, e);
            const auto whole = [](typename N::Unit c) { return static_cast<int32_t>(c * (1 << 30)); };
            return seen(whole(e.x), whole(e.y), whole(e.z));
        }
    }

private:
    constexpr Vec<typename N::Unit> seen(int32_t x, int32_t y, int32_t z) const
    {
        constexpr uint32_t half = uint32_t{1} << 31;
        const uint32_t up = half / 2 + static_cast<uint32_t>(arc_sine<ShortFixed<N>>(x, y, z)); // to half: the top row
        return texels.at(half + arc_tangent2<ShortFixed<N>>(x, z), (up < half ? up : half - 1) << 1);
    }
};

} // namespace qray
