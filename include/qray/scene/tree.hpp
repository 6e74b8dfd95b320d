// A tree of boxes over all shapes, as many to a node as a register has numbers. No pointers, no recursion.
//
// It only says which shapes a ray may meet: conservatively, in binary32, whatever the number system. The proof: let a ray
// o + t d, |d_i| <= 1, |o_i| <= 64, be at a point of a shape at t in [0, 128], and s be the distance from there to a side
// of the shape's box at `low`, which is behind on an axis with d_i > 0; u = 2^-24. What enters() finds for that side is
//   (low k - c)(1 + e) with k = (1 + e')/d and c = o k (1 + e''), |e| <= u each, twice that for k
// which, with another (1 + e) on low k where a product is rounded before the sum, is at most
//   (t - (s - 128 u)/d)(1 + 3.01 u) <= t + 386 u - (s - 128 u)
// where it is positive. So where s >= 515 u plus what o and d lost on the way to binary32 (64 u, 128 u), and what a
// component of d below `least` was raised by (128 least), less than 4.3e-5 in all, it is at most t. The far sides are
// at least t by the same sum: the ray enters the box. The builder's slack is larger, by what a hit may lie outside its
// shape: see tree_builder.hpp.
#pragma once

#include "../number/lanes.hpp"
#include "../vector/ray.hpp"
#include "lists.hpp"

namespace qray {

// A shape's kind and its index in the table of that kind.
struct ShapeId {
    uint32_t bits;
    constexpr Kind kind() const { return static_cast<Kind>(bits >> 29); }
    constexpr uint32_t index() const { return bits & 0x1fffffff; }
};
constexpr ShapeId shape_id(Kind kind, uint32_t index) { return {static_cast<uint32_t>(kind) << 29 | index}; }

struct BoxNode {
    Bounds sides[3][2];          // of boxes along each axis: low and high; none: +infinity and -infinity
    uint32_t links[bound_lanes]; // a node's number, or leaf_link()
};

constexpr uint32_t leaf_bit = 1u << 31;
constexpr uint32_t leaf_link(uint32_t first, uint32_t count) { return leaf_bit | (count - 1) << 28 | first; }

struct Tree {
    static constexpr int max_depth = 40; // of a leaf, below the root
    const BoxNode* nodes;                // the root first
    const ShapeId* shapes;
};

// A ray in binary32.
template <class N>
class BoundedRay {
public:
    explicit QRAY_INLINE BoundedRay(const Ray<N>& ray)
    {
        constexpr float least = 0x1p-30f;
        const Parts d = parts_of_vector(ray.direction), o = parts_of_vector(ray.origin);
        const PartSigns sign = __builtin_bit_cast(PartSigns, d) & INT32_MIN;
        const Parts size = __builtin_bit_cast(Parts, __builtin_bit_cast(PartSigns, d) & INT32_MAX);
        const Parts some = size > least ? size : least + Parts{};
        const Parts k = 1.0f / __builtin_bit_cast(Parts, __builtin_bit_cast(PartSigns, some) | sign), c = o * -k;
        for (int i = 0; i < 3; i++) {
            inverse[i] = all_bounds(k[i]);
            offset[i] = all_bounds(c[i]);
            near_side[i] = static_cast<uint32_t>(sign[i]) >> 31;
        }
    }

    // Which boxes of a node the ray may enter before `limit`, as bits, and where.
    QRAY_INLINE uint32_t enters(const BoxNode& node, float limit, Bounds& from) const
    {
        const auto at = [&](int axis, size_t side) __attribute__((always_inline)) {
            return mul_add(node.sides[axis][side], inverse[axis], offset[axis]);
        };
        from = higher(higher(at(0, near_side[0]), at(1, near_side[1])), higher(at(2, near_side[2]), Bounds{}));
        const Bounds to = lower(lower(at(0, near_side[0] ^ 1), at(1, near_side[1] ^ 1)),
                                lower(at(2, near_side[2] ^ 1), all_bounds(limit)));
        return mask_bits(from <= to);
    }

