// Gradient along an axis, from M at 0 to N at 1.
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Gradient {
    static constexpr TextureText text = TextureText::cells_along;

    Vec<typename N::Unit> colour; // N
    LatticeAxis<N> axis;

    template <class Make>
    static Gradient made(const Make& make)
    {
        return {make.colour(), make.along_axis(false, false)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        return blend<N>(m, colour, axis.clamped(q));
    }
};

} // namespace qray
