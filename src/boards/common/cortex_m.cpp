// Cortex-M: the vector table and the way into the fault report. No interrupt is enabled but SysTick in
// measured images, so the table ends with the system exceptions.
#include <stdint.h>

extern "C" {
extern uint32_t stack_top[]; // sections.ld
[[noreturn]] void start();
[[noreturn, gnu::used]] void report_fault(const uint32_t* frame, uint32_t exception);

// The report needs a stack: what is below the frame that the core saved, or, where the stack has left the
// RAM, a fresh one.
[[gnu::naked]] void fault()
{
    asm volatile("mrs r0, msp\n\t"
                 "mrs r1, ipsr\n\t"
                 "ldr r2, =stack_top\n\t"
                 "ldr r3, =ram_begin + 256\n\t"
                 "cmp r0, r2\n\t"
                 "bhi 1f\n\t"
                 "cmp r0, r3\n\t"
                 "bhs 2f\n"
                 "1:\tmov sp, r2\n"
                 "2:\tldr r2, =report_fault\n\t"
                 "bx r2\n\t"
                 ".ltorg");
}

[[gnu::weak, gnu::alias("fault")]] void systick() noexcept; // host_systick.cpp, where it is linked
}

namespace {
union Vector {
    uint32_t* stack;
    void (*handler)();
};
[[gnu::section(".vectors"), gnu::used]] const Vector vectors[16] = {
    {.stack = stack_top}, {.handler = start}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault}, {.handler = fault},
    {.handler = fault},   {.handler = fault}, {.handler = fault}, {.handler = systick},
};
}
