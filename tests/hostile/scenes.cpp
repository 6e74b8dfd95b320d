// Random scenes of hostile numbers in every number system: scenes [--scenes N] [--seed N] draws N of each kind and
// fails where light leaves its range or a ray tree its depth. Built with sanitizers, which stop at undefined behaviour.
#include "draw_random.hpp"

using namespace hostile;

namespace {

template <class N>
uint64_t draw_both(const char* system, uint64_t seed, uint64_t scenes)
{
    uint64_t faults = 0;
    for (const bool energy : {false, true}) {
        SceneTally t;
        draw_random<N>(seed + energy, scenes, energy, t);
        std::printf("%-6s %-18s %llu scenes, %llu drawn: %llu negative, %llu too bright, %llu with too many rays\n",
                    system, energy ? "energy-conserving," : "any,", static_cast<unsigned long long>(t.scenes),
                    static_cast<unsigned long long>(t.accepted), static_cast<unsigned long long>(t.negative),
                    static_cast<unsigned long long>(t.brighter), static_cast<unsigned long long>(t.too_many_rays));
        if (!t.first_fault.empty())
            std::printf("%s\n", t.first_fault.c_str());
        std::fflush(stdout);
        faults += t.negative + t.brighter + t.too_many_rays;
    }
    return faults;
}

} // namespace

int main(int argc, char** argv)
{
    uint64_t scenes = 125000, seed = 3;
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string option = argv[i];
        (option == "--scenes" ? scenes : seed) = std::strtoull(argv[i + 1], nullptr, 10);
    }
    uint64_t faults = 0;
#define QRAY_NUMBER(Type, name) faults += draw_both<qray::Type>(#name, seed, scenes);
    QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
    return faults == 0 ? 0 : 1;
}
