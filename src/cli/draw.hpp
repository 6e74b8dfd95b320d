// A picture as binary PPM, drawn by threads that take blocks of rows and written from the top.
#pragma once

#include "../scene/radiosity.hpp"
#include "output.hpp"
#include "renderer.hpp"

namespace qray::cli {

// Seconds on a clock that never jumps.
double now();

// Threads for a picture, this one among them: as many as asked for, or as there are processors.
uint32_t thread_count(uint32_t asked);

// As Solving has it.
void run_in_threads(void (*part)(void* work, uint32_t i), void* work, uint32_t count, const scene::Solving& with);

// The bytes do not depend on `threads`, at most max_threads. Adds up the rays. False where a write failed. Shows how
// much is done, and the time left, on standard error where that is asked for.
bool draw_picture(const Renderer& renderer, const Built& picture, uint32_t threads, Output& output, bool progress,
                  RayCounts& counts);

} // namespace qray::cli
