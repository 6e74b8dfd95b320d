// Any bytes, of which those behind the first 0 are what every file beside the scene holds: either a scene, which every
// number system builds and draws at 8 x 8, or one line of error.
// A libFuzzer target; a test includes it and replays the corpus.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "../tracer.hpp"

namespace {

using namespace qray;

void expect(bool right, const char* what)
{
    if (!right) {
        std::fprintf(stderr, "fuzz_scene: %s\n", what);
        std::abort();
    }
}

// One line that begins with its place, as in "fuzz:3:14: ...".
void expect_line(const char* text, const char* start)
{
    expect(std::strncmp(text, start, std::strlen(start)) == 0, "an error without its place");
    expect(std::strlen(text) > std::strlen(start), "an empty error");
    for (const char* c = text; *c != 0; c++)
        expect(static_cast<unsigned char>(*c) >= 0x20 && *c != 0x7f, "an error with control characters");
}

template <class N>
void draw(const scene::Description& d, const scene::Settings& settings)
{
    scene::Error error;
    if (!scene::Builder<N>(d, settings, test::kept<scene::Storage<N>>()).build(error)) {
        expect_line(error.text, "");
        return;
    }
    const auto s = test::kept<scene::Storage<N>>().template view<scene::desktop_effects()>();
    uint8_t rows[2 * 8 * 3];
    uint32_t drawn = 0;
    const auto sink = [&drawn](uint32_t first, uint32_t count, const uint8_t*, uint32_t bytes) {
        expect(first == drawn && bytes == count * 24, "rows out of order");
        drawn += count;
        return true;
    };
    test::RayCount counted;
    render<Rgb888>(s, rows, 2, sink, counted);
    expect(drawn == 8, "rows that are missing");
}

// What stands beside the scene, and rooms of just the size that is asked for.
std::string_view beside;
bool grow(scene::Room& room, size_t size)
{
    if (size > room.size) {
        auto* const larger = static_cast<uint8_t*>(std::aligned_alloc(64, (size + 63) / 64 * 64));
        if (room.size != 0)
            std::memcpy(larger, room.at, room.size);
        std::free(room.at);
        room = {larger, size};
    }
    return true;
}
const char* append(const char*, size_t, scene::Bytes& to)
{
    if (beside.empty())
        return "there is none";
    grow(to.room, to.size + beside.size());
    std::memcpy(to.room.at + to.size, beside.data(), beside.size());
    to.size += beside.size();
    return nullptr;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size)
{
    scene::Description& d = test::kept<scene::Description>();
    scene::Error error;
    const std::string_view all(reinterpret_cast<const char*>(bytes), size);
    if (const size_t zero = all.find('\0'); zero != all.npos) {
        beside = all.substr(zero + 1);
        size = zero;
    } else {
        beside = {};
    }
    constexpr scene::Files files{append, grow};
    // A copy of just that size: to read beyond its end is an error that the sanitizers see.
    char* text = static_cast<char*>(std::malloc(size + (size == 0)));
    std::memcpy(text, bytes, size);
    const bool accepted = scene::parse("fuzz", text, size, d, error, &files);
    std::free(text);
    if (!accepted) {
        expect_line(error.text, beside.empty() ? "fuzz:" : "");
        return 0;
    }
    // How it is drawn depends on the size of the text: depth 1 to 4, plain, on a grid or adaptively.
    scene::Settings settings;
    settings.width = settings.height = 8;
    settings.depth = 1 + static_cast<uint32_t>(size % 4);
    settings.cutoff = size % 3 == 0 ? 0 : 0.0014;
    settings.grid = size % 5 == 1 ? 2 : 1;
    settings.levels = size % 5 == 2 ? 2 : 0;
    draw<q32>(d, settings);
    draw<Float>(d, settings);
#ifndef QRAY_LANES_ALONE
    draw<q16>(d, settings);
    draw<q24>(d, settings);
    draw<Double>(d, settings);
#endif
    return 0;
}
