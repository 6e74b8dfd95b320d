// The builder's result as a constexpr header: a namespace with Number, effects, width, height and scene, for
// programs that include <qray/qray.hpp>. It holds what the scene calls for and nothing else.
#pragma once

#include <concepts>
#include <iterator>
#include <string_view>

#include "effect_names.hpp"
#include "members.hpp"
#include "moving.hpp"
#include "source.hpp"
#include "storage.hpp"

namespace qray::scene {

// What a compiled scene says of the columns of a table.
constexpr const char* fields_of(std::string_view table)
{
    constexpr struct {
        std::string_view table;
        const char* fields;
    } known[] = {
#define QRAY_FIELDS(Type, name, table) {#table, Host<Type>::fields},
        QRAY_SHAPES(QRAY_FIELDS)
#undef QRAY_FIELDS
        {"vertices", "corners of polygons and patches"},
        {"normals", "shading normals, as many as vertices"},
        {"mattes", "by material: colour; ambient light and emission; diffuse"},
        {"highlights", "by material: amount; shine: whole, fraction"},
        {"mirrors", "by material: amount"},
        {"transmits", "by material: amount; 1 / index of refraction, index"},
        {"textures", "by material: kind; index into the table of that kind"},
        {"texels", "bytes of images: an index a texel, with their colours behind them, or red, green, blue"},
        {"images", "coordinates along u, v; texels, their colours, width, height"},
        {"globes", "centre / 2^shift; shift; texels, their colours, width, height"},
        {"lights", "place / 2^shift; shift; colour"},
        {"panels", "corner, steps from place to place, all / 2^shift; shift; colour; places along an edge; number"},
        {"suns", "direction towards it; colour"},
        {"entries", "boxes, a tree in preorder: middle; half; link"},
        {"lights_of", "by place in the scene file: number of the outside's light map, of the inside's; "
                      "from 2^31 even lights"},
        {"even_lights", "light that is the same everywhere on a side, times diffuse; ambient light"},
        {"light_maps", "along columns, and rows: coordinate; knots, steps, nodes; what 256 stands for; "
                       "first cell, root, cut"},
        {"light_knots", "by steps along an axis: the node there, in 2^-8; roots of cuts"},
        {"light_cuts", "plane of a wall; link above, below: 2 k + 1 to cut k, 2 k + 2 to part k"},
        {"light_planes", "normal; height"},
        {"light_cells", "red, green, blue of the light at each node, times diffuse"},
        {"light_surfaces", "light, or complement of a panel; tag of the surface that it lies on; normal there; side"},
    };
    for (const auto& k : known)
        if (k.table == table)
            return k.fields;
    return "colour; coordinates";
}

// Calls f(array, type, name) for each table that a tracer for e needs of a scene, in Scene's order.
template <class N, class F>
void for_each_table(const Storage<N>& s, const Effects& e, F f)
{
#define QRAY_TABLE(Type, name, table) \
    if (e.name && s.table.count != 0) \
        f(s.table, #Type, #table);
    QRAY_TABLES(QRAY_TABLE)
#undef QRAY_TABLE
}

template <class N>
class Emitter {
public:
    // Of a scene that was built with Settings::compiled.
    Emitter(const Storage<N>& from, Source& to) : s(from), out(to), e(from.effects)
    {
        e.tree = false;
        e.flat_tree = s.entries.count != 0;
        e.moving = s.moving != 0;
    }

    // `title` may be empty; `origin` says what the header was made from; `name` is of the namespace.
    void emit(const char* title, const char* origin, const char* name)
    {
        if (*title != 0)
            out.comment(title);
        out.comment(origin);
        out.put("#pragma once\n\n#include <qray/qray.hpp>\n\n");
        out.print("namespace %s::inline h%016llx { // by its contents, so that a linker tells two scenes apart\n\n",
                  name, static_cast<unsigned long long>(digest()));
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
        out.print("using Number = qray::%s;\n", number_names_of<N>().type);
        if constexpr (N::is_fixed)
            out.print("// Lengths are in 2^-%d, unit vectors and coefficients in 2^-%d, light in 2^-%d.\n",
                      N::Length::frac, N::Unit::frac, N::Colour::frac);
        out.print("\ninline constexpr uint32_t width = %u, height = %u;\n", unsigned{s.camera.width},
                  unsigned{s.camera.height});
        effects();
        if (e.moving) {
            out.put("\n// Scene units to Number's and back.\ninline constexpr qray::Frame<Number> frame = ");
            value(s.frame);
            out.put(";\n// Of the text, in scene units: eye; where it looks; up; sine and cosine of half the field.\n"
                    "inline constexpr qray::View<Number> view = ");
            value(s.text_view);
            out.put(";\ninline constinit qray::Camera<Number> camera{\n");
            camera("    ");
            out.put("};\n");
        }
        for_each_table(s, e, [this](const auto& array, const char* type, const char* name) {
            const unsigned count = array.count;
            if (moves(name))
                out.print("\n// At first: %s\ninline constexpr qray::MovingTable<qray::%s<Number>, %u> first_%s = {{\n",
                          fields_of(name), type, count, name);
            else
                out.print("\n// %s\ninline constexpr qray::%s<Number> %s[] = {\n", fields_of(name), type, name);
            constexpr uint32_t in_line = sizeof array.data[0] <= 2 ? 24 : 1;
            for (uint32_t i = 0; i < array.count; i++) {
                out.put(i % in_line == 0 ? "    " : " ");
                value(array.data[i]);
                out.put((i + 1) % in_line == 0 || i + 1 == array.count ? ",\n" : ",");
            }
            if (moves(name))
                out.print("}};\ninline constinit qray::MovingTable<qray::%s<Number>, %u> %s = first_%s;\n", type, count,
                          name, name);
            else
                out.put("};\n");
        });
        out.put("\ninline constexpr qray::Scene<Number, effects> scene{\n");
        if (e.moving) {
            out.put("    .camera = camera,\n");
        } else {
            out.put("    .camera = {\n");
            camera("        ");
            out.put("    },\n");
        }
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
        for_each_table(s, e, [this](const auto& array, const char*, const char* name) {
            const char* const data = moves(name) ? ".data" : "";
            out.print("    .%s = {%s%s, %u},\n", name, name, data, static_cast<unsigned>(array.count));
        });
        out.put("};\n");
        if (moves("entries"))
            out.print("\n// After shapes have moved, before a picture.\ninline void refit() {%s}\n",
                      e.flat_tree ? " qray::refit(scene, entries.data); " : "");
    }

    void effects()
    {
        out.put("inline constexpr qray::Effects effects{\n");
        for (const EffectName& name : effect_names)
            if (e.*name.effect)
                out.print("    .%s = true,\n", name.name);
        out.print("    .depth = %u,\n%s", unsigned{e.depth}, e.moving ? "    .moving = true,\n" : "");
        if (e.light_bits != 8)
            out.print("    .light_bits = %u,\n", unsigned{e.light_bits});
        out.put("};\n");
    }

    bool moves(std::string_view table) const
    {
        for (uint32_t i = 0; i < std::size(table_names); i++)
            if (table == table_names[i])
                return (s.moving >> i & 1) != 0;
        return false;
    }

    void camera(const char* indent)
    {
        const auto& [eye, centre, right, down, width, height, grid] = s.camera;
        const auto field = [this, indent](const char* name, const auto& v) {
            out.print("%s.%s = ", indent, name);
            value(v);
            out.put(",\n");
        };
        field("eye", eye);
        field("centre", centre);
        field("right", right);
        field("down", down);
        out.print("%s.width = width,\n%s.height = height,\n", indent, indent);
        field("grid", grid);
    }

    template <class T>
    void member(const char* name, const T& v)
    {
        out.print("    .%s = ", name);
        value(v);
        out.put(",\n");
    }

    // A braced list, all braces written.
    template <class... Members>
    void list(const Members&... members)
    {
        [[maybe_unused]] const char* before = "{";
        ((out.put(before), before = ", ", value(members)), ...);
        out.put(sizeof...(members) == 0 ? "{}" : "}");
    }

    void value(std::integral auto v) { out.number(int64_t{v}); }
    void value(const uint8_t* v)
    {
        if (v == nullptr)
            out.put("nullptr");
        else
            out.print("texels + %u", static_cast<unsigned>(v - s.texels.data));
    }
    void value(bool v) { out.put(v ? "true" : "false"); }
    void value(float v) { out.number(v); }
    void value(double v) { out.number(v); }
    void value(Tag v)
    {
        out.print("make_tag(%u, %u)", static_cast<unsigned>(v.place()), static_cast<unsigned>(v.material()));
    }
    template <class T>
    void value(const Vec<T>& v) { list(v.x, v.y, v.z); }
    void value(const Pencil<N>& v) { list(v.x, v.y, v.z); }
    void value(TextureKind v)
    {
#define QRAY_NAME(Type, name, table) , "qray::TextureKind::" #name
        constexpr const char* names[] = {"qray::TextureKind::none" QRAY_TEXTURES(QRAY_NAME)};
#undef QRAY_NAME
        out.put(names[static_cast<int>(v)]);
    }
    template <class T>
        requires std::is_aggregate_v<T>
    void value(const T& v)
    {
        with_members(v, [this](const auto&... members) { this->list(members...); });
    }
};

} // namespace qray::scene
