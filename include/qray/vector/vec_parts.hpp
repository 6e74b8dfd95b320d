// Three components of one type. What a vector stands for (a point, a direction, a colour) is said by its
// component type: Length, Unit or Colour of a number system.
#pragma once

#include "../number/lanes.hpp"
#include "../number/floating.hpp"
#include "../number/q16.hpp"
#include "../number/q24.hpp"
#include "../number/q32.hpp"

namespace qray {

template <class T>
struct Vec {
    T x, y, z;

    friend constexpr Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    constexpr Vec operator-() const { return {-x, -y, -z}; }
    friend constexpr bool operator==(const Vec& a, const Vec& b)
    {
        return a.x == b.x && a.y == b.y && a.z == b.z;
    }
};

// A copy part by part, which leaves the parts in registers where a copy of the whole goes through memory.
template <class T>
QRAY_INLINE constexpr Vec<T> parts_of(const Vec<T>& a)
{
    if constexpr (requires { a.lanes; })
        return a;
    else
        return {a.x, a.y, a.z};
}

// Are its vectors one register each? Then vec_lanes.hpp has the functions below.
template <class N>
inline constexpr bool in_lanes = QRAY_LANES && (WideFixed<N> || SingleFloat<N>);
template <class N>
concept InParts = !in_lanes<N>;
template <class N>
concept AnyLanes = in_lanes<N>;
template <class N>
concept FloatLanes = in_lanes<N> && !N::is_fixed;
template <class N>
concept FixedLanes = in_lanes<N> && N::is_fixed;

// Exact in fixed point.
template <InParts N, class A, class B>
QRAY_INLINE constexpr auto dot(const Vec<A>& a, const Vec<B>& b)
{
    return N::dot(a.x, a.y, a.z, b.x, b.y, b.z);
}
template <InParts N>
QRAY_INLINE constexpr auto norm2(const Vec<typename N::Length>& a)
{
    return N::norm2(a.x, a.y, a.z);
}

// t d, one rounding a component.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> along(typename N::Length t, const Vec<typename N::Unit>& d)
{
    return {N::length(t * d.x), N::length(t * d.y), N::length(t * d.z)};
}
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Unit> scaled(typename N::Unit k, const Vec<typename N::Unit>& d)
{
    return {N::unit(k * d.x), N::unit(k * d.y), N::unit(k * d.z)};
}
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Colour> scaled(typename N::Unit k, const Vec<typename N::Colour>& c)
    requires N::is_fixed
{
    return {N::colour(c.x * k), N::colour(c.y * k), N::colour(c.z * k)};
}

// Light after a surface or a veil of colour m.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Colour> filtered(const Vec<typename N::Colour>& light,
                                                       const Vec<typename N::Unit>& m)
{
    return {N::colour(light.x * m.x), N::colour(light.y * m.y), N::colour(light.z * m.z)};
}
// v / r, for |v| <= about r.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Unit> ratio(const Vec<typename N::Length>& v, typename N::Scale inverse_r)
{
    return {N::ratio(v.x, inverse_r), N::ratio(v.y, inverse_r), N::ratio(v.z, inverse_r)};
}

// 2^fine (middle d - v), rounded once: the point of the ray at `middle`, seen from o + v.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> fine_offset(typename N::Length middle, const Vec<typename N::Unit>& d,
                                                          const Vec<typename N::Length>& v, int32_t fine)
{
    return {N::fine_sub(middle * d.x, v.x, fine), N::fine_sub(middle * d.y, v.y, fine),
            N::fine_sub(middle * d.z, v.z, fine)};
}
// Back from the block scale.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> coarse(const Vec<typename N::Length>& p, int32_t fine)
{
    return {N::coarse(p.x, fine), N::coarse(p.y, fine), N::coarse(p.z, fine)};
}

// Is any component beyond +-r? In fixed point, of what is not, sums of squares fit; others do without.
template <class N>
    requires(!FixedLanes<N>)
QRAY_INLINE constexpr bool outside_cube([[maybe_unused]] const Vec<typename N::Length>& w,
                                        [[maybe_unused]] typename N::Length r)
{
    if constexpr (WideFixed<N>)
        return w.x > r || w.y > r || w.z > r || w.x < -r || w.y < -r || w.z < -r;
    else
        return false;
}

// Of lattice.hpp, a number that is odd where the sum of a point's three cells is: where one question tells for all
// three that they fit a word. False where they must be found one by one.
template <class N, class Step>
    requires(!FloatLanes<N>)
QRAY_INLINE constexpr bool sum_of_cells([[maybe_unused]] const Step& x, [[maybe_unused]] const Step& y,
                                        [[maybe_unused]] const Step& z,
                                        [[maybe_unused]] const Vec<typename N::Length>& q,
                                        [[maybe_unused]] uint32_t& sum)
{
    if constexpr (SingleFloat<N>) {
        const auto px = x.row * q.x + x.inside, py = y.row * q.y + y.inside, pz = z.row * q.z + z.inside;
        if (N::absolute(px) + N::absolute(py) + N::absolute(pz) < N::whole_limit) {
            sum = N::floor(px) + N::floor(py) + N::floor(pz) + x.index + y.index + z.index;
            return true;
        }
    }
    return false;
}

