// Makes a compiled scene's tree fit shapes that have moved.
#pragma once

#include "scene.hpp"

namespace qray {

namespace detail {

// In the steps of ProjectedRay, with what TreeEntry wants a box to be wider.
template <class N>
struct StepBox {
    int32_t low[3], high[3];

    static constexpr StepBox around(const BoundingBox<N>& box)
    {
        constexpr int32_t slack = TreeEntry<N>::slack;
        return {{steps(box.low.x) - slack, steps(box.low.y) - slack, steps(box.low.z) - slack},
                {steps(box.high.x) + slack + 1, steps(box.high.y) + slack + 1, steps(box.high.z) + slack + 1}};
    }
    static constexpr StepBox of(const TreeEntry<N>& e)
    {
        return {{e.x - e.half_x, e.y - e.half_y, e.z - e.half_z}, {e.x + e.half_x, e.y + e.half_y, e.z + e.half_z}};
    }
    constexpr void add(const StepBox& b)
    {
        for (int i = 0; i < 3; i++) {
            low[i] = b.low[i] < low[i] ? b.low[i] : low[i];
            high[i] = b.high[i] > high[i] ? b.high[i] : high[i];
        }
    }
    constexpr void put(TreeEntry<N>& e) const
    {
        const auto side = [this](int i, int16_t& middle, uint16_t& half) {
            const int32_t from = low[i] < INT16_MIN ? INT16_MIN : low[i];
            const int32_t to = high[i] > INT16_MAX ? INT16_MAX : high[i];
            middle = static_cast<int16_t>((from + to) >> 1);
            half = static_cast<uint16_t>(to - middle);
        };
        side(0, e.x, e.half_x);
        side(1, e.y, e.half_y);
        side(2, e.z, e.half_z);
    }

private:
    // Rounded down.
    static constexpr int32_t steps(typename N::Length v)
    {
        constexpr int frac = ProjectedRay::step_frac;
        if constexpr (N::is_fixed) {
            return v.raw >> (N::Length::frac - frac);
        } else {
            const auto scaled = v * typename N::Length(1 << frac);
            const int32_t whole = static_cast<int32_t>(scaled);
            return whole - (static_cast<typename N::Length>(whole) > scaled);
        }
    }
};

template <class N, Effects E>
constexpr BoundingBox<N> box_of(const Scene<N, E>& scene, Kind kind, uint32_t index)
{
#define QRAY_BOX(Type, name, table) \
    if constexpr (E.name) \
        if (kind == Kind::name) \
            return box_of(scene.table[index], corners_of(scene));
    QRAY_SHAPES(QRAY_BOX)
#undef QRAY_BOX
    return {};
}

} // namespace detail

// Makes every box of the tree hold what is below it: in one pass over the shapes and the entries, which are
// the scene's own, in RAM. A tree stays the better the less its shapes have left their neighbours; the picture
// does not depend on it.
template <class N, Effects E>
    requires(E.flat_tree)
constexpr void refit(const Scene<N, E>& scene, TreeEntry<N>* entries)
{
    using OnGrid = detail::StepBox<N>;
    for (uint32_t i = scene.entries.count; i-- != 0;) { // what is below an entry stands behind it
        TreeEntry<N>& e = entries[i];
        if (e.link == TreeEntry<N>::last)
            continue;
        if (e.is_leaf()) {
            const uint32_t first = e.first();
            OnGrid box = OnGrid::around(detail::box_of(scene, e.kind(), first));
            for (uint32_t k = 1; k < e.count(); k++)
                box.add(OnGrid::around(detail::box_of(scene, e.kind(), first + k)));
            box.put(e);
        } else {
            OnGrid box = OnGrid::of(entries[i + 1]);
            for (uint32_t k = i + 1; k < i + e.link; k += entries[k].is_leaf() ? 1 : entries[k].link)
                box.add(OnGrid::of(entries[k]));
            box.put(e);
        }
    }
}

} // namespace qray
