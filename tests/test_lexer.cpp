#include "../src/scene/lexer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using qray::scene::Lexer;
using qray::scene::NumberError;
using qray::scene::read_count;
using qray::scene::read_number;
using qray::scene::Token;
using qray::scene::TokenKind;

struct Seen {
    std::string text;
    uint32_t line, column;
    TokenKind kind;
    bool operator==(const Seen&) const = default;
};

void PrintTo(const Seen& seen, std::ostream* out) {
    *out << '\'' << seen.text << "' at " << seen.line << ':' << seen.column << " kind "
         << static_cast<int>(seen.kind);
}

Seen next(Lexer& lexer) {
    const Token& token = lexer.next();
    return {std::string(token.text), token.at.line, token.at.column, token.kind};
}

// All tokens up to and with the first `end` or `bad`, from a copy of exactly the text's size.
std::vector<Seen> tokens(const std::string& text) {
    const std::vector<char> copy(text.begin(), text.end());
    Lexer lexer(copy.data(), copy.size());
    std::vector<Seen> seen;
    do {
        seen.push_back(next(lexer));
    } while (seen.back().kind != TokenKind::end && seen.back().kind != TokenKind::bad);
    return seen;
}

std::string comment(const std::string& text) {
    Lexer lexer(text.data(), text.size());
    while (lexer.next().kind != TokenKind::end) {}
    return std::string(lexer.comment());
}

constexpr TokenKind word = TokenKind::word, number = TokenKind::number, end = TokenKind::end,
                    bad = TokenKind::bad;

TEST(Lexer, SkipsAByteOrderMark) {
    const std::vector<Seen> expected = {{"s", 1, 1, word}, {"0", 1, 3, number}, {"", 1, 4, end}};
    EXPECT_EQ(tokens("\xef\xbb\xbfs 0"), expected);
    EXPECT_EQ(tokens("\xef\xbb\xbf"), std::vector<Seen>({{"", 1, 1, end}}));
    EXPECT_EQ(tokens("\xef\xbb"), std::vector<Seen>({{"\xef", 1, 1, bad}}));
}

TEST(Lexer, SplitsAtWhiteSpaceAndComments) {
    const std::vector<Seen> expected = {
        {"s", 1, 1, word},     {"0", 1, 4, number}, {"-1", 2, 1, number}, {".5", 3, 2, number},
        {"+7x", 4, 1, number}, {"a", 5, 1, word},   {"b!~", 8, 3, word},  {"", 8, 6, end},
    };
    EXPECT_EQ(tokens("s\t 0\n-1\r\n\f.5#c\n+7x\ra#b # c\n\n#\n\v b!~"), expected);
}

TEST(Lexer, EndStandsBehindTheLastByte) {
    const struct {
        const char* text;
        uint32_t line, column;
    } cases[] = {{"", 1, 1},     {"\n", 2, 1},  {"\r\n", 2, 1}, {"\r\r", 3, 1},
                 {"\n\r", 3, 1}, {" \t", 1, 3}, {"# c", 1, 4},  {"# c\r", 2, 1}};
    for (const auto& [text, line, column] : cases) {
        EXPECT_EQ(tokens(text), (std::vector<Seen>{{"", line, column, end}})) << text;
    }
}

TEST(Lexer, EndRepeats) {
    Lexer lexer("s", 1);
    EXPECT_EQ(next(lexer), (Seen{"s", 1, 1, word}));
    EXPECT_EQ(next(lexer), (Seen{"", 1, 2, end}));
    EXPECT_EQ(next(lexer), (Seen{"", 1, 2, end}));
}

TEST(Lexer, TakesNoTextAtAll) {
    Lexer lexer(nullptr, 0);
    EXPECT_EQ(next(lexer), (Seen{"", 1, 1, end}));
}

TEST(Lexer, UnreadGivesTheLatestOnceMore) {
    Lexer lexer("a b", 3);
    EXPECT_EQ(next(lexer), (Seen{"a", 1, 1, word}));
    lexer.unread();
    EXPECT_EQ(next(lexer), (Seen{"a", 1, 1, word}));
    EXPECT_EQ(next(lexer), (Seen{"b", 1, 3, word}));
}

