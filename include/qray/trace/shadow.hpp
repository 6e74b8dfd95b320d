// Shadow rays among opaque surfaces: the first one in the way ends the search.
#pragma once

#include "nearest.hpp"

namespace qray {

// Is any surface strictly between the ray's origin and `distance`?
template <class N, Effects E, class... Light>
QRAY_INLINE constexpr bool light_blocked(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance,
                                         Light... light)
{
    bool blocked = false;
    for_each_candidate(scene, ray, [distance] { return distance; },
                       [&](const auto& shape, Kind, uint32_t) QRAY_INLINE_LAMBDA {
                           blocked = crossings_before(scene, shape, ray, distance, light...) != 0;
                           return blocked;
                       });
    return blocked;
}

} // namespace qray
