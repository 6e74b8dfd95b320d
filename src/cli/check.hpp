// The truth behind a prediction: `make run` as another program, and its picture against the best one.
#pragma once

#include "../study/errors.hpp"
#include "renderer.hpp"

namespace qray::cli {

struct Truth {
    double instructions, flash, ram; // RAM with the stack
    char picture[300];
};

// Runs make with these variables, ended by a null. False, having said why, where that fails.
bool run_firmware(const char* scene, const char* const* variables, Truth& truth);

// Adds the differences between a picture file and what the renderer draws. False, having said why, where the
// file is not a picture of that size.
bool compare_picture(const char* path, const Renderer& renderer, const Built& built, study::Errors& errors);

} // namespace qray::cli
