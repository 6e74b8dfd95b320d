// A picture's pixels in an order that looks like chance: combs of up to 64 pixels of a row, each comb once. The
// beginning of the order stands for the whole picture, whatever lies in its rows and columns.
#pragma once

#include <stdint.h>

namespace qray::study {

struct Scattered {
    uint32_t width, height;
    // What is left at the right of the combs, a column or two, is the least.
    constexpr uint32_t stride() const
    {
        uint32_t best = (width + 63) / 64;
        for (uint32_t n = best; n <= (width + 31) / 32; n++)
            best = width % n <= width % best ? n : best;
        return best;
    }
    constexpr uint32_t length() const { return width / stride(); }
    constexpr uint32_t count() const { return stride() * height; }

    // Pixels x + i stride of row y, i < length.
    struct Comb {
        uint32_t x, y;
    };
    // The k-th, k < count(). Each step can be undone within the next power of two; what is beyond goes round again.
    constexpr Comb operator()(uint32_t k) const
    {
        uint32_t bits = 1;
        while (uint32_t{1} << bits < count())
            bits++;
        const uint32_t mask = (uint32_t{1} << bits) - 1, factors[] = {0x7feb352d, 0x846ca68b, 0x9e3779b1};
        do {
            k = (k + 0x9e3779b9) & mask;
            for (uint32_t factor : factors) {
                k ^= k >> (bits + 1) / 2;
                k = k * factor & mask;
            }
            k ^= k >> (bits + 1) / 2;
        } while (k >= count());
        return {k % stride(), k / stride()};
    }
};

} // namespace qray::study
