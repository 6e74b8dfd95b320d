#include "stats.hpp"

#include "../scene/effect_names.hpp"
#include "../scene/shapes.hpp"

#include <inttypes.h>
#include <stdio.h>

#include <iterator>
#include <utility>

namespace qray::cli {

namespace {

void print_objects(const scene::Description& d)
{
    const auto print = [](const char* name, uint32_t count) { fprintf(stderr, "%s: %" PRIu32 "\n", name, count); };
    print("objects", d.object_count);
    scene::for_each_host([&](auto host, Kind kind) {
        for (uint8_t entity = 0; entity < std::size(host.entities); entity++) {
            uint32_t count = 0;
            for (uint32_t i = 0; i < d.object_count; i++)
                count += d.objects[i].kind == kind && d.objects[i].entity == entity;
            print(host.entities[entity].plural, count);
        }
    });
    uint32_t suns = 0, panels = 0;
    for (uint32_t i = 0; i < d.light_count; i++) {
        suns += d.lights[i].sun;
        panels += d.lights[i].places != 0;
    }
    print("vertices", d.vertex_count);
    print("materials", d.fill_count);
    print("lights", d.light_count - suns - panels);
    print("suns", suns);
    print("panels", panels);
    print("dropped", d.dropped);
}

} // namespace

void print_stats(const Options& options, const scene::Description& description, const Built& built,
                 uint32_t threads, const RayCounts& counts, const Seconds& seconds)
{
    const scene::Settings& settings = options.settings;
    fprintf(stderr, "scene: %s\n", scene::ShownName(options.scene).text);
    if (description.comment[0] != 0)
        fprintf(stderr, "title: %s\n", description.comment);
    print_objects(description);
    fprintf(stderr, "vanished: %" PRIu32 "\n", built.vanished);

    fputs("effects:", stderr);
    for (const scene::EffectName& e : scene::effect_names)
        if (built.effects.*e.effect)
            fprintf(stderr, " %s", e.name);
    const int number = static_cast<int>(options.number);
    fprintf(stderr, "\nnumber: %s\nkernel: %s\nlanes: %s\n", number_names[number], built.kernel,
            &fastest_renderer(options.number) == renderers[number] ? "none" : "avx2");

    fprintf(stderr, "width: %" PRIu32 "\nheight: %" PRIu32 "\n", built.width, built.height);
    if (settings.levels != 0)
        fprintf(stderr, "levels: %" PRIu32 "\nthreshold: %g\n", settings.levels, settings.threshold);
    else
        fprintf(stderr, "samples: %" PRIu32 "\n", settings.grid * settings.grid);
    fprintf(stderr, "depth: %" PRIu32 "\ncutoff: %g\nthreads: %" PRIu32 "\n", settings.depth, settings.cutoff,
            threads);

    if (description.radiosity > 0)
        fprintf(stderr,
                "radiosity_cells: %" PRIu32 "\nradiosity_nodes: %" PRIu32 "\nradiosity_parts: %" PRIu32
                "\nradiosity_rays: %" PRIu64 "\nradiosity_rounds: %" PRIu32
                "\nradiosity_change: %.3g\nradiosity_seconds: %.4f\n",
                description.cell_count, description.light_size, description.cut_count, description.light_rays,
                description.light_rounds, description.light_change, seconds.solving);

    uint64_t rays = 0;
    for (int i = 0; i < 4; i++) {
        constexpr const char* kinds[] = {"camera", "shadow", "mirrored", "refracted"};
        fprintf(stderr, "%s_rays: %" PRIu64 "\n", kinds[i], counts.rays[i]);
        rays += counts.rays[i];
    }
    fprintf(stderr, "rays: %" PRIu64 "\nrays/second: %.0f\nreading_seconds: %.4f\nseconds: %.4f\n", rays,
            static_cast<double>(rays) / (seconds.drawing > 1e-9 ? seconds.drawing : 1e-9), seconds.reading,
            seconds.drawing);
}

int describe()
{
    const char* before = "{\"numbers\": [";
    for (const char* name : number_names) {
        printf("%s\"%s\"", before, name);
        before = ", ";
    }
    before = "],\n\"effects\": [";
    for (const scene::EffectName& e : scene::effect_names) {
        printf("%s\"%s\"", before, e.name);
        before = ", ";
    }
    // An object of each shape that the text has, and a place on it; each texture, and what stands behind its name.
    before = "],\n\"shapes\": {";
#define QRAY_SHAPE(Type, name, table) \
    if (const auto& example = scene::Host<Type>::example; example[0] != nullptr) \
        printf("%s\"" #name "\": [\"%s\", \"%s\"]", std::exchange(before, ",\n    "), example[0], example[1]);
    QRAY_SHAPES(QRAY_SHAPE)
#undef QRAY_SHAPE
    constexpr const char* texts[] = {"1 0 0 0.3", "1 0 0 0.3 1 2 0", "image.ppm 0 0 0 1 0 0 0 1 0", "image.ppm 0 0 0"};
    before = "},\n\"textures\": {";
#define QRAY_TEXTURE(Type, name, table) \
    printf("%s\"" #name "\": \"%s\"", before, texts[static_cast<int>(Type<Double>::text)]); \
    before = ", ";
    QRAY_TEXTURES(QRAY_TEXTURE)
#undef QRAY_TEXTURE
    puts("}}");
    return 0;
}

} // namespace qray::cli
