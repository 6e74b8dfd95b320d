// Ticks of SysTick, at the core's clock. It has 24 bits; an interrupt carries the rest, at a cost of some ten
// instructions in 16.8 million ticks. The counter is never restarted, so what a reading cuts off the next one
// gives back, and a sum over many rows is as exact as one reading.
#include "board.hpp"

namespace {
constexpr uint32_t control = 0xe000e010, reload = 0xe000e014, value = 0xe000e018, pending = 0xe000ed04;
volatile uint32_t wraps;
}

extern "C" void systick()
{
    wraps = wraps + 1;
}

namespace board {

void start_ticks()
{
    reg(reload) = 0xff'ffff;
    reg(value) = 0;   // any write clears it
    reg(control) = 7; // core clock, interrupt, on
}

uint64_t ticks()
{
    uint32_t high, low;
    do {
        high = wraps;
        low = (0u - reg(value)) & 0xff'ffff; // it counts down, and the interrupt comes at 0
    } while (high != wraps || (reg(pending) & 1u << 26) != 0);
    return static_cast<uint64_t>(high) << 24 | low;
}

} // namespace board
