// How much is done, and the time left, in one line on standard error that is wiped at the end.
#pragma once

#include <stdint.h>

namespace qray::cli {

// Seconds on a clock that never jumps.
double now();

class Progress {
public:
    explicit Progress(bool shown) : shown_(shown), start_(shown ? now() : 0), next_(start_ + 0.5) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() { wipe(); }

    void update(uint32_t done, uint32_t total);
    void wipe();

private:
    bool shown_, dirty_ = false;
    double start_, next_;
};

} // namespace qray::cli