TEST(Lexer, StopsAtEachByteOutsideOfPrintableAsciiAndWhiteSpace) {
    for (int byte = 0; byte < 256; ++byte) {
        const bool blank = byte == ' ' || (byte >= 0x09 && byte <= 0x0d);
        const char c = static_cast<char>(byte);
        const std::vector<Seen> seen = tokens(std::string("ab") + c);
        if (blank || byte == '#') {
            EXPECT_EQ(seen.front(), (Seen{"ab", 1, 1, word})) << byte;
        } else if (byte > 0x20 && byte < 0x7f) {
            EXPECT_EQ(seen.front(), (Seen{std::string("ab") + c, 1, 1, word})) << byte;
        } else {
            EXPECT_EQ(seen, (std::vector<Seen>{{std::string(1, c), 1, 3, bad}})) << byte;
        }
    }
}

TEST(Lexer, CommentsHoldAnyByte) {
    for (int byte = 0; byte < 256; ++byte) {
        if (byte == '\n' || byte == '\r') continue;
        const std::string text = std::string("#") + static_cast<char>(byte) + "s\nb";
        EXPECT_EQ(tokens(text), (std::vector<Seen>{{"b", 2, 1, word}, {"", 2, 2, end}})) << byte;
    }
}

TEST(Lexer, KeepsTheFirstCommentThatSaysSomething) {
    EXPECT_EQ(comment("s 1"), "");
    EXPECT_EQ(comment("s 1 # \t a ball # of glass \t\n# and more"), "a ball # of glass");
    EXPECT_EQ(comment("#####\n#\n# title #\r\n#####"), "title");
    EXPECT_EQ(comment("#last"), "last");
}

TEST(ReadNumber, RoundsToTheNearestDouble) {
    const struct {
        const char* text;
        double value;
    } cases[] = {
        {"0", 0},
        {"-7", -7},
        {"+7", 7},
        {".5", 0.5},
        {"-.5", -0.5},
        {"5.", 5},
        {"+5.e1", 50},
        {"1E2", 100},
        {"1e+2", 100},
        {"25e-2", 0.25},
        {"007", 7},
        {"0.1", 0x1.999999999999ap-4},
        // Half way between two doubles: to the even one.
        {"1e23", 0x1.52d02c7e14af6p+76},
        {"9007199254740993", 9007199254740992},
        {"9007199254740995", 9007199254740996},
        {"0.500000000000000166533453693773481063544750213623046875", 0x1.0000000000002p-1},
        // The largest, the largest subnormal and the smallest normal, the smallest.
        {"1.7976931348623157e308", 0x1.fffffffffffffp1023},
        {"2.2250738585072011e-308", 0x0.fffffffffffffp-1022},
        {"2.2250738585072014e-308", 0x1p-1022},
        {"4.9e-324", 0x1p-1074},
        // Below half of the smallest, by exponent or by zeros.
        {"2e-324", 0},
        {"1e-400", 0},
        {"-1e-99999999999999999999", 0},
        {"100000e-400", 0},
        // The exponent is out of range, the number is not.
        {"0e999999999999", 0},
        {"0.00000000000000000000000000000000000000000000000000000000000000000001e376", 0x1.1ccf385ebc8ap1023},
    };
    for (const auto& [text, expected] : cases) {
        double value = -1;
        EXPECT_EQ(read_number(text, value), NumberError::none) << text;
        EXPECT_EQ(value, expected) << text;
    }
    const std::string small = "0." + std::string(400, '0') + "1", same = small + "e401";
    double value = -1;
    EXPECT_EQ(read_number(small, value), NumberError::none);
    EXPECT_EQ(value, 0);
    EXPECT_EQ(read_number(same, value), NumberError::none);
    EXPECT_EQ(value, 1);
    EXPECT_EQ(read_number("1" + std::string(400, '0') + "e-400", value), NumberError::none);
    EXPECT_EQ(value, 1);
}

