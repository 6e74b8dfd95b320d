// The mirrored direction: for mirrors, and for total internal reflection.
#pragma once

#include "ray.hpp"

namespace qray {

// d - 2 (n.d) n. A reflection keeps length, but for rounding, which must not add up from mirror to mirror.
template <class N>
QRAY_INLINE constexpr Direction<N> mirrored(const Direction<N>& d, const Direction<N>& n, typename N::Unit n_d)
{
    const auto twice = n_d + n_d;
    Direction<N> out = d - scaled<N>(twice, n);
    N::sharpen(out.x, out.y, out.z);
    return out;
}

} // namespace qray
