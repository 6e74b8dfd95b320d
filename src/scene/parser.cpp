// The grammar of the scene language, entity by entity, and all its checks.
#include "image.hpp"
#include "members.hpp"
#include "obj.hpp"
#include "shapes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <span>
#include <string_view>

namespace qray::scene {

namespace {

// Words that stand only inside of an entity, for the message where one stands elsewhere.
constexpr struct {
    std::string_view word;
    const char* entity;
} inner_words[] = {
    {"from", "v"},   {"at", "v"},         {"up", "v"},       {"angle", "v"},
    {"hither", "v"}, {"resolution", "v"}, {"on", "shadows"}, {"off", "shadows"},
};

// What `material` sets, by its word in quotes; colour apart.
struct MaterialWord {
    std::string_view quoted;
    double Fill::*value;
    const Range* range;
    constexpr std::string_view word() const { return quoted.substr(1, quoted.size() - 2); }
};
constexpr MaterialWord material_words[] = {
    {"'colour'", nullptr, &share_range},
    {"'ambient'", &Fill::ambient, &share_range},
    {"'diffuse'", &Fill::diffuse, &share_range},
    {"'highlight'", &Fill::highlight, &share_range},
    {"'shine'", &Fill::shine, &shine_range},
    {"'mirror'", &Fill::mirror, &share_range},
    {"'transmit'", &Fill::transmit, &share_range},
    {"'ior'", &Fill::ior, &ior_range},
    {"'emission'", &Fill::emission, &light_range},
};

constexpr struct {
    std::string_view word;
    TextureKind kind;
    TextureText text;
} texture_words[] = {
#define QRAY_WORD(Type, name, table) {#name, TextureKind::name, Type<Double>::text},
    QRAY_TEXTURES(QRAY_WORD)
#undef QRAY_WORD
};

// Whether `found` is `word` but for case and a letter or two: one too many, missing, another, or two exchanged.
bool is_near(std::string_view found, std::string_view word)
{
    constexpr size_t most = 16;
    if (found.size() > most || word.size() > most)
        return false;
    // From the first i letters of one to the first j of the other: of i - 2, i - 1 and i.
    std::array<size_t, most + 1> steps[3] = {};
    for (size_t j = 0; j <= word.size(); j++)
        steps[2][j] = j;
    const auto same = [&](size_t i, size_t j) { return (found[i] | 0x20) == (word[j] | 0x20); };
    for (size_t i = 0; i < found.size(); i++) {
        steps[0] = steps[1];
        steps[1] = steps[2];
        steps[2][0] = i + 1;
        for (size_t j = 0; j < word.size(); j++) {
            size_t least = std::min({steps[1][j + 1] + 1, steps[2][j] + 1, steps[1][j] + !same(i, j)});
            if (i > 0 && j > 0 && same(i, j - 1) && same(i - 1, j))
                least = std::min(least, steps[0][j - 1] + 1);
            steps[2][j + 1] = least;
        }
    }
    return steps[2][word.size()] <= (word.size() < 3 ? 0 : word.size() < 6 ? 1 : 2);
}

// Words for a message, and which of them is meant.
class Words {
public:
    explicit Words(std::string_view word) : found(word) {}
    void add(std::string_view word)
    {
        const int size = static_cast<int>(word.size());
        used += snprintf(text + used, sizeof text - static_cast<size_t>(used), "%s%.*s", used == 0 ? "" : " ", size,
                         word.data());
        if (meant[0] == 0 && is_near(found, word))
            snprintf(meant, sizeof meant, "did you mean '%.*s'? ", size, word.data());
    }
    char text[160] = {}, meant[40] = {};

private:
    std::string_view found;
    int used = 0;
};

class Parser : public Reader {
public:
    Parser(const char* scene, const char* from, size_t bytes, Description& into, Error& to, const Files* beside)
        : Reader(scene, from, bytes, to), text(from, bytes), out(into), files(beside)
    {
    }

