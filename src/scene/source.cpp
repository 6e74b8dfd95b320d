#include "source.hpp"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

namespace qray::scene {

void Source::put(const char* text, size_t size)
{
    while (size != 0) {
        const size_t room = sizeof block_ - used_;
        const size_t part = size < room ? size : room;
        memcpy(block_ + used_, text, part);
        used_ += part;
        text += part;
        size -= part;
        if (used_ == sizeof block_)
            finish();
    }
}

void Source::put(const char* text)
{
    put(text, strlen(text));
}

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

void Source::number(int64_t value)
{
    print("%" PRId64, value);
}

void Source::number(float value)
{
    const double wide = static_cast<double>(value);
    if (fabs(wide) < 0x1p24 && wide == floor(wide) && !(wide == 0 && signbit(wide)))
        print("%.0f", wide);
    else
        print("%af", wide);
}

void Source::number(double value)
{
    if (fabs(value) < 0x1p31 && value == floor(value) && !(value == 0 && signbit(value)))
        print("%.0f", value);
    else
        print("%a", value);
}

bool Source::finish()
{
    good_ = good_ && write_(to_, block_, used_);
    used_ = 0;
    return good_;
}

} // namespace qray::scene
