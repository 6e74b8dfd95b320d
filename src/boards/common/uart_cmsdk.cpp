// CMSDK APB UART 0 of the MPS2 images (Arm Cortex-M System Design Kit TRM, 4.3; AN385, 4.2: 25 MHz).
#include "board.hpp"

namespace board {
namespace {
constexpr uint32_t uart = 0x4000'4000;
}

void open_uart()
{
    reg(uart + 0x10) = 25'000'000 / 115'200; // BAUDDIV
    reg(uart + 0x08) = 1;                    // CTRL: transmit
}

void put_uart(uint8_t byte)
{
    while ((reg(uart + 0x04) & 1) != 0) { // STATE: transmit buffer full
    }
    reg(uart + 0x00) = byte;
}

} // namespace board
