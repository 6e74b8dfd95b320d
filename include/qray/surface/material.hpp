// What a surface is made of, part by part: a material's number indexes one table for each part that the scene
// calls for. Coefficients and colours are in [0, 1].
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Matte {
    Vec<typename N::Unit> colour; // M, unless a texture gives it
    Rgb<N> ambient;               // the ambient light times the coefficient
    typename N::Unit diffuse;
};

// Which texture, if any: the kinds' own tables hold it.
enum class TextureKind : uint8_t { none, checker, stripes, gradient, rings, noise, marble, wood, brick };
struct TextureRef {
    TextureKind kind;
    uint16_t index;
};

} // namespace qray