    bool parse()
    {
        if (text.size() > Limits::text)
            return fail({}, "a text of %zu bytes; expected at most %u (limit 'text')", text.size(), Limits::text);
        if (const char* encoding = wide_encoding(text))
            return fail({}, "the text is in %s; expected ASCII or UTF-8", encoding);
        if (out.lay_out(text.size()) > out.room.size)
            return fail({}, "not enough memory");
        for (;;) {
            const Token before = entity;
            entity = token = lexer.next();
            if (token.kind == TokenKind::end)
                return finish();
            if (token.kind == TokenKind::number && !before.text.empty())
                return fail(token.at, "expected an entity, found '%s'; the '%s' in line %u is complete without it",
                            Shown(token.text).text, Shown(before.text).text, before.at.line);
            if (token.kind != TokenKind::word)
                return expected("", "an entity");
            if (!read_entity())
                return false;
        }
    }

private:
    const std::string_view text;
    Description& out;
    const Files* const files;
    Token entity;                            // being read
    uint32_t view_line = 0, object_line = 0; // of the view, of the first object; 0 before it
    Fill current;
    uint32_t current_index = none; // of the current fill in out.fills, once an object has used it
    static constexpr uint32_t none = UINT32_MAX;
    // A fill's number, its index + 1, stands at its hash or, where that is taken, at the next place that was free.
    uint16_t numbers[2 * Limits::materials] = {};
    bool light_is_default[Limits::lights] = {};
    char path[4096]; // of the latest file beside the scene
    std::string_view image_names[Limits::images];

    // What is no object; objects are read by their hosts.
    struct Statement {
        std::string_view word;
        bool (Parser::*read)();
    };
    static std::span<const Statement> statements()
    {
        static constexpr Statement all[] = {
            {"v", &Parser::view},
            {"b", &Parser::background},
            {"l", &Parser::lamp},
            {"f", &Parser::fill},
            {"ambientlight", &Parser::ambient_light},
            {"sun", &Parser::sun},
            {"panel", &Parser::panel},
            {"material", &Parser::material},
            {"texture", &Parser::texture},
            {"mesh", &Parser::mesh},
            {"shadows", &Parser::shadows},
            {"far", &Parser::far},
            {"radiosity", &Parser::radiosity},
        };
        return all;
    }

    // Calls f(word) for the word of every entity.
    template <class F>
    static void for_each_entity(F f)
    {
        for (const Statement& s : statements())
            f(s.word);
        for_each_host([&f](auto host, Kind) {
            for (const Entity& e : host.entities)
                f(e.word);
        });
    }

    bool read_entity()
    {
        for (const Statement& s : statements())
            if (entity.text == s.word)
                return (this->*s.read)();
        bool found = false, good = true;
        for_each_host([&](auto host, Kind kind) {
            for (uint8_t i = 0; !found && i < std::size(host.entities); i++) {
                found = entity.text == host.entities[i].word;
                if (found)
                    good = object(kind, i);
            }
        });
        return found ? good : unknown_entity();
    }

    // The file whose name follows, looked up beside the scene: its `path` and, behind what `to` holds, its `contents`,
    // until `to` grows again.
    bool file(const char* what, size_t most, Bytes& to, std::string_view& contents)
    {
        token = lexer.next();
        if (token.kind == TokenKind::end || token.kind == TokenKind::bad)
            return expected("", what);
        const std::string_view scene = token.text.starts_with('/') ? "" : scene_name();
        const size_t folder = scene.rfind('/') + 1, before = to.size; // npos + 1 is 0
        const char* wrong = files == nullptr ? "the scene has no folder" : "the name is too long";
        if (folder + token.text.size() < sizeof path) {
            snprintf(path, sizeof path, "%.*s%.*s", static_cast<int>(folder), scene.data(),
                     static_cast<int>(token.text.size()), token.text.data());
            if (files != nullptr)
                wrong = files->append(path, most, to);
        }
        if (wrong != nullptr)
            return fail(token.at, "cannot read '%s': %s; expected %s", Shown(token.text).text, wrong, what);
        if (to.size - before > most)
            return fail(token.at, "'%s' has more than %zu bytes; expected %s that is shorter",
                        Shown(token.text).text, most, what);
        contents = {reinterpret_cast<const char*>(to.room.at) + before, to.size - before};
        return true;
    }

    // The view and the lights.

    bool field(std::string_view word)
    {
        token = lexer.next();
        if (token.kind != TokenKind::end && token.text == word)
            return true;
        char what[40];
        snprintf(what, sizeof what, "the field '%.*s' of 'v'", static_cast<int>(word.size()), word.data());
        return expected("", what);
    }

    bool view()
    {
        if (view_line != 0)
            return fail(entity.at, "a second view; the first is in line %u", view_line);
        view_line = entity.at.line;
        View& v = out.view;
        if (!field("from") || !point("'from'", v.from) || !field("at") || !point("'at'", v.at))
            return false;
        const Vec3d forward = v.at - v.from;
        if (is_zero(forward))
            return fail(vector_at, "'at' is where 'from' is; expected another point");
        if (!field("up") || !direction("'up'", v.up))
            return false;
        const Vec3d side = cross(forward, v.up);
        if (dot(side, side) < 1e-18 * dot(forward, forward) * dot(v.up, v.up))
            return fail(vector_at, "'up' lies along the view from 'from' to 'at'; expected another direction");
        double hither = 0;
        return field("angle") && number("'angle'", angle_range, v.angle) && field("hither")
            && any_number("'hither'", hither) && field("resolution")
            && count("the width of 'resolution'", 1, Limits::resolution, "resolution", v.width)
            && count("the height of 'resolution'", 1, Limits::resolution, "resolution", v.height);
    }

