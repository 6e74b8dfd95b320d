// Ends in a fault after the picture's header.
#include "boards/common/board.hpp"

int main()
{
    if (!board::open_picture("P6\n1 1\n255\n", 11))
        return 1;
#if defined(JUMP)
    auto nowhere = reinterpret_cast<void (*)()>(0x3000'0000);
    asm volatile("" : "+r"(nowhere));
    nowhere();
#elif defined(STATUS)
    return 7;
#elif defined(__arm__)
    asm volatile("udf #0");
#else
    asm volatile("unimp");
#endif
    return 0;
}
