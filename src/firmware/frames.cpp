// Draws the frames of an animation, one picture behind another, and ends: the compiled scene QRAY_SCENE_HEADER as
// QRAY_ANIMATION moves it. The same on every board, and on the desktop with desktop.cpp.
#include "boards/common/board.hpp"
#include "firmware/ppm.hpp"

#include <qray/qray.hpp>

#include QRAY_SCENE_HEADER
#include QRAY_ANIMATION

int main()
{
    static uint8_t row[3 * scene::width];
    static constexpr auto header = ppm_header<scene::width, scene::height>();
    const auto sink = [](uint32_t, uint32_t, const uint8_t* rgb, uint32_t bytes) {
        return board::write_picture(rgb, bytes);
    };
    for (uint32_t frame = 0; frame != QRAY_FRAMES; frame++) {
        if (!(frame == 0 ? board::open_picture(header.text, header.size)
                         : board::write_picture(reinterpret_cast<const uint8_t*>(header.text), header.size)))
            return 1;
        if (!animate(frame, QRAY_FRAMES)) {
            board::say("qray: a move that leaves the scene's frame was refused; expected WITHIN=x,y,z,x,y,z, two "
                       "corners of a box around all that will be\n");
            return 1;
        }
        if (!qray::render<qray::Rgb888>(scene::scene, row, 1, sink))
            return 1;
    }
    return board::close_picture() ? 0 : 1;
}
