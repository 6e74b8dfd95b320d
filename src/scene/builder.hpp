// From a description in double to a number system's storage: moves and scales the scene to fill the range, finds
// what it calls for, and computes what the tracer would otherwise compute again and again.
#pragma once

#include <stdio.h>

#include "balls.hpp"
#include "resolution.hpp"
#include "settings.hpp"
#include "storage.hpp"

namespace qray::scene {

template <class N>
class Builder {
public:
    // `into` has the room that into.lay_out(from) asks for.
    Builder(const Description& from, const Settings& with, Storage<N>& into) : d(from), settings(with), s(into) {}

    // False, and a reason in `error` without a place, where the scene does not fit the number system.
    bool build(Error& error)
    {
        if (!few_enough(error))
            return false;
        if (s.lay_out(d) > s.room.size) {
            snprintf(error.text, sizeof error.text, "not enough memory");
            return false;
        }
        s.vanished = 0;
        s.lost.clear();
        fit();
        if (!fine_enough(error))
            return false;
        resolution.pairs(s.order.data);
        // Patches first: a corner's normal has the number of the corner, and polygons need none.
        for (const bool patches : {true, false}) {
            place = 0;
            for (uint32_t i = 0; i < d.object_count; i++)
                add(d.objects[i], patches);
        }
        lights();
        materials();
        camera();
        eye_surface();
        TreeBuilder<N>(s).build();
        effects();
        return true;
    }

private:
    // What block-scaled radii may be: see cone.hpp, q16.hpp.
    static constexpr double cone_world = NarrowFixed<N> ? 18 : 40, sphere_world = 31.9;

    static constexpr bool is_float = !N::is_fixed && sizeof(typename N::Length) == 4;

    const Description& d;
    const Settings& settings;
    Storage<N>& s;
    Frame frame;
    Resolution<N> resolution{d, frame, s.lost};
    uint32_t place = 0;

    // A tag has room for so many places, but for the one that names no surface.
    bool few_enough(Error& error) const
    {
        uint64_t surfaces = 0;
        for (uint32_t i = 0; i < d.object_count; i++)
            surfaces += surfaces_of(d.objects[i]);
        if (surfaces <= Limits::surfaces)
            return true;
        snprintf(error.text, sizeof error.text,
                 "the scene has %llu surfaces (a patch of n corners counts as n - 2), "
                 "more than the limit of %u surfaces",
                 static_cast<unsigned long long>(surfaces), Limits::surfaces);
        return false;
    }

    // Has a narrow number system enough steps left where a plane takes most of them, and for the cells of textures?
    bool fine_enough([[maybe_unused]] Error& error) const
    {
        if constexpr (NarrowFixed<N>) {
            const double step = resolution.step();
            if (frame.radius < Limits::narrow_radius * step) {
                snprintf(error.text, sizeof error.text,
                         "q16 has lengths in steps of %.3g where planes reach as far as %.6g, and the scene's radius "
                         "of %.3g is less than %.0f of them; expected a nearer 'far', or another number system",
                         step, frame.far, frame.radius, Limits::narrow_radius);
                return false;
            }
            for (uint32_t i = 0; i < d.fill_count; i++)
                if (const Texture& t = d.fills[i].texture;
                    t.kind != TextureKind::none && t.size < Limits::narrow_cell * step) {
                    snprintf(error.text, sizeof error.text,
                             "q16 has lengths in steps of %.3g here, and a texture's size of %.3g is less than "
                             "1/%.0f of one; expected a larger one, or another number system",
                             step, t.size, 1 / Limits::narrow_cell);
                    return false;
                }
        }
        return true;
    }

