// The grammar of the scene language, entity by entity, and all its checks.
#include "geometry.hpp"
#include "reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <string_view>

namespace qray::scene {

namespace {

// Words that stand only inside of an entity, for the message where one stands elsewhere.
struct InnerWord {
    std::string_view word;
    const char* entity;
};
constexpr InnerWord inner_words[] = {
    {"from", "v"},   {"at", "v"},         {"up", "v"},      {"angle", "v"},
    {"hither", "v"}, {"resolution", "v"}, {"on", "shadows"}, {"off", "shadows"},
};

// What `material` sets, by its word in quotes; colour apart.
struct MaterialWord {
    const char* quoted;
    double Fill::*value;
    const Range* range;
    constexpr std::string_view word() const {
        const std::string_view text(quoted);
        return text.substr(1, text.size() - 2);
    }
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
};

struct TextureWord {
    std::string_view word;
    TextureKind kind;
    bool has_axis;
};
constexpr TextureWord texture_words[] = {
    {"checker", TextureKind::checker, false},  {"stripes", TextureKind::stripes, true},
    {"gradient", TextureKind::gradient, true}, {"rings", TextureKind::rings, false},
    {"noise", TextureKind::noise, false},      {"marble", TextureKind::marble, true},
    {"wood", TextureKind::wood, true},         {"brick", TextureKind::brick, false},
};

// Whether `found` is `word` but for case and a letter or two: one too many, missing, another, or two exchanged.
bool is_near(std::string_view found, std::string_view word) {
    constexpr size_t most = 16;
    if (found.size() > most || word.size() > most) return false;
    // From the first i letters of one to the first j of the other: of i - 2, i - 1 and i.
    std::array<size_t, most + 1> steps[3] = {};
    for (size_t j = 0; j <= word.size(); ++j) steps[2][j] = j;
    const auto same = [&](size_t i, size_t j) { return (found[i] | 0x20) == (word[j] | 0x20); };
    for (size_t i = 0; i < found.size(); ++i) {
        steps[0] = steps[1];
        steps[1] = steps[2];
        steps[2][0] = i + 1;
        for (size_t j = 0; j < word.size(); ++j) {
            size_t least = std::min({steps[1][j + 1] + 1, steps[2][j] + 1, steps[1][j] + !same(i, j)});
            if (i > 0 && j > 0 && same(i, j - 1) && same(i - 1, j)) least = std::min(least, steps[0][j - 1] + 1);
            steps[2][j + 1] = least;
        }
    }
    return steps[2][word.size()] <= (word.size() < 3 ? 0 : word.size() < 6 ? 1 : 2);
}

// Words for a message, and which of them is meant.
class Words {
public:
    explicit Words(std::string_view found) : found_(found) {}
    void add(std::string_view word) {
        used_ += snprintf(text + used_, sizeof text - static_cast<size_t>(used_), "%s%.*s", used_ == 0 ? "" : " ",
                          static_cast<int>(word.size()), word.data());
        if (meant[0] == 0 && is_near(found_, word)) {
            snprintf(meant, sizeof meant, "did you mean '%.*s'? ", static_cast<int>(word.size()), word.data());
        }
    }
    char text[160] = {}, meant[40] = {};

private:
    std::string_view found_;
    int used_ = 0;
};

// Whether n >= 3 corners enclose something. What rounding each coordinate to a double could make of an area
// of 0 (up to 2^-50 times the largest coordinate times the extent, in each product) is none.
bool has_area(const Vec3d* corners, uint32_t n, bool fan) {
    double coordinate = largest(corners[0]), extent = 0;
    for (uint32_t i = 1; i < n; ++i) {
        coordinate = std::max(coordinate, largest(corners[i]));
        extent = std::max(extent, largest(corners[i] - corners[0]));
    }
    if (extent < smallest_length) return false;
    const double noise = 0x1p-50 * extent * coordinate;
    Vec3d sum;
    for (uint32_t i = 1; i + 1 < n; ++i) {
        const Vec3d area = cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
        // A polygon whose lobes cancel in the sum still has the plane of its first corner, and is drawn.
        if ((fan || i == 1) && largest(area) > noise) return true;
        sum = sum + area;
    }
    return !fan && largest(sum) > noise;
}

uint64_t hash_of(const Fill& fill) {
    const Texture& texture = fill.texture;
    const double values[] = {
        fill.colour.x,    fill.colour.y, fill.colour.z,  fill.ambient,   fill.diffuse,     fill.highlight,
        fill.shine,       fill.mirror,   fill.transmit,  fill.ior,       texture.colour.x, texture.colour.y,
        texture.colour.z, texture.size,  texture.axis.x, texture.axis.y, texture.axis.z,
    };
    uint64_t hash = static_cast<uint64_t>(texture.kind);
    for (const double value : values) {
        hash = (hash ^ std::bit_cast<uint64_t>(value)) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    }
    return hash;
}

class Parser : private Reader {
public:
    Parser(const char* name, const char* text, size_t size, Description& out, Error& error)
        : Reader(name, text, size, error), text_(text), size_(size), out_(out) {}

