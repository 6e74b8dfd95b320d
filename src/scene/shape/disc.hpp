// disc X Y Z NX NY NZ r; and plane X Y Z NX NY NZ, which is the disc in which it is cut where `far` ends it.
#pragma once

#include "host.hpp"

namespace qray::scene {

template <>
struct Host<Disc> : HostOfFlat {
    static bool read(Reader& r, Description&, Object& o, bool& empty)
    {
        if (!r.point("the centre of a disc", o.a) || !r.direction("the normal of a disc", o.b)
            || !r.radius("the radius of a disc", o.ra))
            return false;
        empty = o.ra == 0;
        return true;
    }
    static bool read_plane(Reader& r, Description&, Object& o, bool&)
    {
        o.ra = HUGE_VAL;
        return r.point("the point of a plane", o.a) && r.direction("the normal of a plane", o.b);
    }
    static constexpr Entity entities[] = {{"disc", "disc", "discs", read}, {"plane", "plane", "planes", read_plane}};
    static constexpr const char* fields = "centre; normal; radius; tag";
    static constexpr const char* example[] = {"disc 0 0 -1  0 0 1  2", "0 1 -1"};

    static bool is_endless(const Object& o) { return o.ra == HUGE_VAL; }
    static void extent(Extent& box, const Description&, const Object& o)
    {
        if (!is_endless(o))
            box.add(o.a, circle_extent(unit(o.b), o.ra));
    }
    static bool covers(const Description&, const Object& o, Vec3d, const Vec3d& p) { return length(p - o.a) < o.ra; }
    static Above lies_on(const Description&, const Object& o, uint32_t, const Vec3d& p, double off)
    {
        return length(p - o.a) <= o.ra + off ? above_plane(o.a, unit(o.b), p, off) : Above{};
    }

    // Of as many corners and the same area as these.
    template <class F>
    static void outline(const Description&, const Object& o, F f)
    {
        if (is_endless(o))
            return;
        const Vec3d n = unit(o.b), u = unit_across(n), v = cross(n, u);
        const double turn[] = {0.98078528040323045, 0.19509032201612827}; // cosine and sine of 1/32
        double x = o.ra * 1.0032220804984129, y = 0; // sqrt(pi / (16 sin(pi / 16)))
        for (int i = 0; i < 32; i++) {
            f(o.a + u * x + v * y);
            const double next = x * turn[0] - y * turn[1];
            y = x * turn[1] + y * turn[0];
            x = next;
        }
    }

    template <class B>
    static void convert(B& b, const Object& o, uint32_t place)
    {
        using N = typename B::Number;
        const Vec3d n = unit(o.b);
        Vec3d centre = o.a;
        double r = o.ra;
        if (is_endless(o)) {
            const double far = b.frame.far, height = dot(n, o.a - b.frame.centre);
            if (fabs(height) >= far)
                return;
            centre = b.frame.centre + n * height;
            r = sqrt(far * far - height * height);
        }
        if (b.length(r) == N::length_zero)
            return b.leave_out(o);
        b.s.discs.push() = {b.point(centre), Convert<N>::direction(n), b.length(r), make_tag(place, o.fill)};
    }
    template <class N>
    static Extent box(const Disc<N>& s, const Corners<N>&)
    {
        Extent box;
        box.add(value(s.centre), circle_across(unit(value(s.normal)), value(s.radius)));
        return box;
    }

    template <class R>
    static auto random(R& r)
    {
        return r.chance(0.5) ? "disc " + r.point() + " " + r.direction() + " " + r.radius()
                             : "plane " + r.point() + " " + r.direction();
    }
};

} // namespace qray::scene
