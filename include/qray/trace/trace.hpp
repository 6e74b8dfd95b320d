// The Whitted tracer: light at a point, and the loop over mirrored and refracted rays.
#pragma once

#include "light_of_surfaces.hpp"
#include "nearest.hpp"
#include "see_through.hpp"
#include "shadow.hpp"

namespace qray {

enum class RayKind : uint8_t { camera, shadow, mirrored, refracted };

// Told of every ray that is traced. This one costs nothing.
struct NoCount {
    constexpr void operator()(RayKind) const {}
};

// Has a surface of this kind shading normals of its own? What is none of the others then asks nothing.
template <class N, Effects E>
QRAY_INLINE constexpr bool is_smooth([[maybe_unused]] Kind kind)
{
#define QRAY_SMOOTH(Type, name, table) \
    if constexpr (E.name && Type<N>::is_smooth) \
        if (E.shapes() == 1 || kind == Kind::name) \
            return true;
    QRAY_SHAPES(QRAY_SMOOTH)
#undef QRAY_SMOOTH
    return false;
}

template <class N, Effects E>
QRAY_INLINE constexpr Surface<N> surface_at(const Scene<N, E>& scene, const Ray<N>& ray, const Hit<N>& hit)
{
    Point<N> q;
    Direction<N> g, n;
    const auto at = [&]<class Shape>(const Shape& shape, Kind, uint32_t) __attribute__((always_inline)) {
        surface_of(shape, corners_of(scene), ray, hit.t, hit.local, q, g);
        if constexpr (Shape::is_smooth)
            n = shading_normal(shape, corners_of(scene), ray, g);
        else
            n = g;
        return true;
    };
    with_shape(scene, hit.kind, hit.index, at);
    const auto n_d = N::unit(dot<N>(n, ray.direction));
    const bool turned = n_d > N::zero;
    if constexpr (keeps_step<N>) {
        const Direction<N> to_viewer = turned ? -n : n;
        return {q, g, to_viewer, turned ? -n_d : n_d, turned, step_off<N>(q, to_viewer, true)};
    } else {
        return {q, g, turned ? -n : n, turned ? -n_d : n_d, turned};
    }
}

// A ray that leaves the surface in direction d; `above` tells whether n.d > 0. Where the shading normal is
// the geometric one, or that one turned, that also tells the side.
template <class N, Effects E>
QRAY_INLINE constexpr Ray<N> leaving(const Surface<N>& s, [[maybe_unused]] Kind kind, Tag tag,
                                     const Direction<N>& d, bool above)
{
    if (is_smooth<N, E>(kind)) {
        const bool outward = dot<N>(s.geometric, d) > typename N::Cosine{};
        return {step_off<N>(s.point, s.geometric, outward), d, tag, outward};
    }
    if constexpr (keeps_step<N>)
        if (above)
            return {parts_of(s.above), d, tag, !s.turned};
    return {step_off<N>(s.point, s.normal, above), d, tag, above != s.turned};
}

// The same for a ray that brings back a picture, given |n.d|. A step along the normal moves it to its side,
// and what it meets in mirrors and lenses by far more; unless the ray is flat, a step along itself leads away
// from the surface as well.
template <class N, Effects E>
QRAY_INLINE constexpr Ray<N> going_on(const Surface<N>& s, [[maybe_unused]] Kind kind, Tag tag,
                                      const Direction<N>& d, bool above, [[maybe_unused]] typename N::Unit cosine)
{
    if constexpr (WideFixed<N>) {
        bool outward = above != s.turned;
        if (is_smooth<N, E>(kind)) {
            cosine = N::unit(dot<N>(s.geometric, d));
            outward = cosine > N::zero;
            cosine = outward ? cosine : -cosine;
        }
        if (cosine >= N::steep)
            return {step_along<N>(s.point, d), d, tag, outward};
    }
    return leaving<N, E>(s, kind, tag, d, above);
}

template <class N, Effects E>
QRAY_INLINE constexpr Vec<typename N::Unit> colour_at(const Scene<N, E>& scene, uint32_t material, const Point<N>& q)
{
    const Vec<typename N::Unit>& m = scene.mattes[material].colour;
    if constexpr (E.texture()) {
        const TextureRef& ref = scene.textures[material];
#define QRAY_ASK(Type, name, table) \
    if constexpr (E.name) \
        if (ref.kind == TextureKind::name) \
            return scene.table.at(ref.index)(m, q);
        QRAY_TEXTURES(QRAY_ASK)
#undef QRAY_ASK
    }
    return m;
}

// Light at a surface seen along d: what the matte part gathers (to be multiplied by its colour) and the highlights.
template <class N, Effects E>
struct Gathered {
    Rgb<N> matte;
    [[no_unique_address]] Maybe<Rgb<N>, E.highlight> highlight;
};

// The same of one colour, from the places of a panel: as sums of shares in [0, 1], so that it is rounded once.
template <class N>
struct ShareSum {
    using type = int64_t;
};
template <class N>
    requires(!N::is_fixed)
struct ShareSum<N> {
    using type = typename N::Unit;
};
template <class N>
struct GatheredShares {
    using Sum = typename ShareSum<N>::type;
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
    if (!(n_l > N::zero))
        return;
    auto diffuse = N::unit(scene.mattes[seen.material].diffuse * n_l);
    [[maybe_unused]] auto highlight = N::zero;
    // A power takes long: on a desktop only where the light is known to come.
    constexpr bool waits = E.highlight && E.tree;
    if constexpr (waits) {
        if (diffuse == N::zero)
            highlight = highlight_along(scene, seen, l, n_l);
    } else if constexpr (E.highlight) {
        highlight = highlight_along(scene, seen, l, n_l);
    }
    const bool waiting = waits && diffuse != N::zero;
    if (diffuse == N::zero && highlight == N::zero)
        return;
    if constexpr (E.shadow) {
        if (scene.shadows.value) {
            count(RayKind::shadow);
            const Ray<N> to_light = leaving<N, E>(s, seen.kind, seen.tag, l, true);
            if constexpr (E.see_through) {
                const auto through = light_through(scene, to_light, distance, light...);
                if (through == N::zero)
                    return;
                diffuse = N::unit(diffuse * through);
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
    if constexpr (requires { sum.add(diffuse, highlight); }) { // for others a function moved registers
        sum.add(diffuse, highlight);
    } else {
        add_scaled<N>(sum.matte, diffuse, colour);
        if constexpr (E.highlight)
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
#define QRAY_GATHER(Type, name, table) \
    if constexpr (E.name) \
        for (uint32_t i = 0; i < scene.table.count; i++) { \
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
    Rgb<N> light{};
    if constexpr (N::is_fixed) { // a copy costs floating point registers, and saves others
        const Vec<typename N::Unit> m = colour_at(scene, seen.material, seen.surface.point);
        light = filtered<N>(sum.matte, m);
    } else {
        light = filtered<N>(sum.matte, colour_at(scene, seen.material, seen.surface.point));
    }
    if constexpr (E.highlight)
        light = light + sum.highlight.value;
    return light;
}

// Does the ray only touch an edge of a body, where it meets two faces at the same t? It then enters by one of them and leaves
// by the other, and what is between is nothing; but the first in the file is met, and may be the one that it leaves. Where t
// has few bits that happens along a whole outline, and glass would keep rays that never were in it. Faces in one plane do not
// share an edge.
template <class N, Effects E>
QRAY_NOINLINE constexpr bool touches_edge(const Scene<N, E>& scene, Ray<N> ray, Direction<N> left, Tag tag,
                                          typename N::Length at)
{
    constexpr auto parallel = N::fraction(1023, 1024);
    bool touches = false;
    for_each_shape(scene, [&]<class S>(const S& shape, Kind, uint32_t) {
        if constexpr (S::has_corners) {
            typename N::Length t{};
            Local<N> local{};
            const Direction<N> normal = normal_of(shape, corners_of(scene));
            const auto cosine = N::unit(dot<N>(left, normal));
            touches = !(tag_of(shape) == tag) && dot<N>(normal, ray.direction) < typename N::Cosine{} && cosine < parallel
                && -cosine < parallel && intersect(shape, corners_of(scene), ray, at, t, local);
        }
        return touches;
    });
    return touches;
}

// A ray that waits its turn.
template <class N>
struct Waiting {
    Ray<N> ray;
    typename N::Unit weight;
    uint8_t depth;
};
template <class N, Effects E>
struct Stack {
    // At most one ray waits for each depth: a ray of depth k is only pushed by its parent, of depth k - 1,
    // and the parent's mirrored ray goes on at once.
    Waiting<N> entries[E.depth];
    uint32_t count;
};

template <class N, Effects E>
QRAY_INLINE constexpr void accumulate(Rgb<N>& sum, const Rgb<N>& light, typename N::Unit weight)
{
    if (!E.spawns() || (N::is_fixed && weight == N::one))
        saturating_add<N>(sum, light);
    else
        saturating_add<N>(sum, light, weight);
}

// The light that comes back along an eye ray, not yet clamped to [0, 1], divided by 2^exposure.
// `sample` is the eye's, where there are panels.
// EyeRay: Ray<N>, or a reference to one that may be lost.
template <class N, Effects E, class EyeRay, class Count, class... Sample>
constexpr Rgb<N> trace(const Scene<N, E>& scene, EyeRay ray, Count& count, Sample... sample)
{
    Rgb<N> sum{N::black, N::black, N::black};
    [[maybe_unused]] Maybe<Stack<N, E>, E.transmit> stack;
    if constexpr (E.transmit)
        stack.value.count = 0;
    [[maybe_unused]] auto weight = N::one;
    [[maybe_unused]] uint32_t depth = 1;
    count(RayKind::camera);
    for (;;) {
        Hit<N> hit;
        if (!nearest(scene, ray, hit)) {
            accumulate<N, E>(sum, scene.background, weight);
        } else {
            const Surface<N> s = surface_at(scene, ray, hit);
            const uint32_t material = hit.tag.material();
            const Seen<N> seen{s, hit.kind, hit.tag, material, ray.direction};
            accumulate<N, E>(sum, local_light(scene, seen, count, sample...), weight);
            if constexpr (E.spawns()) {
                if (depth < scene.max_depth.value) {
                    auto reflect = N::zero;
                    if constexpr (E.mirror)
                        reflect = scene.mirrors[material].amount;
                    if constexpr (E.transmit) {
                        const Transmit<N>& glass = scene.transmits[material];
                        if (glass.amount > N::zero) {
                            const bool entering = is_smooth<N, E>(hit.kind)
                                ? dot<N>(ray.direction, s.geometric) < typename N::Cosine{}
                                : !s.turned;
                            Direction<N> bent{};
                            bool goes_through =
                                refracted<N>(ray.direction, s.normal, s.n_d, entering ? glass.into : glass.out, bent);
                            if constexpr (NarrowFixed<N> && E.corners())
                                if (!goes_through && !entering && (ray.outward || ray.from == Tag{Tag::none})
                                    && touches_edge(scene, ray, parts_of(s.geometric), hit.tag, hit.t)) {
                                    bent = ray.direction;
                                    goes_through = true;
                                }
                            if (goes_through) {
                                const auto w = N::unit(weight * glass.amount);
                                if (w >= scene.cutoff.value && w > N::zero) {
                                    count(RayKind::refracted);
                                    const auto cosine = -N::unit(dot<N>(s.normal, bent));
                                    stack.value.entries[stack.value.count++] = {
                                        going_on<N, E>(s, hit.kind, hit.tag, bent, false, cosine), w,
                                        static_cast<uint8_t>(depth + 1)};
                                }
                            } else {
                                reflect = reflect > N::one - glass.amount ? N::one : reflect + glass.amount;
                            }
                        }
                    }
                    const auto w = N::unit(weight * reflect);
                    if (w >= scene.cutoff.value && (QRAY_KNOWN(scene.cutoff.value > N::zero) || w > N::zero)) {
                        count(RayKind::mirrored);
                        ray = going_on<N, E>(s, hit.kind, hit.tag,
                                             mirrored<N>(ray.direction, s.normal, s.n_d), true, -s.n_d);
                        weight = w;
                        depth++;
                        continue;
                    }
                }
            }
        }
        if constexpr (E.transmit) {
            if (stack.value.count == 0)
                return sum;
            const Waiting<N>& next = stack.value.entries[--stack.value.count];
            ray = next.ray;
            weight = next.weight;
            depth = next.depth;
        } else {
            return sum;
        }
    }
}

} // namespace qray
