// FLIP of pictures against the first one (flip.hpp), as a line of JSON each: the mean, the share of pixels above the
// threshold of seeing, and the pixels a degree for which that is.
//   flip [-p PIXELS-PER-DEGREE] REFERENCE.ppm PICTURE.ppm ...
// Exit status: 0; 1 and a line for a picture that cannot be read or has another size; 2 and a line for bad options.
#include "flip.hpp"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <algorithm>
#include <vector>

namespace {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

[[gnu::format(printf, 2, 3)]] int fail(int status, const char* format, ...)
{
    va_list values;
    va_start(values, format);
    fputs("flip: ", stderr);
    vfprintf(stderr, format, values);
    fputc('\n', stderr);
    va_end(values);
    return status;
}

// As qray writes them. Null, or what is wrong.
const char* read(const char* path, Picture& picture)
{
    constexpr uint32_t most = 32768;
    FILE* const file = fopen(path, "rb");
    if (!file)
        return strerror(errno);
    picture = {};
    const bool headed = fscanf(file, "P6 %5u %5u 255", &picture.width, &picture.height) == 2 && fgetc(file) == '\n'
        && picture.width - 1 < most && picture.height - 1 < most;
    const size_t size = size_t{3} * picture.width * picture.height;
    size_t there = 0;
    // Grows with what is there: a damaged header may say anything.
    while (headed && there < size) {
        picture.rgb.resize(std::min(size, there + (size_t{1} << 20)));
        const size_t got = fread(picture.rgb.data() + there, 1, picture.rgb.size() - there, file);
        if (got == 0)
            break;
        there += got;
    }
    fclose(file);
    return !headed ? "no binary PPM of 255 levels" : there < size ? "ends before its last pixel" : nullptr;
}

} // namespace

int main(int argc, char** argv)
{
    using qray::study::Flip;
    double pixels_per_degree = Flip::default_pixels_per_degree;
    int at = 1;
    for (; at < argc && argv[at][0] == '-'; at += 2) {
        if (strcmp(argv[at], "-p") != 0)
            return fail(2, "unknown option '%s'; usage: flip [-p PIXELS-PER-DEGREE] REFERENCE.ppm PICTURE.ppm ...",
                        argv[at]);
        char* end = nullptr;
        const char* const text = at + 1 < argc ? argv[at + 1] : "";
        pixels_per_degree = strtod(text, &end);
        if (end == text || *end != 0 || !(pixels_per_degree >= Flip::min_pixels_per_degree)
            || !(pixels_per_degree <= Flip::max_pixels_per_degree))
            return fail(2, "'-p %s': expected pixels per degree, %g to %g", text, Flip::min_pixels_per_degree,
                        Flip::max_pixels_per_degree);
    }
    if (argc - at < 2)
        return fail(2, "expected two pictures; usage: flip [-p PIXELS-PER-DEGREE] REFERENCE.ppm PICTURE.ppm ...");
    const Flip flip{pixels_per_degree};
    Picture reference, picture;
    for (int i = at; i < argc; i++) {
        if (const char* const wrong = read(argv[i], i == at ? reference : picture))
            return fail(1, "%s: %s", argv[i], wrong);
        if (i == at)
            continue;
        const uint32_t width = picture.width, height = picture.height;
        if (width != reference.width || height != reference.height)
            return fail(1, "%s is %u x %u, %s %u x %u", argv[i], width, height, argv[at], reference.width,
                        reference.height);
        std::vector<double> work(Flip::room(width)), row(width);
        double sum = 0;
        uint32_t seen = 0;
        for (uint32_t y = 0; y < height; y++) {
            flip.row(reference.rgb.data(), picture.rgb.data(), width, height, y, work.data(), row.data());
            for (double value : row) {
                sum += value;
                seen += value > flip.threshold();
            }
        }
        const double pixels = static_cast<double>(width) * height;
        printf("{\"flip\": %.6f, \"seen\": %.6f, \"pixels_per_degree\": %g}\n", sum / pixels, seen / pixels,
               pixels_per_degree);
    }
    return 0;
}