// dot() and along() for the normal of a flat surface. In a constant table it often lies along an axis, and products
// with 0 change nothing but the sign of a floating-point 0.
template <class N, class A>
QRAY_INLINE constexpr auto dot_normal(const Vec<A>& a, const Vec<typename N::Unit>& n)
{
    if constexpr (!N::is_fixed && InParts<N>) {
        if (QRAY_KNOWN(n.x == 0) && QRAY_KNOWN(n.z == 0))
            return a.y * n.y;
        if (QRAY_KNOWN(n.x == 0) && QRAY_KNOWN(n.y == 0))
            return a.z * n.z;
        if (QRAY_KNOWN(n.y == 0) && QRAY_KNOWN(n.z == 0))
            return a.x * n.x;
    }
    return dot<N>(a, n);
}
template <class N>
QRAY_INLINE constexpr Vec<typename N::Length> along_normal(typename N::Length t, const Vec<typename N::Unit>& n)
{
    if constexpr (!N::is_fixed && InParts<N>)
        return {QRAY_KNOWN(n.x == 0) ? 0 : t * n.x, QRAY_KNOWN(n.y == 0) ? 0 : t * n.y,
                QRAY_KNOWN(n.z == 0) ? 0 : t * n.z};
    else
        return along<N>(t, n);
}

// The point a little off q on one side of a surface with normal g: where a ray starts that leaves it.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> step_off(const Vec<typename N::Length>& q,
                                                       const Vec<typename N::Unit>& g, bool outward)
{
    if constexpr (N::is_fixed) {
        const auto o = outward ? g : -g;
        return {q.x + N::leave(o.x), q.y + N::leave(o.y), q.z + N::leave(o.z)};
    } else {
        const auto step = N::leave(q.x, q.y, q.z);
        const auto k = outward ? step : -step;
        return {q.x + g.x * k, q.y + g.y * k, q.z + g.z * k};
    }
}

// The same for a ray that goes on with a picture and is steep, along itself.
template <InParts N>
    requires WideFixed<N>
QRAY_INLINE constexpr Vec<typename N::Length> step_along(const Vec<typename N::Length>& q,
                                                         const Vec<typename N::Unit>& d)
{
    return {q.x + N::leave_along(d.x), q.y + N::leave_along(d.y), q.z + N::leave_along(d.z)};
}

// The unit vector along v, each component within 1 ulp (fixed point). False, and u untouched, where v is zero.
template <class N, class T>
    requires(InParts<N> || sizeof(T) > 4)
QRAY_INLINE constexpr bool normalise(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    return N::normalise(v.x, v.y, v.z, u.x, u.y, u.z);
}

// Makes a vector unit whose length is 1 but for 2^-15.
template <InParts N>
QRAY_INLINE constexpr void sharpen(Vec<typename N::Unit>& n)
{
    N::sharpen(n.x, n.y, n.z);
}

// A direction before it is made a unit vector: w + x u + y v with |w|, |x u|, |y v| <= 2^60 in fixed point, 2^29 where
// products have 32 bits.
template <class N>
struct Pencil;
template <InParts N>
struct Pencil<N> {
    using Part = typename N::Span;
    Part x, y, z;
    constexpr bool unit(Vec<typename N::Unit>& d) const
    {
        if constexpr (requires { N::normalise_here(x, y, z, d.x, d.y, d.z); })
            return N::normalise_here(x, y, z, d.x, d.y, d.z);
        else
            return N::normalise(x, y, z, d.x, d.y, d.z);
    }
    friend constexpr Pencil operator+(const Pencil& a, const Pencil& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Pencil operator*(const Pencil& a, int32_t k)
    {
        return {a.x * static_cast<Part>(k), a.y * static_cast<Part>(k), a.z * static_cast<Part>(k)};
    }
};

// a - b, each component clamped to the range of Length.
template <InParts N>
QRAY_INLINE constexpr Vec<typename N::Length> saturating_sub(const Vec<typename N::Length>& a,
                                                             const Vec<typename N::Length>& b)
{
    return {N::saturating_sub(a.x, b.x), N::saturating_sub(a.y, b.y), N::saturating_sub(a.z, b.z)};
}

// Adds k times light to a sum that has room for it.
template <InParts N>
QRAY_INLINE constexpr void add_scaled(Vec<typename N::Colour>& sum, typename N::Unit k,
                                      const Vec<typename N::Colour>& light)
{
    sum.x += N::colour(light.x * k);
    sum.y += N::colour(light.y * k);
    sum.z += N::colour(light.z * k);
}

// Adds light to a sum; each component, none of which is negative, clamped.
template <InParts N>
QRAY_INLINE constexpr void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light)
{
    sum.x = N::saturating_add(sum.x, light.x);
    sum.y = N::saturating_add(sum.y, light.y);
    sum.z = N::saturating_add(sum.z, light.z);
}
} // namespace qray