    // A limit, and by how much a hit that is reported before it may lie behind: a plane's, where it is seen almost edge
    // on, and one whose direction is not quite unit.
    static QRAY_INLINE float beyond(typename N::Length limit) { return as_float(limit) + (NarrowFixed<N> ? 1.0f : 1.0f / 16); }

private:
    typedef float Parts __attribute__((vector_size(16)));
    typedef int32_t PartSigns __attribute__((vector_size(16)));

    template <class L>
    static QRAY_INLINE float as_float(L v)
    {
        if constexpr (N::is_fixed)
            return static_cast<float>(v.raw) * (1.0f / static_cast<float>(int64_t{1} << L::frac));
        else
            return static_cast<float>(v);
    }
    template <class L>
    static QRAY_INLINE Parts parts_of_vector(const Vec<L>& v)
    {
#if QRAY_LANES
        if constexpr (FloatLanes<N>) {
            return v.lanes;
        } else if constexpr (FixedLanes<N>) {
            const Half8 h = halves(v.lanes);
            return __builtin_convertvector(__builtin_shufflevector(h, h, 0, 2, 4, 6), Parts)
                * (1.0f / static_cast<float>(int64_t{1} << L::frac));
        }
#endif
        return Parts{as_float(v.x), as_float(v.y), as_float(v.z), 0};
    }

    Bounds inverse[3], offset[3];
    size_t near_side[3];
};

// Calls visit(ShapeId) for every shape whose box the ray may enter before limit(), until visit returns true: the nearest
// boxes first, or in any order. limit() is asked again after each leaf, as hits come nearer.
template <bool NearestFirst, class N, class Limit, class Visit>
QRAY_INLINE void walk(const Tree& tree, const Ray<N>& ray, Limit limit, Visit visit)
{
    // Boxes that wait: where the ray enters them, and above their links.
    uint64_t stack[Tree::max_depth * (bound_lanes - 1) + 1];
    uint64_t* top = stack;
    const BoundedRay<N> bounded(ray);
    float end = BoundedRay<N>::beyond(limit());
    uint32_t link = 0;
    for (;;) {
        while ((link & leaf_bit) == 0) {
            const BoxNode& node = tree.nodes[link];
            alignas(Bounds) uint32_t from[bound_lanes];
            Bounds entered;
            uint32_t mask = bounded.enters(node, end, entered);
            if (mask == 0)
                goto next;
            __builtin_memcpy(from, &entered, sizeof from);
            const auto entry = [&](uint32_t i) __attribute__((always_inline)) {
                return uint64_t{from[i]} << 32 | node.links[i]; // from >= 0: in the order of integers
            };
            uint32_t i = lowest_bit(mask);
            mask &= mask - 1;
            link = node.links[i];
            if (mask == 0)
                continue;
            if constexpr (NearestFirst) {
                uint64_t* const base = top;
                *top++ = entry(i);
                do {
                    i = lowest_bit(mask);
                    mask &= mask - 1;
                    const uint64_t e = entry(i);
                    uint64_t* at = top++;
                    for (; at != base && at[-1] < e; at--)
                        *at = at[-1];
                    *at = e;
                } while (mask != 0);
                link = static_cast<uint32_t>(*--top);
            } else {
                do {
                    i = lowest_bit(mask);
                    mask &= mask - 1;
                    *top++ = node.links[i];
                } while (mask != 0);
            }
        }
        for (uint32_t i = link & 0x0fffffff, count = (link >> 28 & 7) + 1; count != 0; i++, count--)
            if (visit(tree.shapes[i]))
                return;
        if constexpr (NearestFirst)
            end = BoundedRay<N>::beyond(limit());
    next:
        do {
            if (top == stack)
                return;
            link = static_cast<uint32_t>(*--top);
        } while (NearestFirst && __builtin_bit_cast(float, static_cast<uint32_t>(*top >> 32)) > end);
    }
}

} // namespace qray
