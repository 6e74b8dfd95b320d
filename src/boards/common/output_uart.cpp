// The board's output without a debugger: picture and messages leave by the serial port.
#include "board.hpp"

namespace board {

bool open_picture(const char* header, uint32_t size)
{
    open_uart();
    return write_picture(reinterpret_cast<const uint8_t*>(header), size);
}

bool write_picture(const uint8_t* bytes, uint32_t size)
{
    for (uint32_t i = 0; i != size; ++i)
        put_uart(bytes[i]);
    return true;
}

bool close_picture()
{
    return true;
}

void say(const char* text)
{
    for (; *text != 0; ++text)
        put_uart(static_cast<uint8_t>(*text));
}

void stop(int status)
{
    if (status != 0)
        say("qray: stopped\n");
    for (;;)
        asm volatile("wfi");
}

} // namespace board
