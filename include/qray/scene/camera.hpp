// The view. A sample's place is counted from the centre of the picture in steps of half a cell of the finest
// sampling grid, so that places are integers: with n x n cells a pixel, x = 2n i + 2k + 1 - n width.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// A direction before it is made a unit vector: w + x u + y v with |w|, |x u|, |y v| <= 2^60 in fixed point, 2^29 where
// products have 32 bits.
template <class N>
struct Pencil;
template <class N>
    requires(WideFixed<N> && InParts<N>)
struct Pencil<N> {
    int64_t x, y, z;
    constexpr bool unit(Direction<N>& d) const { return N::normalise_wide(x, y, z, d.x, d.y, d.z); }
    friend constexpr Pencil operator+(const Pencil& a, const Pencil& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Pencil operator*(const Pencil& a, int32_t k) { return {a.x * k, a.y * k, a.z * k}; }
};
template <class N>
    requires NarrowFixed<N>
struct Pencil<N> {
    int32_t x, y, z;
    constexpr bool unit(Direction<N>& d) const { return N::normalise(x, y, z, d.x, d.y, d.z); }
    friend constexpr Pencil operator+(const Pencil& a, const Pencil& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Pencil operator*(const Pencil& a, int32_t k) { return {a.x * k, a.y * k, a.z * k}; }
};
template <class N>
    requires(!N::is_fixed && InParts<N>)
struct Pencil<N> {
    using F = typename N::Length;
    F x, y, z;
    constexpr bool unit(Direction<N>& d) const { return N::normalise(x, y, z, d.x, d.y, d.z); }
    friend constexpr Pencil operator+(const Pencil& a, const Pencil& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Pencil operator*(const Pencil& a, int32_t k)
    {
        return {a.x * static_cast<F>(k), a.y * static_cast<F>(k), a.z * static_cast<F>(k)};
    }
};

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
