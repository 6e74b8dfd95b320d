// Marble: veins across an axis, bent by turbulence (scenes/README.md defines it).
#pragma once

#include "value_noise.hpp"

namespace qray {

// The cell of 2 p.
template <class N>
constexpr Cell<N> twice(const Cell<N>& c)
{
    const auto f = c.inside + c.inside;
    return f < N::one ? Cell<N>{2 * c.index, f} : Cell<N>{2 * c.index + 1, f - N::one};
}

template <class N>
struct Marble {
    static constexpr TextureText text = TextureText::cells_along;

    Vec<typename N::Unit> colour; // N
    Lattice<N> lattice;
    LatticeAxis<N> axis;

    template <class Make>
    static Marble made(const Make& make)
    {
        return {make.colour(), make.lattice(false), make.along_axis(false, true)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        // The fraction of p.axis + 2 turbulence, octave by octave: whole turns do not matter.
        Cell<N> x = lattice.x.cell(q.x), y = lattice.y.cell(q.y), z = lattice.z.cell(q.z);
        auto v = axis.cell(q).inside;
        const auto first = noise<N>(x, y, z);
        v = wrap(wrap(v + first) + first);
        for (int octave = 1; octave < 4; octave++) {
            x = twice<N>(x);
            y = twice<N>(y);
            z = twice<N>(z);
            auto n = noise<N>(x, y, z); // weight 2 / 2^octave
            for (int halving = 1; halving < octave; halving++)
                n = half<N>(n);
            v = wrap(v + n);
        }
        const auto two_v = v + v;
        const auto s = two_v < N::one ? two_v : N::one - (two_v - N::one);
        return blend<N>(m, colour, smoothstep<N>(s));
    }

private:
    static constexpr typename N::Unit wrap(typename N::Unit v) { return v < N::one ? v : v - N::one; }
};

} // namespace qray
