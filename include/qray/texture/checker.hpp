// Checker: M or N by the parity of the three cell numbers.
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Checker {
    static constexpr TextureText text = TextureText::cells;

    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;           // offsets hold epsilon

    template <class Make>
    static Checker made(const Make& make)
    {
        return {make.colour(), make.lattice(true)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        const Vec<typename N::Unit>& of_cell = lattice.parity(q) & 1 ? colour : m;
        return parts_of(of_cell);
    }
};

} // namespace qray