    bool parse();

private:
    bool view();
    bool background() { return colour("the background", light_range, out_.background); }
    bool ambient_light() { return colour("the ambient light", light_range, out_.ambient); }
    bool far() { return number("'far'", size_range, out_.far); }
    bool lamp() { return light(false); }
    bool sun() { return light(true); }
    bool light(bool sun);
    bool fill();
    bool material();
    bool texture();
    bool shadows();
    bool sphere();
    bool cone();
    bool polygon() { return corners(Shape::polygon); }
    bool patch() { return corners(Shape::patch); }
    bool corners(Shape shape);
    bool plane();
    bool disc();
    bool finish();

    bool expect_field(std::string_view word);
    bool begin_object();
    bool add(Object object);
    bool drop(uint32_t pieces = 1) {
        if (out_.dropped == 0 && pieces != 0) out_.dropped_line = entity_.at.line;
        out_.dropped += pieces;
        return true;
    }
    void warn_of_nonplanar(const Vec3d* corners, uint32_t n);
    bool use_fill(uint32_t& index);

    bool clamped(const char* what, const Range& range, double& value);
    bool unknown_entity();
    bool unknown_in_material();
    void keep_comment();

    struct Entity {
        std::string_view word;
        bool (Parser::*read)();
    };
    static const Entity entities[];
    static const Entity* entity_of(std::string_view word);

    static constexpr uint32_t none = UINT32_MAX;
    static constexpr uint32_t chains = 512;
    static_assert(Limits::materials < UINT16_MAX);

