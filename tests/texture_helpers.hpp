// Texture lattices of a number system, and where a point lies in them, in long double.
#pragma once

#include "number_helpers.hpp"

#include "../src/scene/convert.hpp"

namespace qray::test {

// Where a texture lies: p = (q / scale + origin) / size, as the builder moves and scales a scene.
struct Placing {
    double size = 1;
    Vec3 origin{0, 0, 0};
    double scale = 1;
};

template <class N>
LatticeAxis<N> make_axis(const Placing& at, const Vec3& along, double offset, bool wraps)
{
    const double k = 1 / at.size;
    return scene::Convert<N>::axis({along.x * k, along.y * k, along.z * k}, {at.origin.x, at.origin.y, at.origin.z},
                                   at.scale, offset, wraps);
}
template <class N>
LatticeStep<N> make_step(const Placing& at, const Vec3& along, double offset)
{
    return scene::Convert<N>::step(make_axis<N>(at, along, offset, true));
}
template <class N>
Lattice<N> make_lattice(const Placing& at, double offset)
{
    return {make_step<N>(at, {1, 0, 0}, offset), make_step<N>(at, {0, 1, 0}, offset),
            make_step<N>(at, {0, 0, 1}, offset)};
}
template <class N>
Vec<Real> texture_point(const Placing& at, const Point<N>& q)
{
    return (real(q) * (1 / Real(at.scale)) + real(at.origin)) * (1 / Real(at.size));
}

// How far p may be off where q reaches so far: the row's 30 bits; in q16 a row that is exact to 2^-14 of what p can be
// in the whole world; or a float sum of three products and an offset.
template <class N>
double place_tolerance(const Placing& at, double q_reach)
{
    const double reach = (NarrowFixed<N> ? 62.5 : q_reach) / at.scale / at.size + 1;
    const double with_origin = reach + length(at.origin) / at.size;
    return NarrowFixed<N> ? reach * 0x1p-14
        : N::is_fixed     ? with_origin * 0x1p-29
                          : with_origin * 6 * value(N::ulp) / 64;
}

// Distance to the nearest integer.
inline double from_integer(Real p)
{
    return static_cast<double>(std::fabs(p - std::round(p)));
}
inline bool is_odd(Real cell)
{
    return std::fmod(std::fabs(cell), Real(2)) == 1;
}

constexpr Real texture_epsilon = Real(1) / 1024;

} // namespace qray::test
