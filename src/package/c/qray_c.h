/* A scene for programs in C, or in C++ before C++20: the object that `make object`, or qray_object() of the CMake
   package, makes of it. It allocates nothing and holds no state, but for what moves, below; any number of threads may
   draw at once. It wants of the linker memcpy, memset and the compiler's own library (libgcc), nothing of C++. */
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

/* What follows is there in an object that was made with MOVING=..., and is called while nothing draws. Coordinates,
   sizes and factors are in 1/65536: QRAY_ONE is one of the scene's units. 2^32 of an angle are a whole turn. */
#define QRAY_ONE 65536

/* n/d of a whole turn, for d from 1 to 65536. */
uint32_t qray_turn(uint32_t n, uint32_t d);

/* Turns the camera at `eye` towards `at`; `field` is the whole vertical one, or 0 for the text's. False, and nothing
   changes, where the eye leaves the scene's frame (WITHIN=...) or is where `at` is, `up` lies along the view, or the
   field is half a turn or more. */
int qray_look_at(const int32_t eye[3], const int32_t at[3], const int32_t up[3], uint32_t field);

/* How things move: turned by `angle` about an axis, counter-clockwise seen from where that points, and scaled by a
   factor (0 leaves the size), both about a place; then shifted. Always from where they are in the text, so that no
   error adds up: what is all 0 puts them back there. */
typedef struct {
    int32_t about[3];
    int32_t axis[3];
    uint32_t angle;
    int32_t scale;
    int32_t shift[3];
} qray_motion;

/* Moves `count` things of a kind, or those to the last, from number `first` on, as the compiled scene numbers them.
   Returns how many were moved: it ends at one that would leave the frame, which stays where it is. 0 where that kind
   does not move. Of a patch each triangle counts. */
uint32_t qray_move_spheres(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_discs(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_cones(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_polygons(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_patches(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_lights(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_suns(uint32_t first, uint32_t count, const qray_motion* motion);
uint32_t qray_move_panels(uint32_t first, uint32_t count, const qray_motion* motion);

/* What the text has as `s`, `l` and `sun`, with these numbers; the colour of a material, each part from 0 to QRAY_ONE.
   False, and nothing changes, where that cannot be or does not move. */
int qray_place_sphere(uint32_t number, const int32_t centre[3], int32_t radius);
int qray_place_light(uint32_t number, const int32_t at[3]);
int qray_place_sun(uint32_t number, const int32_t from[3]);
int qray_paint(uint32_t material, const int32_t colour[3]);

/* After shapes have moved, before a picture. */
void qray_refit(void);

#ifdef __cplusplus
}
#endif

#endif
