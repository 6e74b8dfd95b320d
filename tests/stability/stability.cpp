// Robust forms and textbook forms beside each other: stability [--rays N] [--seed N] [--threads N] prints a
// table of errors, comma separated; stability --cost prints the names of what is measured, in order, for
// valgrind's callgrind, which counts the instructions in measured_loop() between two calls of measured_end().
#include <cstdlib>
#include <string>
#include <vector>

#include "beside.hpp"

using namespace hostile;

extern "C" {
[[gnu::noinline]] uint64_t measured_loop(uint64_t (*f)(const void*), const void* with)
{
    return f(with);
}
[[gnu::noinline]] void measured_end(const char* name)
{
    std::printf("%s\n", name);
}
}

namespace {

volatile uint64_t kept;

constexpr int objects = 128, rays_each = 16;

// What a tracer has at hand when it tests rays at one shape.
template <class N, template <class> class TrialOf>
struct Bundle {
    using T = typename textbook::Beside<N>::T;
    TrialOf<N> trial;
    decltype(textbook::form<T, TrialOf<N>::effects>()) form;
    qray::Ray<N> rays[rays_each];
    std::vector<qray::RejectRay<N>> rejects;
    textbook::Ray<T> textbook_rays[rays_each];

    void make(Random& random)
    {
        trial.make(random, Regime::ordinary);
        form.look_at(trial);
        rejects.clear();
        for (int i = 0; i < rays_each; i++) {
            rays[i] = trial.aim(random, Regime::ordinary);
            rejects.emplace_back(rays[i]);
            textbook_rays[i] = textbook::ray<T>(rays[i]);
        }
    }
    static uint64_t nothing(const void* with)
    {
        const auto& b = *static_cast<const Bundle*>(with);
        uint64_t hits = 0;
        for (int i = 0; i < rays_each; i++)
            hits += b.rays[i].outward;
        return hits;
    }
    static uint64_t ours(const void* with)
    {
        const auto& b = *static_cast<const Bundle*>(with);
        const auto scene = b.trial.bench.storage.template view<TrialOf<N>::effects>();
        uint64_t hits = 0;
        for (int i = 0; i < rays_each; i++) {
            typename N::Length t{};
            qray::Local<N> local{};
            hits += !surely_missed(b.trial.shape, b.rejects[static_cast<size_t>(i)])
                && qray::intersect<true>(b.trial.shape, corners_of(scene), b.rays[i], N::length_max, t, local);
        }
        return hits;
    }
    static uint64_t theirs(const void* with)
    {
        const auto& b = *static_cast<const Bundle*>(with);
        uint64_t hits = 0;
        for (int i = 0; i < rays_each; i++) {
            T t{};
            hits += b.form.hit(b.textbook_rays[i], t);
        }
        return hits;
    }
};

template <class N, template <class> class Trial>
void cost(uint64_t seed)
{
    const char* const names[3] = {"nothing", "ours", "textbook"};
    uint64_t (*const tests[3])(const void*) = {Bundle<N, Trial>::nothing, Bundle<N, Trial>::ours,
                                               Bundle<N, Trial>::theirs};
    Bundle<N, Trial> bundle;
    for (int k = 0; k < 3; k++) {
        Random random(seed);
        uint64_t hits = 0;
        for (int i = 0; i < objects; i++) {
            bundle.make(random);
            hits += measured_loop(tests[k], &bundle);
        }
        kept = hits;
        const std::string name = std::string(Trial<N>::name) + "," + system_name<N>() + "," + names[k] + ","
            + std::to_string(objects * rays_each);
        measured_end(name.c_str());
    }
}
template <class N>
void costs(uint64_t seed)
{
    cost<N, SphereTrial>(seed);
    cost<N, PlaneTrial>(seed);
    cost<N, DiscTrial>(seed);
    cost<N, CylinderTrial>(seed);
    cost<N, ConeTrial>(seed);
    cost<N, PolygonTrial>(seed);
    cost<N, PatchTrial>(seed);
}

void print(const Row& row, const char* form, const Tally& t)
{
    const auto number = [](uint64_t n) { return static_cast<unsigned long long>(n); };
    std::printf("%s,%s,%s,%s,%llu,%llu,%.3g,%.3g,%llu,%llu,%llu\n", row.shape, row.system,
                regime_names[row.regime], form, number(t.rays), number(t.wrong), t.worst,
                t.measured ? t.sum / static_cast<double>(t.measured) : 0, number(t.rebounds),
                number(t.self_hits), number(t.leaks));
}

} // namespace

int main(int argc, char** argv)
{
    Selection selection;
    selection.threads = std::thread::hardware_concurrency();
    uint64_t rays = 3000000;
    bool instructions = false;
    for (int i = 1; i < argc; i++) {
        const std::string option = argv[i];
        if (option == "--cost") {
            instructions = true;
            continue;
        }
        const uint64_t value = i + 1 < argc ? std::strtoull(argv[i + 1], nullptr, 10) : 0;
        if (option == "--rays" && value > 0)
            rays = value;
        else if (option == "--seed" && value > 0)
            selection.seed = value;
        else if (option == "--threads" && value > 0)
            selection.threads = static_cast<unsigned>(value);
        else {
            std::fprintf(stderr, "stability: bad option %s\n", option.c_str());
            return 2;
        }
        i++;
    }
    if (instructions) {
#define QRAY_NUMBER(Type, name) costs<qray::Type>(selection.seed);
        QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
        return 0;
    }
    std::printf("shape,number,regime,form,rays,wrong,worst error,mean error,rebounds,self-hits,leaks\n");
    each_row<textbook::Examiner>(selection, rays, [](const Row& row) {
        print(row, "ours", row.tally);
        print(row, "textbook", row.beside);
        std::fflush(stdout);
    });
    return 0;
}
