// NS16550A of QEMU's RISC-V virt machine, byte-wide registers, 3.6864 MHz (National Semiconductor PC16550D).
#include "board.hpp"

namespace board {
namespace {
volatile uint8_t& port(uint32_t offset)
{
    return *reinterpret_cast<volatile uint8_t*>(0x1000'0000 + offset);
}
}

void open_uart()
{
    port(1) = 0;    // no interrupts
    port(3) = 0x83; // divisor latch, 8 bits, no parity, one stop bit
    port(0) = 2;    // 3686400 / 16 / 115200
    port(1) = 0;
    port(3) = 0x03;
    port(2) = 1; // FIFO
}

void put_uart(uint8_t byte)
{
    while ((port(5) & 0x20) == 0) { // transmit holding register empty
    }
    port(0) = byte;
}

} // namespace board
