// The tracer of the page, in WebAssembly: what JavaScript calls. One scene's text, one picture in work for each worker
// that has an instance. Answers are JSON, in a text that stands until the next call.
#include "../cli/explain.hpp"
#include "../scene/radiosity.hpp"
#include "../scene/reader.hpp"
#include "../study/flip.hpp"
#include "../study/scattered.hpp"
#include "kernel.hpp"

#include <iterator>

#define QRAY_EXPORT(name) extern "C" [[clang::export_name(#name)]]

// A file that the page holds: its size, or -1; its bytes. From JavaScript.
extern "C" [[clang::import_module("page"), clang::import_name("size")]] int32_t file_size(const char* name);
extern "C" [[clang::import_module("page"), clang::import_name("read")]] void file_read(const char* name, void* to);

namespace qray::cli {

// Memory is never given back: pages from its end. JavaScript begins anew with another instance where it grew large.
bool grow_room(scene::Room& room, size_t size)
{
    if (size <= room.size)
        return true;
    constexpr size_t page = 65536;
    const size_t pages = (size + size / 4 + page - 1) / page; // a text that grows a little finds room
    const size_t first = __builtin_wasm_memory_grow(0, pages);
    if (first == SIZE_MAX)
        return false;
    auto* const at = reinterpret_cast<uint8_t*>(first * page);
    if (room.size != 0)
        memcpy(at, room.at, room.size);
    room = {at, pages * page};
    return true;
}

bool make_room(scene::Room& room, size_t size)
{
    if (size > room.size)
        room = {};
    return grow_room(room, size);
}

} // namespace qray::cli

