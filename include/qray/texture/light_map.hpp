// Light that flat surfaces send one another (radiosity): what arrives on a side of a surface, times its diffuse, is
// looked up there. It was found when the scene was built (src/scene/radiosity.hpp; scenes/README.md, section 3).
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// Of a surface, by its place in the scene file: for its outside and its inside the number of a map or, from `even` on,
// of a light that is the same everywhere.
template <class N>
struct LightOf {
    static constexpr uint32_t even = uint32_t{1} << 31;
    uint32_t outside, inside;
};

// Types of their own: absent tables of one type would take room in a scene.
template <class N>
struct EvenLight {
    Rgb<N> light;
};

// A scene's table of where, along an axis of a map, its nodes are: by steps, the node there in 2^-8. And of where walls
// cut what is between four nodes: 0, or a link: 2 k + 1 to cut k of the map, 2 k + 2 to part k of what cuts leave.
template <class N>
struct LightKnot {
    uint16_t value;
};
template <class N>
struct LightCut {
    uint16_t plane, above, below; // links
};
template <class N>
struct LightPlane {
    Vec<typename N::Unit> normal; // unit
    typename N::Length height;    // normal . p
};
// And of the light at all nodes: red, green and blue each, in 8 bits or, where a scene is compiled so, in 4 or 2,
// several in a byte, the first lowest.
template <class N>
struct LightCell {
    uint8_t value;
};

// How many steps along an axis a point is, in 2^-8: row . q + offset, at most 2^30 either way.
template <class N>
struct LightSteps {
    static constexpr int32_t most = 1 << 15; // steps of a length of 1
    Vec<typename N::Length> row; // 2^8 / step, in fixed point 2^24 of these to a length of 1
    int32_t offset;
    constexpr int32_t operator()(const Point<N>& q) const
    {
        if constexpr (N::is_fixed)
            return static_cast<int32_t>(dot<N>(q, row).raw >> 32) + offset;
        else
            return static_cast<int32_t>(dot<N>(q, row)) + offset;
    }
};
template <NarrowFixed N>
struct LightSteps<N> {
    static constexpr int32_t most = 1 << 15;
    int32_t row_x, row_y, row_z, offset, shift; // in 2^-(8 + shift)
    constexpr int32_t operator()(const Point<N>& q) const
    {
        using Unit = typename N::Unit;
        return (N::dot(q.x, q.y, q.z, Unit{row_x}, Unit{row_y}, Unit{row_z}).raw + offset) >> shift;
    }
};

template <class N>
struct LightAxis {
    static constexpr uint32_t even = UINT32_MAX; // instead of knots: a node at each step
    LightSteps<N> steps;
    int32_t last;   // the greatest that counts
    uint32_t knots; // the first of its own

    // The node before a point, and how far the next is, in 2^-8.
    QRAY_INLINE constexpr uint32_t operator()(const Point<N>& q, const LightKnot<N>* table) const
    {
        int32_t p = steps(q);
        p = p < 0 ? 0 : p > last ? last : p;
        if (knots == even)
            return static_cast<uint32_t>(p);
        const LightKnot<N>* const at = table + knots + (p >> 8);
        return at[0].value + (static_cast<uint32_t>((at[1].value - at[0].value) * (p & 255)) >> 8);
    }
};

template <class N>
struct LightMap {
    static constexpr uint32_t whole = UINT32_MAX; // instead of roots: no walls
    LightAxis<N> x, y;
    Rgb<N> scale;           // what 256 stands for; in floating point, 2^24
    uint16_t columns, rows; // nodes, at least 2
    uint32_t first; // of its cells, row by row, and four of each part behind them
    uint32_t roots; // the first link, among the knots
    uint32_t cuts;  // the first of its own

    // Between four nodes; beyond the outermost as there. `scene` has the tables, Bits for a colour of its cells.
    template <uint32_t Bits, class Scene>
    QRAY_INLINE constexpr Rgb<N> at(const Point<N>& q, const Scene& scene) const
    {
        const LightKnot<N>* const knots = scene.light_knots.data;
        const uint32_t u = x(q, knots), v = y(q, knots);
        uint32_t cell = (v >> 8) * columns + (u >> 8), row = columns;
        if (roots != whole)
            if (uint32_t link = knots[roots + cell - (v >> 8)].value; link != 0) {
                while (link % 2 != 0) {
                    const LightCut<N>& cut = scene.light_cuts[cuts + link / 2];
                    const LightPlane<N>& plane = scene.light_planes[cut.plane];
                    link = N::length(dot<N>(q, plane.normal)) > plane.height ? cut.above : cut.below;
                }
                cell = uint32_t{columns} * rows + 2 * link - 4;
                row = 2;
            }
        const LightCell<N>* const cells = scene.light_cells.data;
        const uint32_t low = first + 3 * cell, high = low + 3 * row;
        return {light<Bits>(cells, low, high, u & 255, v & 255, scale.x),
                light<Bits>(cells, low + 1, high + 1, u & 255, v & 255, scale.y),
                light<Bits>(cells, low + 2, high + 2, u & 255, v & 255, scale.z)};
    }

private:
    // 0 to 255.
    template <uint32_t Bits>
    QRAY_INLINE static constexpr uint32_t value(const LightCell<N>* cells, uint32_t i)
    {
        constexpr uint32_t most = (1u << Bits) - 1;
        if constexpr (Bits == 8)
            return cells[i].value;
        else
            return (cells[i * Bits / 8].value >> i * Bits % 8 & most) * (255 / most);
    }
    template <uint32_t Bits>
    QRAY_INLINE static constexpr typename N::Colour light(const LightCell<N>* cells, uint32_t low, uint32_t high,
                                                          uint32_t u, uint32_t v, typename N::Colour scale)
    {
        const uint32_t below = value<Bits>(cells, low) * (256 - u) + value<Bits>(cells, low + 3) * u;
        const uint32_t above = value<Bits>(cells, high) * (256 - u) + value<Bits>(cells, high + 3) * u;
        const uint32_t sum = below * (256 - v) + above * v; // in 2^-16, below 2^24
        if constexpr (NarrowFixed<N>)
            return {static_cast<int32_t>((sum >> 9) * static_cast<uint32_t>(scale.raw) >> 15)};
        else if constexpr (N::is_fixed)
            return {static_cast<int32_t>(mul_high(sum << 8, static_cast<uint32_t>(scale.raw)))};
        else
            return static_cast<typename N::Colour>(static_cast<int32_t>(sum)) * scale;
    }
};

} // namespace qray
