// What each bit of each step buys (stepped.hpp), as JSON: sums of squared differences to the picture in double.
//   bits OPTIONS SCENE     options of qray
#include "../cli/draw.hpp"
#include "../cli/input.hpp"
#include "../cli/renderer.hpp"
#include "stepped.hpp"

#include <inttypes.h>
#include <stdio.h>

#include <type_traits>
#include <vector>

namespace qray::study {

namespace {

constexpr int least_bits = 4, most_bits = 24, bits_step = 2;

scene::Description description;
cli::Options options;
cli::Built built;

using Picture = std::vector<uint8_t>;
Picture truth;

// Where a tree would say which shapes a ray meets, what rounding makes of their edges would not show. It is taken for
// what is too large without: nearly all are triangles then, and the inside of these is exact.
constexpr uint32_t few_objects = 200;
template <bool Tree>
constexpr Effects stepped_effects()
{
    Effects e = scene::desktop_effects();
    e.tree = Tree;
    e.grid = e.adaptive = false;
    return e;
}

// What a scene says of its materials and its lights.
void round_tables(scene::Storage<Stepped>& s)
{
    const auto all = []<Step S, class T, class M>(std::integral_constant<Step, S>, scene::Array<T>& table, M T::*member) {
        for (uint32_t i = 0; i < table.count; i++)
            table.data[i].*member = keep<S>(table.data[i].*member);
    };
    constexpr std::integral_constant<Step, Step::weight> weight;
    constexpr std::integral_constant<Step, Step::colour> colour;
    all(weight, s.mattes, &Matte<Stepped>::diffuse);
    all(weight, s.highlights, &Highlight<Stepped>::amount);
    all(weight, s.mirrors, &Mirror<Stepped>::amount);
    all(weight, s.transmits, &Transmit<Stepped>::amount);
    s.cutoff = keep<Step::weight>(s.cutoff);
    all(colour, s.mattes, &Matte<Stepped>::ambient);
    all(colour, s.even_lights, &EvenLight<Stepped>::light);
#define QRAY_ROUND(Type, name, table) all(colour, s.table, &Type<Stepped>::colour);
    QRAY_LIGHTS(QRAY_ROUND)
#undef QRAY_ROUND
    s.background = keep<Step::colour>(s.background);
}

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

template <class With>
int64_t squares(const With& with)
{
    static Picture rgb;
    if (!draw(with, rgb))
        return -1;
    int64_t sum = 0;
    for (size_t i = 0; i < rgb.size(); i++)
        sum += (rgb[i] - truth[i]) * (rgb[i] - truth[i]);
    return sum;
}

int64_t squares(Step step, int bits)
{
    Widths w;
    w[step] = bits;
    return squares(w);
}

// What a number system reaches, and what its widths say: all steps rounded at once, and each alone.
template <class N>
void print_number(cli::Number number)
{
    const int64_t reached = squares(*cli::renderers[static_cast<int>(number)]);
    const Widths own = widths_of<N>(cli::storage_of<N>().exposure);
    printf("\"%s\": {\"reached\": %" PRId64 ", \"together\": %" PRId64, cli::number_names[static_cast<int>(number)], reached,
           reached < 0 ? -1 : squares(own));
    for (int i = 0; i < steps && reached >= 0; i++) {
        Widths w = own;
        for (int k = 0; k < steps; k++)
            w.bits[k] = k == i ? own.bits[k] : exact;
        printf(", \"%d\": %" PRId64, i, squares(w));
    }
    putchar('}');
}

void print_steps()
{
    const char* const names[] = {
#define QRAY_NAME(name, quantity, what) #name,
        QRAY_STEPS(QRAY_NAME)
#undef QRAY_NAME
    };
    printf("\"steps\": {");
    for (int i = 0; i < steps; i++) {
        printf("%s\"%s\": [", i ? ", " : "", names[i]);
        const Step step{i};
        const int64_t most = squares(step, least_bits);
        printf("%" PRId64, most);
        for (int bits = least_bits + bits_step; bits <= most_bits; bits += bits_step)
            printf(", %" PRId64, most == 0 ? 0 : squares(step, bits)); // else the scene has no such step
        putchar(']');
    }
    printf("}, \"together\": [");
    for (int bits = least_bits; bits <= most_bits; bits += bits_step)
        printf("%s%" PRId64, bits > least_bits ? ", " : "", squares(Widths(bits)));
    putchar(']');
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
    printf("{\"levels\": %zu, \"exact\": %" PRId64 ", ", truth.size(), squares(Widths()));
    print_steps();
    printf(", \"numbers\": {");
    print_number<q16>(cli::Number::q16);
    printf(", ");
    print_number<q32>(cli::Number::q32);
    puts("}}");
    return 0;
}

} // namespace

} // namespace qray::study

int main(int argc, char** argv) { return qray::study::run(argc, argv); }
