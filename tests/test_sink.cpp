#include <qray/picture/sink.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace qray;

template <class Format>
std::vector<int> written(Pixel p, uint32_t x = 0, uint32_t y = 0)
{
    uint8_t out[4] = {0xaa, 0xaa, 0xaa, 0xaa};
    Format::put(p, x, y, out);
    for (uint32_t i = Format::bytes; i < 4; i++)
        EXPECT_EQ(out[i], 0xaa) << "wrote beyond its bytes";
    return std::vector<int>(out, out + Format::bytes);
}

constexpr Pixel grey(int v)
{
    return {static_cast<uint8_t>(v), static_cast<uint8_t>(v), static_cast<uint8_t>(v)};
}

// n/d to the nearest, halves up.
constexpr int rounded(int n, int d)
{
    return (2 * n + d) / (2 * d);
}

TEST(Sink, Rgb888IsThreeBytesInOrder)
{
    static_assert(Rgb888::bytes == 3 && Rgb888::pixels == 1 && row_bytes<Rgb888>(5) == 15);
    EXPECT_EQ(written<Rgb888>({1, 2, 3}), (std::vector<int>{1, 2, 3}));
}

TEST(Sink, LevelsAreRoundedDownWithEveryThreshold)
{
    for (int most = 0; most < 256; most++)
        for (int v = 0; v < 256; v++)
            for (int k = most % 5; k < 255; k += 5)
                ASSERT_EQ(quantised(static_cast<uint32_t>(v), static_cast<uint32_t>(most), static_cast<uint32_t>(k)),
                          static_cast<uint32_t>((v * most + k) / 255));
}

TEST(Sink, Rgb565HasTheNearestLevels)
{
    static_assert(rgb565({255, 255, 255}) == 0xffff);
    static_assert(rgb565({255, 0, 0}) == 0xf800);
    static_assert(rgb565({0, 255, 0}) == 0x07e0);
    static_assert(rgb565({0, 0, 255}) == 0x001f);
    static_assert(rgb565({4, 2, 4}) == 0); // 0.486, 0.494 and 0.486 of a level
    static_assert(rgb565({5, 3, 5}) == (1 << 11 | 1 << 5 | 1));
    for (int v = 0; v < 256; v++) {
        const int fifth = rounded(31 * v, 255), sixth = rounded(63 * v, 255);
        ASSERT_EQ(rgb565(grey(v)), fifth << 11 | sixth << 5 | fifth);
    }
    EXPECT_EQ(written<Rgb565Little>({255, 0, 8}), (std::vector<int>{0x01, 0xf8}));
    EXPECT_EQ(written<Rgb565Big>({255, 0, 8}), (std::vector<int>{0xf8, 0x01}));
}

// ITU-R BT.601: 0.299 R + 0.587 G + 0.114 B.
TEST(Sink, Grey8IsTheNearestLuma)
{
    static_assert(Grey8::bytes == 1);
    for (int r = 0; r < 256; r++)
        for (int g = 0; g < 256; g += 3)
            for (int b = 0; b < 256; b += 5) {
                const Pixel p{static_cast<uint8_t>(r), static_cast<uint8_t>(g), static_cast<uint8_t>(b)};
                ASSERT_EQ(luma(p), rounded(299 * r + 587 * g + 114 * b, 1000));
            }
    EXPECT_EQ(written<Grey8>({10, 20, 30}), std::vector<int>{18}); // 18.15
    EXPECT_EQ(written<Grey8>({0, 0, 250}), std::vector<int>{29});  // 28.5
}

TEST(Sink, PixelsShareABytesBitsFromTheLeft)
{
    static_assert(row_bytes<Mono>(17) == 3 && row_bytes<Grey2>(5) == 2 && row_bytes<Grey4>(5) == 3);
    const int row[] = {255, 0, 127, 128, 255, 0, 0, 255, 0, 255};
    uint8_t mono[2] = {0xaa, 0xaa}, nibbles[5];
    for (uint32_t x = 0; x < 10; x++) {
        Mono::put(grey(row[x]), x, 3, mono + x / 8);
        Grey4::put(grey(row[x]), x, 3, nibbles + x / 2);
    }
    EXPECT_EQ(mono[0], 0b10011001);
    EXPECT_EQ(mono[1], 0b01000000);
    EXPECT_EQ((std::vector<int>(nibbles, nibbles + 5)), (std::vector<int>{0xf0, 0x78, 0xf0, 0x0f, 0x0f}));
    for (int v = 0; v < 256; v++) {
        ASSERT_EQ(written<Grey4>(grey(v))[0], rounded(15 * v, 255) << 4);
        ASSERT_EQ(written<Grey2>(grey(v))[0], rounded(3 * v, 255) << 6);
    }
}

// Of 64 pixels of one level as many are rounded up as come nearest to its fraction.
TEST(Sink, DitheringKeepsTheMean)
{
    for (int v = 0; v < 256; v++) {
        int white = 0, nibbles = 0, blue = 0;
        for (uint32_t y = 40; y < 48; y++)
            for (uint32_t x = 16; x < 24; x++) {
                uint8_t mono = 0, nibble = 0, colour[2];
                Dithered<Mono>::put(grey(v), x, y, &mono);
                Dithered<Grey4>::put(grey(v), x, y, &nibble);
                Dithered<Rgb565Big>::put(grey(v), x, y, colour);
                white += mono >> (7 - x % 8);
                nibbles += x % 2 == 0 ? nibble >> 4 : nibble;
                blue += colour[1] & 31;
            }
        ASSERT_EQ(white, rounded(64 * v, 255)) << v;
        ASSERT_EQ(nibbles, rounded(64 * 15 * v, 255)) << v;
        ASSERT_EQ(blue, rounded(64 * 31 * v, 255)) << v;
    }
}

TEST(Sink, ThresholdsAreEachOf64Once)
{
    std::vector<int> seen;
    for (uint32_t y = 0; y < 8; y++)
        for (uint32_t x = 0; x < 8; x++) {
            seen.push_back(static_cast<int>(ordered_threshold(x, y)));
            ASSERT_EQ(ordered_threshold(x + 8, y + 800), ordered_threshold(x, y));
        }
    // Bayer's matrix of 2 x 2, 0 2 / 3 1, in sixteenths of its steps.
    EXPECT_TRUE(seen[0] < seen[9] && seen[9] < seen[1] && seen[1] < seen[8]);
    std::sort(seen.begin(), seen.end());
    for (int i = 0; i < 64; i++)
        EXPECT_EQ(seen[static_cast<size_t>(i)], 255 * (2 * i + 1) / 128);
}

// IEC 61966-2-1.
TEST(Sink, CorrectionIsThatOfSrgb)
{
    for (int v = 0; v < 256; v++) {
        const double linear = v / 255.0;
        const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
        ASSERT_EQ(srgb.of[v], std::lround(255 * s)) << v;
    }
    EXPECT_EQ(written<Corrected<Rgb888>>({0, 1, 128}), (std::vector<int>{0, 13, 188}));
    EXPECT_EQ(written<Dithered<Corrected<Rgb565Big>>>(grey(1), 3, 5), written<Dithered<Rgb565Big>>(grey(13), 3, 5));
    static constexpr Levels inverse = [] {
        Levels t{};
        for (uint32_t v = 0; v < 256; v++)
            t.of[v] = static_cast<uint8_t>(255 - v);
        return t;
    }();
    EXPECT_EQ((written<Corrected<Grey8, inverse>>(grey(0))), std::vector<int>{255});
}

} // namespace
