// Hundreds of megabytes of zeros, of which a scene touches little: pages that nobody touches cost nothing, and the
// program's file does not hold them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace qray::test {

template <class T>
class Zeroed {
    void* const memory = std::calloc(1, sizeof(T) + alignof(T)); // aligned for less than vectors may ask

public:
    T* const at = reinterpret_cast<T*>((reinterpret_cast<uintptr_t>(memory) + alignof(T) - 1) & ~(alignof(T) - 1));
    Zeroed() = default;
    Zeroed(const Zeroed&) = delete;
    ~Zeroed() { std::free(memory); }
};

template <class T>
T& kept()
{
    static const Zeroed<T> zeroed;
    return *zeroed.at;
}

} // namespace qray::test
