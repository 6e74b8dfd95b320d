// Mirrored rays.
#pragma once

#include "ray.hpp"

namespace qray {

template <class N>
struct Mirror {
    typename N::Unit amount;
};

// d - 2 (d.n) n. A reflection keeps length: no rounding but the last.
template <class N>
QRAY_INLINE constexpr Direction<N> mirrored(const Direction<N>& d, const Direction<N>& n)
{
    const auto k = N::unit(dot<N>(d, n));
    const auto once = scaled<N>(k, n);
    return d - once - once;
}

} // namespace qray
