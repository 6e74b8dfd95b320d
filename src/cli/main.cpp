// qray: draws a scene, compiles it to a C++ header that is drawn without an operating system, or explains a pixel.
#include "../scene/reader.hpp"
#include "draw.hpp"
#include "explain.hpp"
#include "input.hpp"
#include "stats.hpp"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

namespace qray::cli {

namespace {

scene::Description description;
double solving_seconds = 0;

const char* file_part(const char* path)
{
    const char* const slash = strrchr(path, '/');
    return slash != nullptr ? slash + 1 : path;
}

// "name:line:column:", of what there is of it.
void say_place(const char* name, scene::Position at)
{
    fprintf(stderr, "%s:", scene::ShownName(name).text);
    if (at.line != 0)
        fprintf(stderr, "%u:", at.line);
    if (at.column != 0)
        fprintf(stderr, "%u:", at.column);
}

int refused(const char* name, const scene::Error& error)
{
    say_place(name, error.at);
    fprintf(stderr, " %s\n", error.text);
    return 1;
}

void warn(const char* name, const scene::Warning& w, const char* what = "objects")
{
    if (w.count == 0)
        return;
    const bool number = w.column != 0; // else an object
    say_place(name, {w.line, w.column});
    fprintf(stderr, " warning: %s", w.text);
    if (w.count > 1)
        fprintf(stderr, number ? " (and so for %u more)" : "; %u %s in all", w.count - number, what);
    fputc('\n', stderr);
}

// The output's name: as given, else the scene's in this folder, with another end, or standard output. Null, and a
// message, where that is too long.
const char* output_name(const Options& options, const char* end)
{
    static char own[260];
    if (options.output != nullptr)
        return options.output;
    if (strcmp(options.scene, "-") == 0)
        return "-";
    const char* const name = file_part(options.scene);
    const char* const dot = strrchr(name, '.');
    const size_t length = dot != nullptr && dot != name ? static_cast<size_t>(dot - name) : strlen(name);
    if (length < sizeof own
        && snprintf(own, sizeof own, "%.*s%s", static_cast<int>(length), name, end) < static_cast<int>(sizeof own))
        return own;
    bad_options("'%s' is too long a name to make another from; give '-o FILE'", scene::ShownName(options.scene).text);
    return nullptr;
}

// Builds the scene that was read; `again`, in another number system.
int build(const Options& options, const Renderer& renderer, Built& built, bool again = false)
{
    scene::Error error;
    if (!renderer.build(description, options.settings, built, error))
        return refused(options.scene, error);
    if (options.quiet)
        return go_on;
    if (!again)
        for (const scene::Warning* w :
             {&description.passed_over, &description.clamped, &description.empty, &description.nonplanar})
            warn(options.scene, *w);
    warn(options.scene, built.lost, "warnings"); // an object may have several
    warn(options.scene, built.unmoved, "warnings about '--moving'");
    return go_on;
}

// Reads the scene and builds it. Returns `go_on`, or the status to exit with, having printed why: also where `out` is
// the scene itself.
int load(const Options& options, const Renderer& renderer, const char* out, Built& built)
{
    scene::Error error;
    if (!read_scene(options.scene, description, error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    if (is_scene_file(out))
        return bad_options("'%s' is the scene itself; give another name with '-o FILE'", scene::ShownName(out).text);
    const bool shown = !options.quiet && isatty(STDERR_FILENO);
    const scene::Solving solving{make_room, run_in_threads, thread_count(options.threads), shown};
    const double start = now();
    const bool solved = solve_radiosity(description, solving, error);
    solving_seconds = now() - start;
    return solved ? build(options, renderer, built) : refused(options.scene, error);
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

int draw(const Options& options, const char* out)
{
    if (const int format = check_format(out); format != go_on)
        return format;
    if (strcmp(out, "-") == 0 && isatty(STDOUT_FILENO))
        return bad_options("the picture would go to the terminal; give '-o FILE'");

    const double begin = options.stats ? now() : 0;
    Built built{};
    const Renderer& renderer = fastest_renderer(options.number);
    if (const int loaded = load(options, renderer, out, built); loaded != go_on)
        return loaded;

    Output output;
    const uint32_t threads = thread_count(options.threads);
    const double start = options.stats ? now() : 0;
    RayCounts counts;
    const bool shown = !options.quiet && isatty(STDERR_FILENO);
    if (!output.open(out) || !draw_picture(renderer, built, threads, output, shown, counts) || !output.commit())
        return output.report();
    if (options.stats)
        print_stats(options, description, built, threads, counts, {start - begin, now() - start, solving_seconds});
    return 0;
}

int compile(const Options& options, const char* out)
{
    Built built{};
    const int number = static_cast<int>(options.number);
    const Renderer& renderer = *renderers[number];
    if (const int loaded = load(options, renderer, out, built); loaded != go_on)
        return loaded;

    // What the header was made from, in one line.
    const scene::Settings& settings = options.settings;
    char sampling[64], origin[512];
    if (settings.levels != 0)
        snprintf(sampling, sizeof sampling, "adaptive in %u levels from %g", settings.levels, settings.threshold);
    else
        snprintf(sampling, sizeof sampling, "%u sample%s a pixel", settings.grid * settings.grid,
                 settings.grid == 1 ? "" : "s");
    snprintf(origin, sizeof origin, "%s by qray compile: %s, %u x %u pixels, %s, depth %u, cutoff %g",
             scene::ShownName(file_part(options.scene)).text, number_names[number], built.width, built.height, sampling,
             settings.depth, settings.cutoff);

    Output output;
    if (!output.open(out))
        return output.report();
    scene::Source source(
        [](void* to, const char* text, size_t size) { return static_cast<Output*>(to)->write(text, size); }, &output);
    renderer.emit(source, description.comment, origin, options.name);
    return source.finish() && output.commit() ? 0 : output.report();
}

int explain(const Options& options)
{
    Built built{};
    const Number numbers[] = {options.number, options.beside};
    const uint32_t count = options.beside == options.number ? 1 : 2;
    static Explanation explanations[2];
    for (uint32_t i = 0; i < count; i++) {
        const Renderer& renderer = *renderers[static_cast<int>(numbers[i])];
        const int built_it = i == 0 ? load(options, renderer, "-", built) : build(options, renderer, built, true);
        if (built_it != go_on)
            return built_it;
        if (options.x >= built.width || options.y >= built.height)
            return bad_options("pixel %s is outside of the picture; expected 0,0 to %u,%u",
                               scene::ShownName(options.pixel).text, built.width - 1, built.height - 1);
        explain_pixel(numbers[i], description, options.x, options.y, explanations[i]);
        if (!explanations[i].whole) {
            fputs("qray: not enough memory for all rays of the pixel; less depth or fewer samples take less\n", stderr);
            return 1;
        }
    }
    const auto explained = [&options, &numbers](uint32_t i) {
        const char* const name = number_names[static_cast<int>(numbers[i])];
        return Explained{name, name, options.settings, explanations[i]};
    };
    const Explained first = explained(0), beside = explained(1);
    scene::Source source(
        [](void* to, const char* text, size_t size) { return fwrite(text, 1, size, static_cast<FILE*>(to)) == size; },
        stdout);
    const scene::ShownName name(options.scene);
    write_explanation(source, description, {name.text, built.width, built.height, options.x, options.y}, first,
                      count == 2 ? &beside : nullptr);
    source.finish(); // main() says what could not be written
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
    if (argc == 2 && strcmp(argv[1], "--describe") == 0)
        return describe();
    const char* const word = argc > 1 ? argv[1] : "";
    const bool compiles = strcmp(word, "compile") == 0, explains = strcmp(word, "explain") == 0;
    const Command command = compiles ? Command::compile : explains ? Command::explain : Command::draw;
    const int skipped = compiles || explains;
    Options options;
    if (const int status = read_options(command, argc - skipped, argv + skipped, options); status != go_on)
        return status;
    if (explains)
        return explain(options);
    const char* const out = output_name(options, compiles ? ".hpp" : ".ppm");
    return out == nullptr ? 2 : compiles ? compile(options, out) : draw(options, out);
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
