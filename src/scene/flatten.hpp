// Builds the tree of a compiled scene: the binary one of split.hpp in preorder, the child nearer to the eye first, and the
// shapes in the order of its leaves.
#pragma once

#include "storage.hpp"
#include "tree_builder.hpp"

namespace qray::scene {

// From so many surfaces on a tree pays on all boards; of fewer, some scenes are drawn faster without. In q16 boxes are wider
// and a shape's own test is short.
template <class N>
inline constexpr uint32_t least_for_tree = NarrowFixed<N> ? 40 : 24;

template <class N>
class Flattener {
public:
    explicit Flattener(Storage<N>& storage) : s(storage) {}

    void flatten()
    {
        uint32_t shapes = 0;
#define QRAY_START(Type, name, table) \
        first[static_cast<int>(Kind::name)] = shapes; \
        shapes += s.table.count;
        QRAY_SHAPES(QRAY_START)
#undef QRAY_START
        box_shapes(s);
        const uint32_t count = split_by_area(s.split_shapes.data, shapes, 2, nodes);
        choose(count);
        if (count != 0)
            entries();
        s.entries.push() = {0, 0, 0, UINT16_MAX, UINT16_MAX, UINT16_MAX, TreeEntry<N>::last};
#define QRAY_REORDER(Type, name, table) reorder(s.table.data, order + first[static_cast<int>(Kind::name)], s.table.count);
        QRAY_SHAPES(QRAY_REORDER)
#undef QRAY_REORDER
    }

private:
    static constexpr int kinds = 8; // as a leaf's link has bits for

    Storage<N>& s;
    SplitBox* const nodes = s.split_nodes.data;
    uint32_t* const tests = s.tests.data;         // of a node: boxes below it that are tested where it is met; 0: it has none
    uint32_t* const order = s.order.data;         // old numbers of shapes by new ones, kind after kind
    uint32_t first[kinds] = {}, placed[kinds] = {}; // of a kind: its place there, and how many have a new number

    // Which inner nodes have a box. One that is met by the share p of its parent's rays costs these a test, and saves the
    // others those of the k boxes directly below it: it pays where k (1 - p) > 1.
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

    // Shapes of one kind make an entry, and get the next numbers of that kind.
    void leaf(const SplitBox* at, uint32_t count)
    {
        const auto kind_of = [](const SplitBox& shape) { return ShapeId{shape.first}.kind(); };
        for (const SplitBox* const end = at + count; at != end;) {
            const Kind kind = kind_of(*at);
            const int k = static_cast<int>(kind);
            const uint32_t begin = placed[k];
            SplitBounds box;
            for (; at != end && kind_of(*at) == kind; at++) {
                box.add(at->lows(), at->highs());
                order[first[k] + placed[k]++] = ShapeId{at->first}.index();
            }
            entry(box.low, box.high, TreeEntry<N>::leaf(kind, begin, placed[k] - begin));
        }
    }

    void entry(const Quad& low, const Quad& high, uint32_t link)
    {
        const auto side = [](float l, float h, int16_t& middle, uint16_t& half) {
            constexpr float steps = 1 << ProjectedRay::step_frac, slack = TreeEntry<N>::slack;
            const int from = static_cast<int>(fmaxf(floorf(l * steps - slack), INT16_MIN));
            const int to = static_cast<int>(fminf(ceilf(h * steps + slack), INT16_MAX));
            middle = static_cast<int16_t>((from + to) >> 1);
            half = static_cast<uint16_t>(to - middle);
        };
        TreeEntry<N>& e = s.entries.push();
        side(low[0], high[0], e.x, e.half_x);
        side(low[1], high[1], e.y, e.half_y);
        side(low[2], high[2], e.z, e.half_z);
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

    // Puts a table into its new order: entry i is what was entry old[i]. Goes round the circles in which they change places.
    template <class T>
    static void reorder(T* table, uint32_t* old, uint32_t count)
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
};

} // namespace qray::scene
