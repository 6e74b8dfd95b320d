// The outlines of polygons and patches, as many edges at once as a register has numbers: which edges cross the
// half-line of shape/corners.hpp. For float and q32 on desktops, where the tree asks it before the shape,
// which then need not.
//
// Float does what crosses() does, edge by edge. In q32, whose answer is that of exact arithmetic, binary32 tells
// where it can, in ulp of a length and with u = 2^-24: differences v of corners and origin are exact and less than
// 2^31; a sheared v_x d_z - v_z d_x is off by less than 2 (2^31 3 u) + 2^32 u = 1024, so that where it is beyond
// `apart` its sign is known; and with s the sum of the four magnitudes an edge's a_x b_y - b_x a_y by less than 1024
// s + 2 1024^2 + 512 s.
#pragma once

#include "../number/lanes.hpp"
#include "../shape/corners.hpp"

namespace qray {

// For these, a scene with a tree has them.
template <class N>
inline constexpr bool has_outlines = WideFixed<N> || SingleFloat<N>;

// x, y, z of corners. In each four of them an edge leads from one to the next and from the last to the first; of an
// outline of more, whose fours share the corner between them, that last edge does not count. Behind the blocks of an
// outline that has several: the lowest of each of these blocks, and the highest.
template <class N>
struct alignas(sizeof(Bounds)) OutlineBlock {
    using Row = ByNumber<N, BoundMask, Bounds>;
    Row corners[3];
};

template <class N>
class OutlineRay {
public:
    OutlineRay() = default; // of none yet
    explicit QRAY_INLINE OutlineRay(const Ray<N>& ray)
    {
        const Shear<N> shear(ray.direction);
        const Point<N>& o = ray.origin;
        const bool first = shear.axis == 0, last = shear.axis == 2;
        z_row = static_cast<size_t>(shear.axis);
        x_row = last ? 0 : z_row + 1;
        y_row = first ? 2 : z_row - 1;
        ox = all(first ? o.y : last ? o.x : o.z);
        oy = all(first ? o.z : last ? o.y : o.x);
        oz = all(first ? o.x : last ? o.z : o.y);
        dx = all_bounds(value(shear.dx));
        dy = all_bounds(value(shear.dy));
        dz = all_bounds(value(shear.dz));
    }

    // The edges that cross the half-line, as bits, and those of which that is not known.
    QRAY_INLINE uint32_t crossed(const OutlineBlock<N>& block, uint32_t& unsure) const
    {
        const Bounds vx = number(block.corners[x_row] - ox), vy = number(block.corners[y_row] - oy);
        const Bounds vz = number(block.corners[z_row] - oz), none{};
        const Bounds ax = vx * dz - vz * dx, bx = next_in_four(ax), ay = vy * dz - vz * dy, by = next_in_four(ay);
        const Bounds e = ax * by - bx * ay;
        const BoundMask up = by > none, crosses = (ay > none) ^ up;
        // The edge's sign, the other one where it leads down.
        const BoundMask left = __builtin_bit_cast(Bounds, __builtin_bit_cast(BoundMask, e) ^ (~up & INT32_MIN)) > none;
        if constexpr (N::is_fixed) {
            constexpr float apart = 2048;
            const Bounds near = magnitude(ay), size = magnitude(ax) + near;
            const Bounds margin = (size + next_in_four(size) + apart) * apart;
            unsure = mask_bits((lower(near, next_in_four(near)) <= apart) | (crosses & (magnitude(e) <= margin)));
            return mask_bits(crosses & left);
        } else {
            const BoundMask right_a = ax > none, right_b = bx > none;
            return mask_bits(crosses & ((right_a & right_b) | ((right_a | right_b) & left)));
        }
    }

    // In which blocks may edges cross it, given these blocks' lowest and highest? None does where all sheared y have
    // the same sign, or all x are below 0; each is off by less than 1024 ulp here and there, in float by 2^-13.
    QRAY_INLINE uint32_t meets(const OutlineBlock<N>& lowest, const OutlineBlock<N>& highest) const
    {
        constexpr float apart = N::is_fixed ? 2048 : 0x1p-12f;
        Bounds low_x, high_x, low_y, high_y;
        const auto seen = [&](size_t row, const Row& o, const Bounds& d, const Bounds& low_z, const Bounds& high_z,
                              Bounds& low, Bounds& high) __attribute__((always_inline)) {
            const Bounds a = number(lowest.corners[row] - o) * dz, b = number(highest.corners[row] - o) * dz;
            const Bounds e = low_z * d, f = high_z * d;
            low = lower(a, b) - higher(e, f);
            high = higher(a, b) - lower(e, f);
        };
        const Bounds low_z = number(lowest.corners[z_row] - oz), high_z = number(highest.corners[z_row] - oz);
        seen(x_row, ox, dx, low_z, high_z, low_x, high_x);
        seen(y_row, oy, dy, low_z, high_z, low_y, high_y);
        return mask_bits((lower(high_x, high_y) >= -apart) & (low_y <= apart));
    }

private:
    using Row = typename OutlineBlock<N>::Row;
    Row ox, oy, oz;
    Bounds dx, dy, dz;
    size_t x_row, y_row, z_row;

    QRAY_INLINE static Bounds all(float v) { return all_bounds(v); }
    template <int F>
    QRAY_INLINE static BoundMask all(Fixed<F, 32> v) { return v.raw - BoundMask{}; }
    QRAY_INLINE static float value(float v) { return v; }
    template <int F>
    QRAY_INLINE static float value(Fixed<F, 32> v)
    {
        return static_cast<float>(v.raw) * (1.0f / static_cast<float>(int64_t{1} << F));
    }
    QRAY_INLINE static Bounds magnitude(const Bounds& v)
    {
        return __builtin_bit_cast(Bounds, __builtin_bit_cast(BoundMask, v) & INT32_MAX);
    }
    QRAY_INLINE static Bounds number(const Bounds& v) { return v; }
    QRAY_INLINE static Bounds number(const BoundMask& v) { return __builtin_convertvector(v, Bounds); }
};

} // namespace qray
