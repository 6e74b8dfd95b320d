// A triangle of a patch, in little room.
#pragma once

#include "mesh.hpp"

namespace qray {

template <class N>
using SmoothTriangle = MeshTriangle<N, true>;

} // namespace qray
