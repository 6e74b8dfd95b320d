// A number system as the page sees it.
#pragma once

#include "../cli/renderer.hpp"

namespace qray::page {

struct Kernel {
    const char* name; // as cli::number_names has it
    bool (*build)(const scene::Description&, const scene::Settings&, cli::Built&, scene::Error&);
    // Pixels x, x + stride and so on of row y of the scene that was built last, `count` of them, into rgb.
    void (*pixels)(uint32_t x, uint32_t y, uint32_t stride, uint32_t count, uint8_t* rgb, cli::RayCounts& rays);
};

} // namespace qray::page
