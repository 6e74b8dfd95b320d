// qray compile: a scene as a C++ header, to be drawn without an operating system.
#include "compile.hpp"

#include "../scene/reader.hpp"
#include "load.hpp"
#include "output.hpp"

#include <stdio.h>
#include <string.h>

namespace qray::cli {

namespace {

// What the header was made from, in one line.
void say_origin(const Options& options, const Built& built, char* out, size_t size)
{
    const scene::Settings& settings = options.settings;
    const char* slash = strrchr(options.scene, '/');
    char sampling[64];
    if (settings.levels != 0)
        snprintf(sampling, sizeof sampling, "adaptive in %u levels from %g", settings.levels,
                 settings.threshold);
    else
        snprintf(sampling, sizeof sampling, "%u sample%s a pixel", settings.grid * settings.grid,
                 settings.grid == 1 ? "" : "s");
    snprintf(out, size, "%s by qray compile: %s, %u x %u pixels, %s, depth %u, cutoff %g",
             scene::ShownName(slash != nullptr ? slash + 1 : options.scene).text,
             number_names[static_cast<int>(options.number)], built.width, built.height, sampling,
             settings.depth, settings.cutoff);
}

} // namespace

int compile_main(int argc, char** argv)
{
    Options options;
    const int status = read_options(Command::compile, argc, argv, options);
    if (status != go_on)
        return status;

    const char* out = output_name(options, ".hpp");
    if (out == nullptr)
        return 2;
    Built built{};
    const Renderer& renderer = *renderers[static_cast<int>(options.number)];
    const int loaded = load(options, renderer, out, built);
    if (loaded != go_on)
        return loaded;

    Output output;
    const auto write = [](void* to, const char* text, size_t size) {
        return static_cast<Output*>(to)->write(text, size);
    };
    scene::Source source(write, &output);
    char origin[512];
    say_origin(options, built, origin, sizeof origin);
    bool good = output.open(out);
    if (good) {
        renderer.emit(source, description().comment, origin, options.name);
        good = source.finish() && output.commit();
    }
    if (!good)
        output.report();
    return good ? 0 : 1;
}

} // namespace qray::cli
