// Mirrored rays.
#pragma once

#include "ray.hpp"

namespace qray {

template <class N>
struct Mirror {
    typename N::Unit amount;
};

// d - 2 (n.d) n. A reflection keeps length: nothing is divided.
template <class N>
QRAY_INLINE constexpr Direction<N> mirrored(const Direction<N>& d, const Direction<N>& n, typename N::Unit n_d)
{
    const auto twice = n_d + n_d;
    return d - scaled<N>(twice, n);
}

} // namespace qray
