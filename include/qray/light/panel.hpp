// Panels: light from a parallelogram, by n x n places that each sample of the picture shifts in its own way.
#pragma once

#include "../number/hash.hpp"
#include "light.hpp"

namespace qray {

template <class N>
struct Panel {
    static constexpr bool has_place = true;
    // Lengths are finer by so many bits, so that sums of steps stay exact enough.
    static constexpr int fine = ShortFixed<N> ? 8 : NarrowFixed<N> ? 4 : 0;

    Point<N> corner;         // in units of 2^(shift - fine) lengths, as are
    Point<N> step_u, step_v; // from a place to the next
    int32_t shift;           // as Light's
    Rgb<N> colour;           // of all places together
    uint8_t places;          // n, from 1 to 16
    uint8_t number;          // among panels

    // Calls f(light) for every place.
    template <class Sample, class F>
    QRAY_INLINE constexpr void for_each_place(const Sample& sample, F f) const
    {
        uint32_t h = 0;
        if constexpr (requires { sample.x; })
            hash(sample.x, sample.y, number, h);
        else
            h = 0x80008000;
        Point<N> row = corner + part(step_u, h & 0xffff) + part(step_v, h >> 16);
        for (uint32_t m = 0; m < places; m++) {
            Point<N> at = row;
            for (uint32_t k = 0; k < places; k++) {
                if constexpr (fine != 0)
                    f(Light<N>{coarse<N>(at, fine), shift, colour});
                else
                    f(Light<N>{at, shift, colour});
                at = at + step_u;
            }
            row = row + step_v;
        }
    }

private:
    // (i + 1/2) / 2^16 of a step.
    static constexpr Point<N> part(const Point<N>& step, uint32_t i)
    {
        const auto share = [i](typename N::Length a) {
            if constexpr (N::is_fixed)
                return typename N::Length{rounding_shift<17>(wide_mul(a.raw, static_cast<int32_t>(2 * i + 1)))};
            else
                return a * (static_cast<typename N::Length>(2 * i + 1) / typename N::Length(1 << 17));
        };
        return {share(step.x), share(step.y), share(step.z)};
    }
};

// False, and nothing changes, where it leaves the world; also of one that stands outside of it.
template <class N>
constexpr bool move(const Panel<N>& from, const Motion<N>& motion, Panel<N>& to)
{
    constexpr int fine = Panel<N>::fine;
    const auto inside = [](const Point<N>& p) {
        if constexpr (fine == 0)
            return ball_in_world<N>(p);
        else
            return ball_in_world<N>({{p.x.raw >> fine}, {p.y.raw >> fine}, {p.z.raw >> fine}});
    };
    Panel<N> s = from;
    s.corner = motion(from.corner, fine);
    s.step_u = motion.vector(from.step_u);
    s.step_v = motion.vector(from.step_v);
    if (!motion.valid() || from.shift != 0 || !inside(s.step_u) || !inside(s.step_v))
        return false;
    Point<N> u = s.corner, v = s.corner, across = s.corner;
    for (uint32_t i = 0; i < s.places; i++) {
        u = saturating_sum<N>(u, s.step_u);
        v = saturating_sum<N>(v, s.step_v);
        across = saturating_sum<N>(saturating_sum<N>(across, s.step_u), s.step_v);
    }
    if (!inside(s.corner) || !inside(u) || !inside(v) || !inside(across))
        return false;
    to = s;
    return true;
}

} // namespace qray
