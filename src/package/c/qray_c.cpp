// The C face of the compiled scene QRAY_SCENE_HEADER, in the format QRAY_FORMAT.
#include "qray_c.h"

#include <qray/qray.hpp>

#include QRAY_SCENE_HEADER

#ifndef QRAY_FORMAT
#define QRAY_FORMAT Rgb888
#endif

namespace {
using namespace qray;
using Format = QRAY_FORMAT;
}

extern "C" {

uint32_t qray_width()
{
    return scene::width;
}

uint32_t qray_height()
{
    return scene::height;
}

uint32_t qray_row_bytes(uint32_t width)
{
    return row_bytes<Format>(width);
}

int qray_pixel(uint32_t x, uint32_t y, uint8_t rgb[3])
{
    if (x >= scene::width || y >= scene::height)
        return 0;
    Rgb888::put(render_pixel(scene::scene, x, y), x, y, rgb);
    return 1;
}

int qray_rect(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint8_t* out)
{
    if (x > scene::width || width > scene::width - x || y > scene::height || height > scene::height - y
        || x % Format::pixels != 0)
        return 0;
    render_rect<Format>(scene::scene, x, y, width, height, out);
    return 1;
}

uint32_t qray_rows(uint32_t first, uint32_t count, uint8_t* out)
{
    const uint32_t left = first < scene::height ? scene::height - first : 0;
    const uint32_t rows = count < left ? count : left;
    return qray_rect(0, first, scene::width, rows, out) ? rows : 0;
}
}
