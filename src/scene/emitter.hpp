// The builder's result as a constexpr header: a namespace with Number, effects, width, height and scene, for
// programs that include <qray/qray.hpp>. It holds what the scene calls for and nothing else.
#pragma once

#include <type_traits>

#include "effect_names.hpp"
#include "source.hpp"
#include "storage.hpp"

namespace qray::scene {

// Calls f(array, type, name, fields) for each table that a tracer for e needs of a scene, in Scene's order.
template <class N, class F>
void for_each_table(const Storage<N>& s, const Effects& e, F f)
{
    constexpr const char* lattice = NarrowFixed<N> ? "colour; x, y, z coordinate: row, frac, offset, whole"
        : N::is_fixed                           ? "colour; x, y, z coordinate: row, shift, offset"
                                                : "colour; x, y, z coordinate: row, inside, index";
    const auto table = [&f](bool present, const auto& array, const char* type, const char* name,
                            const char* fields) {
        if (present && array.count != 0)
            f(array, type, name, fields);
    };
    table(e.sphere, s.spheres, "Sphere<Number>", "spheres",
          "centre; radius * 2^fine and its inverse; fine; tag; centre's rounding * 2^fine");
    table(e.disc, s.discs, "Disc<Number>", "discs", "centre; normal; radius; tag");
    table(e.cone, s.cones, "Cone<Number>", "cones",
          "middle; across, across, axis; cosine * mean radius, half height, bound, all * 2^fine; "
          "cosine, sine; fine; tag; middle's rounding * 2^fine");
    table(e.polygon, s.polygons, "Polygon<Number>", "polygons",
          "normal; middle and radius of a ball around it; first vertex, count; tag");
    table(e.patch, s.patches, "Patch<Number>", "patches",
          "normal; middle and radius of a ball around it; vertices: first, second; tag");
    table(e.polygon || e.patch, s.vertices, "Point<Number>", "vertices",
          "corners of polygons and patches");
    table(e.patch, s.normals, "Direction<Number>", "normals", "shading normals, as many as vertices");

    table(true, s.mattes, "Matte<Number>", "mattes", "by material: colour; ambient light; diffuse");
    table(e.highlight, s.highlights, "Highlight<Number>", "highlights",
          "by material: amount; shine: whole, fraction");
    table(e.mirror, s.mirrors, "Mirror<Number>", "mirrors", "by material: amount");
    table(e.transmit || e.see_through, s.transmits, "Transmit<Number>", "transmits",
          "by material: amount; 1 / index of refraction, index");
    table(e.texture(), s.textures, "TextureRef", "textures",
          "by material: kind; index into the table of that kind");
    table(e.checker, s.checkers, "Checker<Number>", "checkers", lattice);
    table(e.stripes, s.stripes, "Stripes<Number>", "stripes", "colour; coordinate");
    table(e.gradient, s.gradients, "Gradient<Number>", "gradients", "colour; coordinate");
    table(e.rings, s.rings, "Rings<Number>", "rings", "colour; x and z coordinate");
    table(e.noise, s.noises, "Noise<Number>", "noises", lattice);
    table(e.marble, s.marbles, "Marble<Number>", "marbles",
          "colour; x, y, z coordinate; the one across the veins");
    table(e.wood, s.woods, "Wood<Number>", "woods", "colour; x, y, z coordinate; two across the grain");
    table(e.brick, s.bricks, "Brick<Number>", "bricks", lattice);

    table(e.light, s.lights, "Light<Number>", "lights", "place / 2^shift; shift; colour");
    table(e.sun, s.suns, "Sun<Number>", "suns", "direction towards it; colour");
}

template <class N>
class Emitter {
public:
    Emitter(const Storage<N>& from, Source& to) : s(from), out(to), e(from.effects)
    {
        e.tree = false; // it pays from some hundred shapes on, and takes a float a ray
    }

    // `title` may be empty; `origin` says what the header was made from; `name` is of the namespace.
    void emit(const char* title, const char* origin, const char* name)
    {
        if (*title != 0)
            out.comment(title);
        out.comment(origin);
        out.put("#pragma once\n\n#include <qray/qray.hpp>\n\n");
        out.print("namespace %s::inline h%016llx { // by its contents, so that a linker tells two scenes apart\n\n", name,
                  static_cast<unsigned long long>(digest()));
        contents();
        out.print("\n} // namespace %s\n", name);
    }

private:
    template <class T>
    struct Single { // a Maybe
        T value;
    };

    const Storage<N>& s;
    Source& out;
    Effects e;

