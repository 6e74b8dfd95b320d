// C++ source text, written a piece at a time.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace qray::scene {

class Source {
public:
    // write(to, bytes, size) takes the text in blocks. Where it returns false, it is not called again.
    using Write = bool (*)(void* to, const char* bytes, size_t size);
    Source(Write how, void* to) : write(how), sink(to) {}
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    void put(const char* text);
    [[gnu::format(printf, 2, 3)]] void print(const char* format, ...);

    // Text from outside as a line of comment: nothing in it ends the line or goes on in the next.
    void comment(const char* text);

    // Literals that stand for exactly this value: whole ones in decimal, others in hexadecimal.
    void number(int64_t value);
    void number(float value);
    void number(double value);

    // False where some of the text could not be written.
    bool finish();

private:
    void put(const char* text, size_t size);

    Write write;
    void* sink;
    bool good = true;
    size_t used = 0;
    char block[4096];
};

} // namespace qray::scene
