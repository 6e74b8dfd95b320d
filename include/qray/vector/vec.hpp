// Vectors: what they are and what is done to them, by their parts (vec_parts.hpp) or in one register (vec_lanes.hpp).
// Both give the same bits, and no folder above knows which.
#pragma once

#include "vec_lanes.hpp"
#include "vec_parts.hpp"

namespace qray {

// Adds a part k of light to a sum.
template <class N>
QRAY_INLINE constexpr void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light,
                                          typename N::Unit k)
{
    saturating_add<N>(sum, scaled<N>(k, light));
}

// Is a longer than r?
template <class N>
QRAY_INLINE constexpr bool beyond(const Vec<typename N::Length>& a, typename N::Length r)
{
    if constexpr (NarrowFixed<N>)
        return N::beyond(a.x, a.y, a.z, r);
    else
        return norm2<N>(a) > r * r;
}

// normalise() of what may be so short that its square is too small for float: false there, too.
template <class N, class T>
QRAY_INLINE constexpr bool normalise_short(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    if constexpr (!N::is_fixed)
        if (!(norm2<N>(v) > N::least_square))
            return false;
    return normalise<N>(v, u);
}

} // namespace qray
