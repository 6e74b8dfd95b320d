// Builds the desktop's tree of boxes from the binary one.
#pragma once

#include "split.hpp"
#include "storage.hpp"

namespace qray::scene {

// How far outside of a shape its hits are, and a box is therefore wider. Let a ray's line be o + t d with these very
// numbers, which trees and shapes read alike. Shown here: where a shape reports a hit at t, there is a t' no farther
// from t than hit_slack where the line is in the shape's box but for box_slack less 4.7e-5, which is what tree.hpp may
// be off by; flat_tree.hpp has slack of its own. Points are within 62 of the middle, so that lengths are at most 124; u
// = 2^-24. In q32, q16 and float (in double all is less than in float, in q24 less than in q16):
//
// Disc. In fixed point n.(c - o) and n.d are exact, and their quotient is off by 2^-25; in q16 by 2^-14 of it and
// 2^-11, 0.0081. So is the point at t off the plane; from the centre it is no farther than the radius and the roundings
// of t d and of the comparison, 2^-23 and 5 2^-10. In float c - o is off by 2^-18 a component, the products and sums of
// its dot product by 3 124 u, those of n.d by 3 u, which counts 124 times, and the quotient by u: 6.6e-6 + 22e-6 +
// 22e-6 + 7.4e-6 off the plane, and along it t d by 13e-6: 6.0e-5 in all of the 7.5e-5 there are.
//
// Sphere. It is met where |p| <= r for the point p = m d - v of the line, as seen from the centre, with m near v.d:
// that p is rounded by 2^-24, 2^-10, 2e-5. The line is in the ball, and the hit at m -+ sqrt(r^2 - |p|^2) no farther
// from what it cuts out than m is from the foot: (|d|^2 - 1) |v| and roundings, that is 5e-7, 0.062, 7.5e-5.
//
// Cone. The line's point nearest to the middle is no farther from it than the bound, nor the hit from that point; so
// the hit is within sqrt(2) bounds, and along the axis within `half` but for 2 ulp. Its radius is that of the frustum
// there but for roundings, divided by the cosine, for which its box has 1e-4; a ray along a generator, whose A is next
// to 0, is not covered by that, nor is it shown that it is not met beyond.
//
// Polygon, patch, triangle. In fixed point the line does pass through the corners' hull, at a t' where it is above the
// plane by what the corners are: these and their normal are rounded, by sqrt(3) (2^-24 + 124 2^-31) = 2.1e-7 together,
// in q16 0.0084. With c = |n.d| the plane is met no farther from t' than that, and what t is off by, over c: 0.0069 for
// c >= 2^-15, in q16 0.0084/c + 0.0081 = 0.15 for c >= 1/16. In q24 it is 1.3e-4 for the corners and the normal, 6e-6
// for n.(c - o) and 4.5e-5 for n.d, over c, and 2^-16: 0.19 for c >= 2^-10. In float outlines are off by 2e-5, and t by
// 7.1e-5/c: 0.0625 for c >= 1.2e-3. What is flatter is met somewhere between its nearest and its farthest corner; none
// of 10^7 hostile rays, a quarter of them along an axis, told that from a tree (make soak-trees). Of corners that are
// off their plane in the text see reach_beside().
template <class N>
inline constexpr double box_slack = NarrowFixed<N> ? 1.0 / 16 : 0x1p-13;

// Box number i, or none.
inline void set_box(BoxNode& node, uint32_t i, const SplitBox* box)
{
    for (int axis = 0; axis < 3; axis++) {
        node.sides[axis][0][i] = box != nullptr ? box->low[axis] : HUGE_VALF;
        node.sides[axis][1][i] = box != nullptr ? box->high[axis] : -HUGE_VALF;
    }
}

// The ball in a box that a sphere fills, or around it; or none.
template <class N>
void set_ball(BallNode& balls, uint32_t i, const SplitBox* box)
{
    const double length = static_cast<double>(BallRay<N>::length), unit = static_cast<double>(BallRay<N>::unit);
    const Vec3d low = box != nullptr ? value(box->lows()) : Vec3d{};
    const Vec3d high = box != nullptr ? value(box->highs()) : Vec3d{};
    const Vec3d centre = (low + high) * 0.5, half = (high - low) * 0.5;
    const bool fills = box != nullptr && is_ball(ShapeId{box->first}.kind());
    // Wider by what coordinates below 2^7 may be off in 24 bits, here and in a ray's origin: the box's slack is.
    const double r = fills ? half.x : scene::length(half), reach = r * length * unit;
    const double behind = hit_slack<N> / 512.0 * length * unit;
    balls.x[i] = static_cast<float>(centre.x * length);
    balls.y[i] = static_cast<float>(centre.y * length);
    balls.z[i] = static_cast<float>(centre.z * length);
    balls.reach[i] = box != nullptr ? static_cast<float>(reach + behind) : -1.0f;
    balls.square[i] = box != nullptr ? static_cast<float>(reach * reach) : -HUGE_VALF;
}

// The outline that a shape has in the tree; of no corners where it has none.
template <class N>
Figure<Point<N>> outline_of([[maybe_unused]] const Storage<N>& s, [[maybe_unused]] ShapeId id)
{
#define QRAY_CASE(Type, name, table) \
    if constexpr (has_outlines<N> && Type<N>::has_corners) \
        if (id.kind() == Kind::name) \
            return s.table.data[id.index()].figure(s.vertices.data);
    QRAY_SHAPES(QRAY_CASE)
#undef QRAY_CASE
    return {};
}

template <class N>
class OutlineBuilder {
public:
    explicit OutlineBuilder(Storage<N>& storage) : s(storage) {}

