// Mirrored rays.
#pragma once

#include "reflection.hpp"

namespace qray {

template <class N>
struct Mirror {
    typename N::Unit amount;
};

} // namespace qray
