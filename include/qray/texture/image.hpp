// Image: texels by two coordinates, along the edges u and v from a corner, again and again.
#pragma once

#include "lattice.hpp"
#include "texels.hpp"

namespace qray {

template <class N>
struct Image {
    static constexpr TextureText text = TextureText::image;

    LatticeAxis<N> s, t;
    Texels<N> texels;

    template <class Make>
    static Image made(const Make& make)
    {
        return {make.along_edge(0), make.along_edge(1), make.texels()};
    }

    constexpr Vec<typename N::Unit> operator()(const Vec<typename N::Unit>&, const Point<N>& q) const
    {
        const auto u = s.cell(q).inside, v = t.cell(q).inside;
        if constexpr (N::is_fixed) {
            constexpr int up = 32 - N::Unit::frac;
            return texels.at(static_cast<uint32_t>(u.raw) << up, static_cast<uint32_t>(v.raw) << up);
        } else {
            return texels.texel(place(u, texels.width), place(v, texels.height));
        }
    }

private:
    static constexpr uint32_t place(typename N::Unit part, uint32_t size)
        requires(!N::is_fixed)
    {
        const uint32_t i = static_cast<uint32_t>(part * static_cast<typename N::Unit>(size));
        return i < size ? i : size - 1; // by rounding
    }
};

} // namespace qray
