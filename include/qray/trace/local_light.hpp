// Light at a surface: from lamps that nothing hides, from other surfaces, and its own.
#pragma once

#include "../surface/late_highlights.hpp"
#include "light_of_surfaces.hpp"
#include "see_through.hpp"
#include "shadow.hpp"
#include "surface.hpp"

namespace qray {

enum class RayKind : uint8_t { camera, shadow, mirrored, refracted };

// Told of every ray that is traced. This one costs nothing.
struct NoCount {
    constexpr void operator()(RayKind) const {}
};
// Is it told everything: what each ray meets, and all that is added or left out? src/cli/observe.cpp
// lists what it is told.
template <class Count>
concept Explains = Count::explains;

// Light at a surface seen along d: what the matte part gathers (to be multiplied by its colour) and the highlights.
template <class N, Effects E>
struct Gathered {
    // Panels add theirs at once.
    static constexpr bool late = LateHighlights<N>::pays && E.tree && E.fractional_shine && !E.panel;
    Rgb<N> matte;
    [[no_unique_address]] Maybe<Rgb<N>, E.highlight> highlight;
    [[no_unique_address]] Maybe<LateHighlights<N>, late> waiting{};
};

// The same of one colour, from the places of a panel: as sums of shares in [0, 1], so that it is rounded once.
template <class N>
struct GatheredShares {
    using Sum = ByNumber<N, int64_t, typename N::Unit>;
    Sum diffuse{}, highlight{};

