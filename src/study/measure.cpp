// Error and time of one scene's picture on this machine, for any settings, as CSV.
//   measure [-a] SCENE WxH NUMBER:SAMPLES:DEPTH:CUTOFF ...     SAMPLES is a square, or aLEVELS,THRESHOLD
// Arithmetic error is against double at the same settings, total error against double with 256 samples and depth
// 8; with -a that is left out, which takes the longest. Time is that of one thread, as a ratio to float's of the
// same settings, each the best of several tries in turn.
#include "../cli/input.hpp"
#include "../cli/renderer.hpp"
#include "errors.hpp"
#include "scattered.hpp"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

namespace qray::study {

namespace {

using cli::Built;
using cli::RayCounts;
using cli::Renderer;
using scene::Settings;

constexpr uint32_t max_pixels = 640 * 480;
scene::Description description;
uint8_t total_truth[3 * max_pixels], truth[3 * max_pixels], picture[3 * max_pixels];
uint32_t seen[2][max_pixels]; // places in the scene file, or 0xfffff

[[noreturn]] void fail(const char* text, const char* what)
{
    fprintf(stderr, "measure: %s%s\n", text, what);
    exit(1);
}

// What the ray through each pixel's centre sees first.
template <class N>
void see(uint32_t* places)
{
    constexpr Effects everywhere = everything(Settings::max_depth);
    const auto view = cli::storage_of<N>().template view<everywhere>();
    const Camera<N>& c = view.camera;
    const int32_t n = c.grid;
    for (int32_t j = 0; j < c.height; j++)
        for (int32_t i = 0; i < c.width; i++) {
            Hit<N> hit;
            const auto at = c.row(2 * n * j + n - n * c.height) + c.right * (2 * n * i + n - n * c.width);
            nearest(view, eye_ray(view, at), hit);
            *places++ = hit.tag.place();
        }
}

// A comb's pixels.
template <class N>
void comb(const Scattered& combs, uint32_t k, uint8_t* rgb, RayCounts& counts)
{
    const auto view = cli::storage_of<N>().template view<everything(Settings::max_depth)>();
    const Scattered::Comb at = combs(k);
    for (uint32_t i = 0; i < combs.length(); i++)
        Rgb888::put(render_pixel(view, at.x + i * combs.stride(), at.y, counts), rgb + 3 * i);
}

struct System {
    const char* name;
    void (*see)(uint32_t* places);
    void (*comb)(const Scattered&, uint32_t, uint8_t* rgb, RayCounts&);
};
constexpr System systems[] = {{"q16", see<q16>, comb<q16>},
                              {"q32", see<q32>, comb<q32>},
                              {"float", see<Float>, comb<Float>},
                              {"double", see<Double>, comb<Double>}};

int index_of(const char* name, size_t length)
{
    for (size_t i = 0; i < sizeof cli::renderers / sizeof *cli::renderers; i++)
        if (strlen(cli::number_names[i]) == length && strncmp(cli::number_names[i], name, length) == 0)
            return static_cast<int>(i);
    fail("no such number system: ", name);
}

const Renderer& renderer(const char* name) { return *cli::renderers[index_of(name, strlen(name))]; }

double now()
{
    timespec t{};
    clock_gettime(CLOCK_MONOTONIC, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Drawn {
    RayCounts counts;
    double seconds;
};

// False where the scene does not fit the number system.
bool build(const Renderer& with, const Settings& settings)
{
    Built built{};
    scene::Error error;
    return with.build(description, settings, built, error);
}

Drawn draw(const Renderer& with, const Settings& settings, uint8_t* to)
{
    Drawn d{};
    const double start = now();
    with.rows(0, settings.height, to, d.counts);
    d.seconds = now() - start;
    return d;
}

// NUMBER:SAMPLES:DEPTH:CUTOFF; returns the number's index.
int read_setting(const char* text, Settings& s)
{
    const char* colon = strchr(text, ':');
    char samples[32];
    unsigned depth = 0, levels = 0;
    if (colon == nullptr || sscanf(colon, ":%31[^:]:%u:%lf", samples, &depth, &s.cutoff) != 3)
        fail("expected NUMBER:SAMPLES:DEPTH:CUTOFF, not ", text);
    s.depth = depth;
    if (samples[0] == 'a') {
        if (sscanf(samples, "a%u,%lf", &levels, &s.threshold) < 1)
            fail("expected aLEVELS,THRESHOLD, not ", samples);
        s.levels = levels;
    } else {
        s.grid = static_cast<uint32_t>(lround(sqrt(atof(samples))));
    }
    return index_of(text, static_cast<size_t>(colon - text));
}

void measure(const char* scene, const char* setting, Settings s, bool whole)
{
    const int number = read_setting(setting, s);
    const Renderer& own = *cli::renderers[number];
    const Renderer& exact = renderer("double");
    const Renderer& single = renderer("float");
    if (!build(own, s)) {
        printf("%s,%u,%u,%s,refused\n", scene, s.width, s.height, setting);
        return;
    }
    build(exact, s);
    build(single, s);
    draw(exact, s, truth);
    double own_time = 1e9, single_time = 1e9;
    for (int i = 0; i < 3; i++) {
        single_time = fmin(single_time, draw(single, s, picture).seconds);
        own_time = fmin(own_time, draw(own, s, picture).seconds);
    }
    const Drawn drawn = draw(own, s, picture);
    const size_t pixels = size_t{s.width} * s.height;
    Errors arithmetic, total;
    arithmetic.add(picture, truth, pixels);
    total.add(picture, total_truth, pixels);
    long other = -1;
    for (const System& system : systems)
        if (strcmp(system.name, cli::number_names[number]) == 0) {
            system.see(seen[0]);
            see<Double>(seen[1]);
            other = 0;
            for (size_t i = 0; i < pixels; i++)
                other += seen[0][i] != seen[1][i];
        }
    uint64_t rays = 0;
    for (uint64_t n : drawn.counts.rays)
        rays += n;
    printf("%s,%u,%u,%s,%llu,%.3f", scene, s.width, s.height, setting, static_cast<unsigned long long>(rays),
           own_time / single_time);
    for (const Errors* e : {&arithmetic, &total})
        if (whole || e == &arithmetic)
            printf(",%.3f,%.4f,%d,%.6f", e->psnr(), e->rms(), e->largest, e->off_share());
        else
            fputs(",nan,nan,nan,nan", stdout);
    printf(",%ld\n", other);
}

// `systems` are in the order of cli::renderers.
void measure_combs(const char* range, const char* const* settings, Settings best)
{
    uint32_t first = 0, last = 0;
    if (sscanf(range, "%u-%u", &first, &last) != 2 || last < first)
        fail("expected FIRST-LAST, not ", range);
    Built built{};
    scene::Error error;
    best.grid = 8;
    best.depth = 8;
    renderer("double").build(description, best, built, error);
    const Scattered combs{built.width, built.height};
    last = last < combs.count() ? last : combs.count();
    const size_t length = combs.length();
    if (size_t{last - first} * length > max_pixels)
        fail("too many combs: ", range);
    printf("{\"width\": %u, \"height\": %u, \"combs\": %u, \"length\": %zu}\n", built.width, built.height,
           combs.count(), length);
    RayCounts counts;
    for (uint32_t k = first; k < last; k++)
        systems[index_of("double", 6)].comb(combs, k, truth + 3 * length * (k - first), counts);
    for (; *settings != nullptr; settings++) {
        Settings s = best;
        s.grid = 1;
        const int number = read_setting(*settings, s);
        if (!cli::renderers[number]->build(description, s, built, error)) {
            printf("{\"setting\": \"%s\", \"spawns\": 0, \"of\": []}\n", *settings);
            continue;
        }
        printf("{\"setting\": \"%s\", \"spawns\": %d, \"of\": [", *settings, built.effects.spawns());
        for (uint32_t k = first; k < last; k++) {
            counts = {};
            systems[number].comb(combs, k, picture, counts);
            Errors errors;
            errors.add(picture, truth + 3 * length * (k - first), length);
            uint64_t rays = 0;
            for (uint64_t n : counts.rays)
                rays += n;
            printf("%s[%llu, %.0f]", k == first ? "" : ", ", static_cast<unsigned long long>(rays), errors.squares);
        }
        puts("]}");
    }
}

} // namespace

} // namespace qray::study

int main(int argc, char** argv)
{
    using namespace qray::study;
    Settings s;
    const char* const mode = argc > 1 && argv[1][0] == '-' ? argv[1] : "";
    const char* const range = strcmp(mode, "-p") == 0 && argc > 2 ? argv[2] : nullptr;
    const bool whole = *mode == 0;
    const int used = (*mode != 0) + (range != nullptr);
    argv += used;
    argc -= used;
    const bool sized = argc > 2 && sscanf(argv[2], "%ux%u", &s.width, &s.height) == 2;
    if (argc < 4 || (range == nullptr && (!sized || s.width * s.height > max_pixels)))
        fail("usage: measure [-a | -p FIRST-LAST] SCENE WxH NUMBER:SAMPLES:DEPTH:CUTOFF ...", "");
    qray::scene::Error error;
    if (!qray::cli::read_scene(argv[1], description, error))
        fail(error.text, "");
    if (range != nullptr) {
        measure_combs(range, argv + 3, s);
        return 0;
    }
    Settings best = s;
    best.grid = 16;
    best.depth = 8;
    if (whole) {
        build(renderer("double"), best);
        draw(renderer("double"), best, total_truth);
    }
    puts("scene,width,height,setting,rays,time/float,arithmetic psnr,arithmetic rms,arithmetic largest,"
         "arithmetic off,total psnr,total rms,total largest,total off,other objects");
    for (int i = 3; i < argc; i++) {
        measure(argv[1], argv[i], s, whole);
        fflush(stdout);
    }
    return 0;
}
