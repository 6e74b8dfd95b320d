// Brick: courses half a cell high, every other one shifted by half a brick (scenes/README.md defines it).
#pragma once

#include "lattice.hpp"

namespace qray {

template <class N>
struct Brick {
    static constexpr TextureText text = TextureText::cells;

    Vec<typename N::Unit> colour; // N, the mortar
    Lattice<N> lattice;           // y counts courses, two to a cell; offsets hold epsilon

    template <class Make>
    static Brick made(const Make& make)
    {
        return {make.colour(), make.lattice(true, 2)};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>& m, const Point<N>& q) const
    {
        const Cell<N> course = lattice.y.cell(q.y);
        const auto x = shifted(lattice.x.cell(q.x).inside, course.index);
        const auto z = shifted(lattice.z.cell(q.z).inside, course.index);
        constexpr auto joint = N::fraction(1, 16);
        return x < joint || z < joint || course.inside < N::fraction(1, 8) ? colour : m;
    }

private:
    static constexpr typename N::Unit shifted(typename N::Unit f, uint32_t course)
    {
        if (!(course & 1))
            return f;
        const auto g = f + N::fraction(1, 2);
        return g < N::one ? g : g - N::one;
    }
};

} // namespace qray
