// What a board draws when it is given no scene: a picture whose every byte has a closed form, so that a new
// board's start-up, arithmetic, output and measurements can be checked before any ray is traced.
//   red    floor(255 x / (width - 1)), or 0 in a picture one pixel wide
//   green  byte 4 of the 64-bit product (x 2654435769 mod 2^32) (y 2246822519 + 1 mod 2^32)
//   blue   floor((x^2 + y^2) / 8) mod 256, with x and y mod 1024; in float, where it is exact
#pragma once

#include <stdint.h>

#ifndef QRAY_WIDTH
#define QRAY_WIDTH 64
#define QRAY_HEIGHT 48
#endif

namespace scene {
constexpr uint32_t width = QRAY_WIDTH, height = QRAY_HEIGHT;
}

namespace test_card {

// Calls sink(y, 1, rgb, bytes) for each row from the top, until it returns false. False if it did.
template <typename Sink>
bool render(uint8_t* row, const Sink& sink)
{
    constexpr uint32_t last = scene::width > 1 ? scene::width - 1 : 1;
    for (uint32_t y = 0; y != scene::height; ++y) {
        for (uint32_t x = 0; x != scene::width; ++x) {
            const uint64_t product = uint64_t{x * 2'654'435'769u} * (y * 2'246'822'519u + 1);
            const uint32_t square = (x & 1023) * (x & 1023) + (y & 1023) * (y & 1023);
            row[3 * x] = static_cast<uint8_t>(255 * x / last);
            row[3 * x + 1] = static_cast<uint8_t>(product >> 32);
            row[3 * x + 2] = static_cast<uint8_t>(static_cast<uint32_t>(static_cast<float>(square) * 0.125f));
        }
        if (!sink(y, 1u, static_cast<const uint8_t*>(row), 3 * scene::width))
            return false;
    }
    return true;
}

} // namespace test_card
