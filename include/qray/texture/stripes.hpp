// Stripes across an axis: M or N by the parity of the cell number along it.
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Stripes {
    static constexpr TextureText text = TextureText::cells_along;

    Vec<typename N::Unit> colour; // N
    LatticeAxis<N> axis;          // offset holds epsilon

    template <class Make>
    static Stripes made(const Make& make)
    {
        return {make.colour(), make.along_axis(true, true)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        return axis.cell(q).index & 1 ? colour : m;
    }
};

} // namespace qray