    bool background() { return colour("the background", light_range, out.background); }
    bool ambient_light() { return colour("the ambient light", light_range, out.ambient); }
    bool far() { return number("'far'", size_range, out.far); }
    bool radiosity()
    {
        out.radiosity_at = entity.at;
        return number("'radiosity'", size_range, out.radiosity);
    }
    bool lamp()
    {
        return light([this](LightSource& l) { return point("the place of a light", l.at); });
    }
    bool sun()
    {
        return light([this](LightSource& l) {
            l.sun = true;
            return direction("the direction of a sun", l.at);
        });
    }
    bool panel()
    {
        return light([this](LightSource& l) {
            return count("the number of places of a panel", 1, Limits::places, "places", l.places)
                && point("the middle of a panel", l.at) && point("u of a panel", l.u) && point("v of a panel", l.v);
        });
    }

    template <class Read>
    bool light(Read read)
    {
        if (object_line != 0)
            return fail(entity.at,
                        "a light after the first object, which is in line %u; expected all lights before it",
                        object_line);
        if (out.light_count == Limits::lights)
            return fail(entity.at, "too many lights; expected at most %u (limit 'lights')", Limits::lights);
        LightSource& l = out.lights[out.light_count];
        l = {};
        l.line = entity.at.line;
        if (!read(l))
            return false;
        const bool has_colour = lexer.next().kind == TokenKind::number;
        lexer.unread();
        light_is_default[out.light_count++] = !has_colour;
        return !has_colour || colour("the colour of a light", light_range, l.colour);
    }

    bool shadows()
    {
        token = lexer.next();
        out.shadows = token.text == "on";
        return out.shadows || token.text == "off" || expected("", "'on' or 'off' after 'shadows'");
    }

    // What a surface looks like.

    // NFF bounds these numbers of `f` by nothing.
    bool clamped(const char* what, const Range& range, double& value)
    {
        if (!any_number(what, value))
            return false;
        value = range.meant(value);
        if (range.holds(value))
            return true;
        value = std::clamp(value, range.low, range.high);
        out.clamped.note(token.at, "%s is %s, outside of %g to %g; %g is taken", what, Shown(token.text).text,
                         range.low, range.high, value);
        return true;
    }

    bool fill()
    {
        start_fill();
        Fill& f = current;
        if (!colour("the colour of a fill", share_range, f.colour) || !clamped("Kd of a fill", share_range, f.diffuse)
            || !clamped("Ks of a fill", share_range, f.mirror) || !number("the shine of a fill", shine_range, f.shine)
            || !clamped("T of a fill", share_range, f.transmit) || !clamped("the ior of a fill", ior_range, f.ior))
            return false;
        f.ambient = f.diffuse;
        f.highlight = f.mirror;
        return true;
    }
    void start_fill()
    {
        current = {};
        current_index = none;
    }

    bool material()
    {
        start_fill();
        for (;;) {
            token = lexer.next();
            const MaterialWord* const known = std::find_if(
                std::begin(material_words), std::end(material_words),
                [this](const MaterialWord& m) { return token.text == m.word(); });
            if (known == std::end(material_words))
                break;
            const char* const what = known->quoted.data();
            if (!(known->value == nullptr ? colour(what, *known->range, current.colour)
                                          : number(what, *known->range, current.*known->value)))
                return false;
        }
        bool ends = token.kind != TokenKind::word;
        for_each_entity([&](std::string_view word) { ends = ends || token.text == word; });
        if (!ends)
            return unknown_in_material();
        lexer.unread();
        return true;
    }

    bool texture()
    {
        token = lexer.next();
        Words words(token.text);
        for (const auto& known : texture_words) {
            words.add(known.word);
            if (token.text != known.word)
                continue;
            Texture& t = current.texture;
            t = {};
            t.kind = known.kind;
            current_index = none;
            if (known.text == TextureText::image)
                return image(t.image) && point("the corner of an image", t.at)
                    && direction("u of an image", t.u) && direction("v of an image", t.v)
                    && (t.size = std::min(length(t.u), length(t.v)), true);
            if (known.text == TextureText::globe)
                return image(t.image) && point("the centre of a globe", t.at);
            return colour("the colour of a texture", share_range, t.colour)
                && number("the size of a texture", size_range, t.size)
                && (known.text == TextureText::cells || direction("the axis of a texture", t.axis));
        }
        if (token.kind == TokenKind::word && words.meant[0] != 0)
            return fail(token.at, "unknown texture '%s'; %sexpected one of %s", Shown(token.text).text, words.meant,
                        words.text);
        char what[200];
        snprintf(what, sizeof what, "a texture (%s)", words.text);
        return expected("", what);
    }

