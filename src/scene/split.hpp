// A binary tree of boxes over shapes, by the surface area heuristic in 16 bins of centroids (Wald, On fast construction
// of SAH-based bounding volume hierarchies, 2007): what the trees of desktops and of boards are made of. Each step
// depends on which shapes are in a set and never on their order, so that the tree is the same on every machine.
#pragma once

#include <math.h>
#include <string.h>

#include <algorithm>

#include "vec3d.hpp"

namespace qray::scene {

typedef float Quad __attribute__((vector_size(16))); // x, y, z and a number that does not count
inline Vec3d value(const Quad& q)
{
    return {static_cast<double>(q[0]), static_cast<double>(q[1]), static_cast<double>(q[2])};
}
inline Quad lower(const Quad& a, const Quad& b) { return a < b ? a : b; }
inline Quad higher(const Quad& a, const Quad& b) { return a > b ? a : b; }

// A box, and what is in it. Of a shape: `first` is its number, as the caller likes. Of a node: where count is 0, nodes
// first and first + 1, else shapes first to first + count - 1.
struct SplitBox {
    float low[3], high[3];
    uint32_t first, count;

    // Holds all of `extent`, which is within +-2^30, and `slack` on each side.
    static SplitBox around(const Extent& extent, double slack, uint32_t number)
    {
        SplitBox box{{}, {}, number, 1};
        const Vec3d wide{slack, slack, slack}, l = extent.low - wide, h = extent.high + wide;
        const double lows[] = {l.x, l.y, l.z}, highs[] = {h.x, h.y, h.z};
        for (int i = 0; i < 3; i++) {
            const float low = static_cast<float>(lows[i]), high = static_cast<float>(highs[i]);
            box.low[i] = (static_cast<double>(low) > lows[i] ? nextafterf(low, -HUGE_VALF) : low) + 0.0f; // -0 is 0
            box.high[i] = (static_cast<double>(high) < highs[i] ? nextafterf(high, HUGE_VALF) : high) + 0.0f;
        }
        return box;
    }
    float half_area() const
    {
        const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
        return x * y + y * z + z * x;
    }
    Quad lows() const { return quad(low); }
    Quad highs() const { return quad(high); }
    Quad centre() const { return lows() + highs(); } // twice that

private:
    static Quad quad(const float v[3]) { return Quad{v[0], v[1], v[2], 0}; }
};

// Of some boxes.
struct SplitBounds {
    Quad low{HUGE_VALF, HUGE_VALF, HUGE_VALF, HUGE_VALF}, high = -low;
    uint32_t count = 0;

    void add(const Quad& l, const Quad& h, uint32_t n = 1)
    {
        low = lower(low, l);
        high = higher(high, h);
        count += n;
    }
    // Half the surface times the number of shapes.
    float cost() const
    {
        const Quad d = high - low;
        return (d[0] * d[1] + d[1] * d[2] + d[2] * d[0]) * static_cast<float>(count);
    }
};

// No leaf is deeper: the root's depth is 0.
inline constexpr int max_split_depth = 40;

// Makes the tree over `count` shapes, whose boxes are put into its order, with at most `leaf` of them in a leaf, in
// ascending numbers; leaf 2^max_split_depth >= count. `nodes` has room for 2 count. Returns how many it takes; the root
// is the first, and a node's children stand behind it.
inline uint32_t split_by_area(SplitBox* shapes, uint32_t count, uint32_t leaf, SplitBox* nodes)
{
    constexpr int bins = 16;
    struct {
        uint32_t node;
        int left; // so many levels are left below
    } stack[max_split_depth + 1];
    if (count == 0)
        return 0;
    uint32_t used = 1;
    int waiting = 1;
    nodes[0].first = 0;
    nodes[0].count = count;
    stack[0] = {0, max_split_depth};
    while (waiting != 0) {
        const auto [number, left] = stack[--waiting];
        SplitBox& node = nodes[number];
        SplitBox* const begin = shapes + node.first;
        SplitBox* const end = begin + node.count;
        SplitBounds whole, centres;
        for (const SplitBox* s = begin; s != end; s++) {
            whole.add(s->lows(), s->highs());
            centres.add(s->centre(), s->centre());
        }
        for (int i = 0; i < 3; i++) {
            node.low[i] = whole.low[i];
            node.high[i] = whole.high[i];
        }
        if (node.count <= leaf) {
            std::sort(begin, end, [](const SplitBox& a, const SplitBox& b) { return a.first < b.first; });
            continue;
        }

        SplitBounds bin[3][bins];
        const Quad size = centres.high - centres.low;
        Quad scale;
        for (int i = 0; i < 4; i++)
            scale[i] = i < 3 && size[i] > 0x1p-60f ? static_cast<float>(bins) * (1 - 0x1p-20f) / size[i] : 0;
        for (const SplitBox* s = begin; s != end; s++) {
            const Quad at = (s->centre() - centres.low) * scale;
            for (int i = 0; i < 3; i++)
                bin[i][static_cast<int>(at[i])].add(s->lows(), s->highs());
        }
        float best = HUGE_VALF;
        int axis = 0, cut = 0;
        for (int i = 0; i < 3; i++) {
            float above[bins];
            SplitBounds sum;
            for (int b = bins - 1; b > 0; b--) {
                sum.add(bin[i][b].low, bin[i][b].high, bin[i][b].count);
                above[b] = sum.count != 0 ? sum.cost() : HUGE_VALF;
            }
            sum = {};
            for (int b = 1; b < bins; b++) {
                sum.add(bin[i][b - 1].low, bin[i][b - 1].high, bin[i][b - 1].count);
                if (const float cost = sum.count != 0 ? sum.cost() + above[b] : HUGE_VALF; cost < best) {
                    best = cost;
                    axis = i;
                    cut = b;
                }
            }
        }
        SplitBox* middle = std::partition(begin, end, [&](const SplitBox& s) {
            return static_cast<int>(((s.centre() - centres.low) * scale)[axis]) < cut;
        });
        // In one place, or too many for the levels that are left: in halves, whatever that costs.
        const auto larger = static_cast<uint64_t>(std::max(middle - begin, end - middle));
        if (larger > uint64_t{leaf} << (left - 1) || larger == node.count) {
            for (int i = 1; i < 3; i++)
                axis = size[i] > size[axis] ? i : axis;
            middle = begin + node.count / 2;
            std::nth_element(begin, middle, end, [axis](const SplitBox& a, const SplitBox& b) {
                const float ca = a.low[axis] + a.high[axis], cb = b.low[axis] + b.high[axis];
                return ca != cb ? ca < cb : a.first < b.first;
            });
        }
        SplitBox* const children = nodes + used;
        children[0].first = node.first;
        children[0].count = static_cast<uint32_t>(middle - begin);
        children[1].first = node.first + children[0].count;
        children[1].count = node.count - children[0].count;
        node.first = used;
        node.count = 0;
        stack[waiting++] = {used + 1, left - 1};
        stack[waiting++] = {used, left - 1};
        used += 2;
    }
    return used;
}

} // namespace qray::scene
