/* A scene for programs in C, or in C++ before C++20: the object that `make object`, or qray_object() of the CMake
   package, makes of it. It holds no state and allocates nothing; any number of threads may draw at once. It wants of
   the linker memcpy, memset and the compiler's own library (libgcc), nothing of C++. */
#ifndef QRAY_C_H
#define QRAY_C_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Size of the picture in pixels; bytes of a row of `width` pixels in the object's format (FORMAT, else Rgb888). */
uint32_t qray_width(void);
uint32_t qray_height(void);
uint32_t qray_row_bytes(uint32_t width);

/* Pixel (x, y), from the left and the top: red, green, blue, from 0 to 255. False, and nothing written, outside. */
int qray_pixel(uint32_t x, uint32_t y, uint8_t rgb[3]);

/* Rows first ... first + count - 1, or to the last, one after another. Returns how many were drawn. */
uint32_t qray_rows(uint32_t first, uint32_t count, uint8_t* out);

/* A rectangle with corner (x, y), rows of qray_row_bytes(width) bytes. x is a multiple of the pixels that share bytes.
   False, and nothing written, where that is not so or it reaches out of the picture. */
int qray_rect(uint32_t x, uint32_t y, uint32_t width, uint32_t height, uint8_t* out);

#ifdef __cplusplus
}
#endif

#endif
