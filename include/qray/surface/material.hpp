// What a surface is made of, part by part: a material's number indexes one table for each part that the scene
// calls for. Coefficients and colours are in [0, 1].
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Matte {
    Vec<typename N::Unit> colour; // M, unless a texture gives it
    Rgb<N> ambient;               // what no light gives: the ambient light times the coefficient, and emission
    typename N::Unit diffuse;
};

} // namespace qray
