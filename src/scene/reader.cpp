#include "reader.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace qray::scene {

Shown::Shown(std::string_view token)
{
    constexpr size_t longest = sizeof text - 1;
    const bool cut = token.size() > longest;
    snprintf(text, sizeof text, "%.*s%s", static_cast<int>(cut ? longest - 3 : token.size()), token.data(),
             cut ? "..." : "");
}

ShownName::ShownName(const char* name)
{
    constexpr size_t longest = sizeof text / 2;
    size_t used = 0;
    if (const size_t length = strlen(name); length > longest) {
        used = static_cast<size_t>(snprintf(text, sizeof text, "..."));
        name += length - longest;
        while ((static_cast<unsigned char>(*name) & 0xc0) == 0x80) // the rest of a UTF-8 sequence
            name++;
    }
    for (; *name != 0 && used + 4 < sizeof text; name++) {
        const unsigned char c = static_cast<unsigned char>(*name);
        const bool plain = c >= 0x20 && c != 0x7f;
        used += static_cast<size_t>(snprintf(text + used, sizeof text - used, plain ? "%c" : "\\x%02x", c));
    }
    text[used] = 0;
}

bool Reader::fail(Position at, const char* format, ...)
{
    const ShownName shown(name);
    const int head = snprintf(error.text, sizeof error.text, "%s:%u:%u: ", shown.text, at.line, at.column);
    va_list values;
    va_start(values, format);
    vsnprintf(error.text + head, sizeof error.text - static_cast<size_t>(head), format, values);
    va_end(values);
    return false;
}

bool Reader::expected(const char* part, const char* what)
{
    if (token.kind == TokenKind::bad)
        return fail(token.at, "found the byte 0x%02x; outside of comments a scene is printable ASCII and white space",
                    static_cast<unsigned>(static_cast<unsigned char>(token.text[0])));
    if (token.kind == TokenKind::end)
        return fail(token.at, "the file ends where %s%s was expected", part, what);
    return fail(token.at, "expected %s%s, found '%s'", part, what, Shown(token.text).text);
}

template <class T>
bool Reader::read(NumberError (*as)(std::string_view, T&), const char* what, const char* part, T& value)
{
    token = lexer.next();
    if (token.kind == TokenKind::end || token.kind == TokenKind::bad)
        return expected(part, what);
    const NumberError wrong = as(token.text, value);
    if (wrong == NumberError::none)
        return true;
    constexpr const char* reasons[] = {
        "", "not a number in plain decimal or e-notation", "not a finite number", "too large for a number",
        "not a whole number", "negative"};
    const bool word = wrong == NumberError::malformed && token.kind == TokenKind::word;
    return fail(token.at, "expected %s%s, found '%s', which is %s", part, what, Shown(token.text).text,
                word ? "not a number" : reasons[static_cast<int>(wrong)]);
}

bool Reader::any_number(const char* what, double& value) { return read(read_number, what, "", value); }

bool Reader::number(const char* what, const Range& range, double& value, const char* part)
{
    if (!read(read_number, what, part, value))
        return false;
    value = range.meant(value);
    return range.holds(value)
        || fail(token.at, "%s%s is %s; expected %s", part, what, Shown(token.text).text, range.text);
}

bool Reader::count(const char* what, uint32_t low, uint32_t high, const char* limit, uint32_t& value)
{
    if (!read(read_count, what, "", value))
        return false;
    const Shown shown(token.text);
    if (value < low)
        return fail(token.at, "%s is %s; expected at least %u", what, shown.text, low);
    return value <= high || fail(token.at, "%s is %s; expected at most %u (limit '%s')", what, shown.text, high, limit);
}

bool Reader::radius(const char* what, double& value)
{
    if (!number(what, length_range, value))
        return false;
    value = std::fabs(value);
    if (value < smallest_length)
        value = 0;
    return true;
}

bool Reader::point(const char* what, Vec3d& value)
{
    if (!number(what, length_range, value.x, "x of "))
        return false;
    vector_at = token.at;
    return number(what, length_range, value.y, "y of ") && number(what, length_range, value.z, "z of ");
}

bool Reader::direction(const char* what, Vec3d& value)
{
    return point(what, value) && not_zero(what, value);
}

bool Reader::not_zero(const char* what, const Vec3d& value)
{
    return !is_zero(value) || fail(vector_at, "%s is zero; expected a vector with a direction", what);
}

bool Reader::colour(const char* what, const Range& range, Vec3d& value)
{
    return number(what, range, value.x, "red of ") && number(what, range, value.y, "green of ")
        && number(what, range, value.z, "blue of ");
}

} // namespace qray::scene
