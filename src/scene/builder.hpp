// From a description in double to a number system's storage: moves and scales the scene to fill the range, finds
// what it calls for, and computes what the tracer would otherwise compute again and again.
#pragma once

#include <stdio.h>
#include <string.h>

#include <utility>

#include "flatten.hpp"
#include "lean.hpp"
#include "moving.hpp"
#include "numbers.hpp"
#include "resolution.hpp"
#include "settings.hpp"
#include "storage.hpp"
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
        if (s.lay_out(d, settings.compiled) > s.room.size) {
            snprintf(error.text, sizeof error.text, "not enough memory");
            return false;
        }
        s.vanished = 0;
        s.lost = {};
        images();
        fit();
        if (!fine_enough(error) || !frame_of_part(error))
            return false;
        s.origin = frame.origin;
        s.scale = frame.scale;
        resolution.pairs(s.sorted.data);
        shapes();
        if (!lights(error))
            return false;
        materials();
        if (d.radiosity > 0)
            light_maps();
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
    int fine_for([[maybe_unused]] double size, [[maybe_unused]] int32_t Blocks::*within) const
    {
        int fine = 0;
        if constexpr (N::is_fixed) {
            const double with_slack = ldexp(size * frame.scale, N::Length::frac) + N::blocks.slack;
            fine = N::blocks.least;
            while (fine < N::blocks.most && ldexp(with_slack, fine + 1) <= N::blocks.*within)
                fine++;
        }
        return fine;
    }

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
        if constexpr (is_float)
            return r < 0x1p-40f;
        else
            return r == N::length_zero;
    }

    // A triangle in little room, where a tree finds it and it fits; see lean.hpp.
    template <class T>
    bool push_lean(Array<T>& table, const Point<N>* corners, const Direction<N>* normals, const Direction<N>& g,
                   uint32_t place, uint32_t fill)
    {
        const bool moves = (settings.moving & bit_of(T::is_smooth ? TableId::patches : TableId::polygons)) != 0;
        return flat && !moves && LeanBuilder<N>{s}.push(table, corners, normals, g, place, fill);
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
    static constexpr bool is_float = !N::is_fixed && sizeof(typename N::Length) == 4;
    const Settings& settings;
    Resolution<N> resolution{d, frame, s.lost};

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
        if (surfaces() <= most)
            return true;
        snprintf(error.text, sizeof error.text,
                 "the scene has %llu surfaces (a patch of n corners counts as n - 2), "
                 "more than the limit of %u surfaces",
                 static_cast<unsigned long long>(surfaces()), most);
        return false;
    }

    // Has a narrow number system enough steps left where a plane takes most of them, and for the cells of textures?
    bool fine_enough([[maybe_unused]] Error& error) const
    {
        if constexpr (NarrowFixed<N>) {
            const double step = resolution.step();
            if (frame.radius < Limits::narrow_radius * step) {
                snprintf(error.text, sizeof error.text,
                         "%s has lengths in steps of %.3g where planes reach as far as %.6g, and the scene's radius "
                         "of %.3g is less than %.0f of them; expected a nearer 'far', or another number system",
                         number_name<N>(), step, frame.far, frame.radius, Limits::narrow_radius);
                return false;
            }
            for (uint32_t i = 0; i < d.fill_count; i++)
                if (const Texture& t = d.fills[i].texture;
                    t.kind != TextureKind::none && t.kind != TextureKind::globe
                    && t.size < Limits::narrow_cell * step) {
                    snprintf(error.text, sizeof error.text,
                             "%s has lengths in steps of %.3g here, and a texture's size of %.3g is less than "
                             "1/%.0f of one; expected a larger one, or another number system",
                             number_name<N>(), step, t.size, 1 / Limits::narrow_cell);
                    return false;
                }
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
        if (moves_tables() && d.grid_count != 0) {
            snprintf(error.text, sizeof error.text,
                     "light between surfaces is that of a scene that stands still; expected "
                     "'--moving camera' alone, or no 'radiosity'");
            return false;
        }
        if constexpr (N::is_fixed) {
            const int exponent = -ilogb(frame.scale);
            if (const double far = largest(frame.origin) + world / frame.scale; exponent < -10 || far >= 32768) {
                snprintf(error.text, sizeof error.text,
                         "a scene that moves has coordinates below 32768 in steps of 1/65536, and this one reaches "
                         "%.6g and has a radius of %.3g; expected other units, or float",
                         far, frame.radius);
                return false;
            }
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

    // What may stand far outside: in units of 2^shift lengths.
    struct FarPoint {
        Vec3d at;
        int shift;
    };
    static FarPoint far_point(Vec3d at)
    {
        int shift = 0;
        if constexpr (N::is_fixed)
            for (; (NarrowFixed<N> ? scene::length(at) : largest(at)) > world; at = at * 0.5)
                shift++;
        return {at, shift};
    }

    // Colours are divided by 2^exposure so that no sum of lights leaves the range of Colour.
    bool lights(Error& error)
    {
        double emission = 0;
        for (uint32_t i = 0; i < d.fill_count; i++)
            emission = fmax(emission, d.fills[i].emission);
        Vec3d sum = d.ambient + grey(emission);
        for (uint32_t i = 0; i < d.light_count; i++)
            sum = sum + d.lights[i].colour * 2;
        double arrives = 0;
        for (uint32_t i = 0; d.grid_count != 0 && i < d.light_size; i++)
            arrives = fmax(arrives, largest(d.light[i]));
        sum = sum + grey(arrives);
        s.exposure = 0;
        if constexpr (N::is_fixed)
            while (ldexp(fmax(largest(sum), largest(d.background)), -s.exposure) > range)
                s.exposure++;
        s.background = colour(d.background);
        s.far_lights = 0;
        uint32_t panels = 0;
        for (uint32_t i = 0; i < d.light_count; i++) {
            const LightSource& l = d.lights[i];
            if (l.places != 0 && !panel(l, panels++, error))
                return false;
            if (l.places != 0)
                continue;
            if (l.sun) {
                s.suns.push() = {Convert<N>::direction(unit(l.at)), colour(l.colour)};
                continue;
            }
            auto [at, shift] = far_point(frame.point(l.at));
            // So far away that it is a sun; in float, its square would be infinite.
            if (shift > 30 || (is_float && largest(at) > 0x1p60)) {
                s.far_lights |= uint64_t{1} << i;
                s.suns.push() = {Convert<N>::direction(unit(at)), colour(l.colour)};
                continue;
            }
            if constexpr (is_float) // what is not 0 from there to a surface has a square that float holds
                at = {off_zero(at.x), off_zero(at.y), off_zero(at.z)};
            if (shift == 0 && !moves_tables())
                resolution.light_surfaces(l.at, keep_light_surface(s.lights.count));
            s.lights.push() = {Convert<N>::point(at), shift, colour(l.colour)};
        }
        if (s.light_surfaces.count <= most_light_surfaces())
            return true;
        snprintf(error.text, sizeof error.text,
                 "lights lie on more than %u surfaces (limit 'light_surfaces', times lights)",
                 most_light_surfaces());
        return false;
    }
    // Which surface a lamp lies on is known of one place alone.
    bool moves_tables() const { return (settings.moving & ~camera_moves) != 0; }
    uint32_t most_light_surfaces() const { return d.light_count * Limits::light_surfaces; }
    // Counts one more than there may be, too. `light` is as LightSurface has it.
    auto keep_light_surface(uint32_t light)
    {
        return [this, light](uint32_t place, uint32_t fill, const Vec3d& outward, int32_t side) {
            if (s.light_surfaces.count < most_light_surfaces())
                s.light_surfaces.push() = {light, make_tag(place, fill), Convert<N>::direction(outward), side};
            else
                s.light_surfaces.count = most_light_surfaces() + 1;
        };
    }

    bool panel(const LightSource& l, uint32_t number, Error& error)
    {
        const Vec3d at = frame.point(l.at), u = l.u * frame.scale, v = l.v * frame.scale;
        const Vec3d reach{fabs(u.x) + fabs(v.x), fabs(u.y) + fabs(v.y), fabs(u.z) + fabs(v.z)};
        const auto [far, shift] = far_point({fabs(at.x) + reach.x, fabs(at.y) + reach.y, fabs(at.z) + reach.z});
        if (shift > 30 || (is_float && largest(far) > 0x1p60)) {
            if (largest(reach) > 0x1p-20 * largest(at)) {
                snprintf(error.text, sizeof error.text,
                         "a panel that is too far away for its size, %.3g by %.3g: "
                         "as far as 1e9 times the scene's size",
                         2 * scene::length(l.u), 2 * scene::length(l.v));
                return false;
            }
            s.far_lights |= uint64_t{1} << (&l - d.lights);
            s.suns.push() = {Convert<N>::direction(unit(at)), colour(l.colour)};
            return true;
        }
        if (shift == 0 && !moves_tables())
            resolution.panel_surfaces(l, keep_light_surface(~number));
        const auto fine = [shift = shift](const Vec3d& p) {
            return Convert<N>::point(p * ldexp(1, Panel<N>::fine - shift));
        };
        s.panels.push() = {fine(at - u - v), fine(u * (2.0 / l.places)), fine(v * (2.0 / l.places)), shift,
                           colour(l.colour), static_cast<uint8_t>(l.places), static_cast<uint8_t>(number)};
        return true;
    }
    static double off_zero(double v) { return copysign(fmax(fabs(v), 0x1p-38), v); }
    static constexpr double range = 7.99;

    Rgb<N> colour(const Vec3d& c) const { return Convert<N>::rgb(c * ldexp(1, -s.exposure)); }
    static Vec3d grey(double v) { return {v, v, v}; }
    static Vec<typename N::Unit> surface(const Vec3d& c) { return Convert<N>::direction(c); }

    void materials()
    {
        for (uint32_t i = 0; i < d.fill_count; i++) {
            const Fill& f = d.fills[i];
            const Vec3d ambient = d.radiosity > 0 ? Vec3d{} : d.ambient * f.ambient; // or in light_maps()
            s.mattes.push() = {surface(f.colour), colour(ambient + grey(f.emission)), Convert<N>::unit(f.diffuse)};
            s.highlights.push() = {Convert<N>::unit(f.highlight), Convert<N>::shine(f.shine)};
            s.mirrors.push() = {Convert<N>::unit(f.mirror)};
            s.transmits.push() = {Convert<N>::unit(f.transmit), Convert<N>::eta(1 / f.ior), Convert<N>::eta(f.ior)};
            s.textures.push() = texture(f.texture);
        }
    }

    Texels<N> texels[Limits::images];

    // The bytes of all images: an index a texel where there are at most 256 colours, which stand behind them, and that
    // is shorter; else all three.
    void images()
    {
        for (uint32_t i = 0; i < d.image_count; i++) {
            const ImageSource& from = d.images[i];
            const uint8_t* const rgb = d.image_bytes.room.at + from.first;
            uint8_t* const to = s.texels.data + s.texels.count;
            const uint32_t size = from.width * from.height;
            // A colour's number stands at its hash, or at the next place that was free.
            uint32_t colours = 0, keys[1024] = {};
            uint8_t numbers[1024];
            for (uint32_t k = 0; k < size && colours <= 256; k++) {
                const uint8_t* const c = rgb + 3 * size_t{k};
                const uint32_t key = 1 + (uint32_t{c[0]} | uint32_t{c[1]} << 8 | uint32_t{c[2]} << 16);
                uint32_t at = key * 0x9e3779b1u >> 22;
                while (keys[at] != 0 && keys[at] != key)
                    at = (at + 1) & 1023;
                if (keys[at] == 0) {
                    keys[at] = key;
                    numbers[at] = static_cast<uint8_t>(colours++);
                }
                to[k] = numbers[at];
            }
            const bool indexed = colours <= 256 && size + 3 * colours < 3 * size;
            if (indexed) {
                for (uint32_t at = 0; at < 1024; at++)
                    for (uint32_t c = 0; keys[at] != 0 && c < 3; c++)
                        to[size + 3 * numbers[at] + c] = static_cast<uint8_t>((keys[at] - 1) >> 8 * c);
            } else {
                memcpy(to, rgb, 3 * size_t{size});
            }
            s.texels.count += indexed ? size + 3 * colours : 3 * size;
            texels[i] = {to, indexed ? to + size : nullptr, static_cast<uint16_t>(from.width),
                         static_cast<uint16_t>(from.height)};
        }
    }

    // The coordinates of a texture, in its own size: see the textures' headers.
    struct Make {
        const Texture& t;
        const Frame& frame;
        const Texels<N>* images;
        // What keeps a surface in a plane of the lattice clean: not less than a hit may lie off its surface.
        double epsilon() const
        {
            if constexpr (NarrowFixed<N>)
                return fmax(1.0 / 1024, ldexp(1.5, -N::Length::frac) / (t.size * frame.scale));
            return 1.0 / 1024;
        }
        Vec3d direction() const { return scene::length(t.axis) > 0 ? unit(t.axis) : Vec3d{0, 1, 0}; }
        LatticeAxis<N> axis(const Vec3d& along, double offset, bool wraps) const
        {
            return Convert<N>::axis(along * (1 / t.size), frame.origin, frame.scale, offset, wraps);
        }

        Vec<typename N::Unit> colour() const { return surface(t.colour); }
        // Cells along x, y and z; of y so many to a size.
        Lattice<N> lattice(bool clean, int courses = 1) const
        {
            const auto step = [&](const Vec3d& along) {
                return Convert<N>::step(axis(along, clean ? epsilon() : 0, true));
            };
            return {step({1, 0, 0}), step({0, static_cast<double>(courses), 0}), step({0, 0, 1})};
        }
        LatticeAxis<N> along_axis(bool clean, bool wraps) const
        {
            return axis(direction(), clean ? epsilon() : 0, wraps);
        }
        LatticeAxis<N> across_axis(int which) const
        {
            const Vec3d u = unit_across(direction());
            return axis(which == 0 ? u : cross(direction(), u), 0, false);
        }
        LatticeAxis<N> along_x() const { return axis({1, 0, 0}, 0, false); }
        LatticeAxis<N> along_z() const { return axis({0, 0, 1}, 0, false); }

        Texels<N> texels() const { return images[t.image]; }
        LatticeAxis<N> along_edge(int which) const
        {
            const Vec3d& edge = which == 0 ? t.u : t.v;
            const double length = scene::length(edge);
            const Vec3d row = edge * (1 / length) * (1 / length);
            return Convert<N>::axis(row, frame.origin, frame.scale, -dot(row, t.at), true);
        }
        // Farther away than any light that is not a sun, only its direction tells.
        auto centre() const
        {
            Vec3d at = frame.point(t.at);
            at = at * fmin(1, ldexp(world, 30) / fmax(largest(at), 1));
            const FarPoint far = far_point(at);
            return std::pair(Convert<N>::point(far.at), int32_t{far.shift});
        }
    };

    TextureRef texture(const Texture& t)
    {
        const auto push = [&t, this](auto& table) {
            table.push() = std::remove_reference_t<decltype(*table.data)>::made(Make{t, frame, texels});
            return TextureRef{t.kind, static_cast<uint16_t>(table.count - 1)};
        };
        switch (t.kind) {
        case TextureKind::none: break;
#define QRAY_CASE(Type, name, table) case TextureKind::name: return push(s.table);
            QRAY_TEXTURES(QRAY_CASE)
#undef QRAY_CASE
        }
        return {TextureKind::none, 0};
    }

    // What surfaces send one another: on what takes no part the ambient light, and on the others nothing
    // before it is solved.
    void light_maps()
    {
        const LightGrid* grid = d.grids;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            bool takes_part = false;
            with_host(o.kind, [&](auto host) { host.outline(d, o, [&](const Vec3d&) { takes_part = true; }); });
            const bool solved = takes_part && d.grid_count != 0;
            const Vec3d ambient = takes_part ? Vec3d{} : d.ambient * d.fills[o.fill].ambient;
            const uint32_t even = solved ? 0 : even_light(ambient);
            for (uint32_t k = surfaces_of(o); k-- > 0;)
                s.lights_of.push() = {even, even};
            if (!solved)
                continue;
            const uint32_t outside = light_map(grid[0]), inside = light_map(grid[1]);
            s.lights_of.data[s.lights_of.count - 1] = {outside, inside};
            grid += 2;
        }
    }

    uint32_t even_light(const Vec3d& light)
    {
        const Rgb<N> c = colour(light);
        uint32_t i = s.even_lights.count;
        while (i > 0 && !(s.even_lights.data[i - 1].light == c))
            i--;
        if (i == 0) {
            s.even_lights.push() = {c};
            i = s.even_lights.count;
        }
        return LightOf<N>::even + i - 1;
    }

    uint32_t light_map(const LightGrid& grid)
    {
        const Vec3d *const first = d.light + grid.first, *const end = first + grid.lights();
        Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{}, sum;
        for (const Vec3d* c = first; c != end; c++) {
            low = {fmin(low.x, c->x), fmin(low.y, c->y), fmin(low.z, c->z)};
            high = {fmax(high.x, c->x), fmax(high.y, c->y), fmax(high.z, c->z)};
            sum = sum + *c;
        }
        const double steps_in_1 = fmax(scene::length(grid.x.along), scene::length(grid.y.along)) / frame.scale;
        if (largest(high - low) <= 1.0 / 512 || steps_in_1 > LightSteps<N>::most)
            return even_light(sum * (1.0 / grid.lights()));
        constexpr double white = 4, steps = 255, least = 0x1p-20;
        const auto top = [](double v) { return fmin(fmax(v, least), white) / steps; };
        const Vec3d step{top(high.x), top(high.y), top(high.z)};
        const LightAxis<N> x = light_axis(grid, grid.x), y = light_axis(grid, grid.y);
        s.light_maps.push() = {x, y, colour(step * (N::is_fixed ? 256 : 0x1p-16)), static_cast<uint16_t>(grid.x.count),
                               static_cast<uint16_t>(grid.y.count), light_values,
                               grid.cuts != 0 ? s.light_knots.count : LightMap<N>::whole, s.light_cuts.count};
        for (uint32_t i = 0; grid.cuts != 0 && i < (grid.x.count - 1) * (grid.y.count - 1); i++)
            s.light_knots.push() = {static_cast<uint16_t>(d.roots[grid.first_root + i])};
        for (uint32_t i = grid.first_cut; i < grid.first_cut + grid.cuts; i++) {
            const WallCut& cut = d.cuts[i];
            s.light_cuts.push() = {light_plane(cut), static_cast<uint16_t>(cut.above),
                                   static_cast<uint16_t>(cut.below)};
        }
        const uint32_t most = (1u << settings.light_bits) - 1;
        for (const Vec3d* c = first; c != end; c++)
            for (double Vec3d::*part : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
                light_value(static_cast<uint32_t>(fmin(floor(c->*part / (step.*part * (255 / most)) + 0.5), most)),
                            most);
        return s.light_maps.count - 1;
    }
    // Only compiled scenes have several in a byte.
    void light_value(uint32_t level, uint32_t most)
    {
        const uint32_t bits = settings.compiled ? settings.light_bits : 8, shift = light_values++ * bits % 8;
        if (shift == 0)
            s.light_cells.push() = {};
        s.light_cells.data[s.light_cells.count - 1].value |=
            static_cast<uint8_t>(settings.compiled ? level << shift : level * (255 / most));
    }
    uint32_t light_values = 0;

    // Of row . q + offset of a point q in the moved and scaled scene.
    static LightSteps<N> light_steps(const Vec3d& row, double offset)
    {
        const auto whole = [](double v) { return static_cast<int32_t>(llrint(v)); };
        if constexpr (NarrowFixed<N>) {
            int exponent = 0;
            frexp((scene::length(row) * world + fabs(offset)) * 1.01, &exponent);
            const int shift = std::min(30 - exponent, 24);
            const double k = ldexp(1, shift - N::Length::frac + N::dropped);
            return {whole(row.x * k), whole(row.y * k), whole(row.z * k), whole(ldexp(offset, shift)), shift};
        } else if constexpr (N::is_fixed) {
            const Vec3d r = row * ldexp(1, 32 - N::Length::frac);
            return {{{whole(r.x)}, {whole(r.y)}, {whole(r.z)}}, whole(offset)};
        } else {
            return {Convert<N>::point(row), whole(offset)};
        }
    }

    uint16_t light_plane(const WallCut& cut)
    {
        const LightPlane<N> plane{Convert<N>::direction(cut.normal),
                                  Convert<N>::length((cut.height - dot(cut.normal, frame.origin)) * frame.scale)};
        uint32_t i = 0;
        while (i < s.light_planes.count
               && !(s.light_planes.data[i].normal == plane.normal && s.light_planes.data[i].height == plane.height))
            i++;
        if (i == s.light_planes.count)
            s.light_planes.push() = plane;
        return static_cast<uint16_t>(i);
    }

    LightAxis<N> light_axis(const LightGrid& grid, const NodeAxis& from)
    {
        const uint16_t* const node = d.nodes + from.first;
        const int between = node[1] - node[0];
        bool even = true;
        for (uint32_t i = 2; i < from.count; i++)
            even = even && node[i] - node[i - 1u] == between;
        const double step = even ? 1.0 / between : 1;
        const Vec3d row = from.along * step;
        const double offset = dot(row, frame.origin - grid.origin) - (even ? node[0] * step : 0);
        const LightSteps<N> axis = light_steps(row * (256 / frame.scale), 256 * offset);
        const int most = static_cast<int>(256 * (from.count - 1)) - 1;
        if (even)
            return {axis, most, LightAxis<N>::even};
        const uint32_t first = s.light_knots.count;
        for (uint32_t k = 0, i = 0; k <= from.steps; k++) {
            while (i + 2 < from.count && node[i + 1] <= k)
                i++;
            const double at = 256 * (i + (static_cast<double>(k) - node[i]) / (node[i + 1] - node[i]));
            s.light_knots.push() = {static_cast<uint16_t>(std::clamp(static_cast<int>(at + 0.5), 0, most))};
        }
        return {axis, static_cast<int32_t>(256 * from.steps - 1), first};
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
