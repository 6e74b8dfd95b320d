// Number systems. One names the types of the quantities of a ray tracer and every operation between
// them that the tracer needs:
//   Length  positions, distances along a ray, radii, in scene units after the builder's move and scale
//   Unit    components of unit vectors, cosines, weights and coefficients in [0, 1]
//   Colour  linear light after the builder's exposure scale, at most Colour's range
// Products are exact (in fixed point) and are summed before one rounding: length(), unit(), colour().
// The builder keeps every point within +-world of the origin, so that differences of points, and all
// distances between them, fit Length.
#pragma once

#include <stdint.h>

#include "fixed.hpp"
#include "math.hpp"
#include "power.hpp"

namespace qray {

// The type of a quantity that is no number system's own: one in fixed point, another in floating point.
template <class N, class InFixed, class InFloating>
using ByNumber = Either<N::is_fixed, InFixed, InFloating>;

// 1/r as fixed point keeps it: v / r = (v << shift) * mantissa, shifted down by what the number system says.
struct FixedScale {
    int32_t mantissa;
    int32_t shift;
};

// What is squared is block-scaled first, times 2^fine, fine from `least` to `most`: so that the radius of a ball, and
// of a cone's ball, with `slack` more for what a coarse test lets pass, stays within `size`, in ulp.
struct Blocks {
    struct Of {
        int least, most;
        int32_t size;
    };
    int32_t slack;
    Of ball, cone;
};

// What every system of fixed point has alike: how many bits its quantities have behind the point, and 16 or 32 to hold
// those that are multiplied.
template <int LengthFrac, int UnitFrac, int ColourFrac, int EtaFrac, int Bits>
struct FixedNumbers {
    static constexpr bool is_fixed = true;
    using Length = Fixed<LengthFrac, Bits>;
    using Unit = Fixed<UnitFrac, Bits>;
    using Colour = Fixed<ColourFrac, Bits>;
    using Eta = Fixed<EtaFrac, Bits>; // ratio of refractive indices, up to 8
    using Area = decltype(Length{} * Length{});
    using Moment = decltype(Length{} * Unit{});
    using Cosine = decltype(Unit{} * Unit{});
    using Scale = FixedScale;
    using Shine = Exponent;

    static constexpr int dropped = LengthFrac + UnitFrac - Moment::frac; // bits of such a product

    static constexpr Length length_zero{0};
    static constexpr Unit one{int32_t{1} << UnitFrac};
    static constexpr Unit zero{0};
    static constexpr Colour black{0};
    static constexpr Length ulp{1};

    // n/d, rounded down, for 0 <= n <= d <= 2^16.
    static consteval Unit fraction(int32_t n, int32_t d)
    {
        return {static_cast<int32_t>((int64_t{n} << UnitFrac) / d)};
    }

    template <int F>
    QRAY_INLINE static constexpr Length length(Wide<F, Bits> w) { return round_to<Length>(w); }
    template <int F>
    QRAY_INLINE static constexpr Unit unit(Wide<F, Bits> w) { return round_to<Unit>(w); }
    template <int F>
    QRAY_INLINE static constexpr Colour colour(Wide<F, Bits> w) { return round_to<Colour>(w); }

    // Back from the block scale 2^fine.
    QRAY_INLINE static constexpr Length coarse(Length a, int32_t fine)
    {
        return {(a.raw + (1 << fine >> 1)) >> fine};
    }
    QRAY_INLINE static constexpr Length coarse_below(Length a, int32_t fine) { return {a.raw >> fine}; }

    // Block scaling: 2^k a.
    template <int F>
    QRAY_INLINE static constexpr Wide<F, Bits> shifted(Wide<F, Bits> a, int k)
    {
        using Rep = typename Wide<F, Bits>::Rep;
        return {k >= 0 ? static_cast<Rep>(a.raw * (Rep{1} << k)) : static_cast<Rep>(a.raw >> -k)};
    }
    // Beyond this scale unit vectors know no more of each other.
    static constexpr int most_headroom = UnitFrac;

    // Block scaling: the largest k with 2^k |a|, 2^k |b|, 2^k |c| all below 1.
    template <int F>
    static constexpr int headroom(Wide<F, Bits> a, Wide<F, Bits> b, Wide<F, Bits> c)
    {
        return count_leading_zeros(magnitude(a.raw) | magnitude(b.raw) | magnitude(c.raw))
            - (8 * static_cast<int>(sizeof a) - F);
    }

    // Is |a| less than 2^-Down?
    template <int Down, int F>
    QRAY_INLINE static constexpr bool is_below(Wide<F, Bits> a)
    {
        constexpr auto limit = typename Wide<F, Bits>::Rep{1} << (F - Down);
        return limit > a.raw && -limit < a.raw;
    }
    // Is a plane with this d.n seen almost edge on? Then its equation does not tell where the ray meets it.
    QRAY_INLINE static constexpr bool nearly_zero(Cosine c) { return is_below<UnitFrac / 2>(c); }

