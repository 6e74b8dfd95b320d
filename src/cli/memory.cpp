#include "memory.hpp"

#include <stdio.h>
#include <sys/mman.h>
#include <sys/resource.h>

namespace qray::cli {

namespace {

constexpr size_t stack_needed = 64 << 10; // twice what the deepest picture takes

[[gnu::noinline]] void touch_stack()
{
    char pages[stack_needed];
    volatile char* const below = pages;
    for (size_t i = stack_needed; i >= 4096; i -= 4096) // from the top: a stack grows downwards
        below[i - 4096] = 0;
}

} // namespace

bool make_room(scene::Room& room, size_t size)
{
    if (size <= room.size)
        return true;
    give_back(room);
    return grow_room(room, size);
}

bool grow_room(scene::Room& room, size_t size)
{
    if (size <= room.size)
        return true;
    void* const pages = room.at == nullptr ? mmap(nullptr, size, PROT_READ | PROT_WRITE,
                                                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)
                                           : mremap(room.at, room.size, size, MREMAP_MAYMOVE);
    if (pages == MAP_FAILED)
        return false;
    room = {static_cast<uint8_t*>(pages), size};
    return true;
}

void give_back(scene::Room& room)
{
    if (room.at != nullptr)
        munmap(room.at, room.size);
    room = {};
}

bool has_memory_to_start()
{
    rlimit space, data;
    if (getrlimit(RLIMIT_AS, &space) == 0 && getrlimit(RLIMIT_DATA, &data) == 0 && space.rlim_cur == RLIM_INFINITY
        && data.rlim_cur == RLIM_INFINITY)
        return true;
    scene::Room probe;
    if (!make_room(probe, 2 * stack_needed)) {
        fputs("qray: not enough memory to start\n", stderr);
        return false;
    }
    give_back(probe);
    touch_stack();
    return true;
}

} // namespace qray::cli