    // Of the namespace's contents: FNV-1a, 64 bits.
    uint64_t digest() const
    {
        uint64_t hash = 0xcbf2'9ce4'8422'2325;
        const auto add = [](void* to, const char* bytes, size_t size) {
            uint64_t& h = *static_cast<uint64_t*>(to);
            for (size_t i = 0; i < size; i++)
                h = (h ^ static_cast<unsigned char>(bytes[i])) * 0x100'0000'01b3;
            return true;
        };
        Source text(add, &hash);
        Emitter(s, text).contents();
        text.finish();
        return hash;
    }

    void contents()
    {
        if (e.shapes() != 0)
            out.put("using qray::make_tag; // place in the scene file, material\n");
        out.print("using Number = qray::%s;\n", number_name());
        if constexpr (N::is_fixed)
            out.print("// Lengths are in 2^-%d, unit vectors and coefficients in 2^-%d, light in 2^-%d.\n",
                      N::Length::frac, N::Unit::frac, N::Colour::frac);
        out.print("\ninline constexpr uint32_t width = %u, height = %u;\n", unsigned{s.camera.width},
                  unsigned{s.camera.height});
        effects();
        for_each_table(s, e, [this](const auto& array, const char* type, const char* name, const char* fields) {
            out.print("\n// %s\ninline constexpr qray::%s %s[] = {\n", fields, type, name);
            for (uint32_t i = 0; i < array.count; i++) {
                out.put("    ");
                value(array.data[i]);
                out.put(",\n");
            }
            out.put("};\n");
        });
        out.put("\ninline constexpr qray::Scene<Number, effects> scene{\n");
        camera();
        if (e.eye_surface)
            member("eye_surface", Single<EyeSurface<N>>{s.eye_surface});
        member("background", s.background);
        member("exposure", s.exposure);
        if (e.spawns()) {
            member("max_depth", Single<uint8_t>{s.max_depth});
            member("cutoff", Single<typename N::Unit>{s.cutoff});
        }
        if (e.shadow)
            member("shadows", Single<bool>{s.shadows});
        if (e.adaptive) {
            member("levels", Single<uint8_t>{s.levels});
            member("threshold", Single<typename N::Unit>{s.threshold});
        }
        for_each_table(s, e, [this](const auto& array, const char*, const char* name, const char*) {
            out.print("    .%s = {%s, %u},\n", name, name, static_cast<unsigned>(array.count));
        });
        out.put("};\n");
    }

    static constexpr const char* number_name()
    {
        return std::is_same_v<N, Float> ? "Float" : std::is_same_v<N, Double> ? "Double" : NarrowFixed<N> ? "q16" : "q32";
    }

    void effects()
    {
        out.put("inline constexpr qray::Effects effects{\n");
        for (const EffectName& name : effect_names)
            if (e.*name.effect)
                out.print("    .%s = true,\n", name.name);
        out.print("    .depth = %u,\n};\n", unsigned{e.depth});
    }

    void camera()
    {
        const auto& [eye, centre, right, down, width, height, grid] = s.camera;
        out.put("    .camera = {\n");
        const auto field = [this](const char* name, const auto& v) {
            out.print("        .%s = ", name);
            value(v);
            out.put(",\n");
        };
        field("eye", eye);
        field("centre", centre);
        field("right", right);
        field("down", down);
        out.put("        .width = width,\n        .height = height,\n");
        field("grid", grid);
        out.put("    },\n");
    }

    template <class T>
    void member(const char* name, const T& v)
    {
        out.print("    .%s = ", name);
        value(v);
        out.put(",\n");
    }

    // A braced list, all braces written.
    template <class First, class... Rest>
    void list(const First& first, const Rest&... rest)
    {
        out.put("{");
        value(first);
        ((out.put(", "), value(rest)), ...);
        out.put("}");
    }

    // Each takes its structure apart: a new member is an error here until it is written too.
    void value(int64_t v) { out.number(v); }
    void value(int32_t v) { out.number(int64_t{v}); }
    void value(uint32_t v) { out.number(int64_t{v}); }
    void value(uint16_t v) { out.number(int64_t{v}); }
    void value(uint8_t v) { out.number(int64_t{v}); }
    void value(bool v) { out.put(v ? "true" : "false"); }
    void value(float v) { out.number(v); }
    void value(double v) { out.number(v); }
    void value(Tag v)
    {
        out.print("make_tag(%u, %u)", static_cast<unsigned>(v.place()), static_cast<unsigned>(v.material()));
    }
    template <class T>
    void value(const Single<T>& v) { list(v.value); }
    template <int F, int B>
    void value(const Fixed<F, B>& v) { list(v.raw); }
    template <class T>
    void value(const Vec<T>& v) { list(v.x, v.y, v.z); }
    void value(const Rounded<N>& v)
    {
        if constexpr (WideFixed<N>) {
            const auto& [x, y, z] = v;
            list(int32_t{x}, int32_t{y}, int32_t{z});
        } else {
            out.put("{}");
        }
    }
    void value(const FixedScale& v)
    {
        const auto& [mantissa, shift] = v;
        list(mantissa, shift);
    }
    void value(const typename N::Shine& v)
    {
        const auto& [whole, fraction] = v;
        list(whole, fraction);
    }
    void value(const Pencil<N>& v)
    {
        list(v.x, v.y, v.z);
    }

