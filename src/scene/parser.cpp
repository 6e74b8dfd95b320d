// The grammar of the scene language, entity by entity, and all its checks.
#include "geometry.hpp"
#include "shapes.hpp"

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
#define QRAY_WORD(Type, name, table) {#name, TextureKind::name, Type<Double>::has_axis},
constexpr TextureWord texture_words[] = {QRAY_TEXTURES(QRAY_WORD)};
#undef QRAY_WORD

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

class Parser : public Reader {
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
    bool object(Kind kind, uint8_t entity);
    bool finish();

    bool expect_field(std::string_view word);
    bool use_fill(uint32_t& index);

    bool clamped(const char* what, const Range& range, double& value);
    bool unknown_entity();
    bool unknown_in_material();
    void keep_comment();

    // What is no object; objects are read by their hosts.
    struct Statement {
        std::string_view word;
        bool (Parser::*read)();
    };
    static const Statement statements[];
    template <class F> static void for_each_entity(F f);
    static bool is_entity(std::string_view word);
    bool entity();

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
    token = lexer_.next();
    if (token.kind != TokenKind::end && token.text == word) return true;
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
    if (is_zero(forward)) return fail(vector_at, "'at' is where 'from' is; expected another point");
    if (!expect_field("up") || !direction("'up'", view.up)) return false;
    const Vec3d side = cross(forward, view.up);
    if (dot(side, side) < 1e-18 * dot(forward, forward) * dot(view.up, view.up)) {
        return fail(vector_at, "'up' lies along the view from 'from' to 'at'; expected another direction");
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
    LightSource light;
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
        fail(token.at, "warning: %s is %s, outside of %g to %g; %g is taken", what, Shown(token.text).text, range.low,
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
        token = lexer_.next();
        const MaterialWord* const end = std::end(material_words);
        const MaterialWord* const known = std::find_if(
            material_words, end, [this](const MaterialWord& m) { return token.text == m.word(); });
        if (known == end) {
            if (token.kind == TokenKind::word && !is_entity(token.text)) return unknown_in_material();
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
    token = lexer_.next();
    if (token.text == "image" || token.text == "globe") {
        return fail(token.at, "the image textures 'image' and 'globe' are not supported yet");
    }
    for (const TextureWord& known : texture_words) {
        if (token.text != known.word) continue;
        Texture texture;
        texture.kind = known.kind;
        if (!colour("the colour of a texture", share_range, texture.colour)) return false;
        if (!number("the size of a texture", size_range, texture.size)) return false;
        if (known.has_axis && !direction("the axis of a texture", texture.axis)) return false;
        fill_.texture = texture;
        fill_index_ = none;
        return true;
    }
    Words words(token.text);
    for (const TextureWord& known : texture_words) words.add(known.word);
    if (token.kind == TokenKind::word && words.meant[0] != 0) {
        return fail(token.at, "unknown texture '%s'; %sexpected one of %s", Shown(token.text).text, words.meant,
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

bool Parser::object(Kind kind, uint8_t number) {
    if (view_line_ == 0) return fail(entity_.at, "an object before the view; expected 'v' first");
    if (object_line_ == 0) object_line_ = entity_.at.line;
    Object object;
    object.kind = kind;
    object.entity = number;
    object.line = entity_.at.line;
    bool empty = false;
    if (!with_host(kind, [&](auto host) { return host.entities[number].read(*this, out_, object, empty); })) return false;
    if (empty) {
        out_.dropped++;
        if (object.count == 0) out_.empty.note(object.line, "a %s of radius 0, left out", name_of(object));
        return true;
    }
    if (out_.object_count == Limits::objects) {
        return fail(entity_.at, "too many objects; expected at most %u (limit 'objects')", Limits::objects);
    }
    if (!use_fill(object.fill)) return false;
    out_.objects[out_.object_count++] = object;
    out_.vertex_count += object.count;
    return true;
}

// The whole.

bool Parser::shadows() {
    token = lexer_.next();
    if (token.text != "on" && token.text != "off") return expected("", "'on' or 'off' after 'shadows'");
    out_.shadows = token.text == "on";
    return true;
}

const Parser::Statement Parser::statements[] = {
    {"v", &Parser::view},
    {"b", &Parser::background},
    {"l", &Parser::lamp},
    {"f", &Parser::fill},
    {"ambientlight", &Parser::ambient_light},
    {"sun", &Parser::sun},
    {"material", &Parser::material},
    {"texture", &Parser::texture},
    {"shadows", &Parser::shadows},
    {"far", &Parser::far},
};

// Calls f(word) for the word of every entity.
template <class F>
void Parser::for_each_entity(F f) {
    for (const Statement& s : statements) f(s.word);
    for_each_host([&f](auto host, Kind) {
        for (const Entity& e : host.entities) f(e.word);
    });
}

bool Parser::is_entity(std::string_view word) {
    bool found = false;
    for_each_entity([&](std::string_view known) { found = found || word == known; });
    return found;
}

bool Parser::entity() {
    for (const Statement& s : statements) {
        if (entity_.text == s.word) return (this->*s.read)();
    }
    bool found = false, good = true;
    for_each_host([&](auto host, Kind kind) {
        for (uint8_t i = 0; !found && i < std::size(host.entities); i++) {
            found = entity_.text == host.entities[i].word;
            if (found) good = object(kind, i);
        }
    });
    return found ? good : unknown_entity();
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
    for_each_entity([&words](std::string_view word) { words.add(word); });
    return fail(entity_.at, "unknown entity '%s'; %sexpected one of %s", shown.text, words.meant, words.text);
}

// The latest token is neither a word of `material` nor an entity, but nearer to the first, or to none.
bool Parser::unknown_in_material() {
    Words words(token.text), others(token.text);
    for (const MaterialWord& known : material_words) words.add(known.word());
    for_each_entity([&others](std::string_view word) { others.add(word); });
    if (words.meant[0] == 0 && others.meant[0] != 0) {
        entity_ = token;
        return unknown_entity();
    }
    return fail(token.at, "unknown word '%s' in 'material'; %sexpected one of %s, or an entity",
                Shown(token.text).text, words.meant, words.text);
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
    if (view_line_ == 0) return fail(token.at, "the file ends without a view; expected 'v'");
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
        entity_ = token = lexer_.next();
        switch (token.kind) {
        case TokenKind::end:
            return finish();
        case TokenKind::bad:
            return bad_byte();
        case TokenKind::number:
            if (before.text.empty()) return expected("", "an entity");
            return fail(token.at,
                        "expected an entity, found '%s'; the '%s' in line %u is complete without it",
                        Shown(token.text).text, Shown(before.text).text, before.at.line);
        case TokenKind::word:
            if (!entity()) return false;
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
    out.empty.clear();
    out.nonplanar.clear();
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
