// Rings around the y axis: M or N by the parity of the distance from it.
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Rings {
    static constexpr TextureText text = TextureText::cells;

    Vec<typename N::Unit> colour; // N
    LatticeAxis<N> x, z;

    template <class Make>
    static Rings made(const Make& make)
    {
        return {make.colour(), make.along_x(), make.along_z()};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        return radial_cell<N>(x.bounded(q), z.bounded(q), true).index & 1 ? colour : m;
    }
};

} // namespace qray
