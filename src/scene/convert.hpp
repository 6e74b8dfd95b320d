// From double to the quantities of a number system, to the nearest.
#pragma once

#include <math.h>

#include <qray/scene/camera.hpp>
#include <qray/texture/lattice.hpp>

#include "description.hpp"

namespace qray::scene {

template <class N>
struct Convert {
    template <class F>
    static F fixed(double v) // F is a Fixed; |v| must be within its range
    {
        return F{static_cast<int32_t>(llrint(ldexp(v, F::frac)))};
    }
    template <class F>
    static F number(double v)
    {
        if constexpr (N::is_fixed)
            return fixed<F>(v);
        else
            return static_cast<F>(v);
    }
    static typename N::Length length(double v) { return number<typename N::Length>(v); }
    static typename N::Unit unit(double v) { return number<typename N::Unit>(v); }
    static typename N::Colour colour(double v) { return number<typename N::Colour>(v); }
    static typename N::Eta eta(double v) { return number<typename N::Eta>(v); }
    static Point<N> point(const Vec3d& p) { return {length(p.x), length(p.y), length(p.z)}; }
    template <class V>
    static V vector(const Vec3d& v)
    {
        using T = decltype(V::x);
        return {number<T>(v.x), number<T>(v.y), number<T>(v.z)};
    }
    static Direction<N> direction(const Vec3d& d) { return {unit(d.x), unit(d.y), unit(d.z)}; }
    static Vec<typename N::Unit> surface(const Vec3d& c) { return direction(c); } // its colour
    // p less its rounding, in units of 2^-fine ulp.
    static Rounded<N> rounded([[maybe_unused]] const Vec3d& p, [[maybe_unused]] int fine)
    {
        if constexpr (WideFixed<N>) {
            const auto of = [fine](double v) {
                const double fixed = ldexp(v, N::Length::frac);
                return static_cast<int16_t>(lrint(ldexp(rint(fixed) - fixed, fine)));
            };
            return {of(p.x), of(p.y), of(p.z)};
        } else {
            return {};
        }
    }
    static Rgb<N> rgb(const Vec3d& c) { return {colour(c.x), colour(c.y), colour(c.z)}; }

    // What is more than 0 stays so: 0^0 is 1, and 0 to any other power is 0.
    static typename N::Shine shine(double e)
    {
        const double least = ldexp(1, N::is_fixed ? -32 : sizeof(typename N::Unit) == 4 ? -24 : -53);
        if (e > 0)
            e = fmax(e, least);
        const double whole = floor(e);
        if constexpr (N::is_fixed)
            return {static_cast<uint32_t>(whole), static_cast<uint32_t>(fmin(4294967295.0, ldexp(e - whole, 32)))};
        else
            return {static_cast<uint32_t>(whole), static_cast<typename N::Unit>(e - whole)};
    }

    // The lattice coordinate row . (q / scale + origin) + offset of a point q in the moved and scaled scene;
    // row is in 1/size. A lattice wraps where cells no longer fit; a distance is clamped.
    static LatticeAxis<N> axis(const Vec3d& row, const Vec3d& origin, double scale, double offset, bool wraps)
    {
        double whole = dot(row, origin) + offset;
        Vec3d r = row * (1 / scale);
        if constexpr (NarrowFixed<N>) {
            // So many bits that p fits for every point of the scene, and no cells of less than a 2^-19 of an ulp.
            int exponent = 0;
            frexp((scene::length(r) * 62.5 + 1) * 1.0001, &exponent);
            if (exponent > 30) {
                r = r * ldexp(1, 30 - exponent);
                whole = ldexp(whole, 30 - exponent);
                exponent = 30;
            }
            const int frac = 31 - exponent;
            const auto row_of = [frac](double v) {
                return static_cast<int32_t>(llrint(ldexp(v, frac - N::Length::frac + N::dropped)));
            };
            const double cell = floor(whole);
            const double index = wraps ? fmod(cell, 4294967296.0) : fmax(-0x1p30, fmin(0x1p30, cell));
            return {row_of(r.x), row_of(r.y), row_of(r.z), frac, static_cast<int32_t>(floor(ldexp(whole - cell, frac))),
                    static_cast<int32_t>(static_cast<int64_t>(index))};
        } else if constexpr (N::is_fixed) {
            // The largest component gets 30 bits.
            int exponent = 0;
            frexp(largest(r), &exponent);
            const int up = 30 - exponent;
            const auto mantissa = [up](double v) { return static_cast<int32_t>(llrint(ldexp(v, up))); };
            // raw q is q 2^frac: row.q 2^32 = (mantissas . raw) 2^(32 - up - frac)
            int shift = 32 - up - N::Length::frac;
            shift = shift > 62 ? 62 : shift < -63 ? -63 : shift;
            const double turn = ldexp(1, 32), limit = ldexp(1, 29);
            const double folded = wraps ? whole - turn * floor(whole / turn + 0.5) : fmax(-limit, fmin(limit, whole));
            return {mantissa(r.x), mantissa(r.y), mantissa(r.z), shift, llrint(ldexp(folded, 32))};
        } else {
            using F = typename N::Length;
            const double cell = floor(whole);
            return {static_cast<F>(r.x), static_cast<F>(r.y), static_cast<F>(r.z), static_cast<F>(whole - cell),
                    static_cast<uint32_t>(static_cast<int64_t>(fmod(cell, 4294967296.0))), static_cast<F>(whole)};
        }
    }

    // Of an axis along one coordinate.
    static LatticeStep<N> step(const LatticeAxis<N>& a)
    {
        const auto row = a.row_x + a.row_y + a.row_z; // two of them are 0
        if constexpr (NarrowFixed<N>)
            return {row, a.frac, a.offset, a.whole};
        else if constexpr (N::is_fixed)
            return {row, a.shift, a.offset};
        else
            return {row, a.inside, a.index};
    }

    static Pencil<N> pencil(const Vec3d& d, double scale)
    {
        [[maybe_unused]] const auto whole = [](double v) { return static_cast<decltype(Pencil<N>::x)>(llrint(v)); };
        if constexpr (N::is_fixed)
            return {whole(d.x * scale), whole(d.y * scale), whole(d.z * scale)};
        else
            return {static_cast<typename N::Unit>(d.x), static_cast<typename N::Unit>(d.y),
                    static_cast<typename N::Unit>(d.z)};
    }
};

} // namespace qray::scene