    const char* text_;
    size_t size_;
    Description& out_;
    Token entity_;                             // the entity being read
    uint32_t view_line_ = 0, object_line_ = 0; // of the view, of the first object; 0 before it
    Fill fill_;
    uint32_t fill_index_ = none; // of fill_ in out_.fills, once an object has used it
    // The fills by their hash, in chains: a fill's number is its index + 1, and 0 ends a chain.
    uint16_t first_in_chain_[chains] = {};
    uint16_t next_in_chain_[Limits::materials]; // by index
    bool light_is_default_[Limits::lights] = {};
};

// The view and the lights.

bool Parser::expect_field(std::string_view word) {
    token_ = lexer_.next();
    if (token_.kind != TokenKind::end && token_.text == word) return true;
    char what[40];
    snprintf(what, sizeof what, "the field '%.*s' of 'v'", static_cast<int>(word.size()), word.data());
    return expected("", what);
}

bool Parser::view() {
    if (view_line_ != 0) return fail(entity_.at, "a second view; the first is in line %u", view_line_);
    view_line_ = entity_.at.line;
    View& view = out_.view;
    double hither = 0;
    if (!expect_field("from") || !point("'from'", view.from)) return false;
    if (!expect_field("at") || !point("'at'", view.at)) return false;
    const Vec3d forward = view.at - view.from;
    if (is_zero(forward)) return fail(vector_at_, "'at' is where 'from' is; expected another point");
    if (!expect_field("up") || !direction("'up'", view.up)) return false;
    const Vec3d side = cross(forward, view.up);
    if (dot(side, side) < 1e-18 * dot(forward, forward) * dot(view.up, view.up)) {
        return fail(vector_at_, "'up' lies along the view from 'from' to 'at'; expected another direction");
    }
    if (!expect_field("angle") || !number("'angle'", angle_range, view.angle)) return false;
    if (!expect_field("hither") || !any_number("'hither'", "", hither)) return false;
    return expect_field("resolution") &&
           count("the width of 'resolution'", 1, Limits::resolution, "resolution", view.width) &&
           count("the height of 'resolution'", 1, Limits::resolution, "resolution", view.height);
}

bool Parser::light(bool sun) {
    if (object_line_ != 0) {
        return fail(entity_.at,
                    "a light after the first object, which is in line %u; expected all lights before it",
                    object_line_);
    }
    if (out_.light_count == Limits::lights) {
        return fail(entity_.at, "too many lights; expected at most %u (limit 'lights')", Limits::lights);
    }
    Light light;
    light.sun = sun;
    bool ok = sun ? direction("the direction of a sun", light.at) : point("the place of a light", light.at);
    if (!ok) return false;
    const bool has_colour = lexer_.next().kind == TokenKind::number;
    lexer_.unread();
    light_is_default_[out_.light_count] = !has_colour;
    if (has_colour) ok = colour("the colour of a light", light_range, light.colour);
    if (!ok) return false;
    out_.lights[out_.light_count++] = light;
    return true;
}

// What a surface looks like.

// NFF bounds these numbers of `f` by nothing.
bool Parser::clamped(const char* what, const Range& range, double& value) {
    if (!any_number(what, "", value)) return false;
    if (&range == &ior_range && value <= 0) value = 1;
    const double nearest = std::clamp(value, range.low, range.high);
    if (value != nearest && out_.clamped++ == 0) {
        fail(token_.at, "warning: %s is %s, outside of %g to %g; %g is taken", what, Shown(token_.text).text, range.low,
             range.high, nearest);
        std::swap(error_, out_.first_clamped);
    }
    value = nearest;
    return true;
}

bool Parser::fill() {
    Fill fill;
    double kd = 0, ks = 0;
    if (!colour("the colour of a fill", share_range, fill.colour) || !clamped("Kd of a fill", share_range, kd) ||
        !clamped("Ks of a fill", share_range, ks) || !number("the shine of a fill", shine_range, fill.shine) ||
        !clamped("T of a fill", share_range, fill.transmit) ||
        !clamped("the ior of a fill", ior_range, fill.ior)) {
        return false;
    }
    fill.ambient = fill.diffuse = kd;
    fill.highlight = fill.mirror = ks;
    fill_ = fill;
    fill_index_ = none;
    return true;
}

bool Parser::material() {
    fill_ = Fill{};
    fill_index_ = none;
    for (;;) {
        token_ = lexer_.next();
        const MaterialWord* const end = std::end(material_words);
        const MaterialWord* const known = std::find_if(
            material_words, end, [this](const MaterialWord& m) { return token_.text == m.word(); });
        if (known == end) {
            if (token_.kind == TokenKind::word && entity_of(token_.text) == nullptr) return unknown_in_material();
            lexer_.unread();
            return true;
        }
        if (known->value == nullptr) {
            if (!colour(known->quoted, *known->range, fill_.colour)) return false;
        } else if (known->range == &ior_range) {
            if (!ior(known->quoted, fill_.ior)) return false;
        } else if (!number(known->quoted, *known->range, fill_.*known->value)) {
            return false;
        }
    }
}

bool Parser::texture() {
    token_ = lexer_.next();
    if (token_.text == "image" || token_.text == "globe") {
        return fail(token_.at, "the image textures 'image' and 'globe' are not supported yet");
    }
    for (const TextureWord& known : texture_words) {
        if (token_.text != known.word) continue;
        Texture texture;
        texture.kind = known.kind;
        if (!colour("the colour of a texture", share_range, texture.colour)) return false;
        if (!number("the size of a texture", size_range, texture.size)) return false;
        if (known.has_axis && !direction("the axis of a texture", texture.axis)) return false;
        fill_.texture = texture;
        fill_index_ = none;
        return true;
    }
    Words words(token_.text);
    for (const TextureWord& known : texture_words) words.add(known.word);
    if (token_.kind == TokenKind::word && words.meant[0] != 0) {
        return fail(token_.at, "unknown texture '%s'; %sexpected one of %s", Shown(token_.text).text, words.meant,
                    words.text);
    }
    char what[200];
    snprintf(what, sizeof what, "a texture (%s)", words.text);
    return expected("", what);
}

bool Parser::use_fill(uint32_t& index) {
    if (fill_index_ == none) {
        uint16_t& first = first_in_chain_[hash_of(fill_) % chains];
        uint32_t number = first;
        while (number != 0 && out_.fills[number - 1] != fill_) number = next_in_chain_[number - 1];
        if (number == 0) {
            if (out_.fill_count == Limits::materials) {
                return fail(entity_.at, "too many different fills; expected at most %u (limit 'materials')",
                            Limits::materials);
            }
            next_in_chain_[out_.fill_count] = first;
            out_.fills[out_.fill_count++] = fill_;
            number = first = static_cast<uint16_t>(out_.fill_count);
        }
        fill_index_ = number - 1;
    }
    index = fill_index_;
    return true;
}

// Objects.

bool Parser::begin_object() {
    if (view_line_ == 0) return fail(entity_.at, "an object before the view; expected 'v' first");
    if (object_line_ == 0) object_line_ = entity_.at.line;
    return true;
}

bool Parser::add(Object object) {
    if (out_.object_count == Limits::objects) {
        return fail(entity_.at, "too many objects; expected at most %u (limit 'objects')", Limits::objects);
    }
    if (!use_fill(object.fill)) return false;
    object.line = entity_.at.line;
    out_.objects[out_.object_count++] = object;
    return true;
}

bool Parser::sphere() {
    Object object;
    object.shape = Shape::sphere;
    if (!begin_object() || !point("the centre of a sphere", object.a) ||
        !radius("the radius of a sphere", object.ra)) {
        return false;
    }
    return object.ra == 0 ? drop() : add(object);
}

bool Parser::cone() {
    Object object;
    object.shape = Shape::cone;
    if (!begin_object() || !point("the base of a cone", object.a) ||
        !radius("the base radius of a cone", object.ra) || !point("the apex of a cone", object.b)) {
        return false;
    }
    if (is_zero(object.b - object.a)) {
        return fail(vector_at_, "the apex of a cone is where its base is; expected an axis that is not zero");
    }
    if (!radius("the apex radius of a cone", object.rb)) return false;
    return object.ra == 0 && object.rb == 0 ? drop() : add(object);
}

// What is drawn lies in the plane of the first corners.
void Parser::warn_of_nonplanar(const Vec3d* corners, uint32_t n) {
    if (n == 3) return;
    const Vec3d normal = unit(across(corners, n));
    Box box;
    double off = 0;
    for (uint32_t i = 0; i < n; ++i) {
        box.add(corners[i]);
        off = std::max(off, std::fabs(dot(corners[i] - corners[0], normal)));
    }
    const double size = length(box.high - box.low);
    if (off > 0.01 * size) {
        out_.nonplanar.note(entity_.at.line, "a polygon with a corner %.3g off its plane, %.3g %% of its size",
                            off, 100 * off / size);
    }
}

bool Parser::corners(Shape shape) {
    const bool patch = shape == Shape::patch;
    Object object;
    object.shape = shape;
    object.vertex = out_.vertex_count;
    if (!begin_object() ||
        !count(patch ? "the number of vertices of a patch" : "the number of vertices of a polygon", 3,
               UINT32_MAX, "", object.count)) {
        return false;
    }
    if (object.count > Limits::vertices - out_.vertex_count) {
        return fail(token_.at,
                    "%s vertices are too many after the %u so far; expected at most %u (limit 'vertices')",
                    Shown(token_.text).text, out_.vertex_count, Limits::vertices);
    }
    const char* vertex = patch ? "a vertex of a patch" : "a vertex of a polygon";
    for (uint32_t i = object.vertex; i != object.vertex + object.count; ++i) {
        if (!point(vertex, out_.vertices[i])) return false;
        if (patch && !direction("a normal of a patch", out_.normals[i])) return false;
    }
    if (!has_area(out_.vertices + object.vertex, object.count, patch)) return drop();
    if (!add(object)) return false;
    const Vec3d* v = out_.vertices + object.vertex;
    if (patch)
        for (uint32_t i = 1; i + 1 < object.count; ++i)
            drop(largest(triangle_area(v[0], v[i], v[i + 1])) == 0);
    else
        warn_of_nonplanar(v, object.count);
    out_.vertex_count += object.count;
    return true;
}

bool Parser::plane() {
    Object object;
    object.shape = Shape::plane;
    return begin_object() && point("the point of a plane", object.a) &&
           direction("the normal of a plane", object.b) && add(object);
}

bool Parser::disc() {
    Object object;
    object.shape = Shape::disc;
    if (!begin_object() || !point("the centre of a disc", object.a) ||
        !direction("the normal of a disc", object.b) || !radius("the radius of a disc", object.ra)) {
        return false;
    }
    return object.ra == 0 ? drop() : add(object);
}

// The whole.

bool Parser::shadows() {
    token_ = lexer_.next();
    if (token_.text != "on" && token_.text != "off") return expected("", "'on' or 'off' after 'shadows'");
    out_.shadows = token_.text == "on";
    return true;
}

const Parser::Entity Parser::entities[] = {
    {"v", &Parser::view},
    {"b", &Parser::background},
    {"l", &Parser::lamp},
    {"f", &Parser::fill},
    {"s", &Parser::sphere},
    {"c", &Parser::cone},
    {"p", &Parser::polygon},
    {"pp", &Parser::patch},
    {"ambientlight", &Parser::ambient_light},
    {"sun", &Parser::sun},
    {"material", &Parser::material},
    {"plane", &Parser::plane},
    {"disc", &Parser::disc},
    {"texture", &Parser::texture},
    {"shadows", &Parser::shadows},
    {"far", &Parser::far},
};

const Parser::Entity* Parser::entity_of(std::string_view word) {
    for (const Entity& e : entities) {
        if (e.word[0] == word[0] && e.word == word) return &e;
    }
    return nullptr;
}

bool Parser::unknown_entity() {
    const Shown shown(entity_.text);
    const char* home = nullptr;
    for (const InnerWord& inner : inner_words) {
        if (entity_.text == inner.word) home = inner.entity;
    }
    for (const MaterialWord& inner : material_words) {
        if (entity_.text == inner.word()) home = "material";
    }
    for (const TextureWord& texture : texture_words) {
        if (entity_.text == texture.word) home = "texture";
    }
    if (home != nullptr) {
        return fail(entity_.at, "expected an entity, found '%s', which stands in '%s'", shown.text, home);
    }
    Words words(entity_.text);
    for (const Entity& e : entities) words.add(e.word);
    return fail(entity_.at, "unknown entity '%s'; %sexpected one of %s", shown.text, words.meant, words.text);
}

// The latest token is neither a word of `material` nor an entity, but nearer to the first, or to none.
bool Parser::unknown_in_material() {
    Words words(token_.text), others(token_.text);
    for (const MaterialWord& known : material_words) words.add(known.word());
    for (const Entity& e : entities) others.add(e.word);
    if (words.meant[0] == 0 && others.meant[0] != 0) {
        entity_ = token_;
        return unknown_entity();
    }
    return fail(token_.at, "unknown word '%s' in 'material'; %sexpected one of %s, or an entity",
                Shown(token_.text).text, words.meant, words.text);
}

void Parser::keep_comment() {
    const std::string_view comment = lexer_.comment();
    size_t length = comment.size();
    if (length >= sizeof out_.comment) {
        length = sizeof out_.comment - 1;
        // Not in the middle of a UTF-8 sequence.
        while (length > 0 && (static_cast<unsigned char>(comment[length]) & 0xc0) == 0x80) --length;
    }
    for (size_t i = 0; i < length; ++i) {
        const unsigned char c = static_cast<unsigned char>(comment[i]);
        out_.comment[i] = c < 0x20 || c == 0x7f ? ' ' : comment[i];
    }
    out_.comment[length] = 0;
}

bool Parser::finish() {
    if (view_line_ == 0) return fail(token_.at, "the file ends without a view; expected 'v'");
    if (out_.light_count != 0) {
        const double white = 1 / std::sqrt(static_cast<double>(out_.light_count));
        for (uint32_t i = 0; i < out_.light_count; ++i) {
            if (light_is_default_[i]) out_.lights[i].colour = {white, white, white};
        }
    }
    keep_comment();
    return true;
}

bool Parser::parse() {
    if (size_ > Limits::text) {
        return fail({}, "a text of %zu bytes; expected at most %u (limit 'text')", size_, Limits::text);
    }
    if (const char* encoding = wide_encoding({text_, size_})) {
        return fail({}, "the text is in %s; expected ASCII or UTF-8", encoding);
    }
    if (out_.lay_out(size_) > out_.room.size) return fail({}, "not enough memory");
    for (;;) {
        const Token before = entity_;
        entity_ = token_ = lexer_.next();
        switch (token_.kind) {
        case TokenKind::end:
            return finish();
        case TokenKind::bad:
            return bad_byte();
        case TokenKind::number:
            if (before.text.empty()) return expected("", "an entity");
            return fail(token_.at,
                        "expected an entity, found '%s'; the '%s' in line %u is complete without it",
                        Shown(token_.text).text, Shown(before.text).text, before.at.line);
        case TokenKind::word:
            if (const Entity* known = entity_of(entity_.text)) {
                if (!(this->*known->read)()) return false;
            } else {
                return unknown_entity();
            }
            break;
        }
    }
}

void reset(Description& out) {
    out.view = View{};
    out.background = Vec3d{};
    out.ambient = Vec3d{0.2, 0.2, 0.2};
    out.shadows = true;
    out.far = 0;
    out.object_count = out.vertex_count = out.fill_count = out.light_count = 0;
    out.dropped = out.clamped = 0;
    out.first_clamped.text[0] = 0;
    out.comment[0] = 0;
}

} // namespace

bool parse(const char* name, const char* text, size_t size, Description& out, Error& error) {
    reset(out);
    error.text[0] = 0;
    return Parser(name, text, size, out, error).parse();
}

} // namespace qray::scene
