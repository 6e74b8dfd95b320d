// The counts that predictions start from (src/cli/counts.hpp), for calibration.
//   operations NUMBER SCENE WxH [SAMPLES | aLEVELS,THRESHOLD]
// One `name: value` a line: its counts, its effects, its kinds of shapes and its balls, and the bytes of its
// tables in each number system that it fits. The number system decides whether a compiled scene has windows.
#include "../cli/counts.hpp"
#include "../cli/input.hpp"
#include "../cli/options.hpp"
#include "../cli/renderer.hpp"
#include "../scene/builder.hpp"
#include "../scene/effect_names.hpp"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

namespace {

qray::scene::Description description;
qray::scene::Storage<qray::Double> storage;

} // namespace

int main(int argc, char** argv)
{
    using namespace qray;
    scene::Settings settings;
    if (argc < 4 || sscanf(argv[3], "%ux%u", &settings.width, &settings.height) != 2) {
        fputs("usage: operations NUMBER SCENE WxH [SAMPLES | aLEVELS,THRESHOLD]\n", stderr);
        return 2;
    }
    if (argc > 4) {
        if (sscanf(argv[4], "a%u,%lf", &settings.levels, &settings.threshold) != 2)
            settings.grid = static_cast<uint32_t>(lround(sqrt(atof(argv[4]))));
    }
    scene::Error error;
    if (!cli::read_scene(argv[2], description, error)
        || !scene::Builder<Double>(description, settings, storage).build(error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    const cli::OperationCounts counts = cli::count_operations(description, settings, 1, argv[1][0] != 'q');
    for (int i = 0; i < cli::operation_count; i++)
        printf("%s: %.1f\n", cli::operation_names[i], counts.of[i]);
    for (const scene::EffectName& e : scene::effect_names)
        printf("effect_%s: %d\n", e.name, storage.effects.*e.effect);
    printf("kinds: %d\nballs: %u\n", storage.effects.shapes(), storage.spheres.count);
    cli::Built built{};
    for (size_t i = 0; i < sizeof cli::renderers / sizeof *cli::renderers; i++)
        if (cli::renderers[i]->build(description, settings, built, error))
            printf("tables_%s: %u\n", cli::number_names[i], built.table_bytes);
    return 0;
}
