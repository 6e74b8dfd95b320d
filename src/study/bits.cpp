// What each bit of each step buys (stepped.hpp), as JSON: squared differences to the picture in double.
//   bits OPTIONS SCENE     options of qray; -s, a size, is asked for
#include "../cli/draw.hpp"
#include "../cli/input.hpp"
#include "../cli/renderer.hpp"
#include "stepped.hpp"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include <vector>

namespace qray::study {

namespace {

constexpr int least_bits = 4, most_bits = 24, bits_step = 2;
// What a number system reaches is measured in a picture that has so many times the columns and the rows: in a small
// one, a single pixel more or less beside an edge may be 10 dB. It is rolled a little, as an edge along a row of pixels
// passes all of these at once or none.
constexpr uint32_t larger = 4;
constexpr double roll = 0.05;
// Where a step shows something else in fewer pixels than that, it is asked with fewer bits, but not with so few that
// shades are off by as much as what moves.
constexpr int enough = 64, fewer_bits[] = {0, 4, 8}, least_fewer = 8;

scene::Description description;
cli::Options options;
cli::Built built;

using Picture = std::vector<uint8_t>;
Picture truth;
bool has_step[steps], first_number = true;

bool draw(const cli::Renderer& renderer, Picture& rgb)
{
    scene::Error error;
    if (!renderer.build(description, options.settings, built, error))
        return false;
    rgb.resize(size_t{3} * built.width * built.height);
    cli::RayCounts counts;
    renderer.rows(0, built.height, rgb.data(), counts);
    return true;
}

bool draw(const Widths& with, Picture& rgb)
{
    set(with);
    scene::Storage<Stepped>& s = cli::storage_of<Stepped>();
    scene::Error error;
    if (!cli::make_room(s.room, s.lay_out(description, false))
        || !scene::Builder<Stepped>(description, options.settings, s).build(error))
        return false;
    round_tables(s);
    rgb.resize(truth.size());
    cli::RayCounts counts;
    const auto rows = description.object_count > few_objects ? cli::rows_of<Stepped, stepped_effects<true>()>
                                                             : cli::rows_of<Stepped, stepped_effects<false>()>;
    rows(0, s.camera.height, rgb.data(), counts);
    return true;
}

// Squared differences to the true picture: of bytes that are off by up to 2, and of others, which show something else,
// and how many pixels have such.
struct Squares {
    int64_t shade = 0, other = 0, pixels = 0;
};

template <class With>
Squares squares(const With& with)
{
    static Picture rgb;
    Squares sum;
    if (!draw(with, rgb))
        abort(); // it was drawn before, or its number system holds it
    for (size_t i = 0; i < rgb.size(); i += 3) {
        bool is_other = false;
        for (size_t k = i; k < i + 3; k++) {
            const int off = rgb[k] - truth[k];
            (off * off <= 4 ? sum.shade : sum.other) += off * off;
            is_other = is_other || off * off > 4;
        }
        sum.pixels += is_other;
    }
    return sum;
}

Squares squares(Step step, int bits)
{
    Widths w;
    w[step] = bits;
    return squares(w);
}

void print(int bits) { printf("%d", bits); }
void print(const Squares& s) { printf("[%" PRId64 ", %" PRId64 ", %" PRId64 "]", s.shade, s.other, s.pixels); }
template <class F>
void print_list(int count, F f)
{
    for (int i = 0; i < count; i++) {
        putchar(i == 0 ? '[' : ',');
        print(f(i));
    }
    putchar(']');
}

// The widths that a number system in fixed point has for this scene, and its name printed; false where it does not fit.
template <class N>
bool begin_number(cli::Number number, Widths& w)
{
    scene::Error error;
    if (!N::is_fixed || !cli::renderers[static_cast<int>(number)]->build(description, options.settings, built, error))
        return false;
    if constexpr (N::is_fixed)
        w = widths_of<N>(cli::storage_of<N>().exposure);
    printf("%s\"%s\": ", first_number ? "" : ", ", cli::number_names[static_cast<int>(number)]);
    first_number = false;
    return true;
}

// What it reaches, and what its widths say: all steps rounded at once.
template <class N>
void print_reached(cli::Number number)
{
    Widths own;
    if (!begin_number<N>(number, own))
        return;
    print_list(2, [&](int i) { return i == 0 ? squares(*cli::renderers[static_cast<int>(number)]) : squares(own); });
}

// Each step alone, in its own width and in the fewer bits that show what is other in enough pixels: a list of both, and
// how many bits fewer.
template <class N>
void print_alone(cli::Number number)
{
    Widths own;
    if (!begin_number<N>(number, own))
        return;
    for (int step = 0; step < steps; step++) {
        Squares at_own, at_fewer;
        int fewer = 0;
        const bool rounds = has_step[step] && own.bits[step] != exact;
        for (size_t i = 0; rounds && i < sizeof fewer_bits / sizeof *fewer_bits; i++) {
            if (i > 0 && own.bits[step] - fewer_bits[i] < least_fewer)
                break;
            fewer = fewer_bits[i];
            Widths w = own;
            for (int k = 0; k < steps; k++)
                w.bits[k] = k == step ? own.bits[k] - fewer : exact;
            at_fewer = squares(w);
            if (i == 0)
                at_own = at_fewer;
            if (at_fewer.pixels >= enough)
                break;
        }
        printf(step == 0 ? "[[" : ", [");
        print(at_own);
        printf(", ");
        print(at_fewer);
        printf(", %d]", fewer);
    }
    putchar(']');
}

void print_steps()
{
    constexpr const char* names[][3] = {
#define QRAY_NAME(name, quantity, what) {#name, #quantity, what},
        QRAY_STEPS(QRAY_NAME)
#undef QRAY_NAME
    };
    constexpr int count = (most_bits - least_bits) / bits_step + 1;
    const auto bits = [](int i) { return least_bits + i * bits_step; };
    printf("\"bits\": ");
    print_list(count, bits);
    printf(", \"steps\": [");
    for (int step = 0; step < steps; step++) {
        const auto& [name, quantity, what] = names[step];
        printf("%s{\"name\": \"%s\", \"of\": \"%s\", \"what\": \"%s\", \"squares\": ", step == 0 ? "" : ", ", name,
               quantity, what);
        const Squares most = squares(Step{step}, least_bits);
        has_step[step] = most.shade + most.other != 0;
        print_list(count, [&](int i) { return i == 0 || !has_step[step] ? most : squares(Step{step}, bits(i)); });
        putchar('}');
    }
    printf("], \"together\": ");
    print_list(count, [=](int i) { return squares(Widths(bits(i))); });
}

int run(int argc, char** argv)
{
    scene::Error error;
    const int status = cli::read_options(cli::Command::draw, argc, argv, options);
    if (status != cli::go_on)
        return status;
    const scene::Solving solving{cli::make_room, cli::run_in_threads, 1};
    if (!cli::read_scene(options.scene, description, error) || !solve_radiosity(description, solving, error))
        return cli::bad_options("%s", error.text);
    if (!draw(cli::double_renderer, truth))
        return cli::bad_options("%s: no picture", options.scene);
    printf("{\"levels\": %zu, ", truth.size());
    print_steps();
    scene::Vec3d& up = description.view.up;
    up = unit(up) + cross(unit(description.view.at - description.view.from), unit(up)) * roll;
    draw(cli::double_renderer, truth);
    printf(", \"alone\": {");
#define QRAY_NUMBER(Type, name) print_alone<Type>(cli::Number::Type);
    QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
    options.settings.width *= larger;
    options.settings.height *= larger;
    draw(cli::double_renderer, truth);
    first_number = true;
    printf("}, \"larger\": %u, \"reached\": {", larger * larger);
#define QRAY_NUMBER(Type, name) print_reached<Type>(cli::Number::Type);
    QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
    puts("}}");
    return 0;
}

} // namespace

} // namespace qray::study

int main(int argc, char** argv) { return qray::study::run(argc, argv); }
