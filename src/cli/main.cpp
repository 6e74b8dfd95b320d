// qray: draws a scene, or hands over to one of its other commands.
#include "compile.hpp"
#include "draw.hpp"
#include "load.hpp"
#include "stats.hpp"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

namespace qray::cli {

namespace {

bool draw(const Renderer& renderer, const Built& built, uint32_t threads, bool quiet, Output& output,
          RayCounts& counts)
{
    Progress progress(!quiet && isatty(STDERR_FILENO));
    return draw_picture(renderer, built, threads, output, progress, counts);
}

int draw_main(int argc, char** argv)
{
    Options options;
    const int status = read_options(Command::draw, argc, argv, options);
    if (status != go_on)
        return status;

    const char* out = output_name(options, ".ppm");
    if (out == nullptr)
        return 2;
    if (strcmp(out, "-") == 0 && isatty(STDOUT_FILENO))
        return bad_options("the picture would go to the terminal; give '-o FILE'");

    const double begin = options.stats ? now() : 0;
    Built built{};
    const Renderer& renderer = fastest_renderer(options.number);
    const int loaded = load(options, renderer, out, built);
    if (loaded != go_on)
        return loaded;

    Output output;
    const uint32_t threads = thread_count(options.threads);
    const double start = options.stats ? now() : 0;
    RayCounts counts;
    if (!output.open(out) || !draw(renderer, built, threads, options.quiet, output, counts) || !output.commit()) {
        output.report();
        return 1;
    }
    if (options.stats) {
        print_stats(options, description(), built, threads, counts, {start - begin, now() - start});
    }
    return 0;
}

} // namespace

} // namespace qray::cli

int main(int argc, char** argv)
{
    using namespace qray::cli;
    if (argc > 1 && strcmp(argv[1], "compile") == 0)
        return compile_main(argc - 1, argv + 1);
    return draw_main(argc, argv);
}
