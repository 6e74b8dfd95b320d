// Light that flat surfaces send one another until nothing changes (scenes/README.md, section 3): solved in double, by
// operations that are the same on every machine, for all number systems.
#pragma once

#include "description.hpp"

namespace qray::scene {

// What solving asks of its caller.
struct Solving {
    // Room for at least so many bytes, in place of what it has. False where there is no more memory.
    bool (*make_room)(Room&, size_t);
    // Calls part(work, i) for all i below count, in any order, by any number of threads.
    void (*run)(void (*part)(void* work, uint32_t i), void* work, uint32_t count, const Solving& with);
    uint32_t threads = 1; // for run() alone, as is whether it shows how much is done
    bool progress = false;
    uint32_t rays = 1800; // of a place, about
};

// Finds out the light of a scene that calls for it. Its rooms are kept for the next.
bool solve_radiosity(Description& d, const Solving& with, Error& error);

} // namespace qray::scene
