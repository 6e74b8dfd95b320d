// From a description in double to a number system's storage: moves and scales the scene to fill the range, finds
// what it calls for, and computes what the tracer would otherwise compute again and again.
#pragma once

#include <stdio.h>

#include "flatten.hpp"
#include "lean.hpp"
#include "light_builder.hpp"
#include "light_map_builder.hpp"
#include "moving.hpp"
#include "numbers.hpp"
#include "resolution.hpp"
#include "settings.hpp"
#include "storage.hpp"
#include "texture_builder.hpp"
#include "tree_builder.hpp"

namespace qray::scene {

template <class N>
class Builder {
public:
    // `into` has the room that into.lay_out(from, with.compiled) asks for.
    Builder(const Description& from, const Settings& with, Storage<N>& into) : d(from), s(into), settings(with) {}

    // False, and a reason in `error` without a place, where the scene does not fit the number system.
    bool build(Error& error)
    {
        if (!few_enough(error))
            return false;
        flat = settings.compiled && surfaces() >= least_for_tree<N>;
        if (s.lay_out(d, settings.compiled) > s.room.size)
            return error.say("not enough memory");
        s.vanished = 0;
        s.lost = {};
        s.unmoved = {};
        textures.images();
        fit();
        if (!fine_enough(error) || !frame_of_part(error))
            return false;
        s.origin = frame.origin;
        s.scale = frame.scale;
        resolution.pairs(s.sorted.data);
        shapes();
        if (!LightBuilder<N>(d, settings, frame, resolution, s).build(error))
            return false;
        materials();
        if (d.radiosity > 0)
            LightMapBuilder<N>(d, settings, frame, s).build();
        camera();
        eye_surface();
        s.entries.count = 0;
        s.entries.data[0] = last_entry<N>; // no tree: a walk ends at once
        if (flat)
            Flattener<N>(s).flatten();
        else
            build_tree(s);
        effects();
        return true;
    }

    // What the shapes' hosts convert with.
    using Number = N;
    const Description& d;
    Storage<N>& s;
    Frame frame;

    Point<N> point(const Vec3d& p) const { return Convert<N>::point(frame.point(p)); }
    typename N::Length length(double r) const { return Convert<N>::length(r * frame.scale); }
    // A bound that rounding does not make too small. In q16 that of corners and of the middle, sqrt(3) ulp, and the 3
    // and more of its reject: see reject.hpp.
    typename N::Length bound(double r) const
    {
        return Convert<N>::length(r * frame.scale * (1 + 1e-6) + (NarrowFixed<N> ? 6.0 / 1024 : 2e-6));
    }

    // The most bits that a shape of this size can have beyond Length's: see Blocks.
    int fine_for(double size, Blocks::Of Blocks::*of) const { return block_scale<N>(length(size), of); }

    void leave_out(const Object& o)
    {
        s.vanished++;
        s.lost.note({o.line, 0}, "a %s too small for steps of %.3g, left out", name_of(o), resolution.step());
    }

    // Smaller than the step by which a ray leaves a surface, a ball cannot hold what starts inside of it.
    static bool too_small_to_leave(typename N::Length r)
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
        if constexpr (SingleFloat<N>)
            return r < 0x1p-40f;
        else
            return r == N::length_zero;
    }

    // A triangle in little room, where a tree finds it and it fits; see lean.hpp.
    template <class T>
    bool push_lean(Array<T>& table, const Point<N>* corners, const Direction<N>* normals, const Direction<N>& g,
                   uint32_t place, const Object& o)
    {
        const bool moves = (settings.moving & bit_of(o.kind)) != 0;
        return flat && !moves && LeanBuilder<N>{s}.push(table, corners, normals, g, place, o.fill);
    }

    // The number of the first of some corners, now in the scene's vertices.
    uint32_t push_corners(const Object& o)
    {
        const uint32_t first = s.vertices.count;
        for (uint32_t i = 0; i < o.count; i++)
            s.vertices.push() = point(d.vertices[o.vertex + i]);
        return first;
    }

private:
    const Settings& settings;
    Resolution<N> resolution{d, frame, s.lost};
    TextureBuilder<N> textures{d, frame, s};

    bool flat = false; // a compiled scene with a tree, which finds triangles that take little room