    // eta x, clamped to +-5/4: a bent direction longer than 1 is totally reflected, however long.
    QRAY_INLINE static constexpr Unit bent(Eta eta, Unit x)
    {
        using Bent = decltype(eta * x);
        constexpr typename Bent::Rep limit = typename Bent::Rep{5} << (Bent::frac - 2);
        const Bent w = eta * x;
        return round_to<Unit>(Bent{w.raw > limit ? limit : w.raw < -limit ? -limit : w.raw});
    }

    // How far a new ray starts from the surface it leaves: 2 ulp along the geometric normal.
    QRAY_INLINE static constexpr Length leave(Unit g)
    {
        return {(g.raw + (1 << (UnitFrac - 2))) >> (UnitFrac - 1)};
    }
};

// Fixed point whose products take one register of 32 bits, and fixed point whose products take 64.
template <class N>
concept NarrowFixed = N::is_fixed && sizeof(typename N::Moment) == 4;
// Whose angles and shares take 16 bits.
template <class N>
concept ShortFixed = NarrowFixed<N> && N::Unit::frac < 16;
template <class N>
concept WideFixed = N::is_fixed && sizeof(typename N::Moment) == 8;
template <class N>
concept SingleFloat = !N::is_fixed && sizeof(typename N::Length) == 4;

template <class T, class Expected>
concept Is = __is_same(T, Expected);

// What the tracer asks of a number system, whatever its numbers are. Each system checks itself.
template <class N>
concept NumberSystem = requires(typename N::Length l, typename N::Unit u, typename N::Colour c, typename N::Eta eta,
                                typename N::Moment moment, typename N::Area area, typename N::Cosine cosine,
                                typename N::Scale scale, typename N::Shine shine, typename N::Span span, int k) {
    { N::is_fixed } -> Is<const bool&>;
    { N::length_max } -> Is<const typename N::Length&>;
    { N::length_zero } -> Is<const typename N::Length&>;
    { N::ulp } -> Is<const typename N::Length&>;
    { N::light_clearance } -> Is<const typename N::Length&>;
    { N::one } -> Is<const typename N::Unit&>;
    { N::zero } -> Is<const typename N::Unit&>;
    { N::black } -> Is<const typename N::Colour&>;
    // Exact products, and their one rounding.
    { l * u } -> Is<typename N::Moment>;
    { l * l } -> Is<typename N::Area>;
    { u * u } -> Is<typename N::Cosine>;
    { N::length(moment) } -> Is<typename N::Length>;
    { N::unit(cosine) } -> Is<typename N::Unit>;
    { N::colour(c * u) } -> Is<typename N::Colour>;
    { N::dot(l, l, l, u, u, u) } -> Is<typename N::Moment>;
    { N::norm2(l, l, l) } -> Is<typename N::Area>;
    { N::fraction(1, 2) } -> Is<typename N::Unit>;
    // What cannot be shown to fit saturates.
    { N::saturating_sub(l, l) } -> Is<typename N::Length>;
    { N::saturating_add(c, c) } -> Is<typename N::Colour>;
    // Block scales.
    { N::fine_sub(moment, l, k) } -> Is<typename N::Length>;
    { N::fine(l, k) } -> Is<typename N::Length>;
    { N::coarse(l, k) } -> Is<typename N::Length>;
    { N::coarse_above(l, k) } -> Is<typename N::Length>;
    { N::headroom(cosine, cosine, cosine) } -> Is<int>;
    { N::shifted(cosine, k) } -> Is<typename N::Cosine>;
    { N::most_headroom } -> Is<const int&>;
    requires !N::is_fixed || requires { { N::blocks } -> Is<const Blocks&>; };
    // Roots, quotients, unit vectors, powers.
    { N::sqrt(area) } -> Is<typename N::Length>;
    { N::root(area) } -> Is<typename N::Length>; // of what is known to be 0 or more
    { N::sqrt_unit(cosine) } -> Is<typename N::Unit>;
    { N::quotient(moment, cosine, k, l) } -> Is<bool>;
    { N::normalise(l, l, l, u, u, u) } -> Is<bool>;
    { N::normalise(span, span, span, u, u, u) } -> Is<bool>;
    { N::ratio(l, scale) } -> Is<typename N::Unit>;
    { N::sharpen(u, u, u) } -> Is<void>;
    { N::bent(eta, u) } -> Is<typename N::Unit>;
    { N::nearly_zero(cosine) } -> Is<bool>;
    { N::power_whole(u, shine) } -> Is<typename N::Unit>;
    { N::power(u, shine) } -> Is<typename N::Unit>;
};

} // namespace qray