    // Once for each file, and for all that hold the same.
    bool image(uint32_t& index)
    {
        const std::string_view file_name = lexer.next().text;
        lexer.unread();
        for (index = 0; index < out.image_count; index++)
            if (image_names[index] == file_name) {
                lexer.next();
                return true;
            }
        Bytes& all = out.image_bytes;
        ImageSource& found = out.images[index];
        found.first = all.size;
        std::string_view contents;
        if (!file("an image, BMP or PPM", Limits::image_bytes, all, contents))
            return false;
        char fault[100];
        if (!decode_image(all.room.at + found.first, contents.size(), found, fault))
            return fail(token.at, "'%s' %s; expected a BMP of 24 bits a pixel or a binary PPM",
                        Shown(token.text).text, fault);
        const size_t bytes = 3 * size_t{found.width} * found.height;
        all.size = found.first + bytes;
        for (uint32_t i = 0; i < out.image_count; i++)
            if (const ImageSource& other = out.images[i];
                found.width == other.width && found.height == other.height
                && memcmp(all.room.at + found.first, all.room.at + other.first, bytes) == 0) {
                all.size = found.first;
                index = i;
                return true;
            }
        if (index == Limits::images)
            return fail(token.at, "too many images; expected at most %u (limit 'images')", Limits::images);
        if (all.size > Limits::image_bytes)
            return fail(token.at, "images of %zu bytes; expected at most %u of all (limit 'image_bytes')", all.size,
                        Limits::image_bytes);
        image_names[out.image_count++] = file_name;
        return true;
    }

    bool use_fill(uint32_t& index)
    {
        if (current_index == none) {
            uint64_t at = 0;
            add_to_hash(at, current);
            while (numbers[at %= std::size(numbers)] != 0 && out.fills[numbers[at] - 1] != current)
                at++;
            if (numbers[at] == 0) {
                if (out.fill_count == Limits::materials)
                    return fail(entity.at, "too many different fills; expected at most %u (limit 'materials')",
                                Limits::materials);
                out.fills[out.fill_count++] = current;
                numbers[at] = static_cast<uint16_t>(out.fill_count);
            }
            current_index = numbers[at] - 1u;
        }
        index = current_index;
        return true;
    }

    // The entity is an object, or several.
    bool start_object(Object& o)
    {
        if (view_line == 0)
            return fail(entity.at, "an object before the view; expected 'v' first");
        if (object_line == 0)
            object_line = entity.at.line;
        o.line = entity.at.line;
        return true;
    }

    bool object(Kind kind, uint8_t number)
    {
        Object o;
        o.kind = kind;
        o.entity = number;
        bool empty = false;
        return start_object(o)
            && with_host(kind, [&](auto host) { return host.entities[number].read(*this, out, o, empty); })
            && keep(o, empty);
    }

    bool keep(Object& o, bool empty)
    {
        if (empty) {
            out.dropped++;
            if (o.count == 0)
                out.empty.note({o.line, 0}, "a %s of radius 0, left out", name_of(o));
            return true;
        }
        if (out.object_count == Limits::objects)
            return fail(entity.at, "too many objects; expected at most %u (limit 'objects')", Limits::objects);
        if (!use_fill(o.fill))
            return false;
        out.objects[out.object_count++] = o;
        out.vertex_count = std::max(out.vertex_count, o.vertex + o.count);
        return true;
    }

