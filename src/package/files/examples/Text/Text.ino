// Draws with characters in the serial monitor: a format of one's own, dithered by place.
#include <qray.h>

#include "balls.hpp"

// Ten characters from dark to bright, one a pixel.
struct Characters {
    static constexpr uint32_t pixels = 1, bytes = 1;
    static constexpr void put(const qray::Pixel& p, uint32_t, uint32_t, uint8_t* out,
                              uint32_t threshold = qray::to_nearest)
    {
        out[0] = static_cast<uint8_t>(" .:-=+*#%@"[qray::quantised(qray::luma(p), 9, threshold)]);
    }
};

static uint8_t line[scene::width + 1];

void setup()
{
    Serial.begin(115200);
    for (uint32_t y = 0; y < scene::height; y += 2) { // a character is about twice as high as wide
        qray::render_row<qray::Dithered<Characters>>(scene::scene, y, line);
        line[scene::width] = '\n';
        Serial.write(line, sizeof line);
    }
}

void loop() {}
