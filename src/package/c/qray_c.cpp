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

#ifdef QRAY_MOVING
// What a scene has not, or does not move: the names in its namespace hide these.
struct Still {};
#define STILL(Type, name, table) [[maybe_unused]] constexpr Still first_##table{}, table{};
QRAY_TABLES(STILL)
#undef STILL
[[maybe_unused]] void refit() {}

template <class T>
concept Moves = requires(const T& table) { table.data; };
template <class T>
constexpr auto data_of([[maybe_unused]] T& table)
{
    if constexpr (Moves<T>)
        return &table.data[0];
    else
        return nullptr;
}
#endif
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

#ifdef QRAY_MOVING
uint32_t qray_turn(uint32_t n, uint32_t d)
{
    return part_of_turn(n, d);
}
#endif
}

#ifdef QRAY_MOVING
namespace scene {
namespace {

template <class N = Number>
Coordinate<N> coordinate_of(int32_t v)
{
    if constexpr (N::is_fixed)
        return {v};
    else
        return static_cast<Coordinate<N>>(v) / QRAY_ONE;
}
ScenePoint<Number> place_of(const int32_t* v)
{
    return {coordinate_of(v[0]), coordinate_of(v[1]), coordinate_of(v[2])};
}

template <class First, class Now>
uint32_t moved([[maybe_unused]] const First& at_first, [[maybe_unused]] Now& now, [[maybe_unused]] uint32_t first,
               [[maybe_unused]] uint32_t count, [[maybe_unused]] const qray_motion& m)
{
    uint32_t done = 0;
    if constexpr (Moves<First>) {
        Motion<Number> motion(frame);
        motion.about(place_of(m.about)).shift(place_of(m.shift));
        if (m.angle != 0)
            motion.turn(place_of(m.axis), m.angle);
        if (m.scale != 0)
            motion.scale(coordinate_of(m.scale));
        for (; done < count && first < at_first.count; done++, first++) {
            const auto& from = at_first[first];
            bool moves;
            if constexpr (requires { move(from, motion, now[first]); })
                moves = move(from, motion, now[first]);
            else
                moves = move(from, Corners<Number>{data_of(first_vertices), data_of(first_normals)}, motion, now[first],
                             MovedCorners<Number>{data_of(vertices), data_of(normals)});
            if (!moves)
                break;
        }
    }
    return done;
}

// Whether change(row) did, of a row that there is and that moves.
template <class First, class Now, class F>
int changed([[maybe_unused]] const First& at_first, [[maybe_unused]] Now& now, [[maybe_unused]] uint32_t number,
            [[maybe_unused]] F change)
{
    if constexpr (Moves<First>)
        if (number < at_first.count)
            return change(now[number]);
    return 0;
}

} // namespace

extern "C" {

int qray_look_at(const int32_t* eye, const int32_t* at, const int32_t* up, uint32_t angle)
{
    const Field<Number> of = angle == 0 ? view.field : field<Number>(angle);
    return look_at(camera, frame, {place_of(eye), place_of(at), place_of(up), of});
}

#define MOVE(table) \
    uint32_t qray_move_##table(uint32_t first, uint32_t count, const qray_motion* motion) \
    { \
        return moved(first_##table, table, first, count, *motion); \
    }
MOVE(spheres)
MOVE(discs)
MOVE(cones)
MOVE(polygons)
MOVE(patches)
MOVE(lights)
MOVE(suns)
MOVE(panels)
#undef MOVE

int qray_place_sphere(uint32_t number, const int32_t* centre, int32_t radius)
{
    return changed(first_spheres, spheres, number,
                   [=](auto& s) { return place(s, frame, place_of(centre), coordinate_of(radius)); });
}

int qray_place_light(uint32_t number, const int32_t* at)
{
    return changed(first_lights, lights, number, [at](auto& l) { return place(l, frame, place_of(at)); });
}

int qray_place_sun(uint32_t number, const int32_t* from)
{
    return changed(first_suns, suns, number, [from](auto& s) { return place(s, place_of(from)); });
}

int qray_paint(uint32_t material, const int32_t* colour)
{
    return changed(first_mattes, mattes, material, [colour](auto& m) { return paint(m, place_of(colour)); });
}

void qray_refit()
{
    refit();
}
}
} // namespace scene
#endif
