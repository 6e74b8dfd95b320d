// From the command line to a scene that is ready to be drawn or written.
#pragma once

#include "renderer.hpp"

namespace qray::cli {

// The output's name: as given, else the scene's with this suffix, else standard output. Null, and a message,
// where that is too long.
const char* output_name(const Options& options, const char* suffix);

// Reads the scene and builds it with the renderer, one of the options' number system. Warns on standard error of what was left out.
// Returns `go_on`, or the status to exit with, having printed why: also where `out` is the scene itself.
int load(const Options& options, const Renderer& renderer, const char* out, Built& built);

// What load() read.
const scene::Description& description();

} // namespace qray::cli
