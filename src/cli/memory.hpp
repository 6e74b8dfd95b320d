// Memory from the system, by the page: all zero, and taken only where it is touched.
#pragma once

#include "../scene/room.hpp"

namespace qray::cli {

// At least `size` bytes, in place of what the room has where that is too small. False where the system has no more.
bool make_room(scene::Room& room, size_t size);
// The same with what the room holds.
bool grow_room(scene::Room& room, size_t size);
void give_back(scene::Room& room);

// Says that there is no more memory, where a limit is set on it, and returns false; else the stack has all that it will
// ever need.
bool has_memory_to_start();

} // namespace qray::cli