    void value(const Sphere<N>& v)
    {
        const auto& [centre, radius, inverse_radius, fine, tag, rounded] = v;
        list(centre, radius, inverse_radius, fine, tag, rounded);
    }
    void value(const Disc<N>& v)
    {
        const auto& [centre, normal, radius, tag] = v;
        list(centre, normal, radius, tag);
    }
    void value(const Cone<N>& v)
    {
        const auto& [middle, e1, e2, axis, rho0, half, bound, cosine, sine, fine, tag, rounded] = v;
        list(middle, e1, e2, axis, rho0, half, bound, cosine, sine, fine, tag, rounded);
    }
    void value(const Polygon<N>& v)
    {
        const auto& [normal, middle, bound, first, count, tag] = v;
        list(normal, middle, bound, first, count, tag);
    }
    void value(const Patch<N>& v)
    {
        const auto& [normal, middle, bound, first, second, tag] = v;
        list(normal, middle, bound, first, second, tag);
    }

    void value(const EyeSurface<N>& v)
    {
        const auto& [tag, normal] = v;
        list(tag, normal);
    }
    void value(const Matte<N>& v)
    {
        const auto& [colour, ambient, diffuse] = v;
        list(colour, ambient, diffuse);
    }
    void value(const Highlight<N>& v)
    {
        const auto& [amount, shine] = v;
        list(amount, shine);
    }
    void value(const Mirror<N>& v)
    {
        const auto& [amount] = v;
        list(amount);
    }
    void value(const Transmit<N>& v)
    {
        const auto& [amount, inward, outward] = v;
        list(amount, inward, outward);
    }
    void value(const TextureRef& v)
    {
        const auto& [kind, index] = v;
        constexpr const char* names[] = {"none",  "checker", "stripes", "gradient", "rings",
                                         "noise", "marble",  "wood",    "brick"};
        out.print("{qray::TextureKind::%s, %u}", names[static_cast<int>(kind)], unsigned{index});
    }

    void value(const LatticeAxis<N>& v)
    {
        if constexpr (NarrowFixed<N>) {
            const auto& [x, y, z, frac, offset, whole] = v;
            list(x, y, z, frac, offset, whole);
        } else if constexpr (N::is_fixed) {
            const auto& [x, y, z, shift, offset] = v;
            list(x, y, z, shift, offset);
        } else {
            const auto& [x, y, z, inside, index, offset] = v;
            list(x, y, z, inside, index, offset);
        }
    }
    void value(const LatticeStep<N>& v)
    {
        if constexpr (NarrowFixed<N>) {
            const auto& [row, frac, offset, whole] = v;
            list(row, frac, offset, whole);
        } else if constexpr (N::is_fixed) {
            const auto& [row, shift, offset] = v;
            list(row, shift, offset);
        } else {
            const auto& [row, inside, index] = v;
            list(row, inside, index);
        }
    }
    void value(const Lattice<N>& v)
    {
        const auto& [x, y, z] = v;
        list(x, y, z);
    }
    void value(const Checker<N>& v)
    {
        const auto& [colour, lattice] = v;
        list(colour, lattice);
    }
    void value(const Stripes<N>& v)
    {
        const auto& [colour, axis] = v;
        list(colour, axis);
    }
    void value(const Gradient<N>& v)
    {
        const auto& [colour, axis] = v;
        list(colour, axis);
    }
    void value(const Rings<N>& v)
    {
        const auto& [colour, x, z] = v;
        list(colour, x, z);
    }
    void value(const Noise<N>& v)
    {
        const auto& [colour, lattice] = v;
        list(colour, lattice);
    }
    void value(const Marble<N>& v)
    {
        const auto& [colour, lattice, axis] = v;
        list(colour, lattice, axis);
    }
    void value(const Wood<N>& v)
    {
        const auto& [colour, lattice, e1, e2] = v;
        list(colour, lattice, e1, e2);
    }
    void value(const Brick<N>& v)
    {
        const auto& [colour, lattice] = v;
        list(colour, lattice);
    }

    void value(const qray::Light<N>& v)
    {
        const auto& [at, shift, colour] = v;
        list(at, shift, colour);
    }
    void value(const Sun<N>& v)
    {
        const auto& [from, colour] = v;
        list(from, colour);
    }
};

} // namespace qray::scene
