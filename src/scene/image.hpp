// Images beside a scene: BMP of 24 bits a pixel, its rows from either end, and binary PPM.
#pragma once

#include "description.hpp"

namespace qray::scene {

// Of a file of `size` bytes its pixels, in its place: red, green and blue in 255ths, row by row from the bottom, and
// its edges into `out`. False, and what the file is instead.
bool decode_image(uint8_t* file, size_t size, ImageSource& out, char (&fault)[100]);

} // namespace qray::scene
