// A picture's pixels in an order whose beginning stands for the whole: combs of up to 64 pixels of a row, each once,
// in rows far from each other.
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
    // The k-th, k < count(). Rows go round by steps of the golden section, so that after any number of combs they lie
    // about evenly over the picture, and over what repeats in it.
    constexpr Comb operator()(uint32_t k) const
    {
        const uint32_t y = static_cast<uint32_t>((uint64_t{k % height} * step() + height / 2) % height);
        return {((y * 0x9e3779b1 >> 16) + k / height) % stride(), y};
    }

private:
    // Undone only by going round all rows.
    constexpr uint32_t step() const
    {
        const auto divisor = [](uint32_t a, uint32_t b) {
            while (b != 0) {
                const uint32_t rest = a % b;
                a = b;
                b = rest;
            }
            return a;
        };
        uint32_t n = static_cast<uint32_t>(height * 0.6180339887 + 0.5);
        while (divisor(n, height) != 1)
            n++;
        return n;
    }
};

} // namespace qray::study
