// A tree of boxes over all shapes, as many to a node as a register has numbers. No pointers, no recursion.
//
// It only says which shapes a ray may meet: conservatively, in binary32, whatever the number system. The proof: let
// a ray o + t d, |d_i| <= 1, |o_i| <= 64, be at a point of a shape at t in [0, 128], and s be the distance from
// there to a side of the shape's box at `low`, which is behind on an axis with d_i > 0; u = 2^-24. What enters()
// finds for that side is
//   (low k - c)(1 + e) with k = (1 + e')/d and c = o k (1 + e''), |e| <= u each, twice that for k and for c, to which
// `behind` is added, as it is to all t here; which, with another (1 + e) on low k where a product is rounded before the
// sum, is at most
//   (t - (s - 192 u)/d)(1 + 3.01 u) <= t + 386 u - (s - 192 u)
// where it is positive. So where s >= 579 u plus what o and d lost on the way to binary32 (64 u, 128 u), and what a
// component of d below `least` was raised by (128 least), less than 4.7e-5 in all, it is at most t. The far sides are
// at least t by the same sum: the ray enters the box. The builder's slack is larger, by what a hit may lie outside its
// shape: see tree_builder.hpp.
#pragma once

#include "lists.hpp"
#include "outline.hpp"

namespace qray {

// A shape's kind and its index in the table of that kind.
struct ShapeId {
    uint32_t bits;
    constexpr Kind kind() const { return static_cast<Kind>(bits >> 29); }
    constexpr uint32_t index() const { return bits & 0x1fffffff; }
};
constexpr ShapeId shape_id(Kind kind, uint32_t index) { return {static_cast<uint32_t>(kind) << 29 | index}; }

struct alignas(2 * sizeof(Bounds)) BoxNode { // whole lines of a cache
    Bounds sides[3][2];          // of boxes along each axis: low and high; none: +infinity and -infinity
    uint32_t links[bound_lanes]; // a node's number, or leaf_link()
};

// In the units of BallRay.
struct BallNode {
    Bounds x, y, z;
    Bounds reach;  // the radius, and hit_slack, by the length of a direction
    Bounds square; // of that; -infinity: no ball
};

constexpr uint32_t leaf_bit = 1u << 31;
constexpr uint32_t leaf_link(uint32_t first, uint32_t count) { return leaf_bit | (count - 1) << 28 | first; }

// A shape, and its outline if it has one: the edges that `edges` has bits of, of one block or of each of some.
struct TreeShape {
    ShapeId id;
    uint32_t block, blocks, edges;
};

template <class N>
struct Tree {
    static constexpr int max_depth = 40; // of a leaf, below the root
    const BoxNode* nodes;                // the root first
    const TreeShape* shapes;
    const OutlineBlock<N>* outlines;
    static constexpr uint32_t most_balls = 3;
    uint32_t ball_nodes; // so few shapes have, instead, balls around them; else 0
    const BallNode* balls;
};

typedef float BoundParts __attribute__((vector_size(16)));
typedef int32_t BoundSigns __attribute__((vector_size(16)));

// x, y, z as numbers, a fixed point's in its ulp.
template <class N, class L>
QRAY_INLINE BoundParts bound_parts(const Vec<L>& v)
{
#if QRAY_LANES
    if constexpr (FloatLanes<N>) {
        return v.lanes;
    } else if constexpr (FixedLanes<N>) {
        const Half8 h = halves(v.lanes);
        return __builtin_convertvector(__builtin_shufflevector(h, h, 0, 2, 4, 6), BoundParts);
    }
#endif
    if constexpr (N::is_fixed)
        return __builtin_convertvector(BoundSigns{v.x.raw, v.y.raw, v.z.raw}, BoundParts);
    else
        return BoundParts{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
template <class N, class L>
constexpr float bound_ulp()
{
    if constexpr (N::is_fixed)
        return 1.0f / static_cast<float>(int64_t{1} << L::frac);
    else
        return 1.0f;
}

// A ray as it is held against boxes.
template <class N>
class BoxRay {
public:
    explicit QRAY_INLINE BoxRay(const Ray<N>& ray)
    {
        using Length = typename N::Length;
        using Unit = typename N::Unit;
        constexpr float least = 0x1p-30f / bound_ulp<N, Unit>();
        const BoundParts d = bound_parts<N>(ray.direction);
        const BoundSigns bits = __builtin_bit_cast(BoundSigns, d), sign = bits & INT32_MIN;
        const BoundParts size = __builtin_bit_cast(BoundParts, bits & INT32_MAX);
        const BoundParts most = size > least ? size : least + BoundParts{};
        const BoundSigns some = __builtin_bit_cast(BoundSigns, most) | sign;
        const BoundParts k = (1.0f / bound_ulp<N, Unit>()) / __builtin_bit_cast(BoundParts, some);
        const BoundParts c = bound_parts<N>(ray.origin) * (k * -bound_ulp<N, Length>()) + behind;
        kx = all_bounds(k[0]);
        ky = all_bounds(k[1]);
        kz = all_bounds(k[2]);
        cx = all_bounds(c[0]);
        cy = all_bounds(c[1]);
        cz = all_bounds(c[2]);
        near_x = sign[0] < 0;
        near_y = sign[1] < 0;
        near_z = sign[2] < 0;
    }

    // Which boxes of a node the ray may enter before `limit`, as bits, and where.
    QRAY_INLINE uint32_t enters(const BoxNode& node, float limit, Bounds& from) const
    {
        const auto& [x, y, z] = node.sides;
        from = higher(higher(mul_add(x[near_x], kx, cx), mul_add(y[near_y], ky, cy)),
                      higher(mul_add(z[near_z], kz, cz), Bounds{}));
        const Bounds to = lower(lower(mul_add(x[near_x ^ 1], kx, cx), mul_add(y[near_y ^ 1], ky, cy)),
                                lower(mul_add(z[near_z ^ 1], kz, cz), all_bounds(limit)));
        return mask_bits(from <= to);
    }

    // A ray is followed from so far behind its origin on, and so far beyond a limit.
    static constexpr float behind = hit_slack<N> / 512.0f;
    static QRAY_INLINE float beyond(typename N::Length limit)
    {
        constexpr float more = 2 * behind;
        if constexpr (N::is_fixed)
            return static_cast<float>(limit.raw) * bound_ulp<N, typename N::Length>() + more;
        else
            return static_cast<float>(limit) + more;
    }

private:
    Bounds kx, ky, kz, cx, cy, cz; // 1/d and -o/d
    size_t near_x, near_y, near_z; // which side of each axis is near
};

// A ray as it is held against balls, where these are few: it needs no quotients. In units that make conversion cheap: a
// fixed point's ulp, also for directions.
template <class N>
class BallRay {
public:
    // A length of 1, and the length of a direction.
    static constexpr float length = 1 / bound_ulp<N, typename N::Length>(), unit = 1 / bound_ulp<N, typename N::Unit>();

    explicit QRAY_INLINE BallRay(const Ray<N>& ray)
    {
        const BoundParts o = bound_parts<N>(ray.origin);
        BoundParts d = bound_parts<N>(ray.direction);
        if constexpr (NarrowFixed<N>) // the direction's length is wrong in the 14th bit
            d *= 1.5f - 0.5f / (unit * unit) * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        ox = all_bounds(o[0]);
        oy = all_bounds(o[1]);
        oz = all_bounds(o[2]);
        dx = all_bounds(d[0]);
        dy = all_bounds(d[1]);
        dz = all_bounds(d[2]);
    }

    // Which balls the ray may enter. |v|^2 - (v.d)^2 is compared with r^2, and v.d is at least -r unless the ball is
    // behind. With |v| < 2^7 and 24 bits, each side of the first comparison is wrong by less than 2^-19 |v|^2; the
    // builder adds to r what the rounded coordinates may be off.
    QRAY_INLINE uint32_t enters(const BallNode& b) const
    {
        constexpr float k = (1.0f - 0x1p-18f) * unit * unit;
        const Bounds x = b.x - ox, y = b.y - oy, z = b.z - oz;
        const Bounds along = mul_add(z, dz, mul_add(y, dy, x * dx));
        const Bounds apart = mul_add(z, z, mul_add(y, y, x * x)) * k - along * along;
        // The sign is the highest bit, which is the only one that mask_bits() sees.
        return mask_bits((apart <= b.square) & ~__builtin_bit_cast(BoundMask, along + b.reach));
    }

private:
    Bounds ox, oy, oz, dx, dy, dz;
};

// A ray as it is held against the outlines of a leaf's shapes.
template <class N, bool Has>
struct Outlines {
    explicit QRAY_INLINE Outlines(const Ray<N>&) {}
    QRAY_INLINE bool surely_missed(const Tree<N>&, const TreeShape&, bool&) { return false; }
};
template <class N>
struct Outlines<N, true> {
    const Ray<N>& of;
    OutlineRay<N> ray; // made for the first outline: many rays ask none
    uint32_t held = ~0u, crossed = 0, unsure = 0; // block number `held`

    explicit QRAY_INLINE Outlines(const Ray<N>& r) : of(r) {}
    QRAY_INLINE bool surely_missed(const Tree<N>& tree, const TreeShape& shape, bool& open)
    {
        if (shape.blocks == 0)
            return false;
        if (shape.block != held) {
            if (held == ~0u)
                ray = OutlineRay<N>(of);
            held = shape.block;
            if (shape.blocks == 1)
                crossed = ray.crossed(tree.outlines[held], unsure);
        }
        uint32_t edges = crossed, doubt = unsure;
        if (shape.blocks > 1)
            edges = all_crossed(tree.outlines + shape.block, shape.blocks, doubt);
        edges &= shape.edges;
        doubt &= shape.edges;
        open = doubt != 0;
        return !open && !__builtin_parity(edges);
    }

private:
    // As many bits, but for pairs of them, as edges of all blocks cross.
    QRAY_NOINLINE uint32_t all_crossed(const OutlineBlock<N>* blocks, uint32_t count, uint32_t& doubt) const
    {
        uint32_t edges = 0;
        doubt = 0;
        for (uint32_t i = 0; i < count; i += bound_lanes) {
            const OutlineBlock<N>* const extents = blocks + count + i / bound_lanes * 2;
            uint32_t near = ray.meets(extents[0], extents[1]);
            near &= count - i < bound_lanes ? (1u << (count - i)) - 1 : ~0u;
            for (; near != 0; near &= near - 1) {
                uint32_t unsure_edges = 0;
                edges ^= ray.crossed(blocks[i + lowest_bit(near)], unsure_edges);
                doubt |= unsure_edges;
            }
        }
        return edges;
    }
};

// Calls visit(ShapeId, open) for every shape whose box the ray may enter before limit(), and whose outline, if it has
// one, it passes inside of or, where that is open, may do so, until visit returns true: the nearest boxes first, or in
// any order. limit() is asked again after each leaf, as hits come nearer.
template <bool NearestFirst, bool HasCorners, class N, class Limit, class Visit>
QRAY_INLINE void walk(const Tree<N>& tree, const Ray<N>& ray, Limit limit, Visit visit)
{
    Outlines<N, HasCorners && has_outlines<N>> outlines(ray);
    const auto ask = [&](const TreeShape& shape) __attribute__((always_inline)) {
        bool open = false;
        return !outlines.surely_missed(tree, shape, open) && visit(shape.id, open);
    };
    // Boxes that wait: where the ray enters them, and above their links.
    uint64_t stack[Tree<N>::max_depth * (bound_lanes - 1) + 1];
    uint64_t* top = stack;
    if (tree.ball_nodes != 0) {
        const BallRay<N> held(ray);
        uint32_t mask = held.enters(tree.balls[0]);
        for (uint32_t i = 1; i < tree.ball_nodes; i++)
            mask |= held.enters(tree.balls[i]) << i * bound_lanes;
        for (; mask != 0; mask &= mask - 1)
            if (ask(tree.shapes[lowest_bit(mask)]))
                return;
        return;
    }
    const BoxRay<N> bounded(ray);
    float end = BoxRay<N>::beyond(limit());
    uint32_t link = 0;
    constexpr uint32_t nothing = ~0u;
    for (;;) {
        while ((link & leaf_bit) == 0) {
            const BoxNode& node = tree.nodes[link];
            Bounds entered;
            uint32_t mask = bounded.enters(node, end, entered);
            if (mask == 0) {
                link = nothing;
                break;
            }
            uint32_t i = lowest_bit(mask);
            mask &= mask - 1;
            link = node.links[i];
            if (mask == 0)
                continue;
            struct Bits {
                uint32_t of[bound_lanes]; // of numbers >= 0: in their order
            };
            const Bits bits = __builtin_bit_cast(Bits, entered);
            uint64_t nearest = uint64_t{bits.of[i]} << 32 | link;
            uint64_t* const base = top;
            do {
                i = lowest_bit(mask);
                mask &= mask - 1;
                uint64_t* at = top++;
                if constexpr (NearestFirst) {
                    const uint64_t e = uint64_t{bits.of[i]} << 32 | node.links[i];
                    const uint64_t farther = e > nearest ? e : nearest;
                    nearest = e > nearest ? nearest : e;
                    for (; at != base && at[-1] < farther; at--)
                        *at = at[-1];
                    *at = farther;
                } else {
                    *at = node.links[i];
                }
            } while (mask != 0);
            if constexpr (NearestFirst)
                link = static_cast<uint32_t>(nearest);
        }
        if (link != nothing) {
            for (uint32_t i = link & 0x0fffffff, count = (link >> 28 & 7) + 1; count != 0; i++, count--)
                if (ask(tree.shapes[i]))
                    return;
            if constexpr (NearestFirst)
                end = BoxRay<N>::beyond(limit());
        }
        do {
            if (top == stack)
                return;
            link = static_cast<uint32_t>(*--top);
        } while (NearestFirst && __builtin_bit_cast(float, static_cast<uint32_t>(*top >> 32)) > end);
    }
}

} // namespace qray
