// Where a point lies in a texture's lattice: cells of edge `size`, counted in 32-bit wrap-around arithmetic, and
// the place inside the cell. In fixed point p = q/size + offset is a 64-bit Q32.32 number: exact to 2^-31 of
// q/size, right as many cells out as a scene can hold, at lattice planes and at the most negative cell.
// The offset undoes the builder's move of the scene; it also holds the definition's epsilon of 1/1024 where a
// texture asks for it.
#pragma once

#include "../vector/ray.hpp"
#include "texels.hpp"

namespace qray {

template <class N>
struct Cell {
    uint32_t index;          // floor(p) mod 2^32
    typename N::Unit inside; // p - floor(p), [0, 1)
};

// One coordinate of the lattice: row . q + offset.
template <class N>
struct LatticeAxis;

template <class N>
    requires(WideFixed<N>)
struct LatticeAxis<N> {
    // row . q = (sum of row_i q_i, in units of 2^-30 lengths) * 2^shift, in units of 2^-32 cells
    int32_t row_x, row_y, row_z;
    int32_t shift;
    int64_t offset;

    // Q32.32, wrapping.
    constexpr uint64_t wrapped(const Point<N>& q) const
    {
        const int64_t sum = wide_dot(q.x.raw, q.y.raw, q.z.raw, row_x, row_y, row_z);
        return (shift >= 0 ? static_cast<uint64_t>(sum) << shift : static_cast<uint64_t>(sum >> -shift))
            + static_cast<uint64_t>(offset);
    }
    constexpr Cell<N> cell(const Point<N>& q) const { return split(wrapped(q)); }
    // p clamped to [0, 1].
    constexpr typename N::Unit clamped(const Point<N>& q) const
    {
        const int64_t p = bounded(q);
        if (p <= 0)
            return N::zero;
        return p >> 32 != 0 ? N::one : typename N::Unit{static_cast<int32_t>(p >> (32 - N::Unit::frac))};
    }
    // Q32.32, clamped to +-2^62.
    constexpr int64_t bounded(const Point<N>& q) const
    {
        constexpr int64_t limit = int64_t{1} << 61;
        const int64_t sum = wide_dot(q.x.raw, q.y.raw, q.z.raw, row_x, row_y, row_z);
        int64_t p = sum >> (shift < 0 ? -shift : 0);
        if (shift > 0)
            p = p >= limit >> shift ? limit : p <= -(limit >> shift) ? -limit : p * (int64_t{1} << shift);
        p += offset < -limit ? -limit : offset > limit ? limit : offset;
        return p;
    }
    static constexpr Cell<N> split(uint64_t p)
    {
        return {static_cast<uint32_t>(p >> 32),
                typename N::Unit{static_cast<int32_t>(static_cast<uint32_t>(p) >> (32 - N::Unit::frac))}};
    }
};

// The same in 32 bits: p = (row . q + offset) 2^-frac + whole, where the sum is less than 2^31 for every point of the
// scene, so that the rounding of a row is worth 2^-15 of that sum: about 1 ulp of the point.
template <class N>
    requires NarrowFixed<N>
struct LatticeAxis<N> {
    int32_t row_x, row_y, row_z;
    int32_t frac; // [1, 30]
    int32_t offset;
    int32_t whole; // where a lattice does not wrap, at most 2^30 either way

    constexpr Cell<N> cell(const Point<N>& q) const
    {
        using Unit = typename N::Unit;
        const int32_t p = N::dot(q.x, q.y, q.z, Unit{row_x}, Unit{row_y}, Unit{row_z}).raw + offset;
        const uint32_t inside = static_cast<uint32_t>(p) << (32 - frac) >> (32 - N::Unit::frac);
        return {static_cast<uint32_t>(p >> frac) + static_cast<uint32_t>(whole), {static_cast<int32_t>(inside)}};
    }
    // In 2^-14, clamped to +-2^30.
    constexpr int32_t bounded(const Point<N>& q) const
    {
        constexpr int32_t limit = int32_t{1} << 16;
        const Cell<N> c = cell(q);
        const int32_t index = static_cast<int32_t>(c.index);
        return index >= limit ? limit << 14
            : index < -limit  ? -limit * (1 << 14)
                              : index * (1 << 14) + (c.inside.raw >> (N::Unit::frac - 14));
    }
    constexpr typename N::Unit clamped(const Point<N>& q) const
    {
        const int32_t p = bounded(q);
        return p > 0 ? (p < 1 << 14 ? typename N::Unit{p << (N::Unit::frac - 14)} : N::one) : N::zero;
    }
    static constexpr Cell<N> split(uint32_t p)
    {
        return {p >> 14, typename N::Unit{static_cast<int32_t>(p & 0x3fff) << (N::Unit::frac - 14)}};
    }
};

template <class N>
    requires(!N::is_fixed)
struct LatticeAxis<N> {
    using F = typename N::Length;
    F row_x, row_y, row_z; // in 1/size
    F inside;              // the offset's fraction, [0, 1)
    uint32_t index;        // the offset's floor, mod 2^32
    F offset;              // the offset whole

