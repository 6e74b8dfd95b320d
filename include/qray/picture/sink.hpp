// Formats in which rows leave: each writes one pixel to `out` and says how many bytes that took.
#pragma once

#include "sampler.hpp"

namespace qray {

struct Rgb888 {
    static constexpr uint32_t bytes = 3;
    static constexpr void put(const Pixel& p, uint8_t* out)
    {
        out[0] = p.r;
        out[1] = p.g;
        out[2] = p.b;
    }
};

constexpr uint16_t rgb565(const Pixel& p)
{
    return static_cast<uint16_t>((p.r >> 3) << 11 | (p.g >> 2) << 5 | p.b >> 3);
}

struct Rgb565Little {
    static constexpr uint32_t bytes = 2;
    static constexpr void put(const Pixel& p, uint8_t* out)
    {
        out[0] = static_cast<uint8_t>(rgb565(p) & 0xff);
        out[1] = static_cast<uint8_t>(rgb565(p) >> 8);
    }
};

struct Rgb565Big {
    static constexpr uint32_t bytes = 2;
    static constexpr void put(const Pixel& p, uint8_t* out)
    {
        out[0] = static_cast<uint8_t>(rgb565(p) >> 8);
        out[1] = static_cast<uint8_t>(rgb565(p) & 0xff);
    }
};

// Luma by ITU-R BT.601, in 256ths.
struct Grey8 {
    static constexpr uint32_t bytes = 1;
    static constexpr void put(const Pixel& p, uint8_t* out)
    {
        out[0] = static_cast<uint8_t>((77u * p.r + 150u * p.g + 29u * p.b + 128u) >> 8);
    }
};

} // namespace qray
