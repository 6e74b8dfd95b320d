// c bx by bz br ax ay az ar: an open cylinder or cone frustum
#pragma once

#include "host.hpp"

namespace qray::scene {

template <>
struct Host<Cone> : HostOfShape {
    static bool read(Reader& r, Description&, Object& o, bool& empty)
    {
        if (!r.point("the base of a cone", o.a) || !r.radius("the base radius of a cone", o.ra)
            || !r.point("the apex of a cone", o.b))
            return false;
        if (is_zero(o.b - o.a))
            return r.fail(r.vector_at, "the apex of a cone is where its base is; expected an axis that is not zero");
        if (!r.radius("the apex radius of a cone", o.rb))
            return false;
        empty = o.ra == 0 && o.rb == 0;
        return true;
    }
    static constexpr Entity entities[] = {{"c", "cone", "cones", read}};
    static constexpr const char* fields =
        "middle; across, across, axis; cosine * mean radius, half height, bound, all * 2^fine; "
        "cosine, sine; fine; tag; middle's rounding * 2^fine";
    static constexpr const char* example[] = {"c 1 0 0 0.3  1 1 0 0.1", "1 0 0.3"};

    static double widest(const Object& o) { return fmax(o.ra, o.rb); }
    static Vec3d middle(const Description&, const Object& o) { return (o.a + o.b) * 0.5; }
    static double apart(const Object& a, const Object& b)
    {
        return fmin(fmax(fabs(a.ra - b.ra) + length(a.a - b.a), fabs(a.rb - b.rb) + length(a.b - b.b)),
                    fmax(fabs(a.ra - b.rb) + length(a.a - b.b), fabs(a.rb - b.ra) + length(a.b - b.a)));
    }
    // The radius of its ball: around the middle of the axis, through the wider rim.
    static double reach(const Object& o)
    {
        const double half = length(o.b - o.a) / 2, r = widest(o);
        return sqrt(half * half + r * r);
    }
    static void extent(Extent& box, const Description&, const Object& o)
    {
        const Vec3d axis = unit(o.b - o.a);
        box.add(o.a, circle_extent(axis, o.ra));
        box.add(o.b, circle_extent(axis, o.rb));
    }
    static Above lies_on(const Description&, const Object& o, uint32_t, const Vec3d& p, double off)
    {
        const Vec3d axis = unit(o.b - o.a);
        const double height = length(o.b - o.a), growth = (o.rb - o.ra) / height;
        const double cosine = 1 / sqrt(1 + growth * growth);
        const double z = dot(p - o.a, axis), r = o.ra + growth * z;
        const Vec3d radial = p - o.a - axis * z;
        const double rho = length(radial);
        const double above = (rho - r) * cosine;
        return {z >= -off && z <= height + off && fabs(above) <= off, above,
                r > off && rho > 0 ? (radial * (1 / rho) - axis * growth) * cosine : Vec3d{}};
    }

    // Its ball is block-scaled, at least by 2^least.
    template <class N>
    static double range(const Object& o)
    {
        if constexpr (N::is_fixed)
            return ldexp(reach(o), N::Length::frac + N::blocks.cone.least) / N::blocks.cone.size;
        else
            return reach(o) / 40;
    }

    template <class B>
    static void convert(B& b, const Object& o, uint32_t place)
    {
        using N = typename B::Number;
        const Vec3d axis = unit(o.b - o.a);
        const double height = length(o.b - o.a), growth = (o.rb - o.ra) / height;
        const double cosine = 1 / sqrt(1 + growth * growth), sine = growth * cosine;
        if (b.vanishes(b.length(widest(o))) || b.vanishes(b.length(height)))
            return b.leave_out(o);
        const Vec3d e1 = unit_across(axis), e2 = cross(axis, e1);
        const int fine = b.fine_for(reach(o), &Blocks::cone);
        const double up = ldexp(1, fine);
        b.s.cones.push() = {b.point(middle(b.d, o)),
                            Convert<N>::direction(e1),
                            Convert<N>::direction(e2),
                            Convert<N>::direction(axis),
                            b.length(cosine * (o.ra + o.rb) / 2 * up),
                            b.length(height / 2 * up),
                            b.bound(reach(o) * up),
                            Convert<N>::unit(cosine),
                            Convert<N>::unit(sine),
                            fine,
                            make_tag(place, o.fill),
                            Convert<N>::rounded(b.frame.point(middle(b.d, o)), fine)};
    }
    template <class N>
    static Extent box(const Cone<N>& s, const Corners<N>&)
    {
        const double down = ldexp(1, -s.fine), bound = value(s.bound) * down;
        // All that is known of a hit where the cone is so flat that its roundings, divided by the cosine, are large.
        const double most = M_SQRT2 * bound;
        if constexpr (NarrowFixed<N>) // too coarse a cosine to divide by
            return ball_extent(value(s.middle), value(s.cosine) < 0.25 ? most : bound);
        Extent box;
        const Vec3d axis = unit(value(s.axis));
        for (const double half : {-value(s.half) * down, value(s.half) * down}) {
            // The test's own roundings, for each of its products, are divided by the cosine as well.
            const double r = (value(s.rho0) * down + value(s.sine) * half + 1e-4) / value(s.cosine);
            box.add(value(s.middle) + axis * half, circle_across(axis, fmin(most, fmax(0, r))));
        }
        return box;
    }

    template <class R>
    static auto random(R& r)
    {
        const auto radius = r.radius();
        const auto ends = r.two_points(0.1);
        return "c " + ends[0] + " " + radius + " " + ends[1] + " "
            + (r.chance(0.3) ? radius : r.chance(0.2) ? "0" : r.radius());
    }
};

} // namespace qray::scene