    void fit()
    {
        Box box;
        box.add(d.view.from);
        box.add(d.view.at);
        double cone = 0;
        bool planes = false;
        for (uint32_t i = 0; i < d.object_count; i++) {
            add_object(box, d, d.objects[i]);
            if (d.objects[i].shape == Shape::cone)
                cone = fmax(cone, cone_bound(d.objects[i]));
            planes = planes || d.objects[i].shape == Shape::plane;
        }
        Frame& f = frame;
        f.centre = (box.low + box.high) * 0.5;
        f.radius = length(box.high - box.low) / 2;
        f.far = d.far > 0 ? d.far : 16 * f.radius;
        const double reach = planes ? fmax(f.radius, f.far) : f.radius;
        int exponent = 0;
        frexp(fmax(reach / world, cone / cone_world), &exponent);
        f.scale = ldexp(1, -exponent);
        // On a coarse lattice, so that coordinates that are round in the file stay so.
        const double step = f.scale * 64;
        f.origin = {round(f.centre.x * step) / step, round(f.centre.y * step) / step, round(f.centre.z * step) / step};
        f.eye = resolution.eye();
        f.pushed = length(f.eye - d.view.from);
        // At most half an ulp from there, so that the eye, where all rays start, is not rounded.
        if constexpr (WideFixed<N>) {
            const auto moved = [&f](double origin, double eye) {
                const double ulp = ldexp(1 / f.scale, -N::Length::frac), at = (eye - origin) / ulp;
                return origin + (at - rint(at)) * ulp;
            };
            f.origin = {moved(f.origin.x, f.eye.x), moved(f.origin.y, f.eye.y), moved(f.origin.z, f.eye.z)};
        }
    }

    Point<N> point(const Vec3d& p) const { return Convert<N>::point(frame.point(p)); }
    typename N::Length radius(double r) const { return Convert<N>::length(r * frame.scale); }
    // A bound that rounding does not make too small. In q16 that of corners and of the middle, sqrt(3) ulp, and the 3 and
    // more of its reject: see reject.hpp.
    typename N::Length bound(double r) const
    {
        return Convert<N>::length(r * frame.scale * (1 + 1e-6) + (NarrowFixed<N> ? 6.0 / 1024 : 2e-6));
    }

    void add(const Object& o, bool patches)
    {
        if ((o.shape == Shape::patch) != patches) {
            place += surfaces_of(o);
            return;
        }
        const Tag tag = make_tag(place, o.fill);
        const uint32_t vanished = s.vanished;
        switch (o.shape) {
        case Shape::sphere: sphere(o, tag); break;
        case Shape::disc: disc(o, point(o.a), unit(o.b), o.ra, tag); break;
        case Shape::plane: plane(o, tag); break;
        case Shape::cone: cone(o, tag); break;
        case Shape::polygon: polygon(o, tag); break;
        case Shape::patch: patch(o); break;
        }
        place += o.shape != Shape::patch;
        if (s.vanished == vanished)
            resolution.span(o);
    }

    // The most bits that a shape of this size can have beyond Length's: 2^fine times it, and a little more that a
    // conservative test may let pass, stays within `most`.
    int fine_for(double size, double most) const
    {
        int fine = 0;
        if constexpr (N::is_fixed)
            while (fine < 10 && ldexp(size * frame.scale + (NarrowFixed<N> ? 1.0 / 128 : 1.0 / 16), fine + 1) <= most)
                fine++;
        return fine;
    }

    void vanish(const Object& o)
    {
        s.vanished++;
        s.lost.note(o.line, "a %s too small for steps of %.3g, left out", shape_names[static_cast<int>(o.shape)],
                    resolution.step());
    }

    // Smaller than the step by which a ray leaves a surface, a ball cannot hold what starts inside of it.
    static bool too_small(typename N::Length r)
    {
        if constexpr (N::is_fixed)
            return r < N::leave(N::one);
        else
            return vanishes(r);
    }

    // The squares of less than 2^-40 of a world of +-62, to the last bit of float, are too small for it:
    // normals would be of any length.
    static bool vanishes(typename N::Length r)
    {
        if constexpr (is_float)
            return r < 0x1p-40f;
        else
            return r == N::length_zero;
    }

    void sphere(const Object& o, Tag tag)
    {
        if (too_small(radius(o.ra))) {
            vanish(o);
            return;
        }
        const int fine = fine_for(o.ra, sphere_world);
        const auto r = radius(ldexp(o.ra, fine));
        s.spheres.push() = {point(o.a), r, Convert<N>::inverse(r), fine, tag,
                            Convert<N>::rounded(frame.point(o.a), fine)};
    }

    void disc(const Object& o, const Point<N>& centre, const Vec3d& n, double r, Tag tag)
    {
        if (radius(r) == N::length_zero) {
            vanish(o);
            return;
        }
        s.discs.push() = {centre, Convert<N>::direction(n), radius(r), tag};
    }

    void plane(const Object& o, Tag tag)
    {
        const Vec3d n = unit(o.b);
        const double height = dot(n, o.a - frame.centre);
        if (fabs(height) < frame.far)
            disc(o, point(frame.centre + n * height), n, sqrt(frame.far * frame.far - height * height), tag);
    }

