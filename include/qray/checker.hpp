// Checker: M or N by the parity of the three cell numbers.
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Checker {
    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;           // offsets hold epsilon

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        if constexpr (in_lanes<N> && !N::is_fixed) {
            uint32_t sum = 0;
            if (lane_cell_sum(lattice.x, lattice.y, lattice.z, q, sum))
                return sum & 1 ? colour : m;
        }
        const uint32_t cells = lattice.x.cell(q.x).index + lattice.y.cell(q.y).index + lattice.z.cell(q.z).index;
        return cells & 1 ? colour : m;
    }
};

} // namespace qray
