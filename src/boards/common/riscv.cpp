// RISC-V, machine mode: reset and the way into the fault report. Interrupts stay off.
#include <stdint.h>

extern "C" {
[[noreturn]] void start();
[[noreturn, gnu::used]] void report_fault(const uint32_t* frame, uint32_t exception);

[[gnu::naked, gnu::section(".vectors"), gnu::used]] void reset()
{
    asm volatile(".option push\n\t"
                 ".option norelax\n\t" // gp is what relaxation relies on
                 "la gp, __global_pointer$\n\t"
                 ".option pop\n\t"
                 "la sp, stack_top\n\t"
                 "la t0, fault\n\t"
                 "csrw mtvec, t0\n\t"
                 "j start");
}

// The stack may be what broke, so the report starts on a fresh one. mtvec wants four-byte alignment.
[[gnu::naked, gnu::used, gnu::aligned(4)]] void fault()
{
    asm volatile("mv a0, sp\n\t"
                 "csrr a1, mcause\n\t"
                 "la sp, stack_top\n\t"
                 "j report_fault");
}
}
