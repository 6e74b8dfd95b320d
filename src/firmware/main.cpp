// Draws one picture and ends: the compiled scene QRAY_SCENE_HEADER, or, without one, the test card. The same
// on every board and for every way out; src/boards gives both.
#include "boards/common/board.hpp"
#include "firmware/ppm.hpp"

#ifdef QRAY_SCENE_HEADER
#include <qray/qray.hpp>

#include QRAY_SCENE_HEADER
#else
#include "firmware/test_card.hpp"
#endif

// Where there are registers for numbers of floating point, a function that is called once had better
// not save them again.
#ifdef __ARM_FP
#define QRAY_FLATTEN __attribute__((flatten))
#else
#define QRAY_FLATTEN
#endif

int main()
{
    static uint8_t row[3 * scene::width];
    static constexpr auto header = ppm_header<scene::width, scene::height>();
    if (!board::open_picture(header.text, header.size))
        return 1;
    const auto sink = [](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {
        return board::write_picture(rgb, bytes);
    };
#ifndef QRAY_SCENE_HEADER
    const bool whole = test_card::render(row, sink);
#else
    const auto draw = [&]() QRAY_FLATTEN { return qray::render<qray::Rgb888>(scene::scene, row, 1, sink); };
    const bool whole = draw();
#endif
    return whole && board::close_picture() ? 0 : 1;
}
