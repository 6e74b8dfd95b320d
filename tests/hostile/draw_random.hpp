// Random scenes, drawn at 2 x 2 pixels in a number system.
#pragma once

#include <cstdlib>
#include <string>

#include "../tracer.hpp"
#include "random_scene.hpp"

namespace hostile {

struct SceneTally {
    uint64_t scenes = 0, accepted = 0, samples = 0;
    uint64_t negative = 0, brighter = 0, too_many_rays = 0;
    double most = 0; // the brightest sample of a scene that conserves energy
    std::string first_fault;
};

// The light of every sample must be in range, the number of rays within that of a binary tree of the greatest depth.
template <class N>
void draw_scene(const std::string& name, const std::string& text, const qray::scene::Settings& settings, bool energy,
                SceneTally& tally)
{
    using namespace qray;
    tally.scenes++;
    scene::Error error;
    auto& description = test::kept<scene::Description>();
    auto& storage = test::kept<scene::Storage<N>>();
    if (!scene::parse(name.c_str(), text.data(), text.size(), description, error)
        || !scene::Builder<N>(description, settings, storage).build(error))
        return;
    tally.accepted++;
    const auto s = storage.template view<scene::desktop_effects()>();
    const Camera<N>& c = s.camera;
    for (int32_t k = 0; k < 4; k++) {
        test::RayCount rays;
        const auto light = trace(s, eye_ray(s, c.row(k / 2 == 0 ? -1 : 1) + c.right * (k % 2 == 0 ? -1 : 1)), rays,
                                 EyeSample{static_cast<uint32_t>(k), 0});
        const double scaled = std::ldexp(1, s.exposure);
        const double r = exact<double>(light.x) * scaled, g = exact<double>(light.y) * scaled,
                     b = exact<double>(light.z) * scaled;
        tally.samples++;
        const bool negative = !(r >= 0 && g >= 0 && b >= 0);
        const double most = std::fmax(r, std::fmax(g, b));
        // Each of some hundred roundings may be upward; in q16 by 2^-14, together by less than half a level of a byte.
        const double excess = NarrowFixed<N> ? 0.5 / 255 : sizeof(light.x) == 8 ? 1e-9 : 1e-4;
        const bool brighter = energy && most > 1 + excess;
        const bool rays_over = rays.rays[2] + rays.rays[3] > (uint64_t{1} << settings.depth) - 2;
        tally.negative += negative;
        tally.brighter += brighter;
        tally.too_many_rays += rays_over;
        if (energy)
            tally.most = std::fmax(tally.most, most);
        if ((negative || brighter || rays_over) && tally.first_fault.empty())
            tally.first_fault = name + " sample " + std::to_string(k) + ": light " + std::to_string(r) + " "
                + std::to_string(g) + " " + std::to_string(b) + "\n" + text;
    }
}

template <class N>
void draw_random(uint64_t seed, uint64_t count, bool energy, SceneTally& tally)
{
    for (uint64_t i = 0; i < count; i++) {
        const uint64_t scene_seed = seed * 0x1000003 + i;
        qray::scene::Settings settings;
        settings.depth = 1 + static_cast<uint32_t>(i % 6);
        settings.cutoff = i % 4 == 0 ? 0 : 0.0014;
        const std::string text = RandomScene(scene_seed).text(energy);
        draw_scene<N>("seed " + std::to_string(scene_seed), text, settings, energy, tally);
    }
}

} // namespace hostile
