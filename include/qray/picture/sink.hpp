// Formats in which rows leave. A format is a structure with
//   pixels, bytes      so many pixels of a row share so many bytes: 1 and 3, 8 and 1; 0 bytes where put() keeps pixels
//   put(p, x, y, out)  writes pixel p, at column x and row y of the picture, to the bytes `out` that hold it. Pixels
//                      that share bytes come from the left, and the first of them writes the whole byte.
// Those with fewer than 256 levels round to the nearest, or, as Dithered<Format>, up or down by place.
#pragma once

#include "sampler.hpp"

namespace qray {

// floor((level * most + threshold) / 255), exactly: 0 ... 255 as 0 ... most, which is 255 at most. Threshold 127 rounds
// to the nearest (there are no halves). 0 stays 0 and 255 becomes `most` with every threshold from 0 to 254.
constexpr uint32_t quantised(uint32_t level, uint32_t most, uint32_t threshold)
{
    const uint32_t v = level * most + threshold;
    return (v + 1 + (v >> 8)) >> 8;
}
inline constexpr uint32_t to_nearest = 127;

// Luma by ITU-R BT.601: (299 r + 587 g + 114 b)/1000 to the nearest, halves up. The quotient is that of a product with
// 2^22/125, rounded up, which is exact for all of them; a division would be a call on small cores.
constexpr uint8_t luma(const Pixel& p)
{
    return static_cast<uint8_t>(((299u * p.r + 587u * p.g + 114u * p.b + 500u) >> 3) * 33555u >> 22);
}

struct Rgb888 {
    static constexpr uint32_t pixels = 1, bytes = 3;
    static constexpr void put(const Pixel& p, uint32_t, uint32_t, uint8_t* out)
    {
        out[0] = p.r;
        out[1] = p.g;
        out[2] = p.b;
    }
};

constexpr uint16_t rgb565(const Pixel& p, uint32_t threshold = to_nearest)
{
    return static_cast<uint16_t>(quantised(p.r, 31, threshold) << 11 | quantised(p.g, 63, threshold) << 5
                                 | quantised(p.b, 31, threshold));
}

// Its upper byte first, as displays take it by SPI, or its lower, as a frame buffer holds it.
template <bool UpperFirst>
struct Rgb565 {
    static constexpr uint32_t pixels = 1, bytes = 2;
    static constexpr void put(const Pixel& p, uint32_t, uint32_t, uint8_t* out, uint32_t threshold = to_nearest)
    {
        const uint16_t v = rgb565(p, threshold);
        out[UpperFirst ? 0 : 1] = static_cast<uint8_t>(v >> 8);
        out[UpperFirst ? 1 : 0] = static_cast<uint8_t>(v & 0xff);
    }
};
using Rgb565Big = Rgb565<true>;
using Rgb565Little = Rgb565<false>;

struct Grey8 {
    static constexpr uint32_t pixels = 1, bytes = 1;
    static constexpr void put(const Pixel& p, uint32_t, uint32_t, uint8_t* out) { out[0] = luma(p); }
};

// 8/Bits pixels a byte, the leftmost in its upper bits; white is all ones.
template <uint32_t Bits>
struct Grey {
    static constexpr uint32_t pixels = 8 / Bits, bytes = 1;
    static constexpr void put(const Pixel& p, uint32_t x, uint32_t, uint8_t* out, uint32_t threshold = to_nearest)
    {
        const uint32_t k = x % pixels, v = quantised(luma(p), (1u << Bits) - 1, threshold) << (8 - Bits - k * Bits);
        out[0] = static_cast<uint8_t>(k == 0 ? v : out[0] | v);
    }
};
using Grey4 = Grey<4>;
using Grey2 = Grey<2>;
using Mono = Grey<1>;

// Ordered dithering: of each 8 x 8 pixels of one level, as many are rounded up as come nearest to it; which, their
// places say (Bayer, "An optimum method for two-level rendition of continuous-tone pictures", 1973).
constexpr uint32_t ordered_threshold(uint32_t x, uint32_t y)
{
    uint32_t rank = 0; // 0 ... 63: bits of x ^ y and y by turns, the lowest first
    for (uint32_t i = 0; i < 3; i++)
        rank = rank << 2 | ((x ^ y) >> i & 1) << 1 | (y >> i & 1);
    return (255 * (2 * rank + 1)) >> 7;
}

template <class Format>
struct Dithered : Format {
    static constexpr void put(const Pixel& p, uint32_t x, uint32_t y, uint8_t* out)
    {
        Format::put(p, x, y, out, ordered_threshold(x, y));
    }
};

// Pixels are linear in light, and so are displays of two levels. What others show of a level grows with its power of
// 2.2 or so, which a table undoes; before dithering, Dithered<Corrected<Rgb565Big>>.
struct Levels {
    uint8_t of[256];
};

// By sRGB (IEC 61966-2-1): 255 (1.055 (v/255)^(1/2.4) - 0.055), to the nearest.
inline constexpr Levels srgb{
    {0, 13, 22, 28, 34, 38, 42, 46, 50, 53, 56, 59, 61, 64, 66, 69, 71, 73, 75, 77, 79, 81, 83, 85, 86, 88, 90, 92, 93,
     95, 96, 98, 99, 101, 102, 104, 105, 106, 108, 109, 110, 112, 113, 114, 115, 117, 118, 119, 120, 121, 122, 124, 125,
     126, 127, 128, 129, 130, 131, 132, 133, 134, 135, 136, 137, 138, 139, 140, 141, 142, 143, 144, 145, 146, 147, 148,
     148, 149, 150, 151, 152, 153, 154, 155, 155, 156, 157, 158, 159, 159, 160, 161, 162, 163, 163, 164, 165, 166, 167,
     167, 168, 169, 170, 170, 171, 172, 173, 173, 174, 175, 175, 176, 177, 178, 178, 179, 180, 180, 181, 182, 182, 183,
     184, 185, 185, 186, 187, 187, 188, 189, 189, 190, 190, 191, 192, 192, 193, 194, 194, 195, 196, 196, 197, 197, 198,
     199, 199, 200, 200, 201, 202, 202, 203, 203, 204, 205, 205, 206, 206, 207, 208, 208, 209, 209, 210, 210, 211, 212,
     212, 213, 213, 214, 214, 215, 215, 216, 216, 217, 218, 218, 219, 219, 220, 220, 221, 221, 222, 222, 223, 223, 224,
     224, 225, 226, 226, 227, 227, 228, 228, 229, 229, 230, 230, 231, 231, 232, 232, 233, 233, 234, 234, 235, 235, 236,
     236, 237, 237, 238, 238, 238, 239, 239, 240, 240, 241, 241, 242, 242, 243, 243, 244, 244, 245, 245, 246, 246, 246,
     247, 247, 248, 248, 249, 249, 250, 250, 251, 251, 251, 252, 252, 253, 253, 254, 254, 255, 255},
};

template <class Format, const Levels& levels = srgb>
struct Corrected : Format {
    static constexpr void put(const Pixel& p, uint32_t x, uint32_t y, uint8_t* out, auto... threshold)
    {
        Format::put({levels.of[p.r], levels.of[p.g], levels.of[p.b]}, x, y, out, threshold...);
    }
};

// Bytes of a row of so many pixels.
template <class Format>
constexpr uint32_t row_bytes(uint32_t width)
{
    return (width + Format::pixels - 1) / Format::pixels * Format::bytes;
}

} // namespace qray
