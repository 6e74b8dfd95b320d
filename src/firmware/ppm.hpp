// The first bytes of a binary PPM, written by the compiler.
#pragma once

#include <stdint.h>

struct PpmHeader {
    char text[24];
    uint32_t size;
};

template <uint32_t Width, uint32_t Height>
consteval PpmHeader ppm_header()
{
    static_assert(Width >= 1 && Width <= 32'768 && Height >= 1 && Height <= 32'768);
    PpmHeader out{"P6\n", 3};
    const auto append = [&out](uint32_t number, char after) {
        uint32_t divisor = 10'000;
        while (divisor > number)
            divisor /= 10;
        for (; divisor != 0; divisor /= 10)
            out.text[out.size++] = static_cast<char>('0' + number / divisor % 10);
        out.text[out.size++] = after;
    };
    append(Width, ' ');
    append(Height, '\n');
    append(255, '\n');
    return out;
}
