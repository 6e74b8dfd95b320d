// The mirrored direction: for mirrors, and for total internal reflection.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// d - 2 (n.d) n. A reflection keeps length, but for rounding, which must not add up from mirror to mirror.
template <class N>
QRAY_INLINE constexpr Direction<N> mirrored(const Direction<N>& d, const Direction<N>& n, typename N::Unit n_d)
{
    const Direction<N> once = scaled<N>(n_d, n); // twice it may be 2, which Unit does not hold
    Direction<N> out = d - once - once;
    sharpen<N>(out);
    return out;
}

} // namespace qray
