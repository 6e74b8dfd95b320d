#include "board.hpp"

namespace board {

void say_decimal(uint64_t value)
{
    static constexpr uint64_t powers[] = {
        10'000'000'000'000'000'000u, 1'000'000'000'000'000'000u, 100'000'000'000'000'000u,
        10'000'000'000'000'000u, 1'000'000'000'000'000u, 100'000'000'000'000u, 10'000'000'000'000u,
        1'000'000'000'000u, 100'000'000'000u, 10'000'000'000u, 1'000'000'000u, 100'000'000u, 10'000'000u,
        1'000'000u, 100'000u, 10'000u, 1'000u, 100u, 10u, 1u};
    char text[21];
    uint32_t size = 0;
    for (uint64_t power : powers) {
        char digit = '0';
        for (; value >= power; value -= power)
            ++digit;
        if (digit != '0' || size != 0 || power == 1)
            text[size++] = digit;
    }
    text[size] = 0;
    say(text);
}

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
