// A file that appears whole or not at all: written under another name in its folder, and renamed at the end.
#pragma once

#include <stddef.h>

namespace qray::cli {

// To be called first: what is not committed is removed by every signal that would end this process and can be caught.
// What is ignored stays so, as nohup has it. A write to a closed pipe, or beyond a limit, fails like any other.
void catch_signals();

// One at a time. Where a function returns false, report() says why, in one line on standard error. What is not
// committed is removed at the end, also where the program is interrupted.
class Output {
public:
    Output() = default;
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;
    ~Output();

    // `name` must outlive this. "-" is standard output; what is no regular file is written as it stands.
    bool open(const char* name);
    bool write(const void* bytes, size_t size);
    bool commit();
    bool fail(const char* what, int error); // "cannot `what`: ", with the error's text; returns false
    int report() const; // 1

private:
    const char* shown = nullptr;
    const char* action = "";
    int reason = 0;
    int file = -1;
};

} // namespace qray::cli
