// Builds the tree of bounding balls: shapes in the order of a space-filling curve, bound_lanes to a
// block, then blocks in the same way.
#pragma once

#include <math.h>

#include <algorithm>

#include "storage.hpp"

namespace qray::scene {

template <class N>
class TreeBuilder {
public:
    explicit TreeBuilder(Storage<N>& storage) : s(storage) {}

    void build()
    {
        s.shape_ids.count = s.blocks.count = 0;
#define QRAY_ADD(Type, name, table) add(Kind::name, s.table.count);
        QRAY_SHAPES(QRAY_ADD)
#undef QRAY_ADD
        const uint32_t count = s.shape_ids.count;
        // What spans much of the scene stands apart, in front.
        if (count > 4)
            std::sort(s.shape_ids.data, s.shape_ids.data + count, [this](ShapeId a, ShapeId b) {
                const uint64_t ka = key(a), kb = key(b);
                return ka != kb ? ka < kb : a.bits < b.bits;
            });
        s.tree = {s.blocks.data, s.shape_ids.data, {}, 0, 0};
        uint32_t below = level(count, [this](uint32_t i) { return ball(s.shape_ids.data[i]); });
        while (below > 3) {
            const uint32_t first = s.tree.first[s.tree.levels - 1];
            below = level(below, [this, first](uint32_t i) { return around(s.blocks.data[first + i]); });
        }
        s.tree.top = below;
    }

private:
    Storage<N>& s;

    void add(Kind kind, uint32_t count)
    {
        for (uint32_t i = 0; i < count; i++)
            s.shape_ids.push() = shape_id(kind, i);
    }

    Ball ball(ShapeId id) const
    {
        switch (id.kind()) {
#define QRAY_BALL(Type, name, table) case Kind::name: return Host<Type>::bound(s.table.data[id.index()]);
            QRAY_SHAPES(QRAY_BALL)
#undef QRAY_BALL
        }
        __builtin_unreachable();
    }

    // Morton order of the centre, 16 bits an axis over +-64; the large ones first.
    uint64_t key(ShapeId id) const
    {
        const Ball b = ball(id);
        if (b.radius > 16)
            return 0;
        const auto spread = [](double v) {
            uint64_t x = static_cast<uint64_t>(fmin(65535, fmax(0, (v + 64) * 512)));
            x = (x | x << 16) & 0x0000ff0000ff;
            x = (x | x << 8) & 0x00f00f00f00f;
            x = (x | x << 4) & 0x0c30c30c30c3;
            return (x | x << 2) & 0x249249249249;
        };
        return 1 + (spread(b.centre.x) | spread(b.centre.y) << 1 | spread(b.centre.z) << 2);
    }

    using Bounded = BoundedRay<N>;
    static constexpr double length = static_cast<double>(Bounded::length);
    static constexpr double reach = length * static_cast<double>(Bounded::unit);

    // What the block's ball number i bounds; a radius below 0 if it is none.
    static Ball ball(const BallBlock& b, uint32_t i)
    {
        return {{static_cast<double>(b.x[i]) / length, static_cast<double>(b.y[i]) / length,
                 static_cast<double>(b.z[i]) / length},
                static_cast<double>(b.reach[i]) / reach};
    }

    static Ball around(const BallBlock& b)
    {
        Extent box;
        for (uint32_t i = 0; i < bound_lanes; i++)
            if (const Ball part = ball(b, i); part.radius >= 0)
                box.add(part.centre, {part.radius, part.radius, part.radius});
        Ball whole{box.middle(), 0};
        for (uint32_t i = 0; i < bound_lanes; i++)
            if (const Ball part = ball(b, i); part.radius >= 0)
                whole.radius = fmax(whole.radius, scene::length(part.centre - whole.centre) + part.radius);
        return whole;
    }

    // By how much a hit may lie outside its shape: see tree.hpp, q16.hpp.
    static constexpr double slack = NarrowFixed<N> ? 1.0 / 64 : 1e-4;

    // One level over `count` balls; returns its number of blocks.
    template <class BallOf>
    uint32_t level(uint32_t count, BallOf of)
    {
        s.tree.first[s.tree.levels++] = s.blocks.count;
        const uint32_t blocks = count == 0 ? 1 : (count + bound_lanes - 1) / bound_lanes;
        for (uint32_t b = 0; b < blocks; b++) {
            BallBlock& block = s.blocks.push();
            for (uint32_t i = 0; i < bound_lanes; i++) {
                const bool present = b * bound_lanes + i < count;
                const Ball ball = present ? of(b * bound_lanes + i) : Ball{};
                block.x[i] = static_cast<float>(ball.centre.x * length);
                block.y[i] = static_cast<float>(ball.centre.y * length);
                block.z[i] = static_cast<float>(ball.centre.z * length);
                // Wider by what coordinates below 2^7 may be off in 24 bits, here and in a ray's origin.
                const double r = (ball.radius * (1 + 1e-6) + slack) * reach;
                block.reach[i] = present ? static_cast<float>(r) : -1.0f;
                block.square[i] = present ? static_cast<float>(r * r) : -HUGE_VALF;
            }
        }
        return blocks;
    }
};

} // namespace qray::scene