    uint64_t surfaces() const
    {
        uint64_t sum = 0;
        for (uint32_t i = 0; i < d.object_count; i++)
            sum += surfaces_of(d.objects[i]);
        return sum;
    }

    // A tag has room for so many places, but for the last of the last material, which names no surface.
    bool few_enough(Error& error) const
    {
        const uint32_t most = Limits::surfaces - (d.fill_count == Limits::materials);
        return surfaces() <= most
            || error.say("the scene has %llu surfaces (a patch of n corners counts as n - 2), more than the limit of "
                         "%u surfaces",
                         static_cast<unsigned long long>(surfaces()), most);
    }

    // Has a narrow number system enough steps left where a plane takes most of them, and for the cells of textures?
    bool fine_enough([[maybe_unused]] Error& error) const
    {
        if constexpr (NarrowFixed<N>) {
            const double step = resolution.step();
            if (frame.radius < Limits::narrow_radius * step)
                return error.say(
                    "%s has lengths in steps of %.3g where planes reach as far as %.6g, and the scene's radius of "
                    "%.3g is less than %.0f of them; expected a nearer 'far', or another number system",
                    number_names_of<N>().name, step, frame.far, frame.radius, Limits::narrow_radius);
            for (uint32_t i = 0; i < d.fill_count; i++)
                if (const Texture& t = d.fills[i].texture; t.size < Limits::narrow_cell * step)
                    return error.say("%s has lengths in steps of %.3g here, and a texture's size of %.3g is less than "
                                     "1/%.0f of one; expected a larger one, or another number system",
                                     number_names_of<N>().name, step, t.size, 1 / Limits::narrow_cell);
        }
        return true;
    }

