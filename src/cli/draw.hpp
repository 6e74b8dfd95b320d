// A picture as binary PPM, drawn by threads that take blocks of rows and written from the top.
#pragma once

#include "output.hpp"
#include "progress.hpp"
#include "renderer.hpp"

namespace qray::cli {

// Threads for a picture, this one among them: as many as asked for, or as there are processors.
uint32_t thread_count(uint32_t asked);

// The bytes do not depend on `threads`, at most max_threads. Adds up the rays. False where a write failed.
bool draw_picture(const Renderer& renderer, const Built& picture, uint32_t threads, Output& output,
                  Progress& progress, RayCounts& counts);

} // namespace qray::cli
