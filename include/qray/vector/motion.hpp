// How something moves: it is turned and scaled about a pivot, and then shifted. A motion is applied to places at first,
// in flash, and gives those of now: so that a thousand small turns end where they began, and no error adds up.
#pragma once

#include "../number/sine.hpp"
#include "frame.hpp"

namespace qray {

// Arguments are in scene units. One that leaves the world makes a motion that moves nothing: valid() is false.
template <class N>
class Motion {
public:
    constexpr explicit Motion(const Frame<N>& of) : frame(of) {}

    // The place about which it turns and scales; the world's middle if none is told.
    constexpr Motion& about(const ScenePoint<N>& place)
    {
        const Point<N> p = frame.point(place);
        return take(ball_in_world<N>(p), pivot, p);
    }
    // By an angle of which 2^32 are a whole turn, counter-clockwise seen from where the axis points.
    // The last one counts.
    constexpr Motion& turn(const ScenePoint<N>& axis, uint32_t angle)
    {
        Part a[3]{};
        usable = usable && unit_axis(axis, a);
        const SineCosine of = sine_cosine(angle);
        // Rodrigues' formula: c + (1 - c) a a^T + s [a]; of 1 - c a half, as 2 is too large for a Part.
        const Part s = part(of.sine), c = part(of.cosine);
        const Part half = part(static_cast<int32_t>(((int64_t{1} << 30) - of.cosine) >> 1));
        const Part sx = times(s, a[0]), sy = times(s, a[1]), sz = times(s, a[2]);
        const Part x = times(half, a[0]), y = times(half, a[1]), z = times(half, a[2]);
        const Part xy = times<29>(x, a[1]), yz = times<29>(y, a[2]), zx = times<29>(z, a[0]);
        row[0] = {total(c, times<29>(x, a[0])), xy - sz, zx + sy};
        row[1] = {xy + sz, total(c, times<29>(y, a[1])), yz - sx};
        row[2] = {zx - sy, yz + sx, total(c, times<29>(z, a[2]))};
        turns = angle != 0;
        return *this;
    }
    // By a factor > 0.
    constexpr Motion& scale(Coordinate<N> by)
    {
        scales = !(by == coordinate<N>(1));
        return take(by > Coordinate<N>{} && by < coordinate<N>(32767), factor, by);
    }
    constexpr Motion& shift(const ScenePoint<N>& by)
    {
        const Point<N> s = frame.vector(by);
        return take(in_reach(s.x) && in_reach(s.y) && in_reach(s.z), step, s);
    }

    constexpr bool valid() const { return usable; }
    // What only shifts gives the exact sums.
    constexpr bool turned() const { return turns; }
    constexpr bool scaled() const { return scales; }

    // Of a place in the world, in units of 2^-fine; one rounding a turn and one a scale. What leaves the range of
    // Length is clamped to it, and so out of the world.
    constexpr Point<N> operator()(const Point<N>& p, int fine = 0) const
    {
        const Point<N> centre = scaled_up(pivot, fine);
        return saturating_sum<N>(turns || scales ? saturating_sum<N>(vector(p - centre), centre) : p,
                                 scaled_up(step, fine));
    }
    // Of a difference of two places.
    constexpr Point<N> vector(Point<N> v) const
    {
        if (turns)
            v = {across(v, row[0]), across(v, row[1]), across(v, row[2])};
        return scales ? Point<N>{times_factor(v.x, 0), times_factor(v.y, 0), times_factor(v.z, 0)} : v;
    }
    // Of a unit vector.
    constexpr Direction<N> direction(const Direction<N>& d) const
    {
        Direction<N> u = blend(d);
        if constexpr (!NarrowFixed<N>) // whose rounding is greater than the rows' errors
            if (turns)
                sharpen<N>(u);
        return u;
    }
    // Of what is a unit vector or shorter, and stays as long.
    constexpr Direction<N> blend(const Direction<N>& d) const
    {
        return turns ? Direction<N>{across(d, row[0]), across(d, row[1]), across(d, row[2])} : d;
    }
    // Of a size, times 2^by: at most 64, which is too large for the world, so that nothing overflows that asks.
    constexpr typename N::Length length(typename N::Length l, int by = 0) const
    {
        const auto size = times_factor(l, by);
        if constexpr (N::is_fixed)
            return {size.raw < 1 << 30 ? size.raw : 1 << 30};
        else
            return size;
    }

private:
    using Part = ByNumber<N, Fixed<30>, typename N::Unit>;
    static constexpr Part one = [] {
        if constexpr (N::is_fixed)
            return Part{int32_t{1} << 30};
        else
            return N::one;
    }();

