// A camera made on the part.
#pragma once

#include "../vector/motion.hpp"
#include "camera.hpp"

namespace qray {

// Half of a picture's vertical field: numbers > 0 in the proportion of its sine and cosine; in fixed point, the
// larger at least 2^31.
template <class N>
struct Field {
    ByNumber<N, uint32_t, typename N::Unit> sine, cosine;
};

// The whole field as an angle of which 2^32 are a turn, above 0 and below half a turn.
template <class N>
constexpr Field<N> field(uint32_t angle)
{
    constexpr uint32_t eighth = uint32_t{1} << 29;
    const uint32_t half = angle >> 1;
    if (half >= 2 * eighth)
        return {};
    const auto [sine, versine] = detail::octant(half > eighth ? 2 * eighth - half : half);
    const uint32_t cosine = versine == 0 ? UINT32_MAX : 0 - versine;
    const uint32_t s = half > eighth ? cosine : sine, c = half > eighth ? sine : cosine;
    if constexpr (N::is_fixed)
        return {s, c};
    else
        return {static_cast<typename N::Unit>(s), static_cast<typename N::Unit>(c)};
}
// As the tangent of half of it.
template <class N>
constexpr Field<N> field_of_tangent(Coordinate<N> tangent)
{
    if constexpr (N::is_fixed) {
        if (tangent.raw <= 0)
            return {};
        const uint32_t sine = static_cast<uint32_t>(tangent.raw), cosine = 1 << Coordinate<N>::frac;
        const int up = count_leading_zeros(sine | cosine);
        return {sine << up, cosine << up};
    } else {
        return {tangent, N::one};
    }
}

// What a camera looks at, and how, in scene units. A compiled scene that moves says the one of its text.
template <class N>
struct View {
    ScenePoint<N> eye, at, up;
    Field<N> field;
};

namespace detail {

// Cut to Bits bits beside the sign, to the nearest, where the largest has more.
template <int Bits>
constexpr void fit(const int64_t (&v)[3], int32_t (&to)[3])
{
    const auto size = [](int64_t a) { return static_cast<uint64_t>(a ^ a >> 63); };
    const int down = 65 - Bits - count_leading_zeros(size(v[0]) | size(v[1]) | size(v[2]) | 1);
    for (int i = 0; i < 3; i++)
        to[i] = static_cast<int32_t>(down > 0 ? (v[i] + (int64_t{1} << (down - 1))) >> down : v[i]);
}

// a x b, exact; for what has 30 bits.
constexpr void cross(const int32_t (&a)[3], const int32_t (&b)[3], int64_t (&c)[3])
{
    for (int i = 0, j = 1, k = 2; i < 3; j = k, k = i++)
        c[i] = wide_mul(a[j], b[k]) - wide_mul(a[k], b[j]);
}

} // namespace detail

// Turns `camera`, whose size and grid stay, to look from view.eye towards view.at: within 2 ulp of the one that a
// desktop makes of these numbers, its parts taken as those of a direction (of Unit, in floating point of 1). False, and
// nothing changes, where `eye` is not in the world, `at` is where it is, `up` has the direction from the one to the
// other, or the field is none.
template <class N>
constexpr bool look_at(Camera<N>& camera, const Frame<N>& frame, const View<N>& view)
{
    const auto& [eye, at, up, field] = view;
    const Point<N> from = frame.point(eye);
    if (!ball_in_world<N>(from) || !(field.sine > 0) || !(field.cosine > 0))
        return false;
    const uint32_t width = camera.width, height = camera.height, n = camera.grid;
    const uint32_t longer = width > height ? width : height;
    if constexpr (N::is_fixed) {
        int32_t v[3]{}, above[3]{}, across[3]{}, upward[3]{}, w[3]{}, u[3]{}, t[3]{};
        int64_t c[3]{};
        const auto ahead_of = [](auto a, auto b) { return int64_t{a.raw} - b.raw; };
        detail::fit<30>({ahead_of(at.x, eye.x), ahead_of(at.y, eye.y), ahead_of(at.z, eye.z)}, v);
        detail::fit<30>({up.x.raw, up.y.raw, up.z.raw}, above);
        detail::cross(v, above, c);
        detail::fit<31>(c, across);
        detail::cross(across, v, c);
        detail::fit<31>(c, upward);
        if (!unit_vector(v[0], v[1], v[2], w) || !unit_vector(across[0], across[1], across[2], u)
            || !unit_vector(upward[0], upward[1], upward[2], t))
            return false;

        // With |w|, |x u| and |y v| at most 1: of the three, `most` is the largest.
        const uint64_t of_w = wide_mul(field.cosine, height);
        const uint64_t of_u = wide_mul(field.sine, longer), most = of_w > of_u ? of_w : of_u;
        const int zeros = count_leading_zeros(most), wide = count_leading_zeros(most * n);
        // of_w / most, 2^30 or less than 2^31; sine / (n most), from 2^30 to 2^31.
        const auto top = [](uint64_t a, int by) { return static_cast<uint32_t>(a << by >> 32); };
        const int finer = of_w != most;
        const int32_t ahead = divide(top(of_w, zeros), top(most, zeros), 30 + finer);
        int down = count_leading_zeros(field.sine);
        const uint32_t sine = field.sine << down, all = top(most * n, wide);
        const int short_of = sine < all;
        const int32_t step = divide(sine, all, 30 + short_of);
        using Part = typename Pencil<N>::Part;
        constexpr int bits = NarrowFixed<N> ? 29 : 60;
        const auto part = [](int32_t a, int32_t b, int by) {
            const int64_t p = wide_mul(a, b);
            return static_cast<Part>(by > 0 ? (p + (int64_t{1} << (by - 1))) >> by : p);
        };
        down += 92 - bits + short_of - wide;
        if (NarrowFixed<N> && down > 63) // of a field so small that a step rounds to 0, as it does by 63
            down = 63;
        camera.eye = from;
        const int less = 60 - bits + finer;
        camera.centre = {part(w[0], ahead, less), part(w[1], ahead, less), part(w[2], ahead, less)};
        camera.right = {part(u[0], step, down), part(u[1], step, down), part(u[2], step, down)};
        camera.down = {part(-t[0], step, down), part(-t[1], step, down), part(-t[2], step, down)};
    } else {
        using F = typename N::Unit;
        const auto cross = [](const Vec<F>& a, const Vec<F>& b) {
            return Vec<F>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
        };
        Vec<F> w{}, u{};
        const Vec<F> v = at - eye;
        const auto is_unit = [](const Vec<F>& d) { return norm2<N>(d) > F(1) / 2; }; // not of what is infinite
        if (!normalise_short<N>(v, w) || !is_unit(w) || !normalise_short<N>(cross(v, up), u) || !is_unit(u))
            return false;
        const Vec<F> t = cross(u, w);
        const F step = field.sine / (field.cosine * static_cast<F>(n * height));
        if (!(step * static_cast<F>(n * longer) < F(int64_t{1} << 60))) // its square is finite
            return false;
        camera.eye = from;
        camera.centre = {w.x, w.y, w.z};
        camera.right = {u.x * step, u.y * step, u.z * step};
        camera.down = {t.x * -step, t.y * -step, t.z * -step};
    }
    return true;
}

} // namespace qray
