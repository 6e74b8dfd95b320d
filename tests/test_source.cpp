// C++ source text: literals that mean exactly what they stand for, and comments that end where they should.
#include "../src/scene/source.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>

namespace {

using qray::scene::Source;

bool append(void* to, const char* bytes, size_t size)
{
    static_cast<std::string*>(to)->append(bytes, size);
    return true;
}

template <class T>
std::string literal(T value)
{
    std::string text;
    Source out(append, &text);
    out.number(value);
    EXPECT_TRUE(out.finish());
    return text;
}

std::string comment(const std::string& said)
{
    std::string text;
    Source out(append, &text);
    out.comment(said.c_str());
    EXPECT_TRUE(out.finish());
    return text;
}

TEST(Source, WholeNumbersAreDecimal)
{
    EXPECT_EQ(literal(int64_t{0}), "0");
    EXPECT_EQ(literal(int64_t{-1234567890123}), "-1234567890123");
    EXPECT_EQ(literal(std::numeric_limits<int64_t>::max()), "9223372036854775807");
    EXPECT_EQ(literal(0.0f), "0");
    EXPECT_EQ(literal(-3.0f), "-3");
    EXPECT_EQ(literal(16777215.0f), "16777215");
    EXPECT_EQ(literal(2147483647.0), "2147483647");
}

TEST(Source, OthersAreHexadecimalAndExact)
{
    EXPECT_EQ(literal(0.5f), "0x1p-1f");
    EXPECT_EQ(literal(-0.1f), "-0x1.99999ap-4f");
    EXPECT_EQ(literal(-0.0f), "-0x0p+0f");
    EXPECT_EQ(literal(16777216.0f), "0x1p+24f");
    EXPECT_EQ(literal(0.1), "0x1.999999999999ap-4");
    EXPECT_EQ(literal(-0.0), "-0x0p+0");
    EXPECT_EQ(literal(2147483648.0), "0x1p+31");
    for (const float v : {0.1f, 1e-38f, 1e-45f, 3.4e38f, 16777217.5f, 1.0f / 3}) {
        EXPECT_EQ(std::strtof(literal(v).c_str(), nullptr), v);
        EXPECT_EQ(std::strtof(literal(-v).c_str(), nullptr), -v);
    }
    for (const double v : {0.1, 1e-308, 5e-324, 1.7e308, 1e17, 1.0 / 3})
        EXPECT_EQ(std::strtod(literal(v).c_str(), nullptr), v);
}

TEST(Source, ACommentIsOneLine)
{
    EXPECT_EQ(comment("three balls"), "// three balls\n");
    EXPECT_EQ(comment("ends in \\"), "// ends in \\.\n");
    EXPECT_EQ(comment("\\ is within"), "// \\ is within\n");
    EXPECT_EQ(comment("a\nb\rc\td\x7f"), "// a?b?c?d?\n");
    EXPECT_EQ(comment("caf\xc3\xa9 \xe2\x80\x93 \xe2\x81\x82"), "// caf\xc3\xa9 \xe2\x80\x93 \xe2\x81\x82\n");
    // Marks that turn the direction of writing, up to the end of the text.
    EXPECT_EQ(comment("a\xe2\x80\xae" "b\xe2\x81\xa6" "c\xe2\x80\xaa"), "// a?b?c?\n");
    EXPECT_EQ(comment("cut off \xe2\x80"), "// cut off \xe2\x80\n");
}

TEST(Source, BlocksComeInOrder)
{
    std::string text, expected;
    Source out(append, &text);
    for (int i = 0; i < 5000; i++) {
        out.print("%d,", i);
        expected += std::to_string(i) + ",";
    }
    EXPECT_TRUE(out.finish());
    EXPECT_EQ(text, expected);
}

TEST(Source, AFailureIsToldAndEndsTheWriting)
{
    int calls = 0;
    const auto fail_second = [](void* to, const char*, size_t) { return ++*static_cast<int*>(to) != 2; };
    Source out(fail_second, &calls);
    for (int i = 0; i < 5000; i++)
        out.put("eight by");
    EXPECT_FALSE(out.finish());
    EXPECT_EQ(calls, 2);
}

} // namespace
