// Value noise (scenes/README.md, section 4). For the noise texture, marble and wood.
#pragma once

#include "../number/hash.hpp"
#include "lattice.hpp"

namespace qray {

// The value at an integer corner, in [0, 1).
template <class N>
constexpr typename N::Unit lattice_noise(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t h = 0;
    hash(x, y, z, h);
    if constexpr (N::is_fixed) {
        constexpr int shift = 24 - N::Unit::frac;
        const uint32_t v = h >> 8;
        return {static_cast<int32_t>(shift > 0 ? v >> (shift > 0 ? shift : 0) : v << (shift > 0 ? 0 : -shift))};
    } else {
        return static_cast<typename N::Unit>(h >> 8) / typename N::Unit(1 << 24);
    }
}

template <class N>
constexpr typename N::Unit half(typename N::Unit v)
{
    if constexpr (N::is_fixed)
        return {v.raw >> 1};
    else
        return v / 2;
}

// 3 f^2 - 2 f^3.
template <class N>
constexpr typename N::Unit smoothstep(typename N::Unit f)
{
    const auto g = N::unit(f * f);
    return g + N::unit(g * (N::one - f)) + N::unit(g * (N::one - f));
}

// The trilinear blend of the eight corners of a cell. Error at most 8 ulp of Unit.
template <class N>
constexpr typename N::Unit noise(const Cell<N>& x, const Cell<N>& y, const Cell<N>& z)
{
    const auto u = smoothstep<N>(x.inside), v = smoothstep<N>(y.inside), w = smoothstep<N>(z.inside);
    typename N::Unit along_z[2]{};
    for (uint32_t k = 0; k < 2; k++) {
        typename N::Unit along_y[2]{};
        for (uint32_t j = 0; j < 2; j++)
            along_y[j] = blend<N>(lattice_noise<N>(x.index, y.index + j, z.index + k),
                                  lattice_noise<N>(x.index + 1, y.index + j, z.index + k), u);
        along_z[k] = blend<N>(along_y[0], along_y[1], v);
    }
    return blend<N>(along_z[0], along_z[1], w);
}

} // namespace qray
