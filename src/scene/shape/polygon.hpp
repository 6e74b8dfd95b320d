// p n, then n corners X Y Z
#pragma once

#include "corners.hpp"

namespace qray::scene {

template <>
struct Host<Polygon> : HostOfCorners {
    static bool read(Reader& r, Description& d, Object& o, bool& empty)
    {
        if (!read_corners(r, d, o, false))
            return false;
        const Vec3d* v = d.vertices + o.vertex;
        empty = !has_area(v, o.count, false);
        if (!empty)
            warn_of_nonplanar(d, o);
        return true;
    }
    static constexpr Entity entities[] = {{"p", "polygon", "polygons", read}};
    static constexpr const char* fields = "normal; middle and radius of a ball around it; first vertex, count; tag";
    static constexpr const char* example[] = {"p 4  -1 -1 0  0 -1 0  0 0 0  -1 0 0.1", "-1 -1 0"};

    static Above lies_on(const Description& d, const Object& o, uint32_t, const Vec3d& p, double off)
    {
        return lies_in_figure(d.vertices + o.vertex, o.count, p, off);
    }

    template <class F>
    static void outline(const Description& d, const Object& o, F f)
    {
        for (uint32_t i = 0; i < o.count; i++)
            f(d.vertices[o.vertex + i]);
    }
    template <class B>
    static void convert(B& b, const Object& o, uint32_t place)
    {
        using N = typename B::Number;
        const Vec3d* v = b.d.vertices + o.vertex;
        const Vec3d g = across(v, o.count);
        if (o.count == 3 && length(g) > 0)
            if (const Point<N> corners[] = {b.point(v[0]), b.point(v[1]), b.point(v[2])}; spans(corners, 3)
                && b.push_lean(b.s.triangles, corners, nullptr, Convert<N>::direction(unit(g)), place, o))
                return;
        const uint32_t first = b.push_corners(o);
        if (!(length(g) > 0) || !spans(b.s.vertices.data + first, o.count)) {
            b.s.vertices.count = first;
            return b.leave_out(o);
        }
        const auto around = corner_ball(b, v, o.count);
        const Direction<N> normal = Convert<N>::direction(unit(g));
        constexpr double whole_scene = 124;
        const double beside = reach_beside<N>(b.s.vertices.data + first, o.count, normal);
        const auto radius = Convert<N>::length(fmin(value(around.radius) + beside, whole_scene));
        b.s.polygons.push() = {normal, around.middle, radius, first, o.count, make_tag(place, o.fill)};
    }
    template <class N>
    static Extent box(const Polygon<N>& s, const Corners<N>& corners)
    {
        Extent box;
        const double beside = reach_beside<N>(corners.points + s.first, s.count, s.normal);
        for (uint32_t i = s.first; i != s.first + s.count; i++)
            box.add(value(corners.points[i]), {beside, beside, beside});
        return box;
    }

    template <class R>
    static auto random(R& r) { return r.figure("p", 3 + r.below(8), false); }
};

} // namespace qray::scene
