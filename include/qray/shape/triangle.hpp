// A polygon of three corners, in little room.
#pragma once

#include "mesh.hpp"

namespace qray {

template <class N>
using Triangle = MeshTriangle<N, false>;

} // namespace qray
