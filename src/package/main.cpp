// Draws a scene and prints it as a text PPM, which any viewer of pictures shows.
#include <stdio.h>

#include <qray/qray.hpp>

#include "balls.hpp"

static int draw()
{
    static uint8_t row[qray::row_bytes<qray::Rgb888>(scene::width)];
    printf("P3\n%u %u\n255\n", static_cast<unsigned>(scene::width), static_cast<unsigned>(scene::height));
    const auto sink = [](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {
        for (uint32_t i = 0; i < bytes; i++)
            printf("%u%c", rgb[i], i % 3 == 2 ? '\n' : ' ');
        return true;
    };
    return qray::render<qray::Rgb888>(scene::scene, row, 1, sink) ? 0 : 1;
}

#ifdef ESP_PLATFORM
extern "C" void app_main() { draw(); }
#else
int main() { return draw(); }
#endif