    void cone(const Object& o, Tag tag)
    {
        const Vec3d along = o.b - o.a;
        const double height = length(along);
        const Vec3d axis = unit(along);
        const double growth = (o.rb - o.ra) / height;
        const double cosine = 1 / sqrt(1 + growth * growth), sine = growth * cosine;
        if (vanishes(radius(fmax(o.ra, o.rb))) || vanishes(radius(height))) {
            vanish(o);
            return;
        }
        const Vec3d e1 = unit_across(axis), e2 = cross(axis, e1);
        const int fine = fine_for(cone_bound(o), cone_world);
        const double up = ldexp(1, fine);
        s.cones.push() = {point((o.a + o.b) * 0.5),
                          Convert<N>::direction(e1),
                          Convert<N>::direction(e2),
                          Convert<N>::direction(axis),
                          radius(cosine * (o.ra + o.rb) / 2 * up),
                          radius(height / 2 * up),
                          bound(cone_bound(o) * up),
                          Convert<N>::unit(cosine),
                          Convert<N>::unit(sine),
                          fine,
                          tag,
                          Convert<N>::rounded(frame.point((o.a + o.b) * 0.5), fine)};
    }

    // The ball around the middle of the box of corner(0) to corner(count - 1).
    struct CornerBall {
        Point<N> middle;
        typename N::Length radius;
    };
    template <class Corner>
    CornerBall ball(uint32_t count, Corner corner) const
    {
        Box box;
        for (uint32_t i = 0; i < count; i++)
            box.add(corner(i));
        const Vec3d centre = (box.low + box.high) * 0.5;
        double far = 0;
        for (uint32_t i = 0; i < count; i++)
            far = fmax(far, length(corner(i) - centre));
        return {point(centre), bound(far)};
    }

    // Do rounded corners not all fall on one point?
    static bool spans(const Point<N>* corners, uint32_t count)
    {
        for (uint32_t i = 1; i < count; i++)
            if (!(corners[i] == corners[0]))
                return true;
        return false;
    }

    // The number of the first of some corners, now in the scene's vertices.
    uint32_t push_corners(const Object& o)
    {
        const uint32_t first = s.vertices.count;
        for (uint32_t i = 0; i < o.count; i++)
            s.vertices.push() = point(d.vertices[o.vertex + i]);
        return first;
    }

    void polygon(const Object& o, Tag tag)
    {
        const Vec3d* v = d.vertices + o.vertex;
        const Vec3d g = across(v, o.count);
        const uint32_t first = push_corners(o);
        if (!(length(g) > 0) || !spans(s.vertices.data + first, o.count)) {
            s.vertices.count = first;
            vanish(o);
            return;
        }
        const CornerBall around = ball(o.count, [v](uint32_t i) { return v[i]; });
        s.polygons.push() = {Convert<N>::direction(unit(g)), around.middle, around.radius, first, o.count, tag};
    }

    void patch(const Object& o)
    {
        // Blended as they are given: only their proportion within the patch counts.
        double longest = 0;
        for (uint32_t i = 0; i < o.count; i++)
            longest = fmax(longest, length(d.normals[o.vertex + i]));
        const uint32_t first = push_corners(o);
        for (uint32_t i = 0; i < o.count; i++)
            s.normals.push() = Convert<N>::direction(d.normals[o.vertex + i] * (1 / longest));
        for (uint32_t i = 1; i + 1 < o.count; i++, place++) {
            const Vec3d* v = d.vertices + o.vertex;
            const Vec3d corners[3] = {v[0], v[i], v[i + 1]};
            const Vec3d g = triangle_area(corners[0], corners[1], corners[2]);
            const Point<N> rounded[3] = {s.vertices.data[first], s.vertices.data[first + i],
                                         s.vertices.data[first + i + 1]};
            if (!(length(g) > 0)) // the parser has counted it
                continue;
            if (!spans(rounded, 3)) {
                vanish(o);
                continue;
            }
            const CornerBall around = ball(3, [&corners](uint32_t k) { return corners[k]; });
            s.patches.push() = {Convert<N>::direction(unit(g)), around.middle, around.radius, first, first + i,
                                make_tag(place, o.fill)};
        }
    }

