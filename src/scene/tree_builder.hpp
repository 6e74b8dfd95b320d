// Builds the desktop's tree of boxes from the binary one.
#pragma once

#include "split.hpp"
#include "storage.hpp"

namespace qray::scene {

// A hit lies outside its shape by less, in the moved and scaled scene, than this less 4.3e-5, which is what tree.hpp may
// be off by: some roundings of lengths up to 124, in q16 as far as its direction leads astray in 14 bits.
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
    Vec3d centre, half;
    if (box != nullptr) {
        const Vec3d low = {box->low[0], box->low[1], box->low[2]}, high{box->high[0], box->high[1], box->high[2]};
        centre = (low + high) * 0.5;
        half = (high - low) * 0.5;
    }
    const bool fills = box != nullptr && ShapeId{box->first}.kind() == Kind::sphere;
    // Wider by what coordinates below 2^7 may be off in 24 bits, here and in a ray's origin: the box's slack is.
    const double r = fills ? half.x : scene::length(half), reach = r * length * unit;
    balls.x[i] = static_cast<float>(centre.x * length);
    balls.y[i] = static_cast<float>(centre.y * length);
    balls.z[i] = static_cast<float>(centre.z * length);
    balls.reach[i] = box != nullptr ? static_cast<float>(reach) : -1.0f;
    balls.square[i] = box != nullptr ? static_cast<float>(reach * reach) : -HUGE_VALF;
}

template <class N>
void build_tree(Storage<N>& s)
{
    static_assert(Tree::max_depth == max_split_depth);
    s.split_shapes.count = s.nodes.count = s.shape_ids.count = 0;
#define QRAY_ADD(Type, name, table) \
    for (uint32_t i = 0; i < s.table.count; i++) \
        s.split_shapes.push() = SplitBox::around(Host<Type>::box(s.table.data[i], {s.vertices.data, s.normals.data}), \
                                                 box_slack<N>, shape_id(Kind::name, i).bits);
    QRAY_SHAPES(QRAY_ADD)
#undef QRAY_ADD
    const uint32_t count = s.split_shapes.count;
    for (uint32_t i = 0; i < count; i++)
        s.shape_ids.push() = {s.split_shapes.data[i].first};
    const uint32_t ball_nodes = count == 0 ? 1 : (count + bound_lanes - 1) / bound_lanes;
    s.tree = {s.nodes.data, s.shape_ids.data, ball_nodes <= Tree::most_balls ? ball_nodes : 0, s.balls};
    if (s.tree.ball_nodes != 0) {
        for (uint32_t i = 0; i < ball_nodes * bound_lanes; i++)
            set_ball<N>(s.balls[i / bound_lanes], i % bound_lanes, i < count ? &s.split_shapes.data[i] : nullptr);
        return;
    }
    const SplitBox* const split = s.split_nodes.data;
    split_by_area(s.split_shapes.data, count, 2, s.split_nodes.data);
    for (uint32_t i = 0; i < count; i++)
        s.shape_ids.data[i] = {s.split_shapes.data[i].first};
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
                if (const SplitBox& part = split[parts[i]]; part.count == 0 && part.half_area() > most) {
                    most = part.half_area();
                    largest = i;
                }
            if (most < 0)
                break;
            parts[filled++] = split[parts[largest]].first + 1;
            parts[largest] = split[parts[largest]].first;
        }
        for (uint32_t i = 0; i < bound_lanes; i++) {
            const SplitBox* const part = i < filled ? &split[parts[i]] : nullptr;
            set_box(node, i, part);
            if (part != nullptr && part->count == 0) {
                node.links[i] = s.nodes.count;
                s.nodes.push().links[0] = parts[i];
            } else if (part != nullptr) {
                node.links[i] = leaf_link(part->first, part->count);
            }
        }
    }
}

} // namespace qray::scene