    // The shapes of a leaf, those with few corners together in a block.
    void add(uint32_t first, uint32_t count)
    {
        filled = bound_lanes;
        for (uint32_t i = first; i != first + count; i++) {
            const ShapeId id{s.split_shapes.data[i].first};
            TreeShape& shape = s.tree_shapes.data[i];
            shape = {id, 0, 0, 0};
            if constexpr (has_outlines<N>)
                if (const Figure<Point<N>> figure = outline_of(s, id); figure.count != 0)
                    outline(shape, figure);
        }
    }

private:
    Storage<N>& s;
    uint32_t filled; // corners of the last block

    void outline(TreeShape& shape, const Figure<Point<N>>& figure)
    {
        const uint32_t count = figure.count;
        // A corner again makes an edge without length, which crosses nothing.
        const auto corner = [&](uint32_t i) { return figure[i < count ? i : 0]; };
        const uint32_t own = count > 4 ? 3 : 4, fours = (count + own - 1) / own; // edges of a four
        if (fours * 4 > bound_lanes - filled)
            filled = bound_lanes;
        shape.block = s.outlines.count - (filled < bound_lanes);
        shape.edges = (count > 4 ? 0x77777777 : (1u << count) - 1) << filled % bound_lanes;
        for (uint32_t i = 0; i < fours * 4; i++, filled++) {
            if (filled == bound_lanes) {
                filled = 0;
                push(corner(0));
            }
            put(s.outlines.count - 1, filled, corner(i / 4 * own + i % 4));
        }
        shape.blocks = s.outlines.count - shape.block;
        if (shape.blocks == 1)
            return;
        filled = bound_lanes; // and none but its own
        for (uint32_t i = 0; i < shape.blocks; i++) {
            if (i % bound_lanes == 0) {
                push(corner(0));
                push(corner(0));
            }
            for (int axis = 0; axis < 3; axis++) {
                const auto& row = s.outlines.data[shape.block + i].corners[axis];
                auto low = row[0], high = low;
                for (uint32_t lane = 1; lane < bound_lanes; lane++) {
                    low = std::min(low, row[lane]);
                    high = std::max(high, row[lane]);
                }
                s.outlines.data[s.outlines.count - 2].corners[axis][i % bound_lanes] = low;
                s.outlines.data[s.outlines.count - 1].corners[axis][i % bound_lanes] = high;
            }
        }
    }
    void push(const Point<N>& p)
    {
        s.outlines.push();
        for (uint32_t lane = 0; lane < bound_lanes; lane++)
            put(s.outlines.count - 1, lane, p);
    }
    void put(uint32_t block, uint32_t lane, const Point<N>& p)
    {
        auto& rows = s.outlines.data[block].corners;
        rows[0][lane] = coordinate(p.x);
        rows[1][lane] = coordinate(p.y);
        rows[2][lane] = coordinate(p.z);
    }
    static auto coordinate(typename N::Length v)
    {
        if constexpr (N::is_fixed)
            return v.raw;
        else
            return v;
    }
};

// The boxes of all shapes.
template <class N>
void box_shapes(Storage<N>& s)
{
    s.split_shapes.count = 0;
#define QRAY_ADD(Type, name, table) \
    for (uint32_t i = 0; i < s.table.count; i++) \
        s.split_shapes.push() = SplitBox::around(Host<Type>::box(s.table.data[i], {s.vertices.data, s.normals.data}), \
                                                 box_slack<N>, shape_id(Kind::name, i).bits);
    QRAY_SHAPES(QRAY_ADD)
#undef QRAY_ADD
}

// Puts a table into its new order: entry i is what was entry old[i]. Goes round the circles in
// which they change places.
template <class T>
void reorder(T* table, uint32_t* old, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const T kept = table[i];
        uint32_t to = i;
        for (uint32_t from; (from = old[to]) != i; to = from) {
            table[to] = table[from];
            old[to] = to;
        }
        table[to] = kept;
        old[to] = to;
    }
}