    // Colours are divided by 2^exposure so that no sum of lights leaves the range of Colour.
    void lights()
    {
        Vec3d sum = d.ambient;
        for (uint32_t i = 0; i < d.light_count; i++)
            sum = sum + d.lights[i].colour * 2;
        s.exposure = 0;
        if constexpr (N::is_fixed)
            while (ldexp(fmax(largest(sum), largest(d.background)), -s.exposure) > range)
                s.exposure++;
        s.background = colour(d.background);
        for (uint32_t i = 0; i < d.light_count; i++) {
            const Light& l = d.lights[i];
            if (l.sun) {
                s.suns.push() = {Convert<N>::direction(unit(l.at)), colour(l.colour)};
                continue;
            }
            Vec3d at = frame.point(l.at);
            int shift = 0;
            if constexpr (N::is_fixed)
                for (; (NarrowFixed<N> ? length(at) : largest(at)) > world; at = at * 0.5)
                    shift++;
            // So far away that it is a sun; in float, its square would be infinite.
            if (shift > 30 || (is_float && largest(at) > 0x1p60)) {
                s.suns.push() = {Convert<N>::direction(unit(at)), colour(l.colour)};
                continue;
            }
            if constexpr (is_float) // what is not 0 from there to a surface has a square that float holds
                at = {off_zero(at.x), off_zero(at.y), off_zero(at.z)};
            s.lights.push() = {Convert<N>::point(at), shift, colour(l.colour)};
        }
    }
    static double off_zero(double v) { return copysign(fmax(fabs(v), 0x1p-38), v); }
    static constexpr double range = 7.99;

    Rgb<N> colour(const Vec3d& c) const { return Convert<N>::rgb(c * ldexp(1, -s.exposure)); }
    static Vec<typename N::Unit> surface(const Vec3d& c) { return Convert<N>::direction(c); }

    void materials()
    {
        for (uint32_t i = 0; i < d.fill_count; i++) {
            const Fill& f = d.fills[i];
            s.mattes.push() = {surface(f.colour), colour(d.ambient * f.ambient), Convert<N>::unit(f.diffuse)};
            s.highlights.push() = {Convert<N>::unit(f.highlight), Convert<N>::shine(f.shine)};
            s.mirrors.push() = {Convert<N>::unit(f.mirror)};
            s.transmits.push() = {Convert<N>::unit(f.transmit), Convert<N>::eta(1 / f.ior), Convert<N>::eta(f.ior)};
            s.textures.push() = texture(f.texture);
        }
    }

    TextureRef texture(const Texture& t)
    {
        // Not less than a hit may lie off its surface.
        const double epsilon = NarrowFixed<N> ? fmax(1.0 / 1024, ldexp(1.5, -10) / (t.size * frame.scale)) : 1.0 / 1024;
        const double k = 1 / t.size;
        const auto n = surface(t.colour);
        const auto axis = [&](const Vec3d& direction, double offset, bool wraps) {
            return Convert<N>::axis(direction * k, frame.origin, frame.scale, offset, wraps);
        };
        const auto step = [&](const Vec3d& direction, double offset) {
            return Convert<N>::step(axis(direction, offset, true));
        };
        const auto lattice = [&](double offset) {
            return Lattice<N>{step({1, 0, 0}, offset), step({0, 1, 0}, offset), step({0, 0, 1}, offset)};
        };
        const auto latest = [&t](const auto& table) {
            return TextureRef{t.kind, static_cast<uint16_t>(table.count - 1)};
        };
        const Vec3d a = length(t.axis) > 0 ? unit(t.axis) : Vec3d{0, 1, 0};
        switch (t.kind) {
        case TextureKind::none: break;
        case TextureKind::checker:
            s.checkers.push() = {n, lattice(epsilon)};
            return latest(s.checkers);
        case TextureKind::stripes:
            s.stripes.push() = {n, axis(a, epsilon, true)};
            return latest(s.stripes);
        case TextureKind::gradient:
            s.gradients.push() = {n, axis(a, 0, false)};
            return latest(s.gradients);
        case TextureKind::rings:
            s.rings.push() = {n, axis({1, 0, 0}, 0, false), axis({0, 0, 1}, 0, false)};
            return latest(s.rings);
        case TextureKind::noise:
            s.noises.push() = {n, lattice(0)};
            return latest(s.noises);
        case TextureKind::marble:
            s.marbles.push() = {n, lattice(0), axis(a, 0, true)};
            return latest(s.marbles);
        case TextureKind::wood: {
            const Vec3d e1 = unit_across(a), e2 = cross(a, e1);
            s.woods.push() = {n, lattice(0), axis(e1, 0, false), axis(e2, 0, false)};
            return latest(s.woods);
        }
        case TextureKind::brick: {
            Lattice<N> l = lattice(epsilon);
            l.y = step({0, 2, 0}, epsilon);
            s.bricks.push() = {n, l};
            return latest(s.bricks);
        }
        }
        return {TextureKind::none, 0};
    }

