// Refracted rays, and what total internal reflection does to the mirrored one.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Transmit {
    typename N::Unit amount;
    typename N::Eta into;  // 1 / ior: for a ray against the outward normal
    typename N::Eta out;   // ior
};

// With n turned against d: e = eta (d - (d.n) n), refracted = e - sqrt(1 - |e|^2) n, made unit: the
// formula of scenes/README.md, section 3, without its cancellation at steep angles. False where |e| > 1: total
// internal reflection.
template <class N>
constexpr bool refracted(const Direction<N>& d, const Direction<N>& n, typename N::Unit n_d, typename N::Eta eta,
                         Direction<N>& out)
{
    const Direction<N> across = d - scaled<N>(n_d, n);
    const Direction<N> e{N::bent(eta, across.x), N::bent(eta, across.y), N::bent(eta, across.z)};
    const auto k = N::one * N::one - dot<N>(e, e);
    if (k < typename N::Cosine{})
        return false;
    const auto root = N::sqrt_unit(k);
    normalise<N>(e - scaled<N>(root, n), out);
    return true;
}

} // namespace qray
