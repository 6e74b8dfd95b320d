// How a scene is drawn: what the command line says, not the scene.
#pragma once

#include <stdint.h>

#include "vec3d.hpp"

namespace qray::scene {

struct Settings {
    uint32_t width = 0, height = 0; // 0: the scene's own
    uint32_t grid = 1;              // n x n samples a pixel
    uint32_t depth = 5;
    double cutoff = 0.0014;
    uint32_t levels = 0; // of adaptive sampling; 0: none
    double threshold = 1.0 / 16;
    uint32_t light_bits = 8; // of a colour in light maps: 2, 4 or 8
    bool compiled = false; // for a header: a tree that boards can read, and triangles in little room
    uint64_t moving = 0; // tables of a header that can be changed; see moving.hpp
    Extent within{};     // where things will be, beside where they are; empty if nothing was said
    bool bounded() const { return within.low.x <= within.high.x; }
    bool stands() const { return moving == 0 && !bounded(); }
    static constexpr uint32_t max_depth = 64;
    static constexpr uint32_t max_grid = 64;
    static constexpr uint32_t max_levels = 6;
};

} // namespace qray::scene