    void fit()
    {
        Extent box;
        box.add(d.view.from);
        box.add(d.view.at);
        if (settings.bounded()) {
            box.add(settings.within.low);
            box.add(settings.within.high);
        }
        double needed = 0; // in units of what a point's coordinates may be
        bool endless = false;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            add_object(box, d, o);
            needed = fmax(needed, with_host(o.kind, [&o](auto host) { return host.template range<N>(o); }));
            endless = endless || is_endless(o);
        }
        Frame& f = frame;
        f.centre = box.middle();
        f.radius = scene::length(box.high - box.low) / 2;
        f.far = d.far > 0 ? d.far : 16 * f.radius;
        const double reach = endless ? fmax(f.radius, f.far) : f.radius;
        int exponent = 0;
        frexp(fmax(reach / world, needed), &exponent);
        f.scale = ldexp(1, -exponent);
        // On a coarse lattice, so that coordinates that are round in the file stay so.
        const double step = f.scale * 64;
        f.origin = {round(f.centre.x * step) / step, round(f.centre.y * step) / step, round(f.centre.z * step) / step};
        f.eye = settings.moving == 0 ? resolution.eye() : d.view.from;
        if (settings.moving != 0)
            resolution.moving_eye(s.unmoved);
        f.pushed = scene::length(f.eye - d.view.from);
        // At most half an ulp from there, so that the eye, where all rays start, is not rounded.
        if (WideFixed<N> && settings.stands()) {
            const auto moved = [this](double origin, double eye) {
                const double ulp = resolution.step(), at = (eye - origin) / ulp;
                return origin + (at - rint(at)) * ulp;
            };
            f.origin = {moved(f.origin.x, f.eye.x), moved(f.origin.y, f.eye.y), moved(f.origin.z, f.eye.z)};
        }
    }

    static ScenePoint<N> place(const Vec3d& p) { return Convert<N>::template vector<ScenePoint<N>>(p); }

    // The frame as a program on the part has it. Its coordinates are in steps of 2^-16.
    bool frame_of_part([[maybe_unused]] Error& error)
    {
        s.moving = settings.moving;
        if (settings.moving == 0)
            return true;
        if (moves_tables(settings.moving) && d.grid_count != 0) {
            error.at = d.radiosity_at;
            return error.say("light between surfaces is that of a scene that stands still; expected '--moving camera' "
                             "alone, or no 'radiosity'");
        }
        if constexpr (N::is_fixed) {
            const int exponent = -ilogb(frame.scale);
            if (const double far = largest(frame.origin) + world / frame.scale; exponent < -10 || far >= 32768)
                return error.say("a scene that moves has coordinates below 32768 in steps of 1/65536, and this one "
                                 "reaches %.6g and has a radius of %.3g; expected other units, or float",
                                 far, frame.radius);
            s.frame = {place(frame.origin), exponent};
        } else {
            using F = typename N::Length;
            s.frame = {place(frame.origin), static_cast<F>(frame.scale), static_cast<F>(1 / frame.scale)};
        }
        const double half = d.view.angle * (M_PI / 360);
        const double most = N::is_fixed ? UINT32_MAX / fmax(sin(half), cos(half)) : 1;
        const auto part = [most](double v) { return static_cast<decltype(s.text_view.field.sine)>(v * most); };
        s.text_view = {place(d.view.from), place(d.view.at), place(unit(d.view.up)),
                       {part(sin(half)), part(cos(half))}};
        return true;
    }

    // What is smooth first: a corner's shading normal has the number of the corner, and other figures need none.
    void shapes()
    {
        if (flat)
            LeanBuilder<N>{s}.start(2 * d.vertex_count + 1);
        for (const bool smooth : {true, false}) {
            uint32_t place = 0;
            for (uint32_t i = 0; i < d.object_count; i++) {
                const Object& o = d.objects[i];
                with_shape_of<N>(o.kind, [&]<class Shape>(auto host) {
                    if (Shape::is_smooth == smooth) {
                        const uint32_t vanished = s.vanished;
                        host.convert(*this, o, place);
                        if (s.vanished == vanished)
                            resolution.span(o);
                    }
                    place += host.surfaces_of(o);
                });
            }
        }
    }

    void materials()
    {
        for (uint32_t i = 0; i < d.fill_count; i++) {
            const Fill& f = d.fills[i];
            const Vec3d ambient = d.radiosity > 0 ? Vec3d{} : d.ambient * f.ambient; // or in light maps
            s.mattes.push() = {Convert<N>::surface(f.colour), s.colour(ambient + grey(f.emission)),
                               Convert<N>::unit(f.diffuse)};
            s.highlights.push() = {Convert<N>::unit(f.highlight), Convert<N>::shine(f.shine)};
            s.mirrors.push() = {Convert<N>::unit(f.mirror)};
            s.transmits.push() = {Convert<N>::unit(f.transmit), Convert<N>::eta(1 / f.ior), Convert<N>::eta(f.ior)};
            s.textures.push() = textures.texture(f.texture);
        }
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
        const int64_t at = settings.moving == 0 ? resolution.eye_surface(fill, outward) : -1;
        s.eye_surface = {{Tag::none}, {}};
        if (at >= 0)
            s.eye_surface = {make_tag(static_cast<uint32_t>(at), fill), Convert<N>::direction(outward)};
    }

    // Of what was named.
    void nothing_to_move()
    {
#define QRAY_NONE(Type, name, table) \
    if ((settings.moving & bit_of(TableId::table)) != 0 && s.table.count == 0) \
        s.unmoved.note({0, 0}, "there are no " #table " to be moved");
        QRAY_SHAPES(QRAY_NONE)
        QRAY_LIGHTS(QRAY_NONE)
#undef QRAY_NONE
    }

    void effects()
    {
        Effects e;
#define QRAY_HAS(Type, name, table) e.name = s.table.count != 0;
        QRAY_SHAPES(QRAY_HAS)
        QRAY_TEXTURES(QRAY_HAS)
        QRAY_LIGHTS(QRAY_HAS)
#undef QRAY_HAS
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
        e.light_surface = e.shadow && s.light_surfaces.count != 0;
        e.eye_surface = !(s.eye_surface.tag == Tag{Tag::none});
        e.light_map = s.lights_of.count != 0;
        if (!moves_all(settings.moving))
            nothing_to_move();
        e.tree = true;
        e.grid = settings.levels == 0 && settings.grid > 1;
        e.adaptive = settings.levels != 0;
        e.depth = e.transmit ? static_cast<uint8_t>(settings.depth) : 1;
        if (e.light_map && settings.compiled)
            e.light_bits = static_cast<uint8_t>(settings.light_bits);
        s.effects = e;
    }
};

} // namespace qray::scene
