// The Whitted tracer: nearest hit, light that reaches a point, and the loop over mirrored and refracted rays.
#pragma once

#include "scene.hpp"

namespace qray {

enum class RayKind : uint8_t { camera, shadow, mirrored, refracted };

// Told of every ray that is traced. This one costs nothing.
struct NoCount {
    constexpr void operator()(RayKind) const {}
};

// Calls f(shape, kind, index) for every shape.
template <class N, Effects E, class F>
QRAY_INLINE constexpr void for_each_shape(const Scene<N, E>& scene, F f)
{
    if constexpr (E.sphere)
        for (uint32_t i = 0; i < scene.spheres.count; i++)
            if (f(scene.spheres[i], Kind::sphere, i))
                return;
    if constexpr (E.disc)
        for (uint32_t i = 0; i < scene.discs.count; i++)
            if (f(scene.discs[i], Kind::disc, i))
                return;
    if constexpr (E.cone)
        for (uint32_t i = 0; i < scene.cones.count; i++)
            if (f(scene.cones[i], Kind::cone, i))
                return;
    if constexpr (E.polygon)
        for (uint32_t i = 0; i < scene.polygons.count; i++)
            if (f(scene.polygons[i], Kind::polygon, i))
                return;
    if constexpr (E.patch)
        for (uint32_t i = 0; i < scene.patches.count; i++)
            if (f(scene.patches[i], Kind::patch, i))
                return;
}

template <class S>
concept HasCorners = requires(const S& s) { s.first; };
template <class S>
concept IsCurved = requires(const S& s) { s.fine; };

template <class N, Effects E, class S>
QRAY_INLINE constexpr bool intersect_in(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray,
                                        typename N::Length limit, typename N::Length& t,
                                        [[maybe_unused]] Local<N>& local)
{
    if constexpr (HasCorners<S>)
        return intersect(shape, scene.vertices.data, ray, limit, t);
    else if constexpr (IsCurved<S>)
        return intersect(shape, ray, limit, t, local);
    else
        return intersect(shape, ray, limit, t);
}
template <class N, Effects E, class S>
QRAY_INLINE constexpr int crossings_in(const Scene<N, E>& scene, const S& shape, const Ray<N>& ray,
                                       typename N::Length limit)
{
    if constexpr (HasCorners<S>)
        return crossings(shape, scene.vertices.data, ray, limit);
    else
        return crossings(shape, ray, limit);
}

// Calls f(shape, kind, index) for the shape of that number.
template <class N, Effects E, class F>
QRAY_INLINE constexpr bool with_shape(const Scene<N, E>& scene, ShapeId id, F f)
{
    if constexpr (E.sphere)
        if (id.kind() == Kind::sphere)
            return f(scene.spheres[id.index()], Kind::sphere, id.index());
    if constexpr (E.disc)
        if (id.kind() == Kind::disc)
            return f(scene.discs[id.index()], Kind::disc, id.index());
    if constexpr (E.cone)
        if (id.kind() == Kind::cone)
            return f(scene.cones[id.index()], Kind::cone, id.index());
    if constexpr (E.polygon)
        if (id.kind() == Kind::polygon)
            return f(scene.polygons[id.index()], Kind::polygon, id.index());
    if constexpr (E.patch)
        if (id.kind() == Kind::patch)
            return f(scene.patches[id.index()], Kind::patch, id.index());
    return false;
}

// Calls f(shape, kind, index) for every shape that the ray may meet before limit(), until it returns true.
template <class N, Effects E, class Limit, class F>
QRAY_INLINE constexpr void for_each_candidate(const Scene<N, E>& scene, [[maybe_unused]] const Ray<N>& ray,
                                              [[maybe_unused]] Limit limit, F f)
{
    if constexpr (E.tree)
        walk(scene.tree.value, ray, limit, [&](ShapeId id) { return with_shape(scene, id, f); });
    else
        for_each_shape(scene, f);
}

template <class N, Effects E>
constexpr bool nearest(const Scene<N, E>& scene, const Ray<N>& ray, Hit<N>& hit)
{
    hit.t = N::length_max;
    hit.tag = {Tag::none};
    for_each_candidate(scene, ray, [&hit] { return hit.t; }, [&](const auto& shape, Kind kind, uint32_t index) {
        typename N::Length t{};
        Local<N> local{};
        if (intersect_in(scene, shape, ray, hit.t, t, local) && hit.after(t, shape.tag)) {
            hit.t = t;
            hit.tag = shape.tag;
            hit.kind = kind;
            hit.index = index;
            if constexpr (IsCurved<decltype(shape)>)
                hit.local = local;
        }
        return false;
    });
    return !(hit.tag == Tag{Tag::none});
}

// Is any surface strictly between the ray's origin and `distance`?
template <class N, Effects E>
constexpr bool light_blocked(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance)
{
    bool blocked = false;
    for_each_candidate(scene, ray, [distance] { return distance; }, [&](const auto& shape, Kind, uint32_t) {
        blocked = crossings_in(scene, shape, ray, distance) != 0;
        return blocked;
    });
    return blocked;
}

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

// The share of light that comes through all surfaces strictly between the ray's origin and `distance`: multiplied in the
// order of their places, so that rounding does not depend on the order in which they are found.
template <class N, Effects E>
constexpr typename N::Unit light_through(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance)
{
    auto through = N::one;
    const auto amount = [&scene](Tag tag) { return scene.transmits[tag.material()].amount; };
    bool first = true;
    uint32_t last = 0;
    for (;;) {
        Veils found;
        bool blocked = false;
        for_each_candidate(scene, ray, [distance] { return distance; }, [&](const auto& shape, Kind, uint32_t) {
            if (!first && shape.tag.place() <= last)
                return false;
            const int times = crossings_in(scene, shape, ray, distance);
            if (times != 0) {
                blocked = amount(shape.tag) == N::zero;
                found.add({shape.tag, times});
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

template <class N, Effects E>
constexpr Surface<N> surface_at(const Scene<N, E>& scene, const Ray<N>& ray, const Hit<N>& hit)
{
    Surface<N> s{ray.origin + along<N>(hit.t, ray.direction), {}, {}, hit.kind != Kind::sphere && hit.kind != Kind::cone};
    constexpr bool one_kind = E.shapes() == 1;
    if constexpr (E.sphere)
        if (one_kind || hit.kind == Kind::sphere)
            s.geometric = normal_at(scene.spheres[hit.index], hit.local, ray.direction);
    if constexpr (E.disc)
        if (one_kind || hit.kind == Kind::disc)
            s.geometric = normal_at(scene.discs[hit.index]);
    if constexpr (E.cone)
        if (one_kind || hit.kind == Kind::cone)
            s.geometric = normal_at(scene.cones[hit.index], hit.local, ray.direction);
    if constexpr (E.polygon)
        if (one_kind || hit.kind == Kind::polygon)
            s.geometric = normal_at(scene.polygons[hit.index]);
    if constexpr (E.patch)
        if (one_kind || hit.kind == Kind::patch) {
            const Patch<N>& patch = scene.patches[hit.index];
            s.geometric = patch.normal;
            s.normal = shading_normal(patch, scene.vertices.data, scene.normals.data, ray);
        }
    if (!E.patch || hit.kind != Kind::patch)
        s.normal = s.geometric;
    if (dot<N>(s.normal, ray.direction) > typename N::Cosine{})
        s.normal = -s.normal;
    return s;
}

// A ray that leaves the surface in direction d.
template <class N>
constexpr Ray<N> leaving(const Surface<N>& s, Tag tag, const Direction<N>& d)
{
    const bool outward = dot<N>(s.geometric, d) > typename N::Cosine{};
    const Point<N> step{N::leave(s.geometric.x, s.flat), N::leave(s.geometric.y, s.flat),
                        N::leave(s.geometric.z, s.flat)};
    return {outward ? s.point + step : s.point - step, d, tag, outward};
}

template <class N, Effects E>
constexpr Vec<typename N::Unit> colour_at(const Scene<N, E>& scene, uint32_t material, const Point<N>& q)
{
    const Vec<typename N::Unit>& m = scene.mattes[material].colour;
    if constexpr (E.texture()) {
        const TextureRef ref = scene.textures[material];
        if constexpr (E.checker)
            if (ref.kind == TextureKind::checker)
                return scene.checkers[ref.index](m, q);
        if constexpr (E.stripes)
            if (ref.kind == TextureKind::stripes)
                return scene.stripes[ref.index](m, q);
        if constexpr (E.gradient)
            if (ref.kind == TextureKind::gradient)
                return scene.gradients[ref.index](m, q);
        if constexpr (E.rings)
            if (ref.kind == TextureKind::rings)
                return scene.rings[ref.index](m, q);
        if constexpr (E.noise)
            if (ref.kind == TextureKind::noise)
                return scene.noises[ref.index](m, q);
        if constexpr (E.marble)
            if (ref.kind == TextureKind::marble)
                return scene.marbles[ref.index](m, q);
        if constexpr (E.wood)
            if (ref.kind == TextureKind::wood)
                return scene.woods[ref.index](m, q);
        if constexpr (E.brick)
            if (ref.kind == TextureKind::brick)
                return scene.bricks[ref.index](m, q);
    }
    return m;
}

// Light at a surface seen along d: what the matte part gathers (to be multiplied by its colour) and the highlights.
template <class N, Effects E>
struct Gathered {
    Rgb<N> matte;
    [[no_unique_address]] Maybe<Rgb<N>, E.highlight> highlight;
};

template <class N>
QRAY_INLINE constexpr void add(Rgb<N>& sum, const Rgb<N>& light, typename N::Unit k)
{
    sum.x += N::colour(light.x * k);
    sum.y += N::colour(light.y * k);
    sum.z += N::colour(light.z * k);
}

template <class N, Effects E, class Count>
constexpr void gather(const Scene<N, E>& scene, const Surface<N>& s, Tag tag, const Direction<N>& d,
                      const Direction<N>& l, typename N::Length distance, const Rgb<N>& colour,
                      Gathered<N, E>& sum, Count& count)
{
    const auto n_l = N::unit(dot<N>(s.normal, l));
    if (!(n_l > N::zero))
        return;
    auto diffuse = N::unit(scene.mattes[tag.material()].diffuse * n_l);
    auto highlight = N::zero;
    if constexpr (E.highlight) {
        const Highlight<N>& h = scene.highlights[tag.material()];
        if (h.amount > N::zero) {
            const auto cosine = mirrored_cosine<N>(s.normal, l, d, n_l);
            typename N::Unit power{};
            if constexpr (E.fractional_shine)
                power = N::power(cosine, h.shine);
            else
                power = N::power_whole(cosine, h.shine);
            highlight = N::unit(h.amount * power);
        }
    }
    if (diffuse == N::zero && highlight == N::zero)
        return;
    if constexpr (E.shadow) {
        if (scene.shadows.value) {
            count(RayKind::shadow);
            const Ray<N> to_light = leaving<N>(s, tag, l);
            if constexpr (E.see_through) {
                const auto through = light_through(scene, to_light, distance);
                if (through == N::zero)
                    return;
                diffuse = N::unit(diffuse * through);
                highlight = N::unit(highlight * through);
            } else if (light_blocked(scene, to_light, distance)) {
                return;
            }
        }
    }
    add<N>(sum.matte, colour, diffuse);
    if constexpr (E.highlight)
        add<N>(sum.highlight.value, colour, highlight);
}

template <class N, Effects E, class Count>
constexpr Rgb<N> local_light(const Scene<N, E>& scene, const Surface<N>& s, Tag tag, const Direction<N>& d,
                             Count& count)
{
    Gathered<N, E> sum{scene.mattes[tag.material()].ambient, {}};
    if constexpr (E.light)
        for (uint32_t i = 0; i < scene.lights.count; i++) {
            Direction<N> l{};
            typename N::Length distance{};
            if (towards(scene.lights[i], s.point, l, distance))
                gather(scene, s, tag, d, l, distance, scene.lights[i].colour, sum, count);
        }
    if constexpr (E.sun)
        for (uint32_t i = 0; i < scene.suns.count; i++)
            gather(scene, s, tag, d, scene.suns[i].from, N::length_max, scene.suns[i].colour, sum, count);
    const Vec<typename N::Unit> m = colour_at(scene, tag.material(), s.point);
    Rgb<N> light{N::colour(sum.matte.x * m.x), N::colour(sum.matte.y * m.y), N::colour(sum.matte.z * m.z)};
    if constexpr (E.highlight)
        light = light + sum.highlight.value;
    return light;
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
    uint32_t count = 0;
};

template <class N>
QRAY_INLINE constexpr void accumulate(Rgb<N>& sum, const Rgb<N>& light, typename N::Unit weight)
{
    sum.x = N::saturating_add(sum.x, N::colour(light.x * weight));
    sum.y = N::saturating_add(sum.y, N::colour(light.y * weight));
    sum.z = N::saturating_add(sum.z, N::colour(light.z * weight));
}

// The light that comes back along an eye ray, not yet clamped to [0, 1], divided by 2^exposure.
template <class N, Effects E, class Count>
constexpr Rgb<N> trace(const Scene<N, E>& scene, Ray<N> ray, Count& count)
{
    Rgb<N> sum{N::black, N::black, N::black};
    [[maybe_unused]] Maybe<Stack<N, E>, E.transmit> stack{};
    auto weight = N::one;
    uint8_t depth = 1;
    count(RayKind::camera);
    for (;;) {
        Hit<N> hit{};
        if (!nearest(scene, ray, hit)) {
            accumulate<N>(sum, scene.background, weight);
        } else {
            const Surface<N> s = surface_at(scene, ray, hit);
            accumulate<N>(sum, local_light(scene, s, hit.tag, ray.direction, count), weight);
            if constexpr (E.spawns()) {
                if (depth < scene.max_depth.value) {
                    auto reflect = N::zero;
                    if constexpr (E.mirror)
                        reflect = scene.mirrors[hit.tag.material()].amount;
                    if constexpr (E.transmit) {
                        const Transmit<N>& glass = scene.transmits[hit.tag.material()];
                        if (glass.amount > N::zero) {
                            const bool entering = dot<N>(ray.direction, s.geometric) < typename N::Cosine{};
                            Direction<N> bent{};
                            if (refracted<N>(ray.direction, s.normal, entering ? glass.into : glass.out, bent)) {
                                const auto w = N::unit(weight * glass.amount);
                                if (w >= scene.cutoff.value && w > N::zero) {
                                    count(RayKind::refracted);
                                    stack.value.entries[stack.value.count++] = {leaving<N>(s, hit.tag, bent), w,
                                                                               static_cast<uint8_t>(depth + 1)};
                                }
                            } else {
                                reflect = reflect > N::one - glass.amount ? N::one : reflect + glass.amount;
                            }
                        }
                    }
                    const auto w = N::unit(weight * reflect);
                    if (w >= scene.cutoff.value && w > N::zero) {
                        count(RayKind::mirrored);
                        ray = leaving<N>(s, hit.tag, mirrored<N>(ray.direction, s.normal));
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
