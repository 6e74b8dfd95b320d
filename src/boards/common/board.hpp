// What a board gives the firmware. An image has one implementation of each function, chosen at link time:
// host_semihosting.cpp (a file on the host, and measurements), or output_uart.cpp (a real board).
// Objects named host_* hold what only an emulated or debugged run needs; the linker script puts them in
// sections of their own, and reports of size leave them out.
#pragma once

#include <stdint.h>

namespace board {

// Starts the picture with its header. False where the host's file cannot be opened or written.
bool open_picture(const char* header, uint32_t size);

// Sends `size` bytes of the picture, and returns once they may be overwritten. Instructions spent in here
// are not counted. False where they cannot be written.
bool write_picture(const uint8_t* bytes, uint32_t size);

// Ends the picture; in a measured image, reports stack and instructions as `name: value` lines.
bool close_picture();

// Messages; numbers in hexadecimal, without a division, so that no helper of the compiler is linked for them.
void say(const char* text);
void say_hex(uint32_t value);

// Ends the run: with this exit status under semihosting, else by sleeping.
[[noreturn]] void stop(int status);

// Instructions since start-up, in units of the board's BOARD_TICK (board.mk); measured images only.
void start_ticks();
uint64_t ticks();

// The board's serial port, 115200 baud 8N1, no interrupts; images for real boards only.
void open_uart();
void put_uart(uint8_t byte); // waits until the port takes it

// A device register.
inline volatile uint32_t& reg(uint32_t address)
{
    return *reinterpret_cast<volatile uint32_t*>(address);
}

} // namespace board