    bool mesh()
    {
        Object o;
        double scale = 1;
        Vec3d offset;
        std::string_view contents;
        out.files.size = 0;
        if (!start_object(o) || !file("a Wavefront OBJ file", Limits::text, out.files, contents))
            return false;
        const Token named = token;
        const bool placed = lexer.next().kind == TokenKind::number;
        lexer.unread();
        if (placed && !(number("the scale of a mesh", size_range, scale) && point("the place of a mesh", offset)))
            return false;

        const Obj::Size size = Obj(path, contents, error).size();
        Vec3d *points = nullptr, *normals = nullptr;
        const auto lay_out = [&] {
            return lay_out_in(out.files.room, [&](Layout& layout) {
                contents = {layout.array<char>(contents.size()), contents.size()};
                points = layout.array<Vec3d>(size.points);
                normals = layout.array<Vec3d>(size.normals);
            });
        };
        const size_t left = static_cast<size_t>(text.end() - (token.text.data() + token.text.size()));
        const uint64_t objects = out.object_count + size.triangles + left / 10 + 1;
        const uint64_t vertices = out.vertex_count + 3 * size.triangles + left / 6 + 3;
        if (!files->grow(out.files.room, lay_out()) || !out.grow(objects, vertices, files->grow))
            return fail(named.at, "not enough memory for '%s'", Shown(named.text).text);
        lay_out();

        Obj obj(path, contents, error);
        const auto face = [&](uint32_t n, bool smooth) {
            o.vertex = out.vertex_count;
            if (smooth) {
                o.kind = Kind::patch;
                o.count = n;
                return keep(o, Host<Patch>::is_empty(out, o));
            }
            // Its corners, n at first, become those of triangles: from the last to the first, each
            // behind what is to come.
            o.kind = Kind::polygon;
            o.count = 3;
            Vec3d* const v = out.vertices + o.vertex;
            if (3 * uint64_t{n - 2} > Limits::vertices - o.vertex)
                return obj.too_many_vertices();
            for (uint32_t i = n - 2; i-- > 0;) {
                v[3 * i + 2] = v[i + 2];
                v[3 * i + 1] = v[i + 1];
                v[3 * i] = v[0];
            }
            for (uint32_t i = 0; i < n - 2; i++, o.vertex += 3)
                if (!keep(o, !has_area(out.vertices + o.vertex, 3, false)))
                    return false;
            return true;
        };
        if (!obj.read(out, scale, offset, points, normals, face))
            return false;
        if (obj.passed_over != 0)
            out.passed_over.note(named.at, "passed over in '%s': %u line%s, the first '%s' in line %u",
                                 Shown(named.text).text, obj.passed_over, obj.passed_over == 1 ? "" : "s",
                                 Shown(obj.first_passed.text).text, obj.first_passed.at.line);
        return true;
    }

    bool unknown_entity()
    {
        const char* home = nullptr;
        for (const auto& inner : inner_words)
            if (entity.text == inner.word)
                home = inner.entity;
        for (const MaterialWord& inner : material_words)
            if (entity.text == inner.word())
                home = "material";
        for (const auto& texture : texture_words)
            if (entity.text == texture.word)
                home = "texture";
        const Shown shown(entity.text);
        if (home != nullptr)
            return fail(entity.at, "expected an entity, found '%s', which stands in '%s'", shown.text, home);
        Words words(entity.text);
        for_each_entity([&words](std::string_view word) { words.add(word); });
        return fail(entity.at, "unknown entity '%s'; %sexpected one of %s", shown.text, words.meant, words.text);
    }

    // The latest token is neither a word of `material` nor an entity, but nearer to the first, or to none.
    bool unknown_in_material()
    {
        Words words(token.text), others(token.text);
        for (const MaterialWord& known : material_words)
            words.add(known.word());
        for_each_entity([&others](std::string_view word) { others.add(word); });
        if (words.meant[0] == 0 && others.meant[0] != 0) {
            entity = token;
            return unknown_entity();
        }
        return fail(token.at, "unknown word '%s' in 'material'; %sexpected one of %s, or an entity",
                    Shown(token.text).text, words.meant, words.text);
    }

    bool finish()
    {
        if (view_line == 0)
            return fail(token.at, "the file ends without a view; expected 'v'");
        const double white = 1 / std::sqrt(static_cast<double>(out.light_count));
        for (uint32_t i = 0; i < out.light_count; i++)
            if (light_is_default[i])
                out.lights[i].colour = {white, white, white};
        const std::string_view comment = lexer.comment();
        size_t length = std::min(comment.size(), sizeof out.comment - 1);
        if (length < comment.size()) // not in the middle of a UTF-8 sequence
            while (length > 0 && (static_cast<unsigned char>(comment[length]) & 0xc0) == 0x80)
                length--;
        std::transform(comment.begin(), comment.begin() + length, out.comment, [](char c) {
            return static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
        });
        return true;
    }
};

} // namespace

bool parse(const char* name, const char* text, size_t size, Description& out, Error& error, const Files* files)
{
    const Room room = out.room, beside = out.files.room, images = out.image_bytes.room, light = out.light_room;
    out = {};
    out.room = room;
    out.files.room = beside;
    out.image_bytes.room = images;
    out.light_room = light;
    error.text[0] = 0;
    return Parser(name, text, size, out, error, files).parse();
}

} // namespace qray::scene
