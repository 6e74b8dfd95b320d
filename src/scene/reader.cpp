#include "reader.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace qray::scene {

namespace {

// Appends `text` with its control bytes as \x1b, as far as there is room.
void append(char*& to, const char* end, const char* text) {
    for (; *text != 0 && to < end; ++text) {
        const unsigned char c = static_cast<unsigned char>(*text);
        if (c >= 0x20 && c != 0x7f) {
            *to++ = *text;
        } else if (end - to >= 4) {
            const char* hex = "0123456789abcdef";
            *to++ = '\\';
            *to++ = 'x';
            *to++ = hex[c >> 4];
            *to++ = hex[c & 15];
        } else {
            break;
        }
    }
}

} // namespace

Shown::Shown(std::string_view token) {
    constexpr size_t longest = sizeof text - 1;
    const bool cut = token.size() > longest;
    const size_t kept = cut ? longest - 3 : token.size();
    memcpy(text, token.data(), kept);
    memcpy(text + kept, cut ? "..." : "", cut ? 4 : 1);
}

ShownName::ShownName(const char* name) {
    constexpr size_t longest = sizeof text / 2;
    const size_t length = strlen(name);
    const bool cut = length > longest;
    const char* from = cut ? name + length - longest : name;
    char* to = text;
    if (cut) {
        append(to, text + sizeof text - 1, "...");
        while ((static_cast<unsigned char>(*from) & 0xc0) == 0x80) ++from; // the rest of a UTF-8 sequence
    }
    append(to, text + sizeof text - 1, from);
    *to = 0;
}

bool Reader::fail(Position at, const char* format, ...) {
    const ShownName name(name_);
    const int head = snprintf(error_.text, sizeof error_.text, "%s:%u:%u: ", name.text, at.line, at.column);
    va_list values;
    va_start(values, format);
    vsnprintf(error_.text + head, sizeof error_.text - static_cast<size_t>(head), format, values);
    va_end(values);
    return false;
}

bool Reader::bad_byte() {
    return fail(token.at,
                "found the byte 0x%02x; outside of comments a scene is printable ASCII and white space",
                static_cast<unsigned>(static_cast<unsigned char>(token.text[0])));
}

bool Reader::expected(const char* part, const char* what) {
    switch (token.kind) {
    case TokenKind::bad:
        return bad_byte();
    case TokenKind::end:
        return fail(token.at, "the file ends where %s%s was expected", part, what);
    case TokenKind::word:
    case TokenKind::number:
        break;
    }
    return fail(token.at, "expected %s%s, found '%s'", part, what, Shown(token.text).text);
}

bool Reader::not_a_number(const char* part, const char* what, NumberError error) {
    const char* why = "";
    switch (error) {
    case NumberError::none:
        return false;
    case NumberError::malformed:
        why = token.kind == TokenKind::word ? "not a number" : "not a number in plain decimal or e-notation";
        break;
    case NumberError::not_finite:
        why = "not a finite number";
        break;
    case NumberError::too_large:
        why = "too large for a number";
        break;
    case NumberError::not_whole:
        why = "not a whole number";
        break;
    case NumberError::negative:
        why = "negative";
        break;
    }
    return fail(token.at, "expected %s%s, found '%s', which is %s", part, what, Shown(token.text).text, why);
}

bool Reader::any_number(const char* what, const char* part, double& value) {
    token = lexer_.next();
    if (token.kind == TokenKind::end || token.kind == TokenKind::bad) return expected(part, what);
    const NumberError error = read_number(token.text, value);
    return error == NumberError::none || not_a_number(part, what, error);
}

bool Reader::number(const char* what, const char* part, const Range& range, double& value) {
    if (!any_number(what, part, value)) return false;
    if (value >= range.low && value <= range.high) return true;
    return fail(token.at, "%s%s is %s; expected %s", part, what, Shown(token.text).text, range.text);
}

bool Reader::ior(const char* what, double& value) {
    if (!any_number(what, "", value)) return false;
    if (value <= 0) value = 1;
    if (value >= ior_range.low && value <= ior_range.high) return true;
    return fail(token.at, "%s is %s; expected %s", what, Shown(token.text).text, ior_range.text);
}

bool Reader::count(const char* what, uint32_t low, uint32_t high, const char* limit, uint32_t& value) {
    token = lexer_.next();
    if (token.kind == TokenKind::end || token.kind == TokenKind::bad) return expected("", what);
    const NumberError error = read_count(token.text, value);
    if (error != NumberError::none) return not_a_number("", what, error);
    const Shown shown(token.text);
    if (value < low) return fail(token.at, "%s is %s; expected at least %u", what, shown.text, low);
    if (value > high) {
        return fail(token.at, "%s is %s; expected at most %u (limit '%s')", what, shown.text, high, limit);
    }
    return true;
}

bool Reader::radius(const char* what, double& value) {
    if (!number(what, length_range, value)) return false;
    value = std::fabs(value);
    if (value < smallest_length) value = 0;
    return true;
}

bool Reader::point(const char* what, Vec3d& value) {
    if (!number(what, "x of ", length_range, value.x)) return false;
    vector_at = token.at;
    return number(what, "y of ", length_range, value.y) && number(what, "z of ", length_range, value.z);
}

bool Reader::direction(const char* what, Vec3d& value) {
    if (!point(what, value)) return false;
    if (is_zero(value)) return fail(vector_at, "%s is zero; expected a vector with a direction", what);
    return true;
}

bool Reader::colour(const char* what, const Range& range, Vec3d& value) {
    return number(what, "red of ", range, value.x) && number(what, "green of ", range, value.y) &&
           number(what, "blue of ", range, value.z);
}

} // namespace qray::scene
