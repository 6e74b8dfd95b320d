#include "board.hpp"

namespace board {

void say_hex(uint32_t value)
{
    char text[11]; // no initialiser, for which a compiler may link memset
    text[0] = '0';
    text[1] = 'x';
    for (uint32_t i = 0; i != 8; ++i)
        text[2 + i] = "0123456789abcdef"[value >> (28 - 4 * i) & 15];
    text[10] = 0;
    say(text);
}

} // namespace board
