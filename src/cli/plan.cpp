// qray plan: which number system, sampling and depth for this scene on that board.
#include "plan.hpp"

#include "../scene/effect_names.hpp"
#include "../scene/reader.hpp"
#include "../study/calibration.hpp"
#include "../study/errors.hpp"
#include "check.hpp"
#include "counts.hpp"
#include "load.hpp"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <algorithm>

namespace qray::cli {

namespace {

using scene::Settings;
using study::Calibration;

// Else calibration.hpp is of other operations; it is made with this program, which must compile with either.
constexpr int costs_known = sizeof(Calibration::cost) / sizeof(double);

// Pictures are judged by some of their rows: enough to hold this many pixels, and not fewer than these rows.
constexpr uint32_t wanted_pixels = 4000, wanted_rows = 8, most_rows = 64;
constexpr size_t row_bytes = 3 * scene::Limits::resolution;
uint8_t truth[size_t{most_rows} * row_bytes], row[row_bytes];

struct Sampling {
    uint32_t grid, levels;
    double threshold;
};
constexpr Sampling samplings[] = {{1, 0, 0}, {2, 0, 0},        {3, 0, 0},
                                  {4, 0, 0}, {1, 2, 1.0 / 16}, {1, 3, 1.0 / 32}};
constexpr uint32_t depths[] = {5, 3, 2, 1};

struct Candidate {
    const Calibration* costs;
    int number;
    Settings settings;
    double instructions, seconds, flash, ram;
    study::Errors errors;
};
constexpr size_t max_candidates = sizeof renderers / sizeof *renderers * 6 * 4;
Candidate candidates[max_candidates];
Candidate* frontier[max_candidates];

const Calibration* find_costs(const char* board, const char* number)
{
    for (const Calibration& c : study::calibrations)
        if (strcmp(c.board, board) == 0 && strcmp(c.number, number) == 0)
            return &c;
    return nullptr;
}

bool known_board(const char* board)
{
    for (const Calibration& c : study::calibrations)
        if (strcmp(c.board, board) == 0)
            return true;
    return false;
}

int unknown_board(const char* board)
{
    char names[300] = "";
    const char* last = "";
    for (const Calibration& c : study::calibrations)
        if (strcmp(last, c.board) != 0) {
            last = c.board;
            const size_t used = strlen(names);
            snprintf(names + used, sizeof names - used, "%s%s", used != 0 ? ", " : "", last);
        }
    if (board == nullptr)
        return bad_options("no board; '--board' takes one of %s", names);
    return bad_options("no board '%s' is calibrated; there are %s", scene::ShownName(board).text, names);
}

double instructions(const Calibration& costs, const OperationCounts& counts, const Effects& effects,
                    const Settings& s)
{
    int called_for = 0;
    for (const scene::EffectName& e : scene::effect_names)
        called_for += effects.*e.effect && e.effect != &Effects::tree && e.effect != &Effects::eye_surface
            && e.effect != &Effects::grid && e.effect != &Effects::adaptive;
    double sum = 0;
    for (int i = 0; i < std::min(operation_count, costs_known); i++)
        sum += (costs.cost[i] + costs.more[i] * called_for) * counts.of[i];
    return sum * (s.levels != 0 ? costs.adaptive : s.grid != 1 ? costs.grid : 1);
}

// Of a table of every program's bytes and of each effect's.
double bytes(const double* table, const Effects& effects)
{
    double sum = table[0];
    for (size_t i = 0; i < sizeof study::effect_order / sizeof *study::effect_order; i++)
        for (const scene::EffectName& e : scene::effect_names)
            if (strcmp(e.name, study::effect_order[i]) == 0 && effects.*e.effect)
                sum += table[i + 1];
    return sum;
}

double flash(const Calibration& costs, const Built& built)
{
    return bytes(costs.flash_bytes, built.effects) + built.table_bytes
        + costs.kind_bytes * (built.effects.shapes() - 1)
        + costs.ball_bytes * (built.balls <= study::few_balls ? built.balls : 0);
}

double ram(const Calibration& costs, const Effects& effects, const Settings& s, uint32_t width)
{
    const double deeper = effects.transmit && s.depth > 5 ? s.depth - 5 : 0;
    return 3.0 * width + bytes(costs.stack_bytes, effects) + 48 * deeper;
}

// The rows that stand for all: every stride-th, from the middle of the first stride on.
struct Rows {
    uint32_t width, height, stride;
    explicit Rows(const Built& b) : width(b.width), height(b.height), stride(1)
    {
        const uint32_t rows = std::clamp(wanted_pixels / b.width, wanted_rows, most_rows);
        stride = std::max(b.height / rows, 1u);
        while (count() > most_rows)
            stride++;
    }
    uint32_t count() const { return (height - stride / 2 + stride - 1) / stride; }
    uint32_t at(uint32_t i) const { return stride / 2 + i * stride; }
};

void judge(const Renderer& renderer, const Rows& rows, study::Errors& errors)
{
    RayCounts counts;
    for (uint32_t i = 0; i < rows.count(); i++) {
        renderer.rows(rows.at(i), rows.at(i) + 1, row, counts);
        errors.add(row, truth + size_t{3} * i * rows.width, rows.width);
    }
}

Settings best_settings(Settings s)
{
    s.grid = 16;
    s.depth = 8;
    s.levels = 0;
    return s;
}

void draw_truth(const Options& options, const Rows& rows)
{
    const Renderer& exact = *renderers[static_cast<int>(Number::double_float)];
    Built built{};
    scene::Error error;
    exact.build(description(), best_settings(options.settings), built, error);
    RayCounts counts;
    for (uint32_t i = 0; i < rows.count(); i++)
        exact.rows(rows.at(i), rows.at(i) + 1, truth + size_t{3} * i * rows.width, counts);
}

// All candidates of the board, with what is predicted of them; returns how many.
size_t predict(const Options& options, const Rows& rows)
{
    size_t found = 0;
    bool spawns[sizeof renderers / sizeof *renderers] = {}; // at the first depth, the greatest
    for (const Sampling& sampling : samplings)
        for (uint32_t depth : depths) {
            Settings s = options.settings;
            s.grid = sampling.grid;
            s.levels = sampling.levels;
            s.threshold = sampling.threshold;
            s.depth = depth;
            const uint32_t fewer = std::max(rows.height / wanted_rows, 1u);
            const uint32_t stride = std::clamp(rows.stride * s.grid, 1u, fewer);
            const OperationCounts fixed = count_operations(description(), s, stride, false);
            const OperationCounts floating = count_operations(description(), s, stride, true);
            for (size_t n = 0; n < sizeof renderers / sizeof *renderers; n++) {
                const Calibration* costs = find_costs(options.board, number_names[n]);
                Built built{};
                scene::Error error;
                if (costs == nullptr || !renderers[n]->build(description(), s, built, error))
                    continue;
                if (depth == depths[0])
                    spawns[n] = built.effects.spawns();
                else if (!spawns[n])
                    continue;
                Candidate& c = candidates[found];
                const OperationCounts& counts = n >= static_cast<size_t>(Number::single_float) ? floating : fixed;
                c = {costs, static_cast<int>(n), s, instructions(*costs, counts, built.effects, s), 0,
                     flash(*costs, built),
                     ram(*costs, built.effects, s, built.width), {}};
                c.seconds = options.mhz > 0 ? c.instructions * costs->cycles / (options.mhz * 1e6) : 0;
                if (c.flash > costs->flash || c.ram > costs->ram)
                    continue;
                judge(*renderers[n], rows, c.errors);
                found++;
            }
        }
    return found;
}

double cycles(const Candidate& c) { return c.instructions * c.costs->cycles; }

// Those that no other is both cheaper and as accurate as, the cheapest first. Less gain than this is none.
constexpr double least_gain = 0.1; // dB

size_t find_frontier(size_t count)
{
    Candidate* sorted[max_candidates];
    for (size_t i = 0; i < count; i++)
        sorted[i] = &candidates[i];
    std::sort(sorted, sorted + count, [](const Candidate* a, const Candidate* b) {
        return cycles(*a) != cycles(*b) ? cycles(*a) < cycles(*b) : a->errors.psnr() > b->errors.psnr();
    });
    size_t kept = 0;
    for (size_t i = 0; i < count; i++)
        if (kept == 0 || sorted[i]->errors.psnr() > frontier[kept - 1]->errors.psnr() + least_gain)
            frontier[kept++] = sorted[i];
    return kept;
}

const Candidate* choose(const Options& o, size_t count)
{
    const Candidate* best = nullptr;
    for (size_t i = 0; i < count; i++) {
        const Candidate* c = frontier[i];
        if (o.seconds > 0 && c->seconds > o.seconds)
            continue;
        if ((o.decibels > 0 && c->errors.psnr() < o.decibels) || (o.levels > 0 && c->errors.rms() > o.levels))
            continue;
        best = c;
        if (o.decibels > 0 || o.levels > 0) // the cheapest that is accurate enough
            break;
    }
    return best;
}

void sampling_text(const Settings& s, char* out, size_t size)
{
    if (s.levels != 0)
        snprintf(out, size, "adaptive %u,%g", s.levels, s.threshold);
    else
        snprintf(out, size, "%u", s.grid * s.grid);
}

void print_frontier(const Options& o, size_t count, const Candidate* chosen)
{
    printf("  %-7s %-16s %5s %14s %9s %6s %7s %7s %6s\n", "number", "samples", "depth", "instructions",
           o.mhz > 0 ? "seconds" : "", "dB", "levels", "flash", "RAM");
    for (size_t i = 0; i < count; i++) {
        const Candidate& c = *frontier[i];
        char sampling[40], seconds[40] = "";
        sampling_text(c.settings, sampling, sizeof sampling);
        if (o.mhz > 0)
            snprintf(seconds, sizeof seconds, "%.3g", c.seconds);
        printf("%c %-7s %-16s %5u %14.0f %9s %6.1f %7.2f %7.0f %6.0f\n", &c == chosen ? '*' : ' ',
               number_names[c.number], sampling, c.settings.depth, c.instructions, seconds, c.errors.psnr(),
               c.errors.rms(), c.flash, c.ram);
    }
}

struct Variables {
    char text[8][300];
    const char* all[10];
};

// What make is given, with a last null; beside these, the name of the output.
void variables(const Options& o, const Built& built, const Candidate& c, Variables& v)
{
    size_t n = 0;
    const auto put = [&](const char* format, auto... values) {
        snprintf(v.text[n], sizeof v.text[n], format, values...);
        v.all[n] = v.text[n];
        n++;
    };
    put("BOARD=%s", o.board);
    put("SCENE=%s", o.scene);
    put("NUMBER=%s", number_names[c.number]);
    put("SIZE=%ux%u", built.width, built.height);
    if (c.settings.levels != 0)
        put("ADAPTIVE=%u,%g", c.settings.levels, c.settings.threshold);
    else if (c.settings.grid != 1)
        put("SAMPLES=%u", c.settings.grid * c.settings.grid);
    if (c.settings.depth != Settings().depth)
        put("DEPTH=%u", c.settings.depth);
    if (c.settings.cutoff != Settings().cutoff)
        put("CUTOFF=%g", c.settings.cutoff);
    v.all[n] = nullptr;
}

int check(const Options& o, const Candidate& c, const Variables& v)
{
    Truth measured{};
    if (!run_firmware(o.scene, v.all, measured))
        return 1;
    const Renderer& exact = *renderers[static_cast<int>(Number::double_float)];
    Built built{};
    scene::Error error;
    exact.build(description(), best_settings(o.settings), built, error);
    study::Errors errors;
    if (!compare_picture(measured.picture, exact, built, errors))
        return 1;
    printf("\n%-13s %14s %14s %9s\n", "", "predicted", "measured", "off");
    const auto line = [](const char* name, double predicted, double found, const char* format) {
        char a[40], b[40];
        snprintf(a, sizeof a, format, predicted);
        snprintf(b, sizeof b, format, found);
        printf("%-13s %14s %14s %+8.1f%%\n", name, a, b, 100 * (predicted / found - 1));
    };
    line("instructions", c.instructions, measured.instructions, "%.0f");
    line("flash", c.flash, measured.flash, "%.0f");
    line("RAM", c.ram, measured.ram, "%.0f");
    printf("%-13s %11.1f dB %11.1f dB %+6.1f dB\n", "accuracy", c.errors.psnr(), errors.psnr(),
           c.errors.psnr() - errors.psnr());
    return 0;
}

} // namespace

int plan_main(int argc, char** argv)
{
    Options options;
    const int status = read_options(Command::plan, argc, argv, options);
    if (status != go_on)
        return status;
    if (costs_known != operation_count) {
        fputs("qray: operations have changed since their costs were measured; make calibrate does that\n",
              stderr);
        return 1;
    }
    if (options.board == nullptr || !known_board(options.board))
        return unknown_board(options.board);
    if (options.seconds > 0 && !(options.mhz > 0))
        return bad_options("'--seconds' needs the board's clock: '--mhz F'");
    if (options.seconds <= 0 && options.decibels <= 0 && options.levels <= 0)
        return bad_options("what is wanted? '--seconds S' or '--error E'");
    if (options.check && strcmp(options.scene, "-") == 0)
        return bad_options("'--check' needs the scene in a file");

    options.number = Number::double_float; // which every scene fits
    Built built{};
    const int loaded = load(options, *renderers[static_cast<int>(options.number)], "-", built);
    if (loaded != go_on)
        return loaded;
    const Rows rows(built);
    draw_truth(options, rows);
    const size_t count = find_frontier(predict(options, rows));
    const Candidate* chosen = choose(options, count);
    printf("%s on %s, %u x %u pixels; predicted from %u of %u rows\n", scene::ShownName(options.scene).text,
           options.board, built.width, built.height, rows.count(), built.height);
    print_frontier(options, count, chosen);
    fflush(stdout);
    if (chosen == nullptr) {
        fprintf(stderr, count == 0 ? "%s: no setting fits the memory of %s\n"
                                   : "%s: no setting for %s is within what was asked for\n",
                scene::ShownName(options.scene).text, options.board);
        return 1;
    }
    Variables v{};
    variables(options, built, *chosen, v);
    printf("\nmake run");
    for (const char* const* word = v.all; *word != nullptr; word++)
        printf(" %s", *word);
    putchar('\n');
    fflush(stdout);
    return options.check ? check(options, *chosen, v) : 0;
}

} // namespace qray::cli