    const Frame<N>& frame;
    Vec<Part> row[3]{{one, {}, {}}, {{}, one, {}}, {{}, {}, one}};
    Point<N> pivot{}, step{};
    Coordinate<N> factor = coordinate<N>(1);
    bool turns = false, scales = false, usable = true;

    constexpr typename N::Length times_factor(typename N::Length l, [[maybe_unused]] int by) const
    {
        if constexpr (N::is_fixed)
            return {detail::shifted_even(wide_mul(l.raw, factor.raw), by - Coordinate<N>::frac)};
        else
            return l * factor;
    }
    template <class T>
    constexpr Motion& take(bool fits, T& to, const T& from)
    {
        if (fits)
            to = from;
        usable = usable && fits;
        return *this;
    }
    static constexpr Part part(int32_t q30)
    {
        if constexpr (N::is_fixed)
            return {q30};
        else
            return static_cast<Part>(q30) / static_cast<Part>(int32_t{1} << 30);
    }
    // a b, or 2 a b where Down is 29.
    template <int Down = 30>
    static constexpr Part times(Part a, Part b)
    {
        if constexpr (N::is_fixed)
            return {rounding_shift<Down>(wide_mul(a.raw, b.raw))};
        else
            return Down == 30 ? a * b : (a + a) * b;
    }
    // a + b where b alone may be 2, modulo 4.
    static constexpr Part total(Part a, Part b)
    {
        if constexpr (N::is_fixed)
            return {static_cast<int32_t>(static_cast<uint32_t>(a.raw) + static_cast<uint32_t>(b.raw))};
        else
            return a + b;
    }
    static constexpr bool unit_axis(const ScenePoint<N>& axis, Part (&a)[3])
    {
        if constexpr (N::is_fixed) {
            int32_t u[3]{};
            const bool is = unit_vector(axis.x.raw, axis.y.raw, axis.z.raw, u);
            for (int i = 0; i < 3; i++)
                a[i] = {u[i]};
            return is;
        } else {
            Direction<N> u{};
            const bool is = normalise_short<N>(axis, u) && norm2<N>(u) > N::one / 2; // not of what is infinite
            a[0] = u.x;
            a[1] = u.y;
            a[2] = u.z;
            return is;
        }
    }
    template <class T>
    static constexpr T across(const Vec<T>& v, const Vec<Part>& r)
    {
        if constexpr (N::is_fixed)
            return {rounding_shift<30>(wide_dot(v.x.raw, v.y.raw, v.z.raw, r.x.raw, r.y.raw, r.z.raw))};
        else
            return v.x * r.x + v.y * r.y + v.z * r.z;
    }
    static constexpr bool in_reach(typename N::Length l)
    {
        constexpr auto most = [] {
            if constexpr (N::is_fixed)
                return typename N::Length{126 << N::Length::frac};
            else
                return typename N::Length(126);
        }();
        return l <= most && l >= -most;
    }
    static constexpr Point<N> scaled_up(const Point<N>& p, [[maybe_unused]] int fine)
    {
        return fine == 0 ? p : Point<N>{N::fine(p.x, fine), N::fine(p.y, fine), N::fine(p.z, fine)};
    }
};

} // namespace qray
