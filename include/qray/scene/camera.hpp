// The view. A sample's place is counted from the centre of the picture in steps of half a cell of the finest
// sampling grid, so that places are integers: with n x n cells a pixel, x = 2n i + 2k + 1 - n width.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

template <class N>
struct Camera {
    Point<N> eye;
    Pencil<N> centre; // w: towards the centre of the picture
    Pencil<N> right;  // u: one step to the right
    Pencil<N> down;   // v: one step down
    uint16_t width, height;
    uint16_t grid;    // n: cells along the edge of a pixel

    // The middle of a row of samples: y = 2n j + 2k + 1 - n height.
    constexpr Pencil<N> row(int32_t y) const { return centre + down * y; }
    constexpr Ray<N> ray(const Pencil<N>& at) const
    {
        Ray<N> r{eye, {N::zero, N::zero, N::one}, {Tag::none}, false};
        at.unit(r.direction);
        return r;
    }
};

} // namespace qray
