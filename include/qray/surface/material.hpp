// What a surface is made of, part by part: a material's number indexes one table for each part that the scene
// calls for. Coefficients and colours are in [0, 1].
#pragma once

#include "../vector/frame.hpp"

namespace qray {

template <class N>
struct Matte {
    Vec<typename N::Unit> colour; // M, unless a texture gives it
    Rgb<N> ambient;               // what no light gives: the ambient light times the coefficient, and emission
    typename N::Unit diffuse;
};

// In this colour, each part from 0 to 1; false, and nothing changes, beyond that.
template <class N>
constexpr bool paint(Matte<N>& matte, const ScenePoint<N>& colour)
{
    const auto is_share = [](Coordinate<N> c) { return c >= Coordinate<N>{} && c <= coordinate<N>(1); };
    if (!is_share(colour.x) || !is_share(colour.y) || !is_share(colour.z))
        return false;
    const auto unit = [](Coordinate<N> c) -> typename N::Unit {
        if constexpr (N::is_fixed)
            return {detail::shifted_even(c.raw, N::Unit::frac - Coordinate<N>::frac)};
        else
            return c;
    };
    matte.colour = {unit(colour.x), unit(colour.y), unit(colour.z)};
    return true;
}

} // namespace qray
