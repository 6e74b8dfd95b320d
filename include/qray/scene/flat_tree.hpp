// A tree of boxes over the shapes of a compiled scene, in integers: entries in preorder, each with a link to what
// follows where a ray misses its box. No stack, and no division at a box. (Stackless by links: Smits, Efficiency issues
// for ray tracing, 1998.)
//
// Boxes are seen by a ProjectedRay, whose header says how far a line may be beside the ray: 4.7 and s steps. A box is
// wider than what is in it by 8: the 3 that are left take in the rounding of the box, and x where it is cut off.
//
// So a ray that passes a leaf's box is near to the corners of what is in it. Rounding makes the box wider, or cuts it
// off at 64, where no corner is: a corner c, cut off to whole steps, is inside by 7 along each axis. The part of the
// box that was asked has a middle x and a half p, and lies in the box but for 1 that x is rounded by; x is therefore at
// most 2 half_x - p - 6 from c. There the line was at most half_y + s p from the box's middle, and this is at most
// half_y - 7 from c: with s <= 1, c is at most 2 half_y + 2 half_x - 13 beside it, and that is rounded up by 1.
#pragma once

#include "../shape/projected_ray.hpp"
#include "lists.hpp"

namespace qray {

// Middle and half extent of a box in the steps of ProjectedRay, and a link: how many entries on the next one
// stands that is not in this one; or, with the highest bit, some shapes of one kind: kind (3 bits), count - 1
// (4), the first (24).
template <class N>
struct TreeEntry {
    static constexpr int32_t slack = 8;
    static constexpr uint32_t most = 16; // shapes
    static constexpr uint32_t last = 0xffffffff; // link of the entry behind all, whose box every ray passes

    int16_t x, y, z;
    uint16_t half_x, half_y, half_z;
    uint32_t link;

    static constexpr uint32_t leaf(Kind kind, uint32_t first, uint32_t count)
    {
        return uint32_t{1} << 31 | static_cast<uint32_t>(kind) << 28 | (count - 1) << 24 | first;
    }
    // Of the entry behind all, too: a walk must not begin there.
    static constexpr bool out_of_reach(const Point<N>& p)
    {
        constexpr auto within = [](typename N::Length v) { return v > -127 && v < 127; };
        return !(within(p.x) && within(p.y) && within(p.z));
    }
    constexpr bool is_leaf() const { return link >> 31 != 0; }
    constexpr Kind kind() const { return static_cast<Kind>(link >> 28 & 7); }
    constexpr uint32_t first() const { return link & 0xffffff; }
    constexpr uint32_t count() const { return (link >> 24 & 15) + 1; }
};

// From entry e on, the first leaf whose box the ray passes. The members are those along the ray, and beside it.
template <auto X, auto Y, auto Z, auto HalfX, auto HalfY, auto HalfZ, class N>
QRAY_INLINE constexpr const TreeEntry<N>* leaf_along(const ProjectedRay& ray, const TreeEntry<N>* e)
{
    const ProjectedRay::Line y = ray.y, z = ray.z;
    const int32_t low = ray.low, high = ray.high;
    for (;;) {
        int32_t x = e->*X, half = e->*HalfX, from = x - half, to = x + half;
        bool passes = true;
        if (from < low || to > high) { // the part of the box from the origin to the limit
            from = from < low ? low : from;
            to = to > high ? high : to;
            passes = from <= to;
            x = (from + to) >> 1;
            half = to - x;
        }
        if (passes && y.passes(x, half, e->*Y, e->*HalfY) && z.passes(x, half, e->*Z, e->*HalfZ)) {
            if (e->is_leaf())
                return e;
            e++;
        } else {
            e += e->is_leaf() ? 1 : e->link;
        }
    }
}

template <class N>
QRAY_NOINLINE constexpr const TreeEntry<N>* next_leaf(const ProjectedRay& ray, const TreeEntry<N>* e)
{
    using Entry = TreeEntry<N>;
    if (ray.axis == 0)
        return leaf_along<&Entry::x, &Entry::y, &Entry::z, &Entry::half_x, &Entry::half_y, &Entry::half_z>(ray, e);
    if (ray.axis == 1)
        return leaf_along<&Entry::y, &Entry::x, &Entry::z, &Entry::half_y, &Entry::half_x, &Entry::half_z>(ray, e);
    return leaf_along<&Entry::z, &Entry::x, &Entry::y, &Entry::half_z, &Entry::half_x, &Entry::half_y>(ray, e);
}

// Calls visit(kind, first, count) for the shapes that the ray may meet before limit(), until it returns true. limit()
// is asked again at every leaf.
template <class N, class Limit, class Visit>
QRAY_INLINE constexpr void walk(const TreeEntry<N>* e, ProjectedRay& ray, Limit limit, Visit visit)
{
    using Entry = TreeEntry<N>;
    auto known = limit();
    ray.end_at<N>(known);
    for (;; e++) {
        if (const auto now = limit(); now != known) {
            known = now;
            ray.end_at<N>(now);
        }
        e = next_leaf(ray, e);
        if (e->link == Entry::last)
            return;
        if constexpr (!ProjectedRay::is_exact<N>) {
            const int32_t along = ray.axis == 0 ? e->half_x : ray.axis == 1 ? e->half_y : e->half_z;
            ray.within = 2 * (along + e->half_x + e->half_y + e->half_z);
        }
        if (visit(e->kind(), e->first(), e->count()))
            return;
    }
}

} // namespace qray
