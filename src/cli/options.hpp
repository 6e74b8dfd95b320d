// The command line of qray, qray compile and qray explain: one table of options for all.
#pragma once

#include "../scene/numbers.hpp"
#include "../scene/settings.hpp"

namespace qray::cli {

#define QRAY_NUMBER(Type, name) Type,
enum class Number : uint8_t { QRAY_NUMBERS(QRAY_NUMBER) };
#undef QRAY_NUMBER
#define QRAY_NUMBER(Type, name) #name,
constexpr const char* number_names[] = {QRAY_NUMBERS(QRAY_NUMBER)};
#undef QRAY_NUMBER

enum class Command : uint8_t { draw = 1, compile = 2, explain = 4 };

struct Options {
    const char* scene = nullptr;  // "-": standard input
    const char* output = nullptr; // "-": standard output; null: the command's own default
    Number number = Number::q32;
    scene::Settings settings;
    bool has_samples = false; // -r was given, so that -a must not be
    uint32_t threads = 0;     // 0: one for each processor
    bool stats = false, quiet = false;
    const char* name = "scene"; // qray compile: the namespace
    const char* pixel = nullptr; // qray explain: of which pixel, as it was given,
    uint32_t x = 0, y = 0;       // and as numbers; what is negative or large is larger than any picture
    Number beside = Number::q32; // and beside which other number system, if not `number`
};

constexpr uint32_t max_threads = 256;

// Reads argv[1] and on. Returns `go_on`, or the status to exit with, having printed what is to be said: 0 after
// help and version, 2 and one line on standard error where something is wrong.
constexpr int go_on = -1;
int read_options(Command command, int argc, char** argv, Options& options);

// One line on standard error, "qray: ..."; returns 2.
[[gnu::format(printf, 1, 2)]] int bad_options(const char* format, ...);

} // namespace qray::cli
