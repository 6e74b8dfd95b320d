#include "renderer.hpp"

namespace qray::cli {

namespace {

// Has the processor what lanes_*.cpp are compiled for? What has all of these counts leading zeros, too.
bool has_lanes()
{
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi")
        && __builtin_cpu_supports("bmi2");
#else
    return false;
#endif
}

} // namespace

const Renderer& fastest_renderer(Number number)
{
    const Renderer* const lanes = number == Number::q32 ? &q32_lanes_renderer
        : number == Number::Float                       ? &float_lanes_renderer
                                                        : nullptr;
    return lanes != nullptr && has_lanes() ? *lanes : *renderers[static_cast<int>(number)];
}

} // namespace qray::cli
