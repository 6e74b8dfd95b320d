#include "progress.hpp"

#include <stdio.h>
#include <time.h>

namespace qray::cli {

double now()
{
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void Progress::update(uint32_t done, uint32_t total)
{
    if (!shown_)
        return;
    const double time = now();
    if (time < next_ || done == 0)
        return;
    next_ = time + 0.2;
    dirty_ = true;
    const unsigned long left = static_cast<unsigned long>((time - start_) / done * (total - done) + 0.5);
    fprintf(stderr, "\r%3u %%, ", static_cast<unsigned>(uint64_t{100} * done / total));
    if (left < 60)
        fprintf(stderr, "%lu s left   ", left);
    else if (left < 3600)
        fprintf(stderr, "%lu min %lu s left   ", left / 60, left % 60);
    else
        fprintf(stderr, "%lu h %lu min left   ", left / 3600, left / 60 % 60);
}

void Progress::wipe()
{
    if (dirty_)
        fputs("\r                                \r", stderr);
    dirty_ = false;
}

} // namespace qray::cli
