// qray: draws a scene, or hands over to one of its other commands.
#include "compile.hpp"
#include "draw.hpp"
#include "load.hpp"
#include "stats.hpp"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
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

// So that no file that is opened later takes the place of one of the three, and is written to in its name.
void keep_standard_files()
{
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(file, F_GETFD) < 0)
            open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY); // using it still fails
}

int run(int argc, char** argv)
{
    if (argc > 1 && strcmp(argv[1], "compile") == 0)
        return compile_main(argc - 1, argv + 1);
    return draw_main(argc, argv);
}

} // namespace

} // namespace qray::cli

int main(int argc, char** argv)
{
    using namespace qray::cli;
    keep_standard_files();
    if (!has_memory_to_start())
        return 1;
    for (const int which : {SIGPIPE, SIGXFSZ}) // what writes tells
        signal(which, SIG_IGN);
    const int status = run(argc, argv);
    if (fflush(stdout) == 0 && ferror(stdout) == 0)
        return status;
    fprintf(stderr, "qray: cannot write: %s\n", strerror(errno));
    return 1;
}