    QRAY_INLINE constexpr void add(typename N::Unit more, typename N::Unit amount)
    {
        if constexpr (N::is_fixed) {
            diffuse += more.raw;
            highlight += amount.raw;
        } else {
            diffuse += more;
            highlight += amount;
        }
    }
    static constexpr typename N::Unit mean(Sum sum, uint32_t count)
    {
        if constexpr (N::is_fixed)
            return {divide(sum, count, 0)};
        else
            return sum / static_cast<typename N::Unit>(count);
    }
};

// One hit: all that shading asks about it.
template <class N>
struct Seen {
    const Surface<N>& surface;
    Kind kind;
    Tag tag;
    uint32_t material;
    const Direction<N>& direction; // of the ray that sees it
};

template <class N, Effects E>
QRAY_INLINE constexpr typename N::Unit highlight_along(const Scene<N, E>& scene, const Seen<N>& seen,
                                                       const Direction<N>& l, typename N::Unit n_l)
{
    auto highlight = N::zero;
    const Highlight<N>& h = scene.highlights[seen.material];
    if (h.amount > N::zero) {
        const auto cosine = mirrored_cosine<N>(l, seen.direction, n_l, seen.surface.n_d);
        if constexpr (E.fractional_shine)
            highlight = N::unit(h.amount * N::power(cosine, h.shine));
        else
            highlight = N::unit(h.amount * N::power_whole(cosine, h.shine));
    }
    return highlight;
}

// Adds the light that comes along l, unless it is blocked.
template <class N, Effects E, class Sum, class Count, class... Light>
QRAY_INLINE constexpr void gather(const Scene<N, E>& scene, const Seen<N>& seen, const Direction<N>& l,
                                  typename N::Length distance, const Rgb<N>& colour, Sum& sum, Count& count,
                                  Light... light)
{
    const Surface<N>& s = seen.surface;
    const auto n_l = N::unit(dot<N>(s.normal, l));
    if constexpr (Explains<Count>)
        count.turned_to_light(n_l, distance);
    if (!(n_l > N::zero))
        return;
    auto diffuse = N::unit(scene.mattes[seen.material].diffuse * n_l);
    [[maybe_unused]] auto highlight = N::zero;
    // A power takes long: on a desktop only where the light is known to come.
    constexpr bool waits = E.highlight && E.tree, late = Gathered<N, E>::late;
    [[maybe_unused]] auto share = N::one;
    if constexpr (waits) {
        if (diffuse == N::zero)
            highlight = highlight_along(scene, seen, l, n_l);
    } else if constexpr (E.highlight) {
        highlight = highlight_along(scene, seen, l, n_l);
    }
    const bool waiting = waits && !late && diffuse != N::zero;
    if (diffuse == N::zero && highlight == N::zero)
        return;
    if constexpr (E.shadow) {
        if (scene.shadows.value) {
            count(RayKind::shadow);
            const Ray<N> to_light = leaving<N, E>(s, seen.kind, seen.tag, l, true);
            if constexpr (Explains<Count>)
                count.crossed(scene, to_light, distance, light...);
            if constexpr (E.see_through) {
                const auto through = light_through(scene, to_light, distance, light...);
                if (through == N::zero)
                    return;
                diffuse = N::unit(diffuse * through);
                if constexpr (late)
                    share = through;
                if constexpr (waits)
                    if (waiting)
                        highlight = highlight_along(scene, seen, l, n_l);
                highlight = N::unit(highlight * through);
            } else {
                if (light_blocked(scene, to_light, distance, light...))
                    return;
            }
        }
    }
    if constexpr (waits)
        if (waiting && !(E.see_through && scene.shadows.value))
            highlight = highlight_along(scene, seen, l, n_l);
    if constexpr (Explains<Count>)
        count.adds_light(diffuse, highlight, colour);
    if constexpr (requires { sum.add(diffuse, highlight); }) { // for others a function moved registers
        sum.add(diffuse, highlight);
    } else {
        add_scaled<N>(sum.matte, diffuse, colour);
        if constexpr (late)
            sum.waiting.value.add(scene.highlights[seen.material],
                                  mirrored_cosine<N>(l, seen.direction, n_l, seen.surface.n_d), share, colour,
                                  sum.highlight.value);
        else if constexpr (E.highlight)
            add_scaled<N>(sum.highlight.value, highlight, colour);
    }
}

// Adds the light of a panel, as the eye's sample shifts its places.
template <class N, Effects E, class Count, class Sample>
constexpr void gather(const Scene<N, E>& scene, const Seen<N>& seen, const Panel<N>& panel, Gathered<N, E>& sum,
                      Count& count, Sample sample)
{
    GatheredShares<N> shares;
    panel.for_each_place(sample, [&](const Light<N>& place) __attribute__((always_inline)) {
        Direction<N> l{};
        typename N::Length distance{};
        if (towards(place, seen.surface.point, l, distance)) {
            if constexpr (E.light_surface)
                gather(scene, seen, l, distance, panel.colour, shares, count, PanelNumber{panel.number});
            else
                gather(scene, seen, l, distance, panel.colour, shares, count);
        }
    });
    const uint32_t places = uint32_t{panel.places} * panel.places;
    add_scaled<N>(sum.matte, shares.mean(shares.diffuse, places), panel.colour);
    if constexpr (E.highlight)
        add_scaled<N>(sum.highlight.value, shares.mean(shares.highlight, places), panel.colour);
}

// `sample` is the eye's, where there are panels.
template <class N, Effects E, class Count, class... Sample>
QRAY_INLINE constexpr Rgb<N> local_light(const Scene<N, E>& scene, const Seen<N>& seen, Count& count, Sample... sample)
{
    Gathered<N, E> sum{scene.mattes[seen.material].ambient, {}};
    if constexpr (E.light_map)
        if (scene.lights_of.count != 0)
            sum.matte = sum.matte + light_of_surfaces(scene, seen.tag, seen.surface.turned, seen.surface.point);
    if constexpr (Explains<Count>)
        count.shades(sum.matte, colour_at(scene, seen.material, seen.surface.point));
#define QRAY_GATHER(Type, name, table) \
    if constexpr (E.name) \
        for (uint32_t i = 0; i < scene.table.count; i++) { \
            if constexpr (Explains<Count>) \
                count.asks_light(scene.table[i], i); \
            Direction<N> l{}; \
            typename N::Length distance{}; \
            if constexpr (requires { gather(scene, seen, scene.table[i], sum, count, sample...); }) { \
                gather(scene, seen, scene.table[i], sum, count, sample...); \
            } else if (towards(scene.table[i], seen.surface.point, l, distance)) { \
                if constexpr (E.light_surface && Type<N>::has_place) \
                    gather(scene, seen, l, distance, scene.table[i].colour, sum, count, i); \
                else \
                    gather(scene, seen, l, distance, scene.table[i].colour, sum, count); \
            } \
        }
    QRAY_LIGHTS(QRAY_GATHER)
#undef QRAY_GATHER
    if constexpr (Gathered<N, E>::late)
        sum.waiting.value.finish(scene.highlights[seen.material], sum.highlight.value);
    Rgb<N> light{};
    if constexpr (N::is_fixed) { // a copy costs floating point registers, and saves others
        const Vec<typename N::Unit> m = colour_at(scene, seen.material, seen.surface.point);
        light = filtered<N>(sum.matte, m);
    } else {
        light = filtered<N>(sum.matte, colour_at(scene, seen.material, seen.surface.point));
    }
    if constexpr (E.highlight)
        light = light + sum.highlight.value;
    if constexpr (Explains<Count>)
        count.shaded(light);
    return light;
}

} // namespace qray
