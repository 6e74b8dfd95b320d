// UART0 of a Stellaris LM3S6965 on pin PA1, at the board's crystal of 8 MHz (its data sheet, chapters 6, 9, 13).
#include "board.hpp"

namespace board {
namespace {
constexpr uint32_t uart = 0x4000'c000, pins = 0x4000'4000, system = 0x400f'e000;
}

void open_uart()
{
    reg(system + 0x060) = 0x078e'3b80; // RCC: the crystal, undivided, no PLL
    for (uint32_t i = 0; i != 200'000; ++i)
        asm volatile(""); // until it swings
    reg(system + 0x104) = 1; // RCGC1: UART0
    reg(system + 0x108) = 1; // RCGC2: port A
    asm volatile("nop\n\tnop\n\tnop");
    reg(pins + 0x420) = 2; // AFSEL
    reg(pins + 0x51c) = 2; // DEN
    reg(uart + 0x24) = 4;  // IBRD, FBRD: 8 MHz / (16 * 115200) = 4 + 22/64
    reg(uart + 0x28) = 22;
    reg(uart + 0x2c) = 0x70;  // LCRH: 8 bits, FIFO
    reg(uart + 0x30) = 0x101; // CTL: on, transmit
}

void put_uart(uint8_t byte)
{
    while ((reg(uart + 0x18) & 1u << 5) != 0) { // FR: transmit FIFO full
    }
    reg(uart + 0x00) = byte;
}

} // namespace board
