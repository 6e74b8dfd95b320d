// The Whitted tracer: light at a point, and the loop over mirrored and refracted rays.
#pragma once

#include "nearest.hpp"
#include "see_through.hpp"
#include "shadow.hpp"

namespace qray {

enum class RayKind : uint8_t { camera, shadow, mirrored, refracted };

// Told of every ray that is traced. This one costs nothing.
struct NoCount {
    constexpr void operator()(RayKind) const {}
};

// Where a ray meets a polygon. Corners that are not quite in one plane let a ray almost along it meet it far
// outside the world, where differences of points would overflow: such a point is put back to the edge.
template <class N>
QRAY_INLINE constexpr Point<N> in_world(const Ray<N>& ray, typename N::Length t)
{
    const Point<N> a = along<N>(t, ray.direction), o = ray.origin;
    if constexpr (N::is_fixed) {
        using Length = typename N::Length;
        const auto sum = [](Length u, Length v) {
            constexpr Length edge{int32_t{64} << Length::frac};
            return v > edge - u ? edge : v < -edge - u ? -edge : u + v;
        };
        return {sum(o.x, a.x), sum(o.y, a.y), sum(o.z, a.z)};
    } else {
        return o + a;
    }
}

// A hit q on the plane through c: moved onto it where its error, which is that of t, is more than some ulp.
template <class N>
QRAY_INLINE constexpr Point<N> on_plane([[maybe_unused]] const Point<N>& c, [[maybe_unused]] const Direction<N>& normal,
                                        const Point<N>& q)
{
    if constexpr (!N::is_fixed)
        return q - along_normal<N>(dot_normal<N>(q - c, normal), normal);
    else if constexpr (NarrowFixed<N>)
        return q - along<N>(N::length(dot<N>(q - c, normal)), normal);
    else
        return q;
}

// The point, and the outward geometric normal there.
template <class N, Effects E>
QRAY_INLINE constexpr void geometry_at(const Scene<N, E>& scene, const Ray<N>& ray, const Hit<N>& hit, Point<N>& q,
                                       Direction<N>& g)
{
    // What is none of the others is the last, so that there q and g are always set.
    constexpr Kind last = E.disc ? Kind::disc
        : E.patch                ? Kind::patch
        : E.polygon              ? Kind::polygon
        : E.cone                 ? Kind::cone
                                 : Kind::sphere;
    const auto is = [&hit](Kind kind) { return kind == last || hit.kind == kind; };
    if constexpr (E.sphere)
        if (is(Kind::sphere))
            return surface_of(scene.spheres[hit.index], hit.local, ray.direction, q, g);
    if constexpr (E.cone)
        if (is(Kind::cone))
            return surface_of(scene.cones[hit.index], hit.local, ray.direction, q, g);
    if constexpr (E.polygon)
        if (is(Kind::polygon)) {
            const Polygon<N>& polygon = scene.polygons[hit.index];
            g = polygon.normal;
            q = on_plane<N>(scene.vertices[polygon.first], g, in_world(ray, hit.t));
            return;
        }
    if constexpr (E.patch)
        if (is(Kind::patch)) {
            const Patch<N>& patch = scene.patches[hit.index];
            g = patch.normal;
            q = on_plane<N>(scene.vertices[patch.first], g, ray.origin + along<N>(hit.t, ray.direction));
            return;
        }
    if constexpr (E.disc) {
        const Disc<N>& disc = scene.discs.at(hit.index);
        g = disc.normal;
        q = on_plane<N>(disc.centre, g, ray.origin + along<N>(hit.t, ray.direction));
    }
}

template <class N, Effects E>
QRAY_INLINE constexpr Surface<N> surface_at(const Scene<N, E>& scene, const Ray<N>& ray, const Hit<N>& hit)
{
    Point<N> q;
    Direction<N> g;
    geometry_at(scene, ray, hit, q, g);
    Direction<N> n = g;
    if constexpr (E.patch)
        if (E.shapes() == 1 || hit.kind == Kind::patch)
            n = shading_normal(scene.patches[hit.index], scene.vertices.data, scene.normals.data, ray);
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
    if constexpr (E.patch)
        if (E.shapes() == 1 || kind == Kind::patch) {
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
        if constexpr (E.patch)
            if (E.shapes() == 1 || kind == Kind::patch) {
                cosine = N::unit(dot<N>(s.geometric, d));
                outward = cosine > N::zero;
                cosine = outward ? cosine : -cosine;
            }
        if (cosine >= N::steep) {
            if constexpr (in_lanes<N>)
                return {step_along<N>(s.point, d), d, tag, outward};
            else
                return {s.point + Point<N>{N::leave_along(d.x), N::leave_along(d.y), N::leave_along(d.z)}, d, tag,
                        outward};
        }
    }
    return leaving<N, E>(s, kind, tag, d, above);
}

template <class N, Effects E>
QRAY_INLINE constexpr Vec<typename N::Unit> colour_at(const Scene<N, E>& scene, uint32_t material, const Point<N>& q)
{
    const Vec<typename N::Unit>& m = scene.mattes[material].colour;
    if constexpr (E.texture()) {
        const TextureRef& ref = scene.textures[material];
        if constexpr (E.checker)
            if (ref.kind == TextureKind::checker)
                return scene.checkers.at(ref.index)(m, q);
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
    if constexpr (in_lanes<N>) {
        sum = sum + scaled<N>(k, light);
    } else {
        sum.x += N::colour(light.x * k);
        sum.y += N::colour(light.y * k);
        sum.z += N::colour(light.z * k);
    }
}

// One hit: all that shading asks about it.
template <class N, bool Windows = false>
struct Seen {
    const Surface<N>& surface;
    Kind kind;
    Tag tag;
    uint32_t material;
    const Direction<N>& direction; // of the ray that sees it
    [[no_unique_address]] Maybe<ShapeSet, Windows> blockers{}; // what may be before a light
};

// Adds the light that comes along l, unless it is blocked.
template <class N, Effects E, class Count>
QRAY_INLINE constexpr void gather(const Scene<N, E>& scene, const Seen<N, E.windows>& seen, const Direction<N>& l,
                                  typename N::Length distance, const Rgb<N>& colour, Gathered<N, E>& sum, Count& count)
{
    const Surface<N>& s = seen.surface;
    const auto n_l = N::unit(dot<N>(s.normal, l));
    if (!(n_l > N::zero))
        return;
    auto diffuse = N::unit(scene.mattes[seen.material].diffuse * n_l);
    [[maybe_unused]] auto highlight = N::zero;
    if constexpr (E.highlight) {
        const Highlight<N>& h = scene.highlights[seen.material];
        if (h.amount > N::zero) {
            const auto cosine = mirrored_cosine<N>(l, seen.direction, n_l, s.n_d);
            if constexpr (E.fractional_shine)
                highlight = N::unit(h.amount * N::power(cosine, h.shine));
            else
                highlight = N::unit(h.amount * N::power_whole(cosine, h.shine));
        }
    }
    if (diffuse == N::zero && highlight == N::zero)
        return;
    if constexpr (E.shadow) {
        if (scene.shadows.value) {
            count(RayKind::shadow);
            const Ray<N> to_light = leaving<N, E>(s, seen.kind, seen.tag, l, true);
            if constexpr (E.see_through) {
                auto through = N::one;
                if constexpr (E.windows)
                    through = light_through(scene, to_light, distance, seen.blockers.value);
                else
                    through = light_through(scene, to_light, distance);
                if (through == N::zero)
                    return;
                diffuse = N::unit(diffuse * through);
                highlight = N::unit(highlight * through);
            } else {
                bool blocked = false;
                if constexpr (E.windows)
                    blocked = light_blocked(scene, to_light, distance, seen.blockers.value);
                else
                    blocked = light_blocked(scene, to_light, distance);
                if (blocked)
                    return;
            }
        }
    }
    add<N>(sum.matte, colour, diffuse);
    if constexpr (E.highlight)
        add<N>(sum.highlight.value, colour, highlight);
}

template <class N, Effects E, class Count>
QRAY_INLINE constexpr Rgb<N> local_light(const Scene<N, E>& scene, const Seen<N, E.windows>& seen, Count& count)
{
    Gathered<N, E> sum{scene.mattes[seen.material].ambient, {}};
    if constexpr (E.light)
        for (uint32_t i = 0; i < scene.lights.count; i++) {
            Direction<N> l{};
            typename N::Length distance{};
            if (towards(scene.lights[i], seen.surface.point, l, distance))
                gather(scene, seen, l, distance, scene.lights[i].colour, sum, count);
        }
    if constexpr (E.sun)
        for (uint32_t i = 0; i < scene.suns.count; i++)
            gather(scene, seen, scene.suns[i].from, N::length_max, scene.suns[i].colour, sum, count);
    const Vec<typename N::Unit> m = colour_at(scene, seen.material, seen.surface.point);
    Rgb<N> light;
    if constexpr (in_lanes<N>)
        light = filtered<N>(sum.matte, m);
    else
        light = {N::colour(sum.matte.x * m.x), N::colour(sum.matte.y * m.y), N::colour(sum.matte.z * m.z)};
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
// `known`, where the scene has windows, may be the ray's sight: elsewhere not even an empty one, which would make other
// code of a desktop's kernels.
template <class N, Effects E, class Count, class... Known>
constexpr Rgb<N> trace(const Scene<N, E>& scene, Ray<N> ray, Count& count, Known... known)
{
    [[maybe_unused]] Maybe<Sight<E.windows>, E.windows> sight{known...};
    Rgb<N> sum{N::black, N::black, N::black};
    [[maybe_unused]] Maybe<Stack<N, E>, E.transmit> stack;
    if constexpr (E.transmit)
        stack.value.count = 0;
    [[maybe_unused]] auto weight = N::one;
    [[maybe_unused]] uint32_t depth = 1;
    count(RayKind::camera);
    for (;;) {
        Hit<N> hit;
        bool found = false;
        if constexpr (E.windows)
            found = nearest(scene, ray, hit, sight.value.ahead());
        else
            found = nearest(scene, ray, hit);
        if (!found) {
            accumulate<N, E>(sum, scene.background, weight);
        } else {
            const Surface<N> s = surface_at(scene, ray, hit);
            const uint32_t material = hit.tag.material();
            Seen<N, E.windows> seen{s, hit.kind, hit.tag, material, ray.direction, {}};
            if constexpr (E.windows) {
                const bool on_floor = hit.tag == scene.windows.value.floor;
                seen.blockers.value = on_floor ? sight.value.before_light() : every_shape;
                sight.value = on_floor ? sight.value.in_floor() : Sight<E.windows>{};
                if constexpr (E.sphere)
                    if ((E.shapes() == 1 || hit.kind == Kind::sphere) && !s.turned)
                        seen.blockers.value = scene.windows.value.blockers[hit.index];
            }
            accumulate<N, E>(sum, local_light(scene, seen, count), weight);
            if constexpr (E.spawns()) {
                if (depth < scene.max_depth.value) {
                    auto reflect = N::zero;
                    if constexpr (E.mirror)
                        reflect = scene.mirrors[material].amount;
                    if constexpr (E.transmit) {
                        const Transmit<N>& glass = scene.transmits[material];
                        if (glass.amount > N::zero) {
                            const bool entering = E.patch && hit.kind == Kind::patch
                                ? dot<N>(ray.direction, s.geometric) < typename N::Cosine{}
                                : !s.turned;
                            Direction<N> bent{};
                            if (refracted<N>(ray.direction, s.normal, s.n_d, entering ? glass.into : glass.out, bent)) {
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
                        if constexpr (E.windows && E.sphere)
                            if ((E.shapes() == 1 || hit.kind == Kind::sphere) && !s.turned)
                                sight.value = {scene.windows.value.octants[hit.index][octant_of<N>(ray.direction)]};
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
            sight = {};
        } else {
            return sum;
        }
    }
}

} // namespace qray
