// Random hostile rays at every shape in every number system:
// hostile [--rays N] [--seed N] [--shape NAME] [--system NAME]
// [--threads N] [--verbose N]. Prints a table; fails where a ray finds the surface it left, or leaks.
//
// A run is cut into pieces of a million rays, each with a seed of its own: the result does not depend on the threads.
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "run.hpp"

using namespace hostile;

int main(int argc, char** argv)
{
    Selection selection;
    uint64_t rays = 1000000;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i], value = argv[i + 1];
        if (option == "--rays")
            rays = std::strtoull(value.c_str(), nullptr, 10);
        else if (option == "--seed")
            selection.seed = std::strtoull(value.c_str(), nullptr, 10);
        else if (option == "--threads")
            selection.threads = static_cast<unsigned>(std::atoi(value.c_str()));
        else if (option == "--verbose")
            selection.verbose = std::atoi(value.c_str());
        else if (option == "--shape")
            selection.shape = value;
        else if (option == "--system")
            selection.system = value;
        else {
            std::fprintf(stderr, "hostile: unknown option %s\n", option.c_str());
            return 2;
        }
    }
    std::printf("%llu rays a shape and number system, seed %llu\n\n", static_cast<unsigned long long>(rays),
                static_cast<unsigned long long>(selection.seed));
    std::printf(
        "| shape | system | regime | wrong/10^6 | worst dt | mean dt | rebounds | self-hits | twin hits | leaks "
        "| wrong parity | off | clearance |\n|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    uint64_t faults = 0;
    each_row(selection, rays, [&](const Row& row) {
        const Tally& t = row.tally;
        std::printf(
            "| %s | %s | %s | %.3g | %.1e | %.1e | %llu | %llu | %llu | %llu | %llu | %.1f | %.1f |\n", row.shape,
            row.system, regime_names[row.regime], 1e6 * static_cast<double>(t.wrong) / static_cast<double>(t.rays),
            t.worst, t.sum / static_cast<double>(t.measured), static_cast<unsigned long long>(t.rebounds),
            static_cast<unsigned long long>(t.self_hits), static_cast<unsigned long long>(t.twin_hits),
            static_cast<unsigned long long>(t.leaks), static_cast<unsigned long long>(t.parity), t.off, t.clearance);
        std::fflush(stdout);
        faults += t.self_hits + t.twin_hits + t.leaks + t.parity;
    });
    return faults == 0 ? 0 : 1;
}
