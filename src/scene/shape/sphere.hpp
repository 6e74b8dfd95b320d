// s X Y Z r
#pragma once

#include "host.hpp"

namespace qray::scene {

template <>
struct Host<Sphere> : HostOfShape {
    static bool read(Reader& r, Description&, Object& o, bool& empty)
    {
        if (!r.point("the centre of a sphere", o.a) || !r.radius("the radius of a sphere", o.ra))
            return false;
        empty = o.ra == 0;
        return true;
    }
    static constexpr Entity entities[] = {{"s", "sphere", "spheres", read}};
    static constexpr const char* fields =
        "centre; radius * 2^fine and its inverse; fine; tag; centre's rounding * 2^fine";
    static constexpr const char* example[] = {"s 0 0 0 0.5", "0 0 0.5"};

    static void extent(Extent& box, const Description&, const Object& o) { box.add(o.a, {o.ra, o.ra, o.ra}); }
    static constexpr bool is_ball = true;
    static double widest(const Object& o) { return o.ra; }
    static double apart(const Object& a, const Object& b) { return fabs(a.ra - b.ra) + length(a.a - b.a); }
    static Above lies_on(const Description&, const Object& o, uint32_t, const Vec3d& p, double off)
    {
        const double distance = length(p - o.a);
        if (!(distance > 0) || fabs(distance - o.ra) > off)
            return {};
        return {true, distance - o.ra, unit(p - o.a)};
    }

    template <class B>
    static void convert(B& b, const Object& o, uint32_t place)
    {
        using N = typename B::Number;
        if (b.too_small_to_leave(b.length(o.ra)))
            return b.leave_out(o);
        const int fine = b.fine_for(o.ra, &Blocks::ball);
        const auto r = b.length(ldexp(o.ra, fine));
        b.s.spheres.push() = {b.point(o.a), r, inverse_of<N>(r), fine, make_tag(place, o.fill),
                              Convert<N>::rounded(b.frame.point(o.a), fine)};
    }
    template <class N>
    static Extent box(const Sphere<N>& s, const Corners<N>&)
    {
        return ball_extent(value(s.centre), ldexp(value(s.radius), -s.fine));
    }

    template <class R>
    static auto random(R& r) { return "s " + r.point() + " " + r.radius(); }
};

} // namespace qray::scene