    constexpr Cell<N> cell(const Point<N>& q) const
    {
        const Cell<N> c = split(row_dot(q) + inside);
        return {c.index + index, c.inside};
    }
    constexpr F clamped(const Point<N>& q) const
    {
        const F p = row_dot(q) + offset;
        return p > F(0) ? (p < F(1) ? p : F(1)) : F(0);
    }
    constexpr F row_dot(const Point<N>& q) const { return row_x * q.x + row_y * q.y + row_z * q.z; }
    constexpr F bounded(const Point<N>& q) const { return row_dot(q) + offset; }
    static constexpr Cell<N> split(F p)
    {
        if constexpr (sizeof(F) == 4) {
            // Conversions to 64 bits would link arithmetic in double precision on small cores.
            if (!(N::absolute(p) < N::whole_limit))
                return {whole_index(__builtin_bit_cast(uint32_t, p)), F(0)};
            return split<int32_t>(p);
        } else {
            constexpr F limit = F(int64_t{1} << 62);
            if (!(N::absolute(p) < limit)) // no fraction left at such a distance
                return {0, F(0)};
            return split<int64_t>(p);
        }
    }

private:
    template <class Whole>
    static constexpr Cell<N> split(F p)
    {
        const Whole whole = static_cast<Whole>(p);
        const F rest = p - static_cast<F>(whole); // exact
        const bool below = rest < F(0);
        return {static_cast<uint32_t>(whole - below), below ? rest + F(1) : rest};
    }
    // Of binary32 beyond whole_limit, modulo 2^32.
    static constexpr uint32_t whole_index(uint32_t bits)
    {
        const uint32_t shift = (bits >> 23 & 0xff) - 150; // at least 8
        const uint32_t size = shift < 32 ? ((bits & 0x7fffff) | 0x800000) << shift : 0;
        return bits >> 31 ? 0 - size : size;
    }
};

// The same of one coordinate alone, q: row q + offset.
template <class N>
struct LatticeStep;

template <class N>
    requires(WideFixed<N>)
struct LatticeStep<N> {
    int32_t row;
    int32_t shift;
    int64_t offset;

    constexpr Cell<N> cell(typename N::Length q) const
    {
        const int64_t p = wide_mul(q.raw, row);
        return LatticeAxis<N>::split(
            (shift >= 0 ? static_cast<uint64_t>(p) << shift : static_cast<uint64_t>(p >> -shift))
            + static_cast<uint64_t>(offset));
    }
};

template <class N>
    requires NarrowFixed<N>
struct LatticeStep<N> {
    int32_t row;
    int32_t frac;
    int32_t offset;
    int32_t whole;

    constexpr Cell<N> cell(typename N::Length q) const
    {
        return LatticeAxis<N>{row, 0, 0, frac, offset, whole}.cell({q, N::length_zero, N::length_zero});
    }
};

template <class N>
    requires(!N::is_fixed)
struct LatticeStep<N> {
    using F = typename N::Length;
    F row;
    F inside;
    uint32_t index;

    constexpr Cell<N> cell(F q) const
    {
        const Cell<N> c = LatticeAxis<N>::split(row * q + inside);
        return {c.index + index, c.inside};
    }
};

// A lattice of cells along the axes of the scene.
template <class N>
struct Lattice {
    LatticeStep<N> x, y, z;

    // Odd where the sum of the three cells is.
    QRAY_INLINE constexpr uint32_t parity(const Point<N>& q) const
    {
        uint32_t sum = 0;
        if (sum_of_cells<N>(x, y, z, q, sum))
            return sum;
        return x.cell(q.x).index + y.cell(q.y).index + z.cell(q.z).index;
    }
};

// sqrt(a^2 + b^2) of two bounded coordinates, plus epsilon: cell and place inside.
template <class N, class P>
constexpr Cell<N> radial_cell(P a, P b, bool with_epsilon)
{
    if constexpr (NarrowFixed<N>) {
        // To 15 bits, if they have more.
        const uint32_t ua = magnitude(a), ub = magnitude(b);
        const int more = 17 - count_leading_zeros(ua | ub);
        const int down = more > 0 ? more : 0;
        const uint32_t na = ua >> down, nb = ub >> down;
        return LatticeAxis<N>::split((isqrt(na * na + nb * nb) << down) + (with_epsilon ? uint32_t{1} << 4 : 0));
    } else if constexpr (N::is_fixed) {
        const uint64_t ua = magnitude(a), ub = magnitude(b);
        const int down = 32 - count_leading_zeros(ua | ub);
        uint64_t rho = 0;
        if (down > 0) {
            const uint64_t na = ua >> down, nb = ub >> down;
            rho = uint64_t{isqrt((na >> 1) * (na >> 1) + (nb >> 1) * (nb >> 1))} << (down + 1);
        } else {
            rho = isqrt((ua >> 1) * (ua >> 1) + (ub >> 1) * (ub >> 1)) * uint64_t{2};
        }
        return LatticeAxis<N>::split(rho + (with_epsilon ? uint64_t{1} << 22 : 0));
    } else {
        return LatticeAxis<N>::split(N::sqrt(a * a + b * b) + (with_epsilon ? P(1) / P(1024) : P(0)));
    }
}

// a + (b - a) k, k in [0, 1].
template <class N>
QRAY_INLINE constexpr typename N::Unit blend(typename N::Unit a, typename N::Unit b, typename N::Unit k)
{
    return a + N::unit((b - a) * k);
}
template <class N>
QRAY_INLINE constexpr Vec<typename N::Unit> blend(const Vec<typename N::Unit>& a, const Vec<typename N::Unit>& b,
                                                  typename N::Unit k)
{
    return {blend<N>(a.x, b.x, k), blend<N>(a.y, b.y, k), blend<N>(a.z, b.z, k)};
}

} // namespace qray
