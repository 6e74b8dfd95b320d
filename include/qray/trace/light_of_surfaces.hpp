// The light that surfaces send one another, where a ray meets one (texture/light_map.hpp).
#pragma once

#include "../scene/scene.hpp"

namespace qray {

// What other surfaces send to the place q of the surface with this tag, on its inside or its outside, times
// diffuse; on what takes no part, the ambient light.
template <class N, Effects E>
QRAY_INLINE constexpr Rgb<N> light_of_surfaces(const Scene<N, E>& scene, Tag tag, bool inside, const Point<N>& q)
{
    const LightOf<N>& of = scene.lights_of[tag.place()];
    const uint32_t number = inside ? of.inside : of.outside;
    if (number >= LightOf<N>::even)
        return scene.even_lights[number - LightOf<N>::even].light;
    return scene.light_maps[number].template at<E.light_bits>(q, scene);
}

} // namespace qray
