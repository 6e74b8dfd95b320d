#include "source.hpp"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <algorithm>

namespace qray::scene {

void Source::put(const char* text, size_t size)
{
    while (size != 0) {
        const size_t part = std::min(size, sizeof block - used);
        memcpy(block + used, text, part);
        used += part;
        text += part;
        size -= part;
        if (used == sizeof block)
            finish();
    }
}

void Source::put(const char* text) { put(text, strlen(text)); }

void Source::print(const char* format, ...)
{
    char text[512];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    put(text);
}

void Source::comment(const char* text)
{
    put("// ");
    char last = 0;
    for (; *text != 0; text++) {
        const unsigned char c = static_cast<unsigned char>(*text);
        // A control byte, or one that turns the direction of writing: U+202A to 202E, U+2066 to 2069.
        const bool turns = strncmp(text, "\xe2\x80", 2) == 0
            ? static_cast<unsigned char>(text[2]) >= 0xaa && static_cast<unsigned char>(text[2]) <= 0xae
            : strncmp(text, "\xe2\x81", 2) == 0 && static_cast<unsigned char>(text[2]) >= 0xa6
                && static_cast<unsigned char>(text[2]) <= 0xa9;
        if (turns)
            text += 2;
        last = turns || c < 0x20 || c == 0x7f ? '?' : *text;
        put(&last, 1);
    }
    put(last == '\\' ? ".\n" : "\n");
}

void Source::number(int64_t value) { print("%" PRId64, value); }

// Is it a whole number smaller than this? -0 is none.
static bool is_whole(double value, double below)
{
    return fabs(value) < below && value == floor(value) && !(value == 0 && signbit(value));
}

void Source::number(float value)
{
    const double wide = static_cast<double>(value);
    print(is_whole(wide, 0x1p24) ? "%.0f" : "%af", wide);
}

void Source::number(double value) { print(is_whole(value, 0x1p31) ? "%.0f" : "%a", value); }

bool Source::finish()
{
    good = good && write(sink, block, used);
    used = 0;
    return good;
}

} // namespace qray::scene
