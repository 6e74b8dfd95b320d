// A room of zeros for the largest scene, of which others touch little: pages that nobody touches cost nothing.
#pragma once

#include <cstdlib>

#include <sys/mman.h>

#include "../src/scene/room.hpp"

namespace qray::test {

// A description, or a number system's storage, with its room. It is the system's own memory: to tell the address
// sanitizer of a gigabyte takes a tenth of a second.
template <class T>
class Roomy {
    static constexpr size_t bytes = size_t{1} << 30, guard = 1 << 16; // which nobody may touch
    void* const memory =
        mmap(nullptr, bytes + guard, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);

public:
    T at{};
    Roomy()
    {
        uint8_t* const begin = static_cast<uint8_t*>(memory);
        if (memory == MAP_FAILED || mprotect(begin + bytes, guard, PROT_NONE) != 0)
            std::abort();
        at.room = {begin, bytes};
    }
    Roomy(const Roomy&) = delete;
    ~Roomy() { munmap(memory, bytes + guard); }
};

// One for the whole program.
template <class T>
T& kept()
{
    static Roomy<T> roomy;
    return roomy.at;
}

} // namespace qray::test
