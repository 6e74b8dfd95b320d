// A room of zeros for the largest scene, of which others touch little: pages that nobody touches cost nothing.
#pragma once

#include <cstdlib>

#include "../src/scene/room.hpp"

namespace qray::test {

// A description, or a number system's storage, with its room.
template <class T>
class Roomy {
    static constexpr size_t bytes = size_t{1} << 30;
    void* const memory = std::calloc(1, bytes + scene::Layout::alignment);

public:
    T at{};
    Roomy()
    {
        const uintptr_t begin = reinterpret_cast<uintptr_t>(memory), a = scene::Layout::alignment;
        at.room = {static_cast<uint8_t*>(memory) + (a - begin % a), bytes};
    }
    Roomy(const Roomy&) = delete;
    ~Roomy() { std::free(memory); }
};

// One for the whole program.
template <class T>
T& kept()
{
    static Roomy<T> roomy;
    return roomy.at;
}

} // namespace qray::test
