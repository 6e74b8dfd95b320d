// Wood: growth rings around an axis through the origin, uneven by noise (scenes/README.md defines it).
#pragma once

#include "value_noise.hpp"

namespace qray {

template <class N>
struct Wood {
    static constexpr TextureText text = TextureText::cells_along;

    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;
    LatticeAxis<N> e1, e2; // across the grain

    template <class Make>
    static Wood made(const Make& make)
    {
        return {make.colour(), make.lattice(false), make.across_axis(0), make.across_axis(1)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        const Cell<N> ring = radial_cell<N>(e1.bounded(q), e2.bounded(q), false);
        auto w = ring.inside + half<N>(noise<N>(lattice.x.cell(q.x), lattice.y.cell(q.y), lattice.z.cell(q.z)));
        if (w >= N::one)
            w = w - N::one;
        return blend<N>(m, colour, N::unit(w * w));
    }
};

} // namespace qray
