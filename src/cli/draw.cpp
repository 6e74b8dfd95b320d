#include "draw.hpp"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <time.h>

#include <algorithm>
#include <atomic>

namespace qray::cli {

namespace {

// Rows wait in slots until all above them are written: at least one of the widest picture for each thread.
constexpr size_t pool_bytes = size_t{max_threads} * scene::Limits::resolution * 3;
constexpr uint32_t max_slots = 4096;
constexpr size_t stack_bytes = 256 << 10; // of a thread: an eighth is used, and more where sanitizers look on

// How much is done, and the time left, in one line on standard error that is wiped at the end.
class Progress {
public:
    explicit Progress(bool wanted) : shown(wanted), start(wanted ? now() : 0), next(start + 0.5) {}
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress()
    {
        if (dirty)
            fputs("\r                                \r", stderr);
    }

    void update(uint32_t done, uint32_t total)
    {
        const double time = shown ? now() : 0;
        if (!shown || time < next || done == 0)
            return;
        next = time + 0.2;
        dirty = true;
        const unsigned long left = static_cast<unsigned long>((time - start) / done * (total - done) + 0.5);
        fprintf(stderr, "\r%3u %%, ", static_cast<unsigned>(uint64_t{100} * done / total));
        if (left < 60)
            fprintf(stderr, "%lu s left   ", left);
        else if (left < 3600)
            fprintf(stderr, "%lu min %lu s left   ", left / 60, left % 60);
        else
            fprintf(stderr, "%lu h %lu min left   ", left / 3600, left / 60 % 60);
    }

private:
    bool shown, dirty = false;
    double start, next;
};

// A block of rows has a number from the top, and the slot of that number modulo the slots. It may be drawn once the
// block before in its slot is written, which the next blocks to be written never wait for.
class Drawing {
public:
    Drawing(const Renderer& with, const Built& picture, uint32_t threads, Output& to, bool shown)
        : renderer(with), height(picture.height), stride(picture.width * 3), output(to), progress(shown)
    {
        // Small blocks, so that no thread waits long for another at the end; of some pixels each, to pay for
        // taking one.
        block_rows = std::max(std::min(height / (32 * threads), 1024 / picture.width), 1u);
        blocks = (height + block_rows - 1) / block_rows;
        slots = std::min(std::min(static_cast<uint32_t>(pool_bytes / stride) / block_rows, max_slots), blocks);
    }
    ~Drawing() { give_back(pool); }
    Drawing(const Drawing&) = delete;
    Drawing& operator=(const Drawing&) = delete;

    bool has_memory() { return make_room(pool, size_t{slots} * block_rows * stride); }

    // What each thread does.
    void work()
    {
        RayCounts own;
        for (;;) {
            const uint32_t block = next.fetch_add(1, std::memory_order_relaxed);
            if (block >= blocks || !wait_for_slot(block))
                break;
            const uint32_t first = block * block_rows;
            renderer.rows(first, std::min(first + block_rows, height), slot(block), own);
            finish(block);
        }
        pthread_mutex_lock(&mutex);
        for (int i = 0; i < 4; i++)
            counts.rays[i] += own.rays[i];
        pthread_mutex_unlock(&mutex);
    }

    uint32_t block_count() const { return blocks; }
    bool whole() const { return !failed; }
    RayCounts counts;

private:
    uint8_t* slot(uint32_t block) const { return pool.at + size_t{block % slots} * block_rows * stride; }

    bool wait_for_slot(uint32_t block)
    {
        pthread_mutex_lock(&mutex);
        while (block - written >= slots && !failed)
            pthread_cond_wait(&slot_is_free, &mutex);
        const bool go = !failed;
        pthread_mutex_unlock(&mutex);
        return go;
    }

    // One thread at a time writes all that is ready; the others go on drawing.
    void finish(uint32_t block)
    {
        pthread_mutex_lock(&mutex);
        ready[block % slots] = true;
        if (!writing) {
            writing = true;
            while (!failed && written < blocks && ready[written % slots]) {
                pthread_mutex_unlock(&mutex);
                const uint32_t first = written * block_rows, rows = std::min(block_rows, height - first);
                const bool good = output.write(slot(written), size_t{rows} * stride);
                progress.update(first + rows, height);
                pthread_mutex_lock(&mutex);
                ready[written % slots] = false;
                written++;
                failed = !good;
                pthread_cond_broadcast(&slot_is_free);
            }
            writing = false;
        }
        pthread_mutex_unlock(&mutex);
    }

    const Renderer& renderer;
    const uint32_t height, stride;
    Output& output;
    Progress progress;
    uint32_t block_rows, blocks, slots;
    scene::Room pool;
    std::atomic<uint32_t> next{0};
    pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER; // for all below, but that `written` is the writer's to read
    pthread_cond_t slot_is_free = PTHREAD_COND_INITIALIZER;
    uint32_t written = 0;
    bool writing = false, failed = false;
    bool ready[max_slots] = {};
};

// Parts of some work, which threads take one by one.
struct Parts {
    void (*part)(void* work, uint32_t i);
    void* of;
    uint32_t count;
    Progress progress;
    std::atomic<uint32_t> next{0};

    void work()
    {
        const bool shows = !shown.exchange(true);
        for (uint32_t i; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;) {
            part(of, i);
            if (shows)
                progress.update(i, count);
        }
    }
    std::atomic<bool> shown{false}; // by the first thread
};

// Calls work.work() in so many threads, this one among them. Where no thread can be had, fewer do.
template <class Work>
void work_in_threads(Work& work, uint32_t threads)
{
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, stack_bytes);
    pthread_t others[max_threads];
    uint32_t started = 0;
    const auto start = [](void* it) -> void* {
        static_cast<Work*>(it)->work();
        return nullptr;
    };
    while (started + 1 < threads && pthread_create(&others[started], &small, start, &work) == 0)
        started++;
    work.work();
    for (uint32_t i = 0; i < started; i++)
        pthread_join(others[i], nullptr);
}

} // namespace

double now()
{
    timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

uint32_t thread_count(uint32_t asked)
{
    if (asked != 0)
        return asked;
    cpu_set_t set;
    const int n = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 1;
    return std::min(std::max(static_cast<uint32_t>(n), 1u), max_threads);
}

void run_in_threads(void (*part)(void* work, uint32_t i), void* work, uint32_t count, const scene::Solving& with)
{
    Parts parts{part, work, count, Progress(with.progress)};
    work_in_threads(parts, std::min(with.threads, count));
}

bool draw_picture(const Renderer& renderer, const Built& picture, uint32_t threads, Output& output, bool progress,
                  RayCounts& counts)
{
    Drawing drawing(renderer, picture, threads, output, progress);
    if (!drawing.has_memory())
        return output.fail("draw", ENOMEM);
    char head[32];
    const int length = snprintf(head, sizeof head, "P6\n%u %u\n255\n", picture.width, picture.height);
    if (!output.write(head, static_cast<size_t>(length)))
        return false;
    work_in_threads(drawing, std::min(threads, drawing.block_count()));
    for (int i = 0; i < 4; i++)
        counts.rays[i] += drawing.counts.rays[i];
    return drawing.whole();
}

} // namespace qray::cli
