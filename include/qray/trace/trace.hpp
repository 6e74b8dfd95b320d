// The Whitted tracer: the loop over mirrored and refracted rays.
#pragma once

#include "local_light.hpp"

namespace qray {

// Does the ray only touch an edge of a body, where it meets two faces at the same t? It then enters by one of them and
// leaves by the other, and what is between is nothing; but the first in the file is met, and may be the one that it
// leaves. Where t has few bits that happens along a whole outline, and glass would keep rays that never were in it.
// Faces in one plane do not share an edge.
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
            touches = !(tag_of(shape) == tag) && dot<N>(normal, ray.direction) < typename N::Cosine{}
                && cosine < parallel
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

// GCC leaves a const one whole, in memory: up to 6 % fewer instructions in small scenes, for 56 bytes of stack, which
// are taken where it is not deepest.
template <class N, Effects E>
using KeptSurface = Either<E.flat_tree, Surface<N>, const Surface<N>>;

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
    if constexpr (Explains<Count>)
        count.starts(RayKind::camera, ray, weight, depth);
    for (;;) {
        Hit<N> hit;
        if (!nearest(scene, ray, hit)) {
            accumulate<N, E>(sum, scene.background, weight);
        } else {
            KeptSurface<N, E> s = surface_at(scene, ray, hit);
            const uint32_t material = hit.tag.material();
            if constexpr (Explains<Count>)
                count.hits(hit, s);
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
                                    if constexpr (Explains<Count>)
                                        count.touches_edge();
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
                                } else if constexpr (Explains<Count>) {
                                    count.cut_off(RayKind::refracted, glass.amount, w);
                                }
                            } else {
                                if constexpr (Explains<Count>)
                                    count.reflects_totally();
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
                        if constexpr (Explains<Count>)
                            count.starts(RayKind::mirrored, ray, weight, depth);
                        continue;
                    }
                    if constexpr (Explains<Count>)
                        count.cut_off(RayKind::mirrored, reflect, w);
                } else if constexpr (Explains<Count>) {
                    count.is_deepest(material);
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
            if constexpr (Explains<Count>)
                count.starts(RayKind::refracted, ray, weight, depth);
        } else {
            return sum;
        }
    }
}

} // namespace qray
