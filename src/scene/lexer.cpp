#include "lexer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace qray::scene {

namespace {

enum class Byte : uint8_t { bad, blank, line_end, comment, token };

Byte kind_of(char c)
{
    if (c > ' ' && c <= '~')
        return c == '#' ? Byte::comment : Byte::token;
    if (c == '\n' || c == '\r')
        return Byte::line_end;
    return c == ' ' || c == '\t' || c == '\v' || c == '\f' ? Byte::blank : Byte::bad;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view text)
{
    const auto idle = [](char c) { return c == '#' || kind_of(c) == Byte::blank; };
    while (!text.empty() && idle(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && idle(text.back()))
        text.remove_suffix(1);
    return text;
}

bool is_word(std::string_view text, std::string_view lower)
{
    return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                      [](char a, char b) { return (a | 0x20) == b; });
}

// Whether a well-formed number that no normal or subnormal double is near is a large one, not a small one:
// the sign of the decimal exponent of its first digit that is not 0. There is such a digit.
bool is_large(std::string_view number)
{
    constexpr int64_t far_off = 1'000'000'000; // beyond what digits can make up for in a text
    const size_t e = std::min(number.find_first_of("eE"), number.size()), point = std::min(number.find('.'), e);
    const auto places = static_cast<int64_t>(point) - static_cast<int64_t>(number.find_first_of("123456789"));
    int64_t exponent = 0;
    if (e != number.size()) {
        const char* const digits = number.data() + e + (number[e + 1] == '+' ? 2 : 1);
        const auto read = std::from_chars(digits, number.data() + number.size(), exponent);
        if (read.ec == std::errc::result_out_of_range)
            exponent = *digits == '-' ? -far_off : far_off;
    }
    return places + (places < 0) + exponent > 0;
}

} // namespace

const char* wide_encoding(std::string_view text)
{
    using namespace std::string_view_literals;
    if (text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0\xfe\xff"sv))
        return "UTF-32";
    if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv))
        return "UTF-16";
    if (text.size() < 4)
        return nullptr;
    const unsigned zeros = (text[0] == 0) + 2u * (text[1] == 0) + 4u * (text[2] == 0) + 8u * (text[3] == 0);
    return zeros == 0b1110 || zeros == 0b0111 ? "UTF-32" : zeros == 0b1010 || zeros == 0b0101 ? "UTF-16" : nullptr;
}

Lexer::Lexer(const char* text, size_t size) : cursor(text), end(text + size)
{
    if (std::string_view(text, size).starts_with("\xef\xbb\xbf"))
        cursor += 3;
    line_start = cursor;
}

void Lexer::skip_blanks()
{
    for (; cursor != end; cursor++) {
        switch (kind_of(*cursor)) {
        case Byte::blank:
            break;
        case Byte::line_end:
            if (*cursor == '\r' && end - cursor > 1 && cursor[1] == '\n')
                cursor++;
            line_start = cursor + 1;
            line++;
            break;
        case Byte::comment: {
            const char* const stop = std::find_if(cursor, end, [](char c) { return kind_of(c) == Byte::line_end; });
            if (first_comment.empty())
                first_comment = trimmed({cursor, stop});
            cursor = stop - 1;
            break;
        }
        case Byte::token:
        case Byte::bad:
            return;
        }
    }
}

const Token& Lexer::next()
{
    if (held) {
        held = false;
        return token;
    }
    skip_blanks();
    const char* start = cursor;
    cursor = std::find_if(cursor, end, [](char c) { return kind_of(c) != Byte::token; });
    if (cursor != end && kind_of(*cursor) == Byte::bad) {
        token.kind = TokenKind::bad;
        start = cursor++;
    } else if (cursor == start) {
        token.kind = TokenKind::end;
    } else {
        const bool number = is_digit(*start) || *start == '-' || *start == '+' || *start == '.';
        token.kind = number ? TokenKind::number : TokenKind::word;
    }
    token.text = {start, cursor};
    token.at = {line, static_cast<uint32_t>(start - line_start) + 1};
    return token;
}

NumberError read_number(std::string_view token, double& value)
{
    std::string_view digits = token;
    if (!digits.empty() && (digits[0] == '+' || digits[0] == '-'))
        digits.remove_prefix(1);
    if (is_word(digits, "inf") || is_word(digits, "infinity") || is_word(digits, "nan"))
        return NumberError::not_finite;
    if (digits.empty() || !(is_digit(digits[0]) || digits[0] == '.'))
        return NumberError::malformed;

    // from_chars knows no '+', and reads "inf" and "nan", which are gone by now.
    const char* const first = token[0] == '+' ? digits.data() : token.data();
    const char* const last = token.data() + token.size();
    double read = 0;
    const auto [stop, error] = std::from_chars(first, last, read);
    if (stop != last || error == std::errc::invalid_argument)
        return NumberError::malformed;
    if (error == std::errc::result_out_of_range) {
        if (is_large(digits))
            return NumberError::too_large;
        read = 0;
    }
    value = read + 0.0; // turns -0 into 0, so that equal numbers have equal bits
    return NumberError::none;
}

NumberError read_count(std::string_view token, uint32_t& value)
{
    double read = 0;
    if (const NumberError error = read_number(token, read); error != NumberError::none)
        return error;
    if (read != std::floor(read))
        return NumberError::not_whole;
    if (read < 0)
        return NumberError::negative;
    value = read < UINT32_MAX ? static_cast<uint32_t>(read) : UINT32_MAX;
    return NumberError::none;
}

} // namespace qray::scene
