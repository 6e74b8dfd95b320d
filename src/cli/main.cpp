// qray: draws a scene, or hands over to one of its other commands.
#include "../scene/reader.hpp"
#include "compile.hpp"
#include "describe.hpp"
#include "draw.hpp"
#include "load.hpp"
#include "stats.hpp"

#include <errno.h>
#include <fcntl.h>
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

// What makes other formats of a PPM, by the ends of their names.
constexpr struct {
    const char *end, *command;
} other_formats[] = {
    {".png", "pnmtopng picture.ppm >"},   {".jpg", "pnmtojpeg picture.ppm >"},  {".jpeg", "pnmtojpeg picture.ppm >"},
    {".bmp", "ppmtobmp picture.ppm >"},   {".gif", "ppmtogif picture.ppm >"},   {".tif", "pnmtotiff picture.ppm >"},
    {".tiff", "pnmtotiff picture.ppm >"}, {".tga", "ppmtotga picture.ppm >"},   {".pgm", "ppmtopgm picture.ppm >"},
    {".webp", "convert picture.ppm"},     {".avif", "convert picture.ppm"},     {".heic", "convert picture.ppm"},
    {".jxl", "convert picture.ppm"},      {".exr", "convert picture.ppm"},      {".ico", "convert picture.ppm"},
    {".pdf", "convert picture.ppm"},      {".svg", "convert picture.ppm"},
};

// go_on, or 2 and a line where the name promises another format.
int check_format(const char* out)
{
    const char* const dot = strrchr(out, '.');
    for (const auto& format : other_formats)
        if (dot != nullptr && strcasecmp(dot, format.end) == 0)
            return bad_options("'%s': qray writes PPM; give '-o picture.ppm', then: %s picture%s",
                               scene::ShownName(out).text, format.command, format.end);
    return go_on;
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
    if (const int format = check_format(out); format != go_on)
        return format;
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
    if (argc == 2 && strcmp(argv[1], "--describe") == 0)
        return describe();
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
    catch_signals();
    const int status = run(argc, argv);
    if (fflush(stdout) == 0 && ferror(stdout) == 0)
        return status;
    fprintf(stderr, "qray: cannot write: %s\n", strerror(errno));
    return 1;
}
