// Every shape in every number system and regime.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "scene/numbers.hpp"
#include "trial.hpp"

namespace hostile {

struct Selection {
    std::string shape, system; // empty: all
    uint64_t seed = 1;
    unsigned threads = 1;
    int verbose = 0;
};

struct Row {
    const char* shape;
    const char* system;
    int regime;
    Tally tally;
    Tally beside; // of what was given the same rays
};

template <class N>
constexpr const char* system_name()
{
    return qray::scene::number_names_of<N>().name;
}

template <class N, template <class> class Trial, template <class, template <class> class> class Beside = Nobody,
          class F>
void rows_of(const Selection& selection, uint64_t rays, F f)
{
    if ((!selection.shape.empty() && selection.shape != Trial<N>::name)
        || (!selection.system.empty() && selection.system != system_name<N>()))
        return;
    constexpr uint64_t piece = 1000000;
    const int regimes = Trial<N>::effects.polygon || Trial<N>::effects.patch ? 4 : 3;
    const uint64_t each = rays / static_cast<uint64_t>(regimes);
    for (int regime = 0; regime < regimes; regime++) {
        const uint64_t pieces = (each + piece - 1) / piece;
        std::vector<Tally> tallies(pieces), others(pieces);
        std::atomic<uint64_t> next{0};
        const auto work = [&] {
            Examiner<N, Trial, Beside> examiner;
            examiner.verbose = selection.verbose;
            for (uint64_t i = next++; i < pieces; i = next++) {
                examiner.tally = examiner.beside.tally = {};
                examiner.run(selection.seed * 0x10001 + static_cast<uint64_t>(regime) * 0x1000003 + i * 0x100000007,
                             static_cast<Regime>(regime), i + 1 < pieces ? piece : each - i * piece);
                tallies[i] = examiner.tally;
                others[i] = examiner.beside.tally;
            }
        };
        std::vector<std::thread> threads;
        for (unsigned k = 1; k < selection.threads && k < pieces; k++)
            threads.emplace_back(work);
        work();
        for (std::thread& t : threads)
            t.join();
        Row row{Trial<N>::name, system_name<N>(), regime, {}, {}};
        for (uint64_t i = 0; i < pieces; i++) {
            row.tally += tallies[i];
            row.beside += others[i];
        }
        f(row);
    }
}

template <class N, template <class, template <class> class> class Beside = Nobody, class F>
void rows_in(const Selection& selection, uint64_t rays, F f)
{
    rows_of<N, SphereTrial, Beside>(selection, rays, f);
    rows_of<N, PlaneTrial, Beside>(selection, rays, f);
    rows_of<N, DiscTrial, Beside>(selection, rays, f);
    rows_of<N, CylinderTrial, Beside>(selection, rays, f);
    rows_of<N, ConeTrial, Beside>(selection, rays, f);
    rows_of<N, PolygonTrial, Beside>(selection, rays, f);
    rows_of<N, PatchTrial, Beside>(selection, rays, f);
}

template <template <class, template <class> class> class Beside = Nobody, class F>
void each_row(const Selection& selection, uint64_t rays, F f)
{
#define QRAY_NUMBER(Type, name) rows_in<qray::Type, Beside>(selection, rays, f);
    QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
}

} // namespace hostile
