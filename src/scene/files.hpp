// Files that a scene names, as whoever has the scene's text hands them to the parser.
#pragma once

#include "room.hpp"

namespace qray::scene {

// Bytes in a room that grows.
struct Bytes {
    Room room;
    size_t size = 0;
};

struct Files {
    // Appends to `to` what stands in the file at `path`; of one that is longer, its first `most` + 1 bytes. What is
    // there may move. Null, or what is wrong: "No such file or directory".
    const char* (*append)(const char* path, size_t most, Bytes& to);
    // At least `size` bytes, with what the room holds. False where there is no more memory.
    bool (*grow)(Room& room, size_t size);
};

} // namespace qray::scene
