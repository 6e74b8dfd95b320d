// What a compiler may call for copies and fills, even freestanding. Words where both ends are aligned.
// Built with -fno-tree-loop-distribute-patterns, or each would be compiled to a call of itself.
#include <stddef.h>
#include <stdint.h>

namespace {
using Word [[gnu::may_alias]] = uint32_t;

bool aligned(const void* a, const void* b)
{
    return ((reinterpret_cast<uintptr_t>(a) | reinterpret_cast<uintptr_t>(b)) & 3) == 0;
}
}

extern "C" {
void* memcpy(void* __restrict to, const void* __restrict from, size_t size)
{
    auto* d = static_cast<uint8_t*>(to);
    auto* s = static_cast<const uint8_t*>(from);
    if (aligned(d, s))
        for (; size >= 4; size -= 4, d += 4, s += 4)
            *reinterpret_cast<Word*>(d) = *reinterpret_cast<const Word*>(s);
    for (; size != 0; --size)
        *d++ = *s++;
    return to;
}

void* memmove(void* to, const void* from, size_t size)
{
    auto* d = static_cast<uint8_t*>(to);
    auto* s = static_cast<const uint8_t*>(from);
    if (reinterpret_cast<uintptr_t>(d) <= reinterpret_cast<uintptr_t>(s))
        return memcpy(to, from, size); // ours goes upwards
    for (; size != 0; --size)
        d[size - 1] = s[size - 1];
    return to;
}

void* memset(void* to, int value, size_t size)
{
    auto* d = static_cast<uint8_t*>(to);
    const auto byte = static_cast<uint8_t>(value);
    if (aligned(d, d))
        for (; size >= 4; size -= 4, d += 4)
            *reinterpret_cast<Word*>(d) = byte * 0x0101'0101u;
    for (; size != 0; --size)
        *d++ = byte;
    return to;
}

int memcmp(const void* left, const void* right, size_t size)
{
    auto* a = static_cast<const uint8_t*>(left);
    auto* b = static_cast<const uint8_t*>(right);
    for (; size != 0; --size, ++a, ++b)
        if (*a != *b)
            return *a < *b ? -1 : 1;
    return 0;
}
}
