// Memory that a caller hands in, and how arrays are cut from it.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include <type_traits>

namespace qray::scene {

// All zero or left by an earlier use; aligned to Layout::alignment.
struct Room {
    uint8_t* at = nullptr;
    size_t size = 0;
};

// Arrays one behind another. From null it only adds up what they take.
class Layout {
public:
    static constexpr size_t alignment = 64;
    explicit Layout(uint8_t* at) : base(at) {}

    template <class T>
    T* array(size_t count)
    {
        static_assert(alignof(T) <= alignment && std::is_trivially_copyable_v<T>);
        T* const here = base == nullptr ? nullptr : reinterpret_cast<T*>(base + taken);
        taken += (count * sizeof(T) + alignment - 1) / alignment * alignment;
        return here;
    }
    size_t used() const { return taken; }

private:
    uint8_t* base;
    size_t taken = 0;
};

// Runs cut(Layout&) over the room where it is large enough, else over none; returns how many bytes are needed.
template <class Cut>
size_t lay_out_in(const Room& room, Cut cut)
{
    Layout needed(nullptr);
    cut(needed);
    if (Layout layout(room.at); needed.used() <= room.size)
        cut(layout);
    return needed.used();
}

} // namespace qray::scene
