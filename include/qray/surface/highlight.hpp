// Phong's highlight: amount * max(0, r.v)^shine, with r the mirrored direction to the light.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Highlight {
    typename N::Unit amount;
    typename N::Shine shine; // in [0, 10^6]
};

// r.v for the unit vectors l (to the light) and d = -v, with n.l > 0 and n.d: clamped to [0, 1].
template <class N>
QRAY_INLINE constexpr typename N::Unit mirrored_cosine(const Direction<N>& l, const Direction<N>& d,
                                                       typename N::Unit n_l, typename N::Unit n_d)
{
    // r.v = 2 (n.l)(n.v) - l.v
    const auto product = n_l * n_d;
    const auto r_v = N::unit(dot<N>(l, d) - product - product);
    return r_v < N::zero ? N::zero : r_v > N::one ? N::one : r_v;
}

} // namespace qray
