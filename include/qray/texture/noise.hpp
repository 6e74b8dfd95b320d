// Noise: a blend from M to N.
#pragma once

#include "value_noise.hpp"

namespace qray {

template <class N>
struct Noise {
    static constexpr TextureText text = TextureText::cells;

    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;

    template <class Make>
    static Noise made(const Make& make)
    {
        return {make.colour(), make.lattice(false)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        return blend<N>(m, colour, noise<N>(lattice.x.cell(q.x), lattice.y.cell(q.y), lattice.z.cell(q.z)));
    }
};

} // namespace qray
