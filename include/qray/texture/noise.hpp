// Noise: a blend from M to N.
#pragma once

#include "value_noise.hpp"

namespace qray {

template <class N>
struct Noise {
    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        return blend<N>(m, colour, noise<N>(lattice.x.cell(q.x), lattice.y.cell(q.y), lattice.z.cell(q.z)));
    }
};

} // namespace qray
