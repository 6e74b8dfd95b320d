#include "options.hpp"

#include "../scene/description.hpp"
#include "../scene/moving.hpp"
#include "../scene/reader.hpp"

#include <qray/qray.hpp>

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <algorithm>
#include <iterator>

namespace qray::cli {

namespace {

struct Option {
    const char* name;
    const char* value; // its name, or null where the option has none
    unsigned commands; // that have it
    const char* help;
    const char* expected; // of its value
    bool (*take)(Options&, const char* value);
};

bool whole(std::string_view text, uint32_t low, uint32_t high, uint32_t& value)
{
    return scene::read_count(text, value) == scene::NumberError::none && value >= low && value <= high;
}

bool share(std::string_view text, double& value)
{
    return scene::read_number(text, value) == scene::NumberError::none && value >= 0 && value <= 1;
}

bool read_number(std::string_view text, Number& number)
{
    for (size_t i = 0; i < std::size(number_names); i++)
        if (text == number_names[i]) {
            number = static_cast<Number>(i);
            return true;
        }
    return false;
}

bool take_number(Options& o, const char* value) { return read_number(value, o.number); }

bool take_numbers(Options& o, const char* value)
{
    const std::string_view text = value;
    const size_t comma = text.find(',');
    return read_number(text.substr(0, comma), o.number)
        && read_number(comma == text.npos ? text : text.substr(comma + 1), o.beside);
}

bool take_size(Options& o, const char* value)
{
    const char* x = strchr(value, 'x');
    return x != nullptr
        && whole({value, static_cast<size_t>(x - value)}, 1, scene::Limits::resolution, o.settings.width)
        && whole(x + 1, 1, scene::Limits::resolution, o.settings.height);
}

bool take_samples(Options& o, const char* value)
{
    constexpr uint32_t most = scene::Settings::max_grid;
    uint32_t samples = 0, n = 1;
    if (!whole(value, 1, most * most, samples))
        return false;
    while (n * n < samples)
        n++;
    o.settings.grid = n;
    o.has_samples = true;
    return n * n == samples;
}

bool take_adaptive(Options& o, const char* value)
{
    const char* comma = strchr(value, ',');
    const size_t length = comma != nullptr ? static_cast<size_t>(comma - value) : strlen(value);
    return whole({value, length}, 1, scene::Settings::max_levels, o.settings.levels)
        && (comma == nullptr || share(comma + 1, o.settings.threshold));
}

// Of C++20, each between blanks.
constexpr std::string_view keywords =
    " alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t "
    "char32_t class compl concept const consteval constexpr constinit const_cast continue co_await "
    "co_return co_yield decltype default delete do double dynamic_cast else enum explicit export extern "
    "false float for friend goto if inline int long mutable namespace new noexcept not not_eq nullptr "
    "operator or or_eq private protected public register reinterpret_cast requires return short signed "
    "sizeof static static_assert static_cast struct switch template this thread_local throw true try "
    "typedef typeid typename union unsigned using virtual void volatile wchar_t while xor xor_eq ";

bool take_name(Options& o, const char* value)
{
    constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_0123456789";
    const size_t length = strlen(value);
    o.name = value;
    if (length == 0 || length > 64 || strspn(value, letters) != length || (*value >= '0' && *value <= '9'))
        return false;
    for (size_t at = 0; (at = keywords.find(value, at)) != keywords.npos; at++)
        if (keywords[at - 1] == ' ' && keywords[at + length] == ' ')
            return false;
    return true;
}

// Six numbers, of two corners of a box.
bool take_within(Options& o, const char* value)
{
    double at[6];
    std::string_view rest = value;
    for (int i = 0; i < 6; i++) {
        const size_t end = rest.find(',');
        if ((end == rest.npos) != (i == 5) || scene::read_number(rest.substr(0, end), at[i]) != scene::NumberError::none
            || fabs(at[i]) > scene::largest_length)
            return false;
        rest.remove_prefix(end == rest.npos ? 0 : end + 1);
    }
    o.settings.within.add({at[0], at[1], at[2]});
    o.settings.within.add({at[3], at[4], at[5]});
    return true;
}

constexpr unsigned draw = static_cast<unsigned>(Command::draw);
constexpr unsigned compile = static_cast<unsigned>(Command::compile);
constexpr unsigned explain = static_cast<unsigned>(Command::explain);
constexpr unsigned all = draw | compile | explain;

#define QRAY_NEXT_LINE "\n                        "
constexpr scene::MovableSaid moving_help(
    "what changes, in RAM: all, or a list, with commas, of: camera," QRAY_NEXT_LINE, QRAY_NEXT_LINE);
constexpr scene::MovableSaid moving_expected("'all', or a list, with commas, of: camera, ");

constexpr Option table[] = {
    {"-o", "FILE", draw, "the picture; '-' is standard output (default: SCENE.ppm in this folder)", "a name",
     [](Options& o, const char* v) { return *(o.output = v) != 0; }},
    {"-o", "FILE", compile, "the header; '-' is standard output (default: SCENE.hpp in this folder)", "a name",
     [](Options& o, const char* v) { return *(o.output = v) != 0; }},
    {"--name", "NAME", compile, "the header's namespace (default: scene)",
     "a C++ name of at most 64 letters, digits and _, and no keyword", take_name},
    {"-s", "WxH", all, "size in pixels (default: the scene's own)", "WIDTHxHEIGHT, each from 1 to 32768", take_size},
    {"-n", "NUMBER", draw | compile, "number system: " QRAY_NUMBERS_SAID " (default: q32)", QRAY_NUMBERS_SAID,
     take_number},
    {"-n", "NUMBER", explain, QRAY_NUMBERS_SAID " (default: q32); two to compare: q16,double",
     QRAY_NUMBERS_SAID ", or two of them with a comma between", take_numbers},
    {"-r", "N", all, "samples a pixel: 1, 4, 9, 16 and so on (default: 1)", "a square number from 1 to 4096",
     take_samples},
    {"-a", "LEVELS[,T]", all, "adaptive sampling (default: off): 1 to 6 levels, threshold 0 to 1 (0.0625)",
     "LEVELS or LEVELS,THRESHOLD, from 1 to 6 and from 0 to 1", take_adaptive},
    {"-d", "N", all, "depth of mirrored and refracted rays (default: 5)", "a whole number from 1 to 64",
     [](Options& o, const char* v) { return whole(v, 1, scene::Settings::max_depth, o.settings.depth); }},
    {"--cutoff", "W", all, "weight below which rays are not traced (default: 0.0014)", "a number from 0 to 1",
     [](Options& o, const char* v) { return share(v, o.settings.cutoff); }},
    {"--light-bits", "B", all, "bits of a colour in light maps: 2, 4 or 8 (default: 8)", "2, 4 or 8",
     [](Options& o, const char* v) {
         return whole(v, 2, 8, o.settings.light_bits) && (o.settings.light_bits & (o.settings.light_bits - 1)) == 0;
     }},
    {"--within", "BOX", all, "where things will be: a box, for the scale and planes' ends (x,y,z,x,y,z)",
     "two corners of a box, X,Y,Z,X,Y,Z", take_within},
    {"--moving", "WHAT", compile, moving_help.text, moving_expected.text,
     [](Options& o, const char* v) { return scene::read_moving(v, o.settings.moving); }},
    {"-j", "N", draw, "threads (default: one for each processor)", "a whole number from 1 to 256",
     [](Options& o, const char* v) { return whole(v, 1, max_threads, o.threads); }},
    {"--stats", nullptr, draw, "say what was in the scene, and what drawing it took", nullptr,
     [](Options& o, const char*) { return o.stats = true; }},
    {"-q", nullptr, all, "no progress, no warnings", nullptr, [](Options& o, const char*) { return o.quiet = true; }},
};
static_assert(scene::Limits::resolution == 32768 && scene::Settings::max_grid == 64 && scene::Settings::max_depth == 64
              && scene::Settings::max_levels == 6 && max_threads == 256); // as the texts say

bool has(const Option& option, Command command)
{
    return (option.commands & static_cast<unsigned>(command)) != 0;
}

void print_help(Command command)
{
    const bool draws = command == Command::draw, compiles = command == Command::compile;
    puts(draws ? "usage: qray [options] SCENE\n"
                 "Draws a scene ('-': standard input) as a binary PPM picture.\n"
         : compiles
               ? "usage: qray compile [options] SCENE\n"
                 "Turns a scene ('-': standard input) into a C++ header, to be drawn without an operating system.\n"
               : "usage: qray explain [options] SCENE X,Y\n"
                 "Says why a pixel of a scene ('-': standard input), X from the left and Y from the top, has its\n"
                 "colour: the tree of rays, what each meets, what each light adds or what blocks it.\n");
    for (const Option& o : table)
        if (has(o, command)) {
            const int name = std::max(9, static_cast<int>(strlen(o.name)));
            printf("  %-9s %-*s %s\n", o.name, 20 - name, o.value != nullptr ? o.value : "", o.help);
        }
    puts("  -h, --help            this\n"
         "  --version\n");
    puts(draws ? "example: qray scenes/showcase.nff -s 640x480 -r 4 -o picture.ppm\n"
                 "also: qray compile -h; qray explain -h, why a pixel is so; qray --describe, what there is as JSON\n"
                 "exit status: 0; 1: bad scene, or the picture cannot be written; 2: bad options"
         : compiles ? "example: qray compile scenes/showcase.nff -s 64x48 -n q32 -o showcase.hpp"
                    : "example: qray explain scenes/showcase.nff -s 64x48 -n q16,double 20,30");
}

const char* command_name(Command command)
{
    return command == Command::draw ? "qray" : command == Command::compile ? "qray compile" : "qray explain";
}

// "12,34", of the pixel to explain.
bool take_pixel(Options& o, const char* text)
{
    const std::string_view value = text;
    const size_t comma = value.find(',');
    const auto take = [](std::string_view number, uint32_t& to) {
        const bool negative = number.starts_with('-');
        if (number.size() == negative || number.find_first_not_of("0123456789", negative) != number.npos)
            return false;
        if (negative || !whole(number, 0, scene::Limits::resolution, to))
            to = UINT32_MAX;
        return true;
    };
    o.pixel = text;
    return comma != value.npos && take(value.substr(0, comma), o.x) && take(value.substr(comma + 1), o.y);
}

// "-s 64x48", "-s64x48", "--cutoff 0.1", "--cutoff=0.1"; `value` is null where none is in the argument itself.
const Option* find(Command command, const char* argument, const char*& value)
{
    for (const Option& o : table) {
        const size_t length = strlen(o.name);
        if (!has(o, command) || strncmp(argument, o.name, length) != 0)
            continue;
        const char* rest = argument + length;
        const bool word = o.name[1] == '-';
        if (*rest == 0)
            value = nullptr;
        else if (o.value != nullptr && (!word || *rest == '='))
            value = rest + word;
        else
            continue;
        return &o;
    }
    return nullptr;
}

} // namespace

int bad_options(const char* format, ...)
{
    char text[600];
    va_list values;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    fprintf(stderr, "qray: %s\n", text);
    return 2;
}

int read_options(Command command, int argc, char** argv, Options& options)
{
    bool only_scenes = false;
    for (int i = 1; i < argc; i++) {
        const char* argument = argv[i];
        const bool wants_pixel = command == Command::explain && options.scene != nullptr && options.pixel == nullptr;
        const bool negative = argument[0] == '-' && argument[1] >= '0' && argument[1] <= '9';
        if (only_scenes || argument[0] != '-' || argument[1] == 0 || (wants_pixel && negative)) {
            if (wants_pixel) {
                if (!take_pixel(options, argument))
                    return bad_options("'%s' is no pixel; expected X,Y, from 0", scene::ShownName(argument).text);
                continue;
            }
            if (options.scene != nullptr)
                return bad_options("one scene at a time; '%s' is a second", scene::ShownName(argument).text);
            options.scene = argument;
            continue;
        }
        if (strcmp(argument, "--") == 0) {
            only_scenes = true;
            continue;
        }
        if (strcmp(argument, "-h") == 0 || strcmp(argument, "--help") == 0) {
            print_help(command);
            return 0;
        }
        if (strcmp(argument, "--version") == 0) {
            printf("qray %d.%d.%d\n", QRAY_VERSION / 10000, QRAY_VERSION / 100 % 100, QRAY_VERSION % 100);
            return 0;
        }
        const char* value = nullptr;
        const Option* option = find(command, argument, value);
        if (option == nullptr)
            return bad_options("unknown option '%s'; '%s -h' lists them", scene::ShownName(argument).text,
                               command_name(command));
        if (option->value != nullptr && value == nullptr) {
            if (i + 1 == argc)
                return bad_options("'%s' is followed by nothing; expected %s", option->name, option->expected);
            value = argv[++i];
        }
        if (!option->take(options, value))
            return bad_options("'%s %s': expected %s", option->name, scene::ShownName(value).text, option->expected);
    }
    options.settings.compiled = command == Command::compile;
    if (options.has_samples && options.settings.levels != 0)
        return bad_options("'-a' and '-r' exclude each other: adaptive sampling chooses the samples of a pixel");
    if (options.scene == nullptr || *options.scene == 0)
        return bad_options("no scene; '%s -h' shows how to give one", command_name(command));
    if (command == Command::explain && options.pixel == nullptr)
        return bad_options("no pixel; expected X,Y behind the scene");
    return go_on;
}

} // namespace qray::cli
