// A fault ends the run with a message and status 3, never in a silent loop.
#include "board.hpp"

extern "C" {
extern uint32_t ram_begin[], stack_top[]; // sections.ld

[[noreturn]] void report_fault(const uint32_t* frame, uint32_t exception)
{
    board::say("\nqray: fault: ");
#if defined(__arm__)
    switch (exception) {
    case 2: board::say("non-maskable interrupt"); break;
    case 3: board::say("hard fault"); break;
    case 4: board::say("memory fault"); break;
    case 5: board::say("bus fault"); break;
    case 6: board::say("usage fault"); break;
    default: board::say("exception "); board::say_hex(exception);
    }
    // The core saved r0-r3, r12, lr, pc and xpsr, unless the stack had left the RAM.
    if (frame >= ram_begin && frame + 8 <= stack_top) {
        board::say(" at ");
        board::say_hex(frame[6]);
        board::say(", called from ");
        board::say_hex(frame[5]);
    } else {
        board::say(", the stack has left the RAM, it is at ");
        board::say_hex(static_cast<uint32_t>(reinterpret_cast<uintptr_t>(frame)));
    }
#if __ARM_ARCH >= 7
    board::say(", CFSR ");
    board::say_hex(board::reg(0xe000ed28));
#endif
#else
    uint32_t pc, value;
    asm volatile("csrr %0, mepc" : "=r"(pc));
    asm volatile("csrr %0, mtval" : "=r"(value));
    board::say("mcause ");
    board::say_hex(exception);
    board::say(" at ");
    board::say_hex(pc);
    board::say(", mtval ");
    board::say_hex(value);
    if (frame < ram_begin || frame > stack_top)
        board::say(", the stack has left the RAM");
#endif
    board::say("\n");
    board::stop(3);
}
}
