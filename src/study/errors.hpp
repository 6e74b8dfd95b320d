// How far two pictures are apart, in levels of 0 to 255.
#pragma once

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

namespace qray::study {

struct Errors {
    double squares = 0; // of all differences
    uint64_t bytes = 0, pixels = 0, off = 0; // off: pixels of which a channel differs by more than 2
    int largest = 0;

    void add(const uint8_t* a, const uint8_t* b, size_t count)
    {
        for (size_t i = 0; i < count; i++) {
            int worst = 0;
            for (size_t c = 0; c < 3; c++) {
                const int difference = abs(a[3 * i + c] - b[3 * i + c]);
                squares += difference * difference;
                worst = worst < difference ? difference : worst;
            }
            off += worst > 2;
            largest = largest < worst ? worst : largest;
        }
        pixels += count;
        bytes += 3 * count;
    }
    double rms() const { return bytes != 0 ? sqrt(squares / static_cast<double>(bytes)) : 0; }
    double off_share() const
    {
        return pixels != 0 ? static_cast<double>(off) / static_cast<double>(pixels) : 0;
    }
    // Decibels; pictures without a difference have 99.
    double psnr() const { return squares > 0 ? fmin(99, 20 * log10(255 / rms())) : 99; }
};

} // namespace qray::study
