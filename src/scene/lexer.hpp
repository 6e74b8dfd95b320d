// The tokens of a scene text: runs of printable ASCII between white space (blank, tab, vertical tab, form
// feed, line end). '#' starts a comment, also in the middle of a token; LF, CR and CR LF each end a line and
// with it the comment. A comment may hold any byte. A UTF-8 byte order mark before all is skipped.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include <string_view>

namespace qray::scene {

// 1-based; columns count bytes.
struct Position {
    uint32_t line = 1, column = 1;
};

enum class TokenKind : uint8_t {
    word,
    number, // starts as a number does, with a digit, a sign or a point; read_number() tells whether it is one
    end,    // of the text; an empty token just behind its last byte
    bad     // a byte that stands in no token; the token is that byte
};

struct Token {
    std::string_view text;
    Position at;
    TokenKind kind = TokenKind::end;
};

class Lexer {
public:
    // The text must outlive the lexer and its tokens, and be shorter than 4 GiB.
    Lexer(const char* text, size_t size);

    // The next token; valid until the next call. Behind the last one comes `end`, again and again.
    const Token& next();

    // Makes next() return its latest token once more.
    void unread() { held = true; }

    // The first comment so far that says something, without its '#' and the blanks around it.
    std::string_view comment() const { return first_comment; }

private:
    void skip_blanks();

    const char* cursor;
    const char* line_start;
    const char* end;
    uint32_t line = 1;
    bool held = false;
    Token token;
    std::string_view first_comment;
};

// "UTF-16" or "UTF-32" where the text's first bytes are a byte order mark of that, or of a character in it; else null.
const char* wide_encoding(std::string_view text);

enum class NumberError : uint8_t { none, malformed, not_finite, too_large, not_whole, negative };

// A decimal number, plain or in e-notation, to the nearest double (ties to even). The sign and the digits on
// one side of the point may be absent. What is too small for a double reads as 0, and so does -0; `value` is
// untouched on an error.
NumberError read_number(std::string_view token, double& value);

// A number whose value is whole and not negative, written as any number may be: 160, 1.6e2, 160.0. From
// 2^32 - 1 on it reads as 2^32 - 1. `value` is untouched on an error.
NumberError read_count(std::string_view token, uint32_t& value);

} // namespace qray::scene
