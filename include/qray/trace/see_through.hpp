// Shadow rays that some surfaces let through.
#pragma once

#include "nearest.hpp"

namespace qray {

// The first few surfaces by place, of those a ray crosses.
struct Veils {
    static constexpr uint32_t capacity = 8;
    struct Veil {
        Tag tag;
        int times;
    } veils[capacity];
    uint32_t count = 0;

    constexpr void add(Veil veil)
    {
        if (count == capacity) {
            if (veil.tag.place() > veils[count - 1].tag.place())
                return;
            count--;
        }
        uint32_t i = count++;
        for (; i > 0 && veils[i - 1].tag.place() > veil.tag.place(); i--)
            veils[i] = veils[i - 1];
        veils[i] = veil;
    }
};

// The share of light that comes through all surfaces strictly between the ray's origin and `distance`:
// multiplied in the order of their places, so that rounding does not depend on the order in which they are
// found.
template <class N, Effects E, class... Light>
constexpr typename N::Unit light_through(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance,
                                         Light... light)
{
    auto through = N::one;
    const auto amount = [&scene](Tag tag) { return scene.transmits[tag.material()].amount; };
    bool first = true;
    uint32_t last = 0;
    for (;;) {
        Veils found;
        bool blocked = false;
        for_each_candidate(scene, ray, [distance] { return distance; }, [&](const auto& shape, Kind, uint32_t) {
            if (!first && tag_of(shape).place() <= last)
                return false;
            const int times = crossings_before(scene, shape, ray, distance, light...);
            if (times != 0) {
                blocked = amount(tag_of(shape)) == N::zero;
                found.add({tag_of(shape), times});
            }
            return blocked;
        });
        if (blocked)
            return N::zero;
        for (uint32_t i = 0; i < found.count; i++)
            for (int k = 0; k < found.veils[i].times; k++)
                through = N::unit(through * amount(found.veils[i].tag));
        if (found.count < Veils::capacity)
            return through;
        first = false;
        last = found.veils[found.count - 1].tag.place();
    }
}

} // namespace qray