namespace qray::page {

#define PAGE_ONE(name) extern const Kernel kernel_##name;
PAGE_KERNELS
#undef PAGE_ONE

namespace {

#define PAGE_ONE(name) &kernel_##name,
constexpr const Kernel* kernels[] = {PAGE_KERNELS};
#undef PAGE_ONE
static_assert(std::size(kernels) == std::size(cli::number_names));

// Without constructors: the linker would have each call from JavaScript run these first.
constinit scene::Description description{};
char scene_name[256];
constinit scene::Room text, picture;
constinit scene::Settings settings; // of the picture
const Kernel* kernel = nullptr; // of the picture
constinit cli::Built built{};
constinit cli::RayCounts rays;

// The answer: JSON, put together piece by piece. Longer ones are cut off.
char answer[8192];
size_t used;

[[gnu::format(printf, 1, 2)]] void put(const char* format, ...)
{
    va_list values;
    va_start(values, format);
    const int n = vsnprintf(answer + used, sizeof answer - used, format, values);
    va_end(values);
    used = used + static_cast<size_t>(n) < sizeof answer ? used + static_cast<size_t>(n) : sizeof answer - 1;
}

void put_string(const char* s)
{
    put("\"");
    for (; *s != 0; s++)
        put(*s == '"' || *s == '\\' ? "\\%c" : static_cast<unsigned char>(*s) < ' ' ? " " : "%c", *s);
    put("\"");
}

const char* answer_error(const char* s)
{
    used = 0;
    put("{\"error\": ");
    put_string(s);
    put("}");
    return answer;
}

void put_warning(const scene::Warning& w)
{
    if (w.count == 0)
        return;
    put("%s{\"line\": %u, \"column\": %u, \"count\": %u, \"text\": ", answer[used - 1] == '[' ? "" : ", ", w.line,
        w.column, w.count);
    put_string(w.text);
    put("}");
}

const char* append_file(const char* name, size_t, scene::Bytes& to)
{
    const int32_t size = file_size(name);
    if (size < 0)
        return "the page holds no such file";
    // One more, as those who read to the end have it.
    if (!cli::grow_room(to.room, to.size + static_cast<size_t>(size) + 1))
        return "not enough memory";
    file_read(name, to.room.at + to.size);
    to.size += static_cast<size_t>(size);
    return nullptr;
}

void run_alone(void (*part)(void* work, uint32_t i), void* work, uint32_t count, const scene::Solving&)
{
    for (uint32_t i = 0; i < count; i++)
        part(work, i);
}

study::Scattered combs() { return {built.width, built.height}; }

} // namespace

QRAY_EXPORT(describe) const char* describe()
{
    used = 0;
    put("{\"numbers\": [");
    for (const char* number : cli::number_names)
        put("%s\"%s\"", answer[used - 1] == '[' ? "" : ", ", number);
    put("]}");
    return answer;
}

// 256 bytes, for the name that a call takes.
QRAY_EXPORT(name_room) char* name_room()
{
    static char name[256];
    return name;
}
// Room for so many bytes of text, and what ends it.
QRAY_EXPORT(text_room) void* text_room(size_t size) { return cli::make_room(text, size + 1) ? text.at : nullptr; }

// Reads the text that is there. {"error"} or what is in the scene.
QRAY_EXPORT(parse) const char* parse(const char* name, size_t size)
{
    scene::Error error;
    text.at[size] = 0;
    kernel = nullptr;
    snprintf(scene_name, sizeof scene_name, "%s", name);
    if (size > scene::Limits::text || !cli::make_room(description.room, description.lay_out(size)))
        return answer_error("not enough memory for the scene");
    constexpr scene::Files files{append_file, cli::grow_room};
    if (!scene::parse(name, reinterpret_cast<const char*>(text.at), size, description, error, &files))
        return answer_error(error.text);
    bool spawns = false;
    for (uint32_t i = 0; i < description.fill_count; i++)
        spawns = spawns || description.fills[i].mirror > 0 || description.fills[i].transmit > 0;
    uint32_t panels = 0;
    for (uint32_t i = 0; i < description.light_count; i++)
        panels += description.lights[i].places != 0;
    used = 0;
    put("{\"spawns\": %s, \"panels\": %u, \"radiosity\": %s, \"title\": ", spawns ? "true" : "false", panels,
        description.radiosity > 0 ? "true" : "false");
    put_string(description.comment);
    put(", \"warnings\": [");
    for (const scene::Warning* w :
         {&description.passed_over, &description.clamped, &description.empty, &description.nonplanar})
        put_warning(*w);
    put("]}");
    return answer;
}

// Light between surfaces, of a text that parse() liked, once.
QRAY_EXPORT(solve) const char* solve()
{
    scene::Error error;
    if (!solve_radiosity(description, {cli::make_room, run_alone}, error))
        return answer_error(error.text);
    return "{}";
}

QRAY_EXPORT(build) const char* build(const char* number, uint32_t width, uint32_t height, uint32_t grid,
                                     uint32_t levels, double threshold, uint32_t depth, double cutoff)
{
    using scene::Settings;
    const auto is_share = [](double v) { return v >= 0 && v <= 1; };
    if (grid - 1 >= Settings::max_grid || levels > Settings::max_levels || depth - 1 >= Settings::max_depth
        || !is_share(threshold) || !is_share(cutoff))
        return answer_error("settings out of range"); // of a link
    settings.width = width;
    settings.height = height;
    settings.grid = grid;
    settings.levels = levels;
    settings.threshold = threshold;
    settings.depth = depth;
    settings.cutoff = cutoff;
    kernel = nullptr;
    for (const Kernel* k : kernels)
        if (strcmp(k->name, number) == 0)
            kernel = k;
    scene::Error error;
    if (kernel == nullptr)
        return answer_error("no such number system");
    if (!kernel->build(description, settings, built, error))
        return answer_error(error.text);
    constexpr uint32_t most = 1 << 22; // pixels that a browser shows in reasonable time
    if (uint64_t{built.width} * built.height > most) {
        snprintf(error.text, sizeof error.text, "%u x %u pixels; this page draws at most %u", built.width, built.height,
                 most);
        return answer_error(error.text);
    }
    if (!cli::make_room(picture, size_t{3} * built.width * built.height))
        return answer_error("not enough memory for the picture");
    rays = {};
    used = 0;
    put("{\"width\": %u, \"height\": %u, \"combs\": %u, \"length\": %u, \"warnings\": [", built.width, built.height,
        combs().count(), combs().length());
    put_warning(built.lost);
    put("]}");
    return answer;
}

// One row of the picture: where its bytes are.
QRAY_EXPORT(row) uint8_t* row(uint32_t y)
{
    uint8_t* const to = picture.at + size_t{3} * built.width * y;
    kernel->pixels(0, y, 1, built.width, to, rays);
    return to;
}

// The k-th comb of pixels, behind the others in the same place.
QRAY_EXPORT(comb) uint8_t* comb(uint32_t k)
{
    const study::Scattered all = combs();
    const auto [x, y] = all(k);
    uint8_t* const to = picture.at + size_t{3} * all.length() * k;
    kernel->pixels(x, y, all.stride(), all.length(), to, rays);
    return to;
}

constinit cli::Explanation explanations[2]{};
constinit struct {
    const char* number;
    scene::Settings settings;
} explained[2]{};
constinit cli::Place place{};

// Why a pixel of the scene that was built last has its colour, as the first or the second of two.
QRAY_EXPORT(explain) void explain(uint32_t which, uint32_t x, uint32_t y)
{
    uint32_t number = 0;
    while (strcmp(kernel->name, cli::number_names[number]) != 0)
        number++;
    explained[which] = {kernel->name, settings};
    place = {scene_name, built.width, built.height, x, y};
    cli::Explanation& e = explanations[which];
    e.samples.count = e.rays.count = e.lights.count = 0;
    e.whole = true;
    cli::explain_pixel(static_cast<cli::Number>(number), description, x, y, e);
}

// That as text, of one or of both; these go by their number systems, or by A and B where they share one.
QRAY_EXPORT(explanation) const char* explanation(uint32_t count)
{
    static scene::Bytes all;
    all.size = 0;
    const auto append = [](void*, const char* bytes, size_t size) {
        if (!cli::grow_room(all.room, 2 * (all.size + size) + 1))
            return false;
        memcpy(all.room.at + all.size, bytes, size);
        all.size += size;
        return true;
    };
    scene::Source source(append, nullptr);
    const bool alike = count == 2 && explained[0].number == explained[1].number;
    const auto of = [alike](uint32_t i) {
        const auto& e = explained[i];
        return cli::Explained{alike ? i == 0 ? "A" : "B" : e.number, e.number, e.settings, explanations[i]};
    };
    const cli::Explained first = of(0), beside = of(1);
    write_explanation(source, description, place, first, count == 2 ? &beside : nullptr);
    if (!source.finish() || !explanations[0].whole || (count == 2 && !explanations[1].whole))
        return "not enough memory for all rays of this pixel";
    all.room.at[all.size] = 0;
    return reinterpret_cast<const char*>(all.room.at);
}

QRAY_EXPORT(ray_count) double ray_count(uint32_t kind) { return static_cast<double>(rays.rays[kind]); }

// Two pictures of that size, one behind the other in the room that room_for_two() gives, and behind them a byte a
// pixel: the largest difference of a channel.
QRAY_EXPORT(room_for_two) uint8_t* room_for_two(uint32_t pixels)
{
    return cli::make_room(picture, size_t{7} * pixels) ? picture.at : nullptr;
}

QRAY_EXPORT(compare) const char* compare(uint32_t width, uint32_t height)
{
    const uint32_t pixels = width * height;
    const uint8_t *const a = picture.at, *const b = a + size_t{3} * pixels;
    uint8_t* const map = picture.at + size_t{6} * pixels;
    uint64_t squares = 0;
    uint32_t differ = 0, most = 0;
    for (uint32_t i = 0; i < pixels; i++) {
        uint32_t largest = 0;
        for (uint32_t c = 0; c < 3; c++) {
            const int d = a[3 * i + c] - b[3 * i + c];
            squares += static_cast<uint64_t>(d * d);
            largest = std::max(largest, static_cast<uint32_t>(d < 0 ? -d : d));
        }
        map[i] = static_cast<uint8_t>(largest);
        differ += largest != 0;
        most = std::max(most, largest);
    }
    used = 0;
    put("{\"squares\": %llu, \"differ\": %u, \"most\": %u", static_cast<unsigned long long>(squares), differ, most);
    static scene::Room work;
    if (cli::make_room(work, sizeof(double) * (study::Flip::room(width) + width))) {
        static const study::Flip flip;
        auto* const doubles = reinterpret_cast<double*>(work.at);
        double* const of_row = doubles + study::Flip::room(width);
        double sum = 0;
        uint32_t seen = 0;
        for (uint32_t y = 0; y < height; y++) {
            flip.row(b, a, width, height, y, doubles, of_row);
            for (uint32_t x = 0; x < width; x++) {
                sum += of_row[x];
                seen += of_row[x] > flip.threshold();
            }
        }
        put(", \"flip\": %.4f, \"seen\": %.6f", sum / pixels, static_cast<double>(seen) / pixels);
    }
    put("}");
    return answer;
}

} // namespace qray::page
