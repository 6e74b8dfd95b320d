#include "lexer.hpp"

#include <charconv>
#include <cmath>

namespace qray::scene {

namespace {

enum class Byte : uint8_t { bad, blank, line_end, comment, token };

struct ByteTable {
    Byte kind[256] = {};

    constexpr ByteTable() {
        for (unsigned c = '!'; c <= '~'; ++c) kind[c] = Byte::token;
        for (const unsigned c : {0x20u, 0x09u, 0x0bu, 0x0cu}) kind[c] = Byte::blank;
        for (const unsigned c : {0x0au, 0x0du}) kind[c] = Byte::line_end;
        kind[0x23] = Byte::comment;
    }
};

constexpr ByteTable bytes;

Byte kind_of(char c) { return bytes.kind[static_cast<unsigned char>(c)]; }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool starts_number(char c) { return is_digit(c) || c == '-' || c == '+' || c == '.'; }

std::string_view trimmed(std::string_view text) {
    const auto idle = [](char c) { return c == '#' || kind_of(c) == Byte::blank; };
    while (!text.empty() && idle(text.front())) text.remove_prefix(1);
    while (!text.empty() && idle(text.back())) text.remove_suffix(1);
    return text;
}

bool is_word(std::string_view text, std::string_view lower) {
    if (text.size() != lower.size()) return false;
    for (size_t i = 0; i < lower.size(); ++i) {
        if ((text[i] | 0x20) != lower[i]) return false;
    }
    return true;
}

// Whether a well-formed number that no normal or subnormal double is near is a large one, not a small one:
// the sign of the decimal exponent of its first digit that is not 0. There is such a digit.
bool is_large(std::string_view token) {
    constexpr int64_t far_off = 1'000'000'000; // beyond what digits can make up for in a text
    int64_t magnitude = 0;
    bool point = false, leading = true;
    size_t i = 0;
    for (; i < token.size() && (token[i] | 0x20) != 'e'; ++i) {
        if (token[i] == '.') {
            point = true;
            continue;
        }
        if (leading && token[i] == '0') {
            magnitude -= point ? 1 : 0;
        } else if (is_digit(token[i])) {
            magnitude += point ? 0 : 1;
            leading = false;
        }
    }
    bool negative = false;
    int64_t exponent = 0;
    for (; i < token.size(); ++i) {
        if (token[i] == '-') negative = true;
        if (is_digit(token[i]) && exponent < far_off) exponent = 10 * exponent + (token[i] - '0');
    }
    return magnitude + (negative ? -exponent : exponent) > 0;
}

} // namespace

const char* wide_encoding(std::string_view text) {
    using namespace std::string_view_literals;
    if (text.starts_with("\xff\xfe\0\0"sv) || text.starts_with("\0\0\xfe\xff"sv)) return "UTF-32";
    if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv)) return "UTF-16";
    if (text.size() < 4) return nullptr;
    const unsigned zeros = (text[0] == 0) + 2u * (text[1] == 0) + 4u * (text[2] == 0) + 8u * (text[3] == 0);
    return zeros == 0b1110 || zeros == 0b0111 ? "UTF-32" : zeros == 0b1010 || zeros == 0b0101 ? "UTF-16" : nullptr;
}

Lexer::Lexer(const char* text, size_t size) : cursor_(text), end_(text + size) {
    if (std::string_view(text, size).starts_with("\xef\xbb\xbf")) cursor_ += 3;
    line_start_ = cursor_;
}

void Lexer::skip_comment() {
    const char* start = cursor_;
    while (cursor_ != end_ && kind_of(*cursor_) != Byte::line_end) ++cursor_;
    if (comment_.empty()) comment_ = trimmed({start, static_cast<size_t>(cursor_ - start)});
}

void Lexer::skip_blanks() {
    while (cursor_ != end_) {
        switch (kind_of(*cursor_)) {
        case Byte::blank:
            ++cursor_;
            break;
        case Byte::line_end:
            if (*cursor_ == '\r' && end_ - cursor_ > 1 && cursor_[1] == '\n') ++cursor_;
            line_start_ = ++cursor_;
            ++line_;
            break;
        case Byte::comment:
            skip_comment();
            break;
        case Byte::token:
        case Byte::bad:
            return;
        }
    }
}

const Token& Lexer::next() {
    if (held_) {
        held_ = false;
        return token_;
    }
    skip_blanks();
    const char* start = cursor_;
    while (cursor_ != end_ && kind_of(*cursor_) == Byte::token) ++cursor_;
    if (cursor_ != end_ && kind_of(*cursor_) == Byte::bad) {
        token_.kind = TokenKind::bad;
        start = cursor_++;
    } else if (cursor_ == start) {
        token_.kind = TokenKind::end;
    } else {
        token_.kind = starts_number(*start) ? TokenKind::number : TokenKind::word;
    }
    token_.text = {start, static_cast<size_t>(cursor_ - start)};
    token_.at = {line_, static_cast<uint32_t>(start - line_start_) + 1};
    return token_;
}

NumberError read_number(std::string_view token, double& value) {
    std::string_view digits = token;
    if (!digits.empty() && (digits[0] == '+' || digits[0] == '-')) digits.remove_prefix(1);
    if (is_word(digits, "inf") || is_word(digits, "infinity") || is_word(digits, "nan")) {
        return NumberError::not_finite;
    }
    if (digits.empty() || !(is_digit(digits[0]) || digits[0] == '.')) return NumberError::malformed;

    // from_chars knows no '+', and reads "inf" and "nan", which are gone by now.
    const char* first = token[0] == '+' ? digits.data() : token.data();
    const char* last = token.data() + token.size();
    double read = 0;
    const std::from_chars_result result = std::from_chars(first, last, read);
    if (result.ptr != last || result.ec == std::errc::invalid_argument) return NumberError::malformed;
    if (result.ec == std::errc::result_out_of_range) {
        if (is_large(digits)) return NumberError::too_large;
        read = 0;
    }
    value = read + 0.0; // turns -0 into 0, so that equal numbers have equal bits
    return NumberError::none;
}

NumberError read_count(std::string_view token, uint32_t& value) {
    double read = 0;
    const NumberError error = read_number(token, read);
    if (error != NumberError::none) return error;
    if (read != std::floor(read)) return NumberError::not_whole;
    if (read < 0) return NumberError::negative;
    value = read < UINT32_MAX ? static_cast<uint32_t>(read) : UINT32_MAX;
    return NumberError::none;
}

} // namespace qray::scene
