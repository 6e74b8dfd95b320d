#include <qray/picture/sink.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace qray;

template <class Format>
std::vector<int> written(Pixel p)
{
    uint8_t out[4] = {0xaa, 0xaa, 0xaa, 0xaa};
    Format::put(p, out);
    for (uint32_t i = Format::bytes; i < 4; i++)
        EXPECT_EQ(out[i], 0xaa) << "wrote beyond its bytes";
    return std::vector<int>(out, out + Format::bytes);
}

TEST(Sink, Rgb888IsThreeBytesInOrder)
{
    static_assert(Rgb888::bytes == 3);
    EXPECT_EQ(written<Rgb888>({1, 2, 3}), (std::vector<int>{1, 2, 3}));
}

TEST(Sink, Rgb565HasTheUpperBits)
{
    static_assert(rgb565({255, 255, 255}) == 0xffff);
    static_assert(rgb565({255, 0, 0}) == 0xf800);
    static_assert(rgb565({0, 255, 0}) == 0x07e0);
    static_assert(rgb565({0, 0, 255}) == 0x001f);
    static_assert(rgb565({7, 3, 7}) == 0);
    static_assert(rgb565({8, 4, 8}) == (1 << 11 | 1 << 5 | 1));
    static_assert(rgb565({0x12, 0x34, 0x56}) == (2 << 11 | 13 << 5 | 10));
    EXPECT_EQ(written<Rgb565Little>({255, 0, 8}), (std::vector<int>{0x01, 0xf8}));
    EXPECT_EQ(written<Rgb565Big>({255, 0, 8}), (std::vector<int>{0xf8, 0x01}));
}

// ITU-R BT.601: 0.299 R + 0.587 G + 0.114 B.
TEST(Sink, Grey8IsTheLuma)
{
    static_assert(Grey8::bytes == 1);
    for (int r = 0; r < 256; r += 5)
        for (int g = 0; g < 256; g += 5)
            for (int b = 0; b < 256; b += 5) {
                const Pixel p{static_cast<uint8_t>(r), static_cast<uint8_t>(g), static_cast<uint8_t>(b)};
                // Weights in 256ths are at most 1/512 off each.
                ASSERT_NEAR(written<Grey8>(p)[0], 0.299 * r + 0.587 * g + 0.114 * b, 0.5 + 1.5 * 255 / 512);
            }
    for (int v = 0; v < 256; v++)
        ASSERT_EQ(written<Grey8>({static_cast<uint8_t>(v), static_cast<uint8_t>(v), static_cast<uint8_t>(v)})[0], v);
}

} // namespace