    void camera()
    {
        const View& v = d.view;
        const uint32_t width = settings.width != 0 ? settings.width : v.width;
        const uint32_t height = settings.height != 0 ? settings.height : v.height;
        const uint32_t n = settings.levels != 0 ? 1u << settings.levels : settings.grid;
        const Vec3d w = unit(v.at - v.from);
        const Vec3d u = unit(cross(w, unit(v.up)));
        const Vec3d t = cross(u, w);
        const double half = tan(v.angle * (M_PI / 360));
        const double step = half / (n * height);
        // |w|, |x u| and |y v| at most 2^60: see camera.hpp
        const double most = fmax(1, fmax(half, half * width / height));
        const double scale = ldexp(1, NarrowFixed<N> ? 29 : 60) / most;
        s.camera = {point(frame.eye),
                    Convert<N>::pencil(w, scale),
                    Convert<N>::pencil(u * step, scale),
                    Convert<N>::pencil(t * -step, scale),
                    static_cast<uint16_t>(width),
                    static_cast<uint16_t>(height),
                    static_cast<uint16_t>(n)};
        s.max_depth = static_cast<uint8_t>(settings.depth);
        s.cutoff = Convert<N>::unit(settings.cutoff);
        s.levels = static_cast<uint8_t>(settings.levels);
        s.threshold = Convert<N>::unit(settings.threshold);
    }

    void eye_surface()
    {
        uint32_t fill = 0;
        Vec3d outward;
        const int64_t at = resolution.eye_surface(fill, outward);
        s.eye_surface = {{Tag::none}, {}};
        if (at >= 0)
            s.eye_surface = {make_tag(static_cast<uint32_t>(at), fill), Convert<N>::direction(outward)};
    }

    void effects()
    {
        Effects e;
        e.sphere = s.spheres.count != 0;
        e.disc = s.discs.count != 0;
        e.cone = s.cones.count != 0;
        e.polygon = s.polygons.count != 0;
        e.patch = s.patches.count != 0;
        e.checker = s.checkers.count != 0;
        e.stripes = s.stripes.count != 0;
        e.gradient = s.gradients.count != 0;
        e.rings = s.rings.count != 0;
        e.noise = s.noises.count != 0;
        e.marble = s.marbles.count != 0;
        e.wood = s.woods.count != 0;
        e.brick = s.bricks.count != 0;
        e.light = s.lights.count != 0;
        e.sun = s.suns.count != 0;
        bool lit = false, transmits = false;
        for (uint32_t i = 0; i < d.fill_count; i++) {
            const Fill& f = d.fills[i];
            lit = lit || f.diffuse > 0 || f.highlight > 0;
            e.highlight = e.highlight || f.highlight > 0;
            e.fractional_shine = e.fractional_shine || (f.highlight > 0 && f.shine != floor(f.shine));
            transmits = transmits || f.transmit > 0;
            // As the tracer weighs them: what is totally reflected has both weights together.
            const auto mirror = s.mirrors.data[i].amount, transmit = s.transmits.data[i].amount;
            const auto most = mirror > N::one - transmit ? N::one : mirror + transmit;
            const bool spawns = settings.depth > 1 && most >= s.cutoff;
            e.mirror = e.mirror || (spawns && mirror > N::zero);
            e.transmit = e.transmit || (spawns && transmit > N::zero);
        }
        e.highlight = e.highlight && e.lights();
        e.fractional_shine = e.fractional_shine && e.lights();
        s.shadows = d.shadows && lit && e.lights();
        e.shadow = s.shadows;
        e.see_through = e.shadow && transmits;
        e.eye_surface = !(s.eye_surface.tag == Tag{Tag::none});
        e.tree = true;
        e.grid = settings.levels == 0 && settings.grid > 1;
        e.adaptive = settings.levels != 0;
        e.depth = e.transmit ? static_cast<uint8_t>(settings.depth) : 1;
        s.effects = e;
    }
};

} // namespace qray::scene
