// Builds the tree of a compiled scene: the binary one of split.hpp in preorder, the child nearer to the eye first.
#pragma once

#include <qray/scene/refit.hpp>

#include "storage.hpp"
#include "tree_builder.hpp"

namespace qray::scene {

// From so many surfaces on a tree pays on all boards; of fewer, some scenes are drawn faster without. In q16 boxes are
// wider and a shape's own test is short.
template <class N>
inline constexpr uint32_t least_for_tree = ShortFixed<N> ? 40 : 24;

template <class N>
inline constexpr TreeEntry<N> last_entry{0, 0, 0, UINT16_MAX, UINT16_MAX, UINT16_MAX, TreeEntry<N>::last};

template <class N>
class Flattener {
public:
    explicit Flattener(Storage<N>& storage) : s(storage) {}

    void flatten()
    {
        box_shapes(s);
        const uint32_t count = split_shapes(s);
        choose(count);
        if (count != 0)
            entries();
        s.entries.push() = last_entry<N>;
    }

private:
    Storage<N>& s;
    SplitBox* const nodes = s.split_nodes.data;
    uint32_t* const tests = s.tests.data; // of a node: boxes below it that are tested where it is met; 0: it has none

    // Which inner nodes have a box. One that is met by the share p of its parent's rays costs these a test, and saves
    // the others those of the k boxes directly below it: it pays where k (1 - p) > 1.
    void choose(uint32_t count)
    {
        for (uint32_t i = count; i-- > 0;) {
            tests[i] = 1;
            if (nodes[i].count != 0)
                continue;
            uint32_t below = 0;
            for (const uint32_t child : {nodes[i].first, nodes[i].first + 1}) {
                const float missed = 1 - nodes[child].half_area() / nodes[i].half_area();
                const bool has_box = nodes[child].count != 0 || static_cast<float>(tests[child]) * missed > 1;
                below += has_box ? 1 : tests[child];
                if (!has_box)
                    tests[child] = 0;
            }
            tests[i] = i != 0 ? below : 0; // all rays meet the whole
        }
    }

    void entries()
    {
        struct {
            bool ends; // entry `number` ends here; otherwise node `number` begins
            uint32_t number;
        } stack[3 * max_split_depth];
        uint32_t waiting = 1;
        stack[0] = {false, 0};
        while (waiting != 0) {
            const auto [ends, number] = stack[--waiting];
            if (ends) {
                s.entries.data[number].link = s.entries.count - number;
                continue;
            }
            const SplitBox& node = nodes[number];
            if (node.count != 0) {
                leaf(s.split_shapes.data + node.first, node.count);
                continue;
            }
            if (tests[number] != 0) {
                stack[waiting++] = {true, s.entries.count};
                entry(node.lows(), node.highs(), 0);
            }
            const bool swapped = distance(nodes[node.first + 1]) < distance(nodes[node.first]);
            stack[waiting++] = {false, node.first + !swapped};
            stack[waiting++] = {false, node.first + swapped};
        }
    }

    // Shapes of one kind make an entry.
    void leaf(const SplitBox* at, uint32_t count)
    {
        for (const SplitBox* const end = at + count; at != end;) {
            const ShapeId first{at->first};
            SplitBounds box;
            for (; at != end && ShapeId{at->first}.kind() == first.kind(); at++)
                box.add(at->lows(), at->highs());
            entry(box.low, box.high, TreeEntry<N>::leaf(first.kind(), first.index(), box.count));
        }
    }

    void entry(const Quad& low, const Quad& high, uint32_t link)
    {
        constexpr float steps = 1 << ProjectedRay::step_frac, slack = TreeEntry<N>::slack;
        detail::StepBox<N> box;
        for (int i = 0; i < 3; i++) {
            box.low[i] = static_cast<int32_t>(floorf(low[i] * steps - slack));
            box.high[i] = static_cast<int32_t>(ceilf(high[i] * steps + slack));
        }
        TreeEntry<N>& e = s.entries.push();
        box.put(e);
        e.link = link;
    }

    // From the eye, squared.
    double distance(const SplitBox& box) const
    {
        const Vec3d eye = value(s.camera.eye);
        const double at[] = {eye.x, eye.y, eye.z};
        double square = 0;
        for (int i = 0; i < 3; i++) {
            const double low = static_cast<double>(box.low[i]), high = static_cast<double>(box.high[i]);
            const double off = fmax(0, fmax(low - at[i], at[i] - high));
            square += off * off;
        }
        return square;
    }
};

} // namespace qray::scene
