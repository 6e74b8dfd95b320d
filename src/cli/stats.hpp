// What the command says of itself and of what it did.
#pragma once

#include "renderer.hpp"

namespace qray::cli {

struct Seconds {
    double reading, drawing, solving; // the light of surfaces, in reading
};

// What was in a scene and what drawing it took, one `name: value` a line.
void print_stats(const Options& options, const scene::Description& description, const Built& built,
                 uint32_t threads, const RayCounts& counts, const Seconds& seconds);

// qray --describe: what there is of each kind, as JSON, for scripts. Returns the exit status.
int describe();

} // namespace qray::cli
