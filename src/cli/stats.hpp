// What was in a scene and what drawing it took, one `name: value` a line.
#pragma once

#include "renderer.hpp"

namespace qray::cli {

struct Seconds {
    double reading, drawing;
};

void print_stats(const Options& options, const scene::Description& description, const Built& built,
                 uint32_t threads, const RayCounts& counts, const Seconds& seconds);

} // namespace qray::cli
