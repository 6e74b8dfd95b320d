// nRF51 UART0 on the micro:bit's USB interface chip (nRF51 Series Reference Manual 3.0, chapters 13, 14, 29).
#include "board.hpp"

namespace board {
namespace {
constexpr uint32_t clock = 0x4000'0000, uart = 0x4000'2000, gpio = 0x5000'0000;
constexpr uint32_t transmit_pin = 24;
}

void open_uart()
{
    reg(clock + 0x000) = 1; // HFCLKSTART: the crystal, as the RC oscillator is too inexact for 115200 baud
    while (reg(clock + 0x100) == 0) {
    }
    reg(gpio + 0x508) = 1u << transmit_pin; // OUTSET: idle is high
    reg(gpio + 0x518) = 1u << transmit_pin; // DIRSET
    reg(uart + 0x50c) = transmit_pin;       // PSELTXD
    reg(uart + 0x524) = 0x01d7'e000;        // BAUDRATE: 115200
    reg(uart + 0x500) = 4;                  // ENABLE
    reg(uart + 0x008) = 1;                  // STARTTX
}

void put_uart(uint8_t byte)
{
    reg(uart + 0x11c) = 0; // TXDRDY
    reg(uart + 0x51c) = byte;
    while (reg(uart + 0x11c) == 0) {
    }
}

} // namespace board
