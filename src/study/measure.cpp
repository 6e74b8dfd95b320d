// Rays and errors on combs of a picture's pixels (scattered.hpp), as JSON.
//   measure FIRST-LAST OPTIONS SCENE , OPTIONS SCENE , ...     options of qray, for one scene in one size
// A line says what the combs are, and one for each picture but the first what it has in combs FIRST to LAST - 1: rays,
// the sum of squared differences to the first picture, and pixels whose centre shows another object than there.
// Nothing of a picture that does not fit its number system.
#include "../cli/draw.hpp"
#include "../cli/input.hpp"
#include "../cli/renderer.hpp"
#include "scattered.hpp"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include <iterator>

namespace qray::study {

namespace {

using cli::RayCounts;

constexpr uint32_t max_pixels = 640 * 480;
scene::Description description;

struct Pixels {
    uint8_t rgb[3 * max_pixels];
    uint32_t objects[max_pixels]; // what the ray through each pixel's centre sees first, by its tag
} truth, drawn;

// A comb's pixels, from `to` on. Returns the rays.
template <class N>
uint64_t draw(const Scattered& combs, uint32_t k, Pixels& pixels, size_t to)
{
    const auto view = cli::storage_of<N>().template view<scene::desktop_effects()>();
    const Camera<N>& c = view.camera;
    const auto [x, y] = combs(k);
    RayCounts counts;
    for (uint32_t i = 0; i < combs.length(); i++, to++) {
        const uint32_t column = x + i * combs.stride();
        Rgb888::put(render_pixel(view, column, y, counts), column, y, pixels.rgb + 3 * to);
        const auto centre = [&c](uint32_t place, uint32_t places) {
            return c.grid * static_cast<int32_t>(2 * place + 1 - places);
        };
        Hit<N> hit;
        nearest(view, eye_ray(view, c.row(centre(y, c.height)) + c.right * centre(column, c.width)), hit);
        pixels.objects[to] = hit.tag.place();
    }
    return counts.rays[0] + counts.rays[1] + counts.rays[2] + counts.rays[3];
}
#define QRAY_NUMBER(Type, name) draw<Type>,
constexpr uint64_t (*draw_in[])(const Scattered&, uint32_t, Pixels&, size_t) = {QRAY_NUMBERS(QRAY_NUMBER)};
#undef QRAY_NUMBER

// [rays, squares, other objects]
void print_comb(uint64_t rays, size_t first, size_t length)
{
    uint64_t squares = 0;
    uint32_t others = 0;
    for (size_t i = 3 * first; i < 3 * (first + length); i++) {
        const int difference = drawn.rgb[i] - truth.rgb[i];
        squares += static_cast<uint64_t>(difference * difference);
    }
    for (size_t i = first; i < first + length; i++)
        others += drawn.objects[i] != truth.objects[i];
    printf("[%" PRIu64 ", %" PRIu64 ", %u]", rays, squares, others);
}

// Returns the status to exit with.
int measure(const cli::Options& options, uint32_t first, uint32_t last, bool is_first)
{
    cli::Built built{};
    scene::Error error;
    const int number = static_cast<int>(options.number);
    if (!cli::renderers[number]->build(description, options.settings, built, error)) {
        puts("[]");
        return 0;
    }
    const Scattered combs{built.width, built.height};
    const size_t length = combs.length();
    last = last < combs.count() ? last : combs.count();
    if (last > first && (last - first) * length > max_pixels)
        return cli::bad_options("more than %u pixels", max_pixels);
    if (is_first)
        printf("{\"width\": %u, \"height\": %u, \"combs\": %u, \"length\": %zu}\n", built.width, built.height,
               combs.count(), length);
    else
        putchar('[');
    for (uint32_t k = first; k < last; k++) {
        const size_t to = (k - first) * length;
        const uint64_t rays = draw_in[number](combs, k, is_first ? truth : drawn, to);
        if (is_first)
            continue;
        print_comb(rays, to, length);
        fputs(k + 1 < last ? ", " : "", stdout);
    }
    fputs(is_first ? "" : "]\n", stdout);
    return 0;
}

} // namespace

} // namespace qray::study

int main(int argc, char** argv)
{
    using namespace qray;
    uint32_t first = 0, last = 0;
    if (argc < 3 || sscanf(argv[1], "%u-%u", &first, &last) != 2)
        return cli::bad_options("usage: measure FIRST-LAST OPTIONS SCENE , OPTIONS SCENE , ...");
    for (int at = 1, end; at < argc; at = end) { // of the range or a comma, and of the next comma
        end = at + 1;
        while (end < argc && strcmp(argv[end], ",") != 0)
            end++;
        cli::Options options;
        scene::Error error;
        int status = cli::read_options(cli::Command::draw, end - at, argv + at, options);
        const scene::Solving solving{cli::make_room, cli::run_in_threads, cli::thread_count(options.threads)};
        if (status == cli::go_on && at == 1
            && !(cli::read_scene(options.scene, study::description, error)
                 && solve_radiosity(study::description, solving, error)))
            status = cli::bad_options("%s", error.text);
        if (status == cli::go_on)
            status = study::measure(options, first, last, at == 1);
        if (status != 0)
            return status;
    }
    return 0;
}
