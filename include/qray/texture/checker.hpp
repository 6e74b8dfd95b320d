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
        const Vec<typename N::Unit>& of_cell = lattice.parity(q) & 1 ? colour : m;
        return parts_of(of_cell);
    }
};

} // namespace qray
