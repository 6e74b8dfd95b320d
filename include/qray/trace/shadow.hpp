// Shadow rays among opaque surfaces: the first one in the way ends the search.
#pragma once

#include "nearest.hpp"

namespace qray {

// Is any surface of a set strictly between the ray's origin and `distance`?
template <class N, Effects E>
QRAY_INLINE constexpr bool light_blocked(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance,
                                         [[maybe_unused]] ShapeSet set = every_shape)
{
    bool blocked = false;
    const auto ask = [&](const auto& shape, Kind, uint32_t) QRAY_INLINE_LAMBDA {
        blocked = crossings_in(scene, shape, ray, distance) != 0;
        return blocked;
    };
    const auto ask_inlined = [&](const auto& shape, Kind, uint32_t) __attribute__((always_inline)) {
        blocked = crossings_in(scene, shape, ray, distance) != 0;
        return blocked;
    };
    const auto limit = [distance] { return distance; };
    if constexpr (E.windows)
        for_each_candidate(scene, ray, set, limit, ask_inlined);
    else
        for_each_candidate(scene, ray, set, limit, ask);
    return blocked;
}

} // namespace qray
