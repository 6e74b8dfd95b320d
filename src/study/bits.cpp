// What each bit of each step buys (stepped.hpp), as JSON: squared differences to the picture in double.
//   bits OPTIONS SCENE     options of qray
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

scene::Description description;
cli::Options options;
cli::Built built;

using Picture = std::vector<uint8_t>;
Picture truth;
bool first_number = true;

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

// Squared differences to the true picture: of bytes that are off by up to 2, and of others, which show something else.
struct Squares {
    int64_t shade = 0, other = 0;
};

template <class With>
Squares squares(const With& with)
{
    static Picture rgb;
    Squares sum;
    if (!draw(with, rgb))
        abort(); // it was drawn before, or its number system holds it
    for (size_t i = 0; i < rgb.size(); i++) {
        const int off = rgb[i] - truth[i];
        (off * off <= 4 ? sum.shade : sum.other) += off * off;
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
void print(const Squares& s) { printf("[%" PRId64 ", %" PRId64 "]", s.shade, s.other); }
template <class F>
void print_list(int count, F f)
{
    for (int i = 0; i < count; i++) {
        putchar(i == 0 ? '[' : ',');
        print(f(i));
    }
    putchar(']');
}

// What a number system reaches, and what its widths say: all steps rounded at once, and each alone.
template <class N>
    requires(!N::is_fixed)
void print_number(cli::Number)
{
}
template <class N>
void print_number(cli::Number number)
{
    const cli::Renderer& renderer = *cli::renderers[static_cast<int>(number)];
    scene::Error error;
    if (!renderer.build(description, options.settings, built, error))
        return;
    printf("%s\"%s\": {\"reached\": ", first_number ? "" : ", ", cli::number_names[static_cast<int>(number)]);
    first_number = false;
    print(squares(renderer));
    const Widths own = widths_of<N>(cli::storage_of<N>().exposure);
    printf(", \"together\": ");
    print(squares(own));
    printf(", \"alone\": ");
    print_list(steps, [&own](int i) {
        Widths w = own;
        for (int k = 0; k < steps; k++)
            w.bits[k] = k == i ? own.bits[k] : exact;
        return squares(w);
    });
    putchar('}');
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
        const bool has_step = most.shade + most.other != 0;
        print_list(count, [&](int i) { return i == 0 || !has_step ? most : squares(Step{step}, bits(i)); });
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
    printf(", \"numbers\": {");
#define QRAY_NUMBER(Type, name) print_number<Type>(cli::Number::Type);
    QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
    puts("}}");
    return 0;
}

} // namespace

} // namespace qray::study

int main(int argc, char** argv) { return qray::study::run(argc, argv); }