// The binary tree over all shapes, of whose boxes it is made, and these in the order of its leaves. Returns
// how many nodes it has.
template <class N>
uint32_t split_shapes(Storage<N>& s)
{
    const uint32_t nodes = split_by_area(s.split_shapes.data, s.split_shapes.count, 2, s.split_nodes.data);
    uint32_t start = 0;
#define QRAY_ORDER(Type, name, table) \
    { \
        uint32_t* const old = s.order.data + start; \
        uint32_t next = 0; \
        for (uint32_t i = 0; i < s.split_shapes.count; i++) \
            if (uint32_t& id = s.split_shapes.data[i].first; ShapeId{id}.kind() == Kind::name) { \
                old[next] = ShapeId{id}.index(); \
                id = shape_id(Kind::name, next++).bits; \
            } \
        reorder(s.table.data, old, next); \
        start += next; \
    }
    QRAY_SHAPES(QRAY_ORDER)
#undef QRAY_ORDER
    return nodes;
}

template <class N>
void build_tree(Storage<N>& s)
{
    static_assert(Tree<N>::max_depth == max_split_depth);
    box_shapes(s);
    s.nodes.count = s.tree_shapes.count = s.outlines.count = 0;
    const uint32_t count = s.split_shapes.count;
    OutlineBuilder<N> outlines(s);
    s.tree_shapes.count = count;
    const uint32_t ball_nodes = count == 0 ? 1 : (count + bound_lanes - 1) / bound_lanes;
    s.tree = {s.nodes.data, s.tree_shapes.data, s.outlines.data,
              ball_nodes <= Tree<N>::most_balls ? ball_nodes : 0, s.balls};
    if (s.tree.ball_nodes != 0) {
        for (uint32_t i = 0; i < ball_nodes * bound_lanes; i++)
            set_ball<N>(s.balls[i / bound_lanes], i % bound_lanes, i < count ? &s.split_shapes.data[i] : nullptr);
        outlines.add(0, count);
        return;
    }
    const SplitBox *const split = s.split_nodes.data, *const shapes = s.split_shapes.data;
    // A part of a node: of the binary tree, or leaf_link(shape, 1).
    const auto box = [=](uint32_t part) -> const SplitBox& {
        return (part & leaf_bit) != 0 ? shapes[part ^ leaf_bit] : split[part];
    };
    // Pairs do, but for those with their outlines in one block.
    const auto comes_apart = [&](const SplitBox& part) {
        const auto in_block = [&](uint32_t i) { return outline_of(s, {shapes[i].first}).count != 0; };
        return part.count == 0 || (part.count == 2 && !(in_block(part.first) && in_block(part.first + 1)));
    };
    split_shapes(s);
    // A node's first link is, until it is made, the part of the binary tree that it stands for.
    s.nodes.push().links[0] = 0;
    for (uint32_t made = 0; made < s.nodes.count; made++) {
        BoxNode& node = s.nodes.data[made];
        // The largest part is taken apart until there are enough.
        uint32_t parts[bound_lanes] = {node.links[0]}, filled = 1;
        while (filled < bound_lanes) {
            float most = -1;
            uint32_t largest = 0;
            for (uint32_t i = 0; i < filled; i++)
                if (const SplitBox& part = box(parts[i]); comes_apart(part) && part.half_area() > most) {
                    most = part.half_area();
                    largest = i;
                }
            if (most < 0)
                break;
            const SplitBox& part = box(parts[largest]);
            const uint32_t child = part.count == 0 ? part.first : leaf_link(part.first, 1);
            parts[largest] = child;
            parts[filled++] = child + 1;
        }
        for (uint32_t i = 0; i < bound_lanes; i++) {
            const SplitBox* const part = i < filled ? &box(parts[i]) : nullptr;
            set_box(node, i, part);
            if (part != nullptr && part->count == 0) {
                node.links[i] = s.nodes.count;
                s.nodes.push().links[0] = parts[i];
            } else if (part != nullptr) {
                const uint32_t first = (parts[i] & leaf_bit) != 0 ? parts[i] ^ leaf_bit : part->first;
                node.links[i] = leaf_link(first, part->count);
                outlines.add(first, part->count);
            }
        }
    }
}

} // namespace qray::scene
