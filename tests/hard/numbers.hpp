// Refraction, reflection, textures, and what numbers do at the ends of their range.
#pragma once

#include "case.hpp"

namespace catalogue {

template <class N>
bool bend(Direction<N> d, Direction<N> n, int64_t eta, int64_t over, Direction<N>& out)
{
    auto ratio = number<typename N::Eta>(eta, over);
    hide(d);
    hide(n);
    hide(ratio);
    return refracted<N>(d, n, N::unit(dot<N>(d, n)), ratio, out);
}

// Out of 5/4, whose critical angle has a sine of 4/5: a millionth of a radian to either side; 1e-5 in float
// and q24, a 64th in q16, whose directions do not tell less apart.
QRAY_CASE(RefractionAMillionthOffTheCriticalAngle)
{
    QRAY_NAMES;
    constexpr int64_t over = 1000000000;
    int64_t sines[2] = {799999400, 800000600}, cosines[2] = {600000800, 599999200};
    if (ShortFixed<N>) {
        sines[0] = 790527720, cosines[0] = 612426250;
        sines[1] = 809276960, cosines[1] = 587427270;
    } else if (NarrowFixed<N> || SingleFloat<N>) {
        sines[0] = 799994000, cosines[0] = 600008000;
        sines[1] = 800006000, cosines[1] = 599992000;
    }
    for (int i = 0; i < 3; i++)
        for (int beyond_it = 0; beyond_it < 2; beyond_it++)
            for (int64_t sign : List{-1, 1}) {
                const Triple d = axes[i] * (-sign * cosines[beyond_it]) + axes[(i + 1) % 3] * sines[beyond_it];
                Direction<N> out{};
                const bool bent = bend<N>(M::direction(d, over), M::direction(axes[i] * sign), 5, 4, out);
                QRAY_HOLDS(bent == (beyond_it == 0));
            }
}

// In and out of a slab of index 2, with ratios that are exact.
QRAY_CASE(SlabLetsOutWhatCameInParallel)
{
    QRAY_NAMES;
    const Unit little = number<Unit>(8, int64_t{1} << unit_bits<N>);
    for (const Exact& e : directions) {
        const Direction<N> d = M::direction(e.d, e.over), n = M::direction(axes[0] * (e.d.x < 0 ? 1 : -1));
        if (e.d.x * e.d.x * 2 < e.over * e.over) // to 45 degrees
            continue;
        Direction<N> inside{}, out{};
        QRAY_HOLDS(bend<N>(d, n, 1, 2, inside) && bend<N>(inside, n, 2, 1, out));
        const Direction<N> off = out - d;
        QRAY_HOLDS(off.x <= little && -off.x <= little && off.y <= little && -off.y <= little && off.z <= little
                   && -off.z <= little);
    }
}

// |d|^2 stays within 2e-7 of 1; in q16, q24 and float within some units of the last place.
QRAY_CASE(ThousandBouncesKeepTheDirectionUnit)
{
    QRAY_NAMES;
    Random random{93};
    Direction<N> d = M::direction({1, 2, 2}, 3);
    const auto one = N::one * N::one;
    const int64_t float_has = SingleFloat<N> ? 20 : 2;
    const Unit little = NarrowFixed<N> ? number<Unit>(ShortFixed<N> ? 3 : 4, 1 << slope<N>) // squares of q24 drop some
                                       : number<Unit>(float_has, 10000000);
    const auto most = N::one * little;
    for (int i = 0; i < 1000; i++) {
        Direction<N> n = d;
        const Point<N> to = M::point({random.in(-999, 999), random.in(-999, 999), random.in(1, 999)}, 64);
        QRAY_HOLDS(normalise<N>(to, n));
        hide(d);
        d = mirrored<N>(d, n, N::unit(dot<N>(d, n)));
        const auto square = d.x * d.x + d.y * d.y + d.z * d.z;
        QRAY_HOLDS(square - one <= most && one - square <= most);
    }
}

// Back and forth between two balls, along the line of their centres, from a direction that is too long by
// some steps: what a normal takes over from a direction must not grow.
QRAY_CASE(ThousandBouncesBetweenTwoBallsKeepTheDirectionUnit)
{
    QRAY_NAMES;
    const Tag tags[2] = {make_tag(0, 0), make_tag(1, 0)};
    const Sphere<N> balls[2] = {M::sphere(M::point({-5, 0, 0}), 1, 1, tags[0]),
                                M::sphere(M::point({5, 0, 0}), 2, 1, tags[1])};
    const auto one = N::one * N::one;
    const int64_t float_has = SingleFloat<N> ? 20 : 2;
    const Unit little = NarrowFixed<N> ? number<Unit>(5, 1 << slope<N>) : number<Unit>(float_has, 10000000);
    Ray<N> ray = M::ray(M::point({0, 0, 0}), M::direction({1, 0, 0}));
    ray.direction.x = ray.direction.x + number<Unit>(2, int64_t{1} << unit_bits<N>);
    for (int i = 0; i < 1000; i++) {
        const Sphere<N>& s = balls[(i + 1) % 2];
        hide(ray);
        Local<N> local{};
        const bool hit = intersect(s, Corners<N>{}, ray, N::length_max, t, local);
        QRAY_HOLDS(hit);
        if (!hit)
            return;
        Point<N> q{};
        Direction<N> n{};
        surface_of(s, Corners<N>{}, ray, t, local, q, n);
        const auto n_d = N::unit(dot<N>(n, ray.direction));
        ray = M::ray(step_off<N>(q, n, true), mirrored<N>(ray.direction, n, n_d), tags[(i + 1) % 2], true);
        const auto d = ray.direction;
        const auto square = d.x * d.x + d.y * d.y + d.z * d.z;
        QRAY_HOLDS(square - one <= N::one * little && one - square <= N::one * little);
    }
}

// --- Texture

// Cells of 2^-15 (q16: 1), at lattice points and one step before them, up to 2^20 cells away.
QRAY_CASE(TextureCellsAMillionAwayAreRight)
{
    QRAY_NAMES;
    LatticeAxis<N> axis{};
    int cells = 15;
    if constexpr (NarrowFixed<N>) {
        axis.row_x = 1 << N::dropped;
        axis.frac = N::Length::frac;
        cells = 0;
    } else if constexpr (N::is_fixed) {
        axis.row_x = 1 << 30;
        axis.shift = -7;
    } else {
        axis.row_x = power_of_two<Length>(cells);
    }
    hide(axis);
    constexpr int most = 1 << 20;
    for (int64_t cell : List{0, 1, -1, 2, -2, 3, -7, 1000, -1000, 65535, -65536, most, -most, most - 1}) {
        if (NarrowFixed<N> && (cell > 62 || cell < -62))
            continue;
        Point<N> q{number<Length>(cell, int64_t{1} << cells), Length{}, Length{}};
        hide(q);
        const Cell<N> here = axis.cell(q);
        QRAY_HOLDS(here.index == static_cast<uint32_t>(cell) && here.inside == Unit{});
        if (!N::is_fixed)
            continue;
        q.x = q.x - ulp;
        QRAY_HOLDS(axis.cell(q).index == static_cast<uint32_t>(cell - 1));
    }
}

// --- Range

QRAY_CASE(MostNegativeIntegers)
{
    int32_t least = INT32_MIN, most = INT32_MAX, one = 1;
    hide(least);
    hide(most);
    hide(one);
    QRAY_HOLDS(magnitude(least) == 0x80000000u);
    QRAY_HOLDS(wide_mul(least, least) == int64_t{1} << 62);
    QRAY_HOLDS(wide_mul(least, most) == -(int64_t{1} << 62) + (int64_t{1} << 31));
    QRAY_HOLDS(wide_mul(most, most) == (int64_t{1} << 62) - (int64_t{1} << 32) + 1);
    QRAY_HOLDS(wide_mul(least, -one) == int64_t{1} << 31);
    QRAY_HOLDS(wide_square(least) == uint64_t{1} << 62);
    QRAY_HOLDS(saturating_sub(least, most) == INT32_MIN + 1); // whose negative is a number
    QRAY_HOLDS(saturating_sub(0, least) == INT32_MAX);
    QRAY_HOLDS(saturating_add(least, least) == INT32_MIN + 1);
    int64_t longest = INT64_MIN;
    hide(longest);
    QRAY_HOLDS(magnitude(longest) == uint64_t{1} << 63);
    QRAY_HOLDS(divide(longest, 1, 0) == -INT32_MAX);
    QRAY_HOLDS(divide(longest, 0xffffffffu, 32) == -INT32_MAX);
    QRAY_HOLDS(divide(int64_t{one}, 0, 0) == INT32_MAX);
}

QRAY_CASE(DotsOfThreeMaxima)
{
    int32_t least = INT32_MIN, most = INT32_MAX, third = 619925131; // 2^30 / sqrt 3
    hide(least);
    hide(most);
    hide(third);
    QRAY_HOLDS(wide_norm2(least, least, least) == uint64_t{3} << 62);
    QRAY_HOLDS(wide_norm2(most, most, most) == 3 * ((uint64_t{1} << 62) - (uint64_t{1} << 32) + 1));
    // 3 (2^31 - 1) 2^30 / sqrt 3 < 2^63
    const int64_t expected = 3 * ((int64_t{619925131} << 31) - 619925131);
    QRAY_HOLDS(wide_dot(most, most, most, third, third, third) == expected);
    QRAY_HOLDS(wide_dot(-most, -most, -most, third, third, third) == -expected);
}

QRAY_CASE(NormaliseOfASingleRawUnit)
{
    QRAY_NAMES;
    const Unit little = number<Unit>(1, int64_t{1} << unit_bits<N>);
    Length step = N::is_fixed ? N::ulp : power_of_two<Length>(-60);
    hide(step);
    const Point<N> off = {step, step, step};
    Direction<N> u{};
    QRAY_HOLDS(normalise<N>(Point<N>{step, Length{}, Length{}}, u) && u.x >= N::one - little && u.x <= N::one);
    QRAY_HOLDS(u.y == Unit{} && u.z == Unit{});
    QRAY_HOLDS(normalise<N>(Point<N>{Length{}, -step, Length{}}, u) && -u.y >= N::one - little
               && -u.y <= N::one);
    // 0.577350269189625...
    const Unit third = number<Unit>(577350269, 1000000000);
    QRAY_HOLDS(normalise<N>(off, u) && u.x == u.y && u.y == u.z && u.x - third <= little + little
               && third - u.x <= little + little);
}

QRAY_CASE(NormaliseOfZeroIsRefused)
{
    QRAY_NAMES;
    Direction<N> u = M::direction({0, 0, 1});
    Point<N> zero{};
    hide(zero);
    QRAY_HOLDS(!normalise<N>(zero, u) && u == M::direction({0, 0, 1}));
}

QRAY_CASE(RootsOfZeroAndOfTheLargestArea)
{
    QRAY_NAMES;
    for (int64_t root : List{0, 1, 2, 5, 11, 45, 120}) {
        if (root > (ShortFixed<N> ? 45 : NarrowFixed<N> ? 5 : 120)) // q16 squares no more than 46340 steps, q24 370727
            continue;
        Length r = number<Length>(root);
        hide(r);
        QRAY_HOLDS(N::sqrt(r * r) == r);
    }
}

// --- Colour

QRAY_CASE(PowersNearOneAndOfZero)
{
    QRAY_NAMES;
    const auto power = [](Unit x, uint32_t whole, bool half) {
        typename N::Shine e{};
        e.whole = whole;
        if constexpr (N::is_fixed)
            e.fraction = half ? uint32_t{1} << 31 : 0;
        else
            e.fraction = half ? Unit(0.5) : Unit(0);
        hide(x);
        hide(e);
        return N::power(x, e);
    };
    QRAY_HOLDS(power(Unit{}, 0, false) == N::one);
    QRAY_HOLDS(power(Unit{}, 1, false) == Unit{});
    QRAY_HOLDS(power(Unit{}, 0, true) == Unit{});
    for (int64_t x : List{0, 1, 100, 500, 1000})
        QRAY_HOLDS(power(number<Unit>(x, 1000), 0, false) == N::one);
    QRAY_HOLDS(power(N::one, 1000000, false) == N::one);
    QRAY_HOLDS(power(N::one, 1000000, true) == N::one);
    if constexpr (!NarrowFixed<N>) { // (1 - 2^-16)^10000 = 0.858482438578...
        const Unit found = power(N::one - power_of_two<Unit>(-16), 10000, false);
        const Unit expected = number<Unit>(858482439, 1000000000);
        const Unit fixed_little = power_of_two<Unit>(-28) + power_of_two<Unit>(-30);
        const Unit little = N::is_fixed ? fixed_little : number<Unit>(6, 10000);
        QRAY_HOLDS(found - expected <= little && expected - found <= little);
    }
}

} // namespace catalogue
