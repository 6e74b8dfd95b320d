// The desktop as a board: pictures go to standard output.
#include "boards/common/board.hpp"

#include <stdio.h>

namespace board {

bool open_picture(const char* header, uint32_t size) { return fwrite(header, 1, size, stdout) == size; }
bool write_picture(const uint8_t* bytes, uint32_t size) { return fwrite(bytes, 1, size, stdout) == size; }
bool close_picture() { return fflush(stdout) == 0; }
void say(const char* text) { fputs(text, stderr); }

} // namespace board
