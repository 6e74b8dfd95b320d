// The scene's text, from a file or from standard input.
#pragma once

#include "../scene/description.hpp"

namespace qray::cli {

// Reads and parses the scene at `path` ("-": standard input). False, and one line in `error`, where there is none.
bool read_scene(const char* path, scene::Description& description, scene::Error& error);

// Is `path` ("-": standard output) the very file that read_scene() read?
bool is_scene_file(const char* path);

} // namespace qray::cli
