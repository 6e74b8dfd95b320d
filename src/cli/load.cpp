#include "load.hpp"

#include "../scene/reader.hpp"
#include "input.hpp"

#include <stdio.h>
#include <string.h>

namespace qray::cli {

namespace {

scene::Description loaded;

void warn(const char* scene, const scene::Warning& w)
{
    if (w.count == 0)
        return;
    fprintf(stderr, "%s:%u:", scene::ShownName(scene).text, w.line);
    if (w.column != 0)
        fprintf(stderr, "%u:", w.column);
    fprintf(stderr, " warning: %s", w.text);
    if (w.count > 1)
        fprintf(stderr, w.column != 0 ? " (and so for %u more)\n" : "; %u objects in all\n", w.count - (w.column != 0));
    else
        fputc('\n', stderr);
}

} // namespace

const char* output_name(const Options& options, const char* suffix)
{
    static char own[260];
    if (options.output != nullptr)
        return options.output;
    if (strcmp(options.scene, "-") == 0)
        return "-";
    if (default_output(options.scene, suffix, own, sizeof own))
        return own;
    bad_options("'%s' is too long a name to make another from; give '-o FILE'",
                scene::ShownName(options.scene).text);
    return nullptr;
}

int load(const Options& options, const Renderer& renderer, const char* out, Built& built)
{
    scene::Error error;
    if (!read_scene(options.scene, loaded, error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    if (is_scene_file(out))
        return bad_options("'%s' is the scene itself; give another name with '-o FILE'",
                           scene::ShownName(out).text);
    if (!renderer.build(loaded, options.settings, built, error)) {
        fprintf(stderr, "%s: %s\n", scene::ShownName(options.scene).text, error.text);
        return 1;
    }
    if (!options.quiet) {
        warn(options.scene, loaded.clamped);
        warn(options.scene, loaded.empty);
        warn(options.scene, loaded.nonplanar);
        warn(options.scene, built.lost);
    }
    return go_on;
}

const scene::Description& description()
{
    return loaded;
}

} // namespace qray::cli
