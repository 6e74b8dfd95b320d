// qray: draws a scene, or hands over to one of its other commands.
#include "../scene/reader.hpp"
#include "compile.hpp"
#include "draw.hpp"
#include "input.hpp"
#include "plan.hpp"
#include "stats.hpp"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

namespace qray::cli {

namespace {

scene::Description description;

void warn(const char* scene, uint32_t objects, const char* what)
{
    if (objects != 0)
        fprintf(stderr, "%s: warning: %u object%s %s\n", scene::ShownName(scene).text, objects,
                objects == 1 ? "" : "s", what);
}

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

    char own_name[260];
    const char* out = options.output;
    if (out == nullptr && strcmp(options.scene, "-") == 0)
        out = "-";
    else if (out == nullptr && default_output(options.scene, ".ppm", own_name, sizeof own_name))
        out = own_name;
    if (out == nullptr)
        return bad_options("'%s' is too long a name to make the picture's from; give '-o FILE'",
                           scene::ShownName(options.scene).text);
    if (strcmp(out, "-") == 0 && isatty(STDOUT_FILENO))
        return bad_options("the picture would go to the terminal; give '-o FILE'");

    const double begin = options.stats ? now() : 0;
    scene::Error error;
    Built built{};
    const Renderer& renderer = *renderers[static_cast<int>(options.number)];
    if (!read_scene(options.scene, description, error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    if (is_scene_file(out))
        return bad_options("'%s' is the scene itself; give another name with '-o FILE'", scene::ShownName(out).text);
    if (!renderer.build(description, options.settings, built, error)) {
        fprintf(stderr, "%s: %s\n", scene::ShownName(options.scene).text, error.text);
        return 1;
    }
    if (!options.quiet) {
        warn(options.scene, description.dropped, "without extent, left out");
        warn(options.scene, built.vanished, "too small for the number system, left out");
    }

    Output output;
    const uint32_t threads = thread_count(options.threads);
    const double start = options.stats ? now() : 0;
    RayCounts counts;
    if (!output.open(out) || !draw(renderer, built, threads, options.quiet, output, counts) || !output.commit()) {
        output.report();
        return 1;
    }
    if (options.stats) {
        print_stats(options, description, built, threads, counts, {start - begin, now() - start});
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
    if (argc > 1 && strcmp(argv[1], "plan") == 0)
        return plan_main(argc - 1, argv + 1);
    return draw_main(argc, argv);
}
