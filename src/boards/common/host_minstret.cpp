// Retired instructions, counted by the core.
#include "board.hpp"

namespace board {

void start_ticks() {}

uint64_t ticks()
{
    uint32_t high, low, again;
    do {
        asm volatile("csrr %0, minstreth" : "=r"(high));
        asm volatile("csrr %0, minstret" : "=r"(low));
        asm volatile("csrr %0, minstreth" : "=r"(again));
    } while (high != again);
    return static_cast<uint64_t>(high) << 32 | low;
}

} // namespace board
