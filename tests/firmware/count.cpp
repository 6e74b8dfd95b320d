// A picture of one row whose instructions are known: LOOPS times around a loop of three, LOOPS
// coming by way of .data. With DEEP, also a
// frame of 400 bytes, touched at its far end.
#include "boards/common/board.hpp"

#ifdef DEEP
[[gnu::noinline]] static void deep()
{
    volatile uint8_t frame[400];
    frame[0] = 1;
    static_cast<void>(frame[0]);
}
#endif

static volatile uint32_t loops_in_ram = LOOPS;

int main()
{
    static uint8_t row[3] = {};
    if (!board::open_picture("P6\n1 1\n255\n", 11))
        return 1;
    uint32_t loops = loops_in_ram;
#if defined(__arm__)
    asm volatile(".syntax unified\n1:\tnop\n\tsubs %0, %0, #1\n\tbne 1b" : "+l"(loops)::"cc");
#else
    asm volatile("1:\tnop\n\taddi %0, %0, -1\n\tbnez %0, 1b" : "+r"(loops));
#endif
#ifdef DEEP
    deep();
#endif
    return board::write_picture(row, sizeof row) && board::close_picture() ? 0 : 1;
}
