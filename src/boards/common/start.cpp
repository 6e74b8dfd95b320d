// From reset to main, on every core: the stack pointer is set, nothing else is.
#include "board.hpp"

int main();

extern "C" {
extern uint32_t data_begin[], data_end[], bss_begin[], bss_end[]; // sections.ld
extern const uint32_t data_image[];

[[noreturn]] void start()
{
#if defined(__ARM_FP)
    board::reg(0xe000ed88) |= 0xfu << 20; // CPACR: full access to coprocessors 10 and 11, the FPU
    asm volatile("dsb\n\tisb" ::: "memory");
#endif
    const uint32_t* from = data_image;
    for (uint32_t* to = data_begin; to != data_end; ++to, ++from) {
        *to = *from;
        asm volatile("" ::: "memory"); // a loop, not a call of memcpy, which may not be linked at all
    }
    for (uint32_t* to = bss_begin; to != bss_end; ++to) {
        *to = 0;
        asm volatile("" ::: "memory");
    }
    board::stop(main());
}
}