TEST(ReadNumber, MinusZeroIsZero) {
    for (const char* text : {"-0", "-0.0e5", "-1e-400"}) {
        double value = -1;
        EXPECT_EQ(read_number(text, value), NumberError::none) << text;
        EXPECT_EQ(value, 0) << text;
        EXPECT_FALSE(std::signbit(value)) << text;
    }
}

TEST(ReadNumber, RefusesWhatIsNoFiniteDecimalNumber) {
    const struct {
        const char* text;
        NumberError error;
    } cases[] = {
        {"", NumberError::malformed},
        {".", NumberError::malformed},
        {"+", NumberError::malformed},
        {"-", NumberError::malformed},
        {"-.", NumberError::malformed},
        {"+-1", NumberError::malformed},
        {"-+1", NumberError::malformed},
        {"--1", NumberError::malformed},
        {"1.2.3", NumberError::malformed},
        {"12abc", NumberError::malformed},
        {"0x10", NumberError::malformed},
        {"0x1p3", NumberError::malformed},
        {"1e", NumberError::malformed},
        {"1e+", NumberError::malformed},
        {"e5", NumberError::malformed},
        {".e5", NumberError::malformed},
        {"1e5.0", NumberError::malformed},
        {"1,5", NumberError::malformed},
        {"1d5", NumberError::malformed},
        {"1_000", NumberError::malformed},
        {"1-2", NumberError::malformed},
        {"1f", NumberError::malformed},
        {"info", NumberError::malformed},
        {"nan(1)", NumberError::malformed},
        {"inf", NumberError::not_finite},
        {"-inf", NumberError::not_finite},
        {"+INF", NumberError::not_finite},
        {"Infinity", NumberError::not_finite},
        {"nan", NumberError::not_finite},
        {"-NaN", NumberError::not_finite},
        {"1e400", NumberError::too_large},
        {"-1e400", NumberError::too_large},
        {"1.8e308", NumberError::too_large},
        {"1.7976931348623159e308", NumberError::too_large},
        {"0.001e999999999999999999999", NumberError::too_large},
    };
    for (const auto& [text, error] : cases) {
        double value = 42;
        EXPECT_EQ(read_number(text, value), error) << text;
        EXPECT_EQ(value, 42) << text;
    }
    double value = 42;
    EXPECT_EQ(read_number(std::string(400, '9'), value), NumberError::too_large);
    EXPECT_EQ(read_number("1" + std::string(800, '0') + "e-400", value), NumberError::too_large);
    EXPECT_EQ(value, 42);
}

TEST(ReadCount, TakesWholeNumbersHoweverWritten) {
    const struct {
        const char* text;
        uint32_t value;
    } cases[] = {{"0", 0},
                 {"-0.0", 0},
                 {"+12", 12},
                 {"007", 7},
                 {"512.0", 512},
                 {"3.", 3},
                 {"1.6e2", 160},
                 {"1600e-1", 160},
                 {"4294967294", 4294967294},
                 {"4294967295", 4294967295},
                 {"4294967296", 4294967295},
                 {"99999999999999999999999999", 4294967295},
                 {"1e308", 4294967295}};
    for (const auto& [text, expected] : cases) {
        uint32_t value = 1;
        EXPECT_EQ(read_count(text, value), NumberError::none) << text;
        EXPECT_EQ(value, expected) << text;
    }
}

TEST(ReadCount, RefusesAllOthers) {
    const struct {
        const char* text;
        NumberError error;
    } cases[] = {{"1.5", NumberError::not_whole},     {"-1.5", NumberError::not_whole},
                 {"4294967294.5", NumberError::not_whole}, {"1e-300", NumberError::not_whole},
                 {"-3", NumberError::negative},       {"-1e300", NumberError::negative},
                 {"", NumberError::malformed},        {"+", NumberError::malformed},
                 {"0x3", NumberError::malformed},     {"three", NumberError::malformed},
                 {"3a", NumberError::malformed},      {"inf", NumberError::not_finite},
                 {"nan", NumberError::not_finite},    {"1e400", NumberError::too_large}};
    for (const auto& [text, error] : cases) {
        uint32_t value = 42;
        EXPECT_EQ(read_count(text, value), error) << text;
        EXPECT_EQ(value, 42u) << text;
    }
}

} // namespace
