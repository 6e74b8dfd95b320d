// Every shape in every number system and regime.
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <vector>

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
};

template <class N>
constexpr const char* system_name()
{
    if constexpr (N::is_fixed)
        return N::Unit::frac == 30 ? "q32" : "q16";
    else
        return sizeof(typename N::Length) == 4 ? "float" : "double";
}

template <class N, template <class> class Trial, class F>
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
        std::vector<Tally> tallies(pieces);
        std::atomic<uint64_t> next{0};
        const auto work = [&] {
            Examiner<N, Trial> examiner;
            examiner.verbose = selection.verbose;
            for (uint64_t i = next++; i < pieces; i = next++) {
                examiner.tally = {};
                examiner.run(selection.seed * 0x10001 + static_cast<uint64_t>(regime) * 0x1000003 + i * 0x100000007,
                             static_cast<Regime>(regime), i + 1 < pieces ? piece : each - i * piece);
                tallies[i] = examiner.tally;
            }
        };
        std::vector<std::thread> others;
        for (unsigned k = 1; k < selection.threads && k < pieces; k++)
            others.emplace_back(work);
        work();
        for (std::thread& t : others)
            t.join();
        Tally sum;
        for (const Tally& t : tallies)
            sum += t;
        f(Row{Trial<N>::name, system_name<N>(), regime, sum});
    }
}

template <class N, class F>
void rows_in(const Selection& selection, uint64_t rays, F f)
{
    rows_of<N, SphereTrial>(selection, rays, f);
    rows_of<N, PlaneTrial>(selection, rays, f);
    rows_of<N, DiscTrial>(selection, rays, f);
    rows_of<N, CylinderTrial>(selection, rays, f);
    rows_of<N, ConeTrial>(selection, rays, f);
    rows_of<N, PolygonTrial>(selection, rays, f);
    rows_of<N, PatchTrial>(selection, rays, f);
}

template <class F>
void each_row(const Selection& selection, uint64_t rays, F f)
{
    rows_in<qray::q16>(selection, rays, f);
    rows_in<qray::q32>(selection, rays, f);
    rows_in<qray::Float>(selection, rays, f);
    rows_in<qray::Double>(selection, rays, f);
}

} // namespace hostile
