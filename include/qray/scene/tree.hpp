// A flat tree of bounding balls over all shapes, n = bound_lanes to a block: block b of a level bounds what blocks n b
// to n b + n - 1 of the level below hold, and those of level 0 each bound n shapes. No pointers, no recursion.
//
// It only says which shapes a ray may meet: conservatively, in binary32, whatever the number system.
#pragma once

#include "../number/lanes.hpp"
#include "../vector/ray.hpp"
#include "lists.hpp"

namespace qray {

// In the units of BoundedRay.
struct BallBlock {
    Bounds x, y, z;
    Bounds reach;  // the radius, by the length of a direction
    Bounds square; // of that; -infinity: no ball
};

// A shape's kind and its index in the table of that kind.
struct ShapeId {
    uint32_t bits;
    constexpr Kind kind() const { return static_cast<Kind>(bits >> 29); }
    constexpr uint32_t index() const { return bits & 0x1fffffff; }
};
constexpr ShapeId shape_id(Kind kind, uint32_t index) { return {static_cast<uint32_t>(kind) << 29 | index}; }

struct Tree {
    static constexpr int max_levels = 12;
    const BallBlock* blocks;
    const ShapeId* shapes;        // bound_lanes for each block of level 0
    uint32_t first[max_levels];   // block of each level
    int32_t levels;
    uint32_t top;                 // blocks of the highest level: few
};

// A ray in binary32, in units that make conversion cheap: a fixed point's ulp, also for directions.
template <class N>
class BoundedRay {
public:
    static constexpr bool raw = WideFixed<N>;
    // A length of 1, and the length of a direction.
    static constexpr float length = raw ? static_cast<float>(int64_t{1} << 24) : 1;
    static constexpr float unit = raw ? static_cast<float>(int64_t{1} << 30) : 1;

    explicit QRAY_INLINE BoundedRay(const Ray<N>& ray)
    {
        spread(ray.origin, ox, oy, oz);
        spread(ray.direction, dx, dy, dz);
        if constexpr (raw)
            static_assert(N::Length::frac == 24 && N::Unit::frac == 30);
        if constexpr (NarrowFixed<N>) { // the direction's length is wrong in the 14th bit
            const Bounds k = 1.5f - 0.5f * (dx * dx + dy * dy + dz * dz);
            dx *= k;
            dy *= k;
            dz *= k;
        }
    }

    // Which balls of a block the ray may enter.
    QRAY_INLINE uint32_t enters(const BallBlock& b) const
    {
        Bounds along;
        const Bounds apart = outside(b, along);
        return mask_bits((apart <= b.square) & ~sign(along + b.reach));
    }
    // Which it may enter before `limit`, times length and unit.
    QRAY_INLINE uint32_t enters(const BallBlock& b, float limit) const
    {
        Bounds along;
        const Bounds apart = outside(b, along);
        return mask_bits((apart <= b.square) & ~sign(along + b.reach) & (along - b.reach <= limit));
    }

