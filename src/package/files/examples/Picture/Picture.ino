// Sends a picture as a binary PPM by the serial port: `cat /dev/ttyACM0 > picture.ppm` receives it.
// The scene is balls.hpp, made by `qray compile balls.nff -s 64x48 -o balls.hpp`.
#include <qray.h>

#include "balls.hpp"

static uint8_t row[qray::row_bytes<qray::Rgb888>(scene::width)];

void setup()
{
    Serial.begin(115200);
    Serial.print("P6\n");
    Serial.print(scene::width);
    Serial.print(' ');
    Serial.print(scene::height);
    Serial.print("\n255\n");
    qray::render<qray::Rgb888>(scene::scene, row, 1, [](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {
        return Serial.write(rgb, bytes) == bytes;
    });
}

void loop() {}
