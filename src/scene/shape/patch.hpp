// pp n, then n corners with their normals X Y Z NX NY NZ: a fan of n - 2 triangles, each a surface of its own
#pragma once

#include "corners.hpp"

namespace qray::scene {

template <>
struct Host<Patch> : HostOfCorners {
    static bool read(Reader& r, Description& d, Object& o, bool& empty)
    {
        if (!read_corners(r, d, o, true))
            return false;
        empty = is_empty(d, o);
        return true;
    }
    // Has no triangle an area? Those that have none in one that is not empty are counted.
    static bool is_empty(Description& d, const Object& o)
    {
        const Vec3d* v = d.vertices + o.vertex;
        const bool empty = !has_area(v, o.count, true);
        for (uint32_t i = 1; !empty && i + 1 < o.count; i++)
            d.dropped += largest(triangle_area(v[0], v[i], v[i + 1])) == 0;
        return empty;
    }
    static constexpr Entity entities[] = {{"pp", "patch", "patches", read}};
    static constexpr const char* fields = "normal; middle and radius of a ball around it; vertices: first, second; tag";
    static constexpr const char* example[] = {"pp 3  1 1 0 0 0 1  2 1 0 1 0 1  1 2 0 0 1 1", "1 1 0"};

    static constexpr bool is_flat = false;
    static uint32_t surfaces_of(const Object& o) { return o.count - 2; }
    static Above lies_on(const Description& d, const Object& o, uint32_t part, const Vec3d& p, double off)
    {
        const Vec3d* v = d.vertices + o.vertex;
        const Vec3d corners[3] = {v[0], v[part + 1], v[part + 2]};
        return lies_in_figure(corners, 3, p, off);
    }

    template <class B>
    static void convert(B& b, const Object& o, uint32_t place)
    {
        using N = typename B::Number;
        // Blended as they are given: only their proportion within the patch counts. Of unit normals, but for their
        // decimals, it is left as it is where rounding is too fine to show, so that patches share them.
        double longest = 0;
        for (uint32_t i = 0; i < o.count; i++)
            longest = fmax(longest, length(b.d.normals[o.vertex + i]));
        if (WideFixed<N> && fabs(longest - 1) < 0.01)
            longest = 1;
        const auto normal = [&](uint32_t i) {
            return Convert<N>::direction(b.d.normals[o.vertex + i] * (1 / longest));
        };
        const Vec3d* const v = b.d.vertices + o.vertex;
        uint32_t first = UINT32_MAX; // of the corners, where they stand together
        for (uint32_t i = 1; i + 1 < o.count; i++, place++) {
            const Vec3d corners[3] = {v[0], v[i], v[i + 1]};
            const Vec3d g = triangle_area(corners[0], corners[1], corners[2]);
            const Point<N> rounded[3] = {b.point(v[0]), b.point(v[i]), b.point(v[i + 1])};
            if (!(length(g) > 0)) // the parser has counted it
                continue;
            if (!spans(rounded, 3)) {
                b.leave_out(o);
                continue;
            }
            const Direction<N> flat = Convert<N>::direction(unit(g)), smooth[3] = {normal(0), normal(i), normal(i + 1)};
            if (b.push_lean(b.s.smooth_triangles, rounded, smooth, flat, place, o))
                continue;
            if (first == UINT32_MAX) {
                first = b.push_corners(o);
                for (uint32_t k = 0; k < o.count; k++)
                    b.s.normals.push() = normal(k);
            }
            const auto around = corner_ball(b, corners, 3);
            b.s.patches.push() = {flat, around.middle, around.radius, first, first + i, make_tag(place, o.fill)};
        }
    }
    template <class N>
    static Extent box(const Patch<N>& s, const Corners<N>& corners)
    {
        Extent box;
        for (const uint32_t i : {s.first, s.second, s.second + 1})
            box.add(value(corners.points[i]));
        return box;
    }

    template <class R>
    static auto random(R& r) { return r.figure("pp", 3 + r.below(3), true); }
};

} // namespace qray::scene