    template <class L>
    static QRAY_INLINE float as_float(L v)
    {
        if constexpr (raw)
            return static_cast<float>(v.raw);
        else if constexpr (N::is_fixed)
            return static_cast<float>(v.raw) * (1.0f / static_cast<float>(int64_t{1} << L::frac));
        else
            return static_cast<float>(v);
    }

private:
    // |v|^2 - (v.d)^2, to be compared with r^2, and v.d, which is at least -r unless the ball is behind. With
    // |v| < 2^7 and 24 bits, each side of the first comparison is wrong by less than 2^-19 |v|^2; the builder
    // adds to r what the rounded coordinates may be off.
    QRAY_INLINE Bounds outside(const BallBlock& b, Bounds& along) const
    {
        constexpr float k = (1.0f - 0x1p-18f) * unit * unit;
        const Bounds x = b.x - ox, y = b.y - oy, z = b.z - oz;
        along = mul_add(z, dz, mul_add(y, dy, x * dx));
        const Bounds square = mul_add(z, z, mul_add(y, y, x * x));
        return square * k - along * along;
    }
    template <class L>
    QRAY_INLINE static void spread(const Vec<L>& v, Bounds& x, Bounds& y, Bounds& z)
    {
#if QRAY_LANES
        if constexpr (raw) {
            const Bounds all = __builtin_convertvector(halves(v.lanes), Bounds);
            x = __builtin_shufflevector(all, all, 0, 0, 0, 0, 0, 0, 0, 0);
            y = __builtin_shufflevector(all, all, 2, 2, 2, 2, 2, 2, 2, 2);
            z = __builtin_shufflevector(all, all, 4, 4, 4, 4, 4, 4, 4, 4);
            return;
        }
#endif
        x = all_bounds(as_float(v.x));
        y = all_bounds(as_float(v.y));
        z = all_bounds(as_float(v.z));
    }
    // The sign is the highest bit, which is the only one that mask_bits() sees.
    QRAY_INLINE static BoundMask sign(const Bounds& v) { return __builtin_bit_cast(BoundMask, v); }
    Bounds ox, oy, oz, dx, dy, dz;
};

// Goes through the tree and stops at each block of level 0 that holds shapes that the ray may meet.
template <class N>
class Walk {
public:
    QRAY_INLINE Walk(const Tree& over, const Ray<N>& ray)
        : tree(over), bounded(ray), level(over.levels), top(0), mask(0)
    {
    }

    // The next block, of those that the ray may enter before `limit`: its shapes, as bits of the result from `base`
    // on. 0 at the end.
    uint32_t next(float limit, uint32_t& base)
    {
        // A shape may lie a little beyond its rounded limit.
        limit = limit * ((1.0f + 0x1p-20f) * BoundedRay<N>::unit)
            + 0x1p-16f * BoundedRay<N>::length * BoundedRay<N>::unit;
        for (;;) {
            while (mask == 0) {
                if (level >= tree.levels - 1) {
                    if (top == tree.top)
                        return 0;
                    level = tree.levels - 1;
                    block = top++;
                    mask = bounded.enters(tree.blocks[tree.first[level] + block], limit);
                } else {
                    level++;
                    block = stack[level].block;
                    mask = stack[level].mask;
                }
            }
            if (level == 0) {
                base = block * bound_lanes;
                const uint32_t found = mask;
                mask = 0;
                return found;
            }
            const uint32_t child = block * bound_lanes + lowest_bit(mask);
            stack[level] = {block, mask & (mask - 1)};
            level--;
            block = child;
            mask = bounded.enters(tree.blocks[tree.first[level] + block], limit);
        }
    }

private:
    const Tree& tree;
    BoundedRay<N> bounded;
    int level;
    uint32_t top, block, mask;
    struct {
        uint32_t block, mask;
    } stack[Tree::max_levels];
};

// Calls visit(ShapeId) for every shape whose ball the ray may enter before limit(), until visit returns true.
// limit() is asked again at every block, as hits come nearer.
template <class N, class Limit, class Visit>
QRAY_INLINE void walk(const Tree& tree, const Ray<N>& ray, Limit limit, Visit visit)
{
    if (tree.levels == 1) { // three blocks at most: all at once
        const BoundedRay<N> bounded(ray);
        uint32_t mask = bounded.enters(tree.blocks[0]);
        if (tree.top > 1)
            mask |= bounded.enters(tree.blocks[1]) << bound_lanes;
        if (tree.top > 2)
            mask |= bounded.enters(tree.blocks[2]) << 2 * bound_lanes;
        for (; mask != 0; mask &= mask - 1)
            if (visit(tree.shapes[lowest_bit(mask)]))
                return;
        return;
    }
    Walk<N> steps(tree, ray);
    uint32_t base = 0;
    // Where the direction's length is wrong in the 14th bit, so is a distance.
    const auto bound = [&limit] {
        const float t = BoundedRay<N>::as_float(limit());
        return NarrowFixed<N> ? t * (1.0f + 0x1p-12f) + 0x1p-6f : t;
    };
    while (uint32_t mask = steps.next(bound(), base))
        for (; mask != 0; mask &= mask - 1)
            if (visit(tree.shapes[base + lowest_bit(mask)]))
                return;
}

} // namespace qray
