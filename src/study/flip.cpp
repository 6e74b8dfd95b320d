// FLIP of pictures against the first one (flip.hpp), as a line of JSON each: the mean, and the share of pixels above
// the threshold of seeing.
//   flip [-p PIXELS-PER-DEGREE] REFERENCE.ppm PICTURE.ppm ...
#include "../cli/options.hpp"
#include "flip.hpp"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <vector>

namespace {

struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;
};

// As qray writes them.
bool read(const char* path, Picture& picture)
{
    FILE* const file = fopen(path, "rb");
    bool is_read = file && fscanf(file, "P6 %u %u 255", &picture.width, &picture.height) == 2 && fgetc(file) == '\n';
    if (is_read && picture.width - 1 < 65535 && picture.height - 1 < 65535) {
        picture.rgb.resize(size_t{3} * picture.width * picture.height);
        is_read = fread(picture.rgb.data(), picture.rgb.size(), 1, file) == 1;
    }
    if (file)
        fclose(file);
    return is_read && !picture.rgb.empty();
}

} // namespace

int main(int argc, char** argv)
{
    using qray::study::Flip;
    double pixels_per_degree = Flip::default_pixels_per_degree;
    int at = 1;
    if (argc > 2 && strcmp(argv[1], "-p") == 0) {
        pixels_per_degree = strtod(argv[2], nullptr);
        at = 3;
    }
    if (argc - at < 2
        || !(pixels_per_degree >= Flip::min_pixels_per_degree && pixels_per_degree <= Flip::max_pixels_per_degree))
        return qray::cli::bad_options("usage: flip [-p PIXELS-PER-DEGREE] REFERENCE.ppm PICTURE.ppm ...");
    const Flip flip{pixels_per_degree};
    Picture reference, picture;
    for (int i = at; i < argc; i++) {
        if (!read(argv[i], i == at ? reference : picture))
            return qray::cli::bad_options("%s: expected a binary PPM", argv[i]);
        if (i == at)
            continue;
        const uint32_t width = picture.width, height = picture.height;
        if (width != reference.width || height != reference.height)
            return qray::cli::bad_options("%s is %u x %u, %s %u x %u", argv[i], width, height, argv[at],
                                          reference.width, reference.height);
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
        printf("{\"flip\": %.6f, \"seen\": %.6f}\n", sum / pixels, seen / pixels);
    }
    return 0;
}
