// Sines and cosines of integer angles: 2^32 steps are a whole turn, so that angles wrap as unsigned numbers do.
#pragma once

#include "power.hpp"

namespace qray {

// n/d of a whole turn, rounded down, for d in [1, 65536].
constexpr uint32_t part_of_turn(uint32_t n, uint32_t d)
{
    const uint32_t high = (n % d) << 16, low = (high % d) << 16;
    return (high / d) << 16 | low / d;
}

struct SineCosine {
    int32_t sine, cosine; // Q2.30
};

namespace detail {

// Of Taylor's series, Q0.32: (1 - sin(y)/y) / y^2 and (1 - cos(y)) / y^2 in y^2.
inline constexpr uint32_t sine_coefficients[5] = {715827883, 35791394, 852176, 11836, 108};
inline constexpr uint32_t cosine_coefficients[6] = {2147483648, 178956971, 5965233, 106522, 1184, 9};

struct Octant {
    uint32_t sine, versine; // 1 - cosine; Q0.32, each within 4 ulp
};
// Of an angle of at most an eighth of a turn.
QRAY_SHARED constexpr Octant octant(uint32_t a)
{
    constexpr uint32_t quarter_pi = 0xc90f'daa2;
    const uint32_t y = mul_high((a << 3) - (a >> 29), quarter_pi), y2 = square_high(y);
    return {y - mul_high(mul_high(y, y2), alternating_polynomial(sine_coefficients, 4, y2)),
            mul_high(y2, alternating_polynomial(cosine_coefficients, 5, y2))};
}

} // namespace detail

// Each within 1.25 ulp; those of whole quarters are exact.
constexpr SineCosine sine_cosine(uint32_t angle)
{
    constexpr uint32_t eighth = uint32_t{1} << 29;
    const uint32_t quarter = angle >> 30, rest = angle & (2 * eighth - 1);
    const bool beyond = rest > eighth;
    const auto [sine, versine] = detail::octant(beyond ? 2 * eighth - rest : rest);
    const int32_t s = static_cast<int32_t>((sine >> 2) + (sine >> 1 & 1));
    const int32_t c = (int32_t{1} << 30) - static_cast<int32_t>((versine >> 2) + (versine >> 1 & 1));
    const int32_t of_sine = beyond ? c : s, of_cosine = beyond ? s : c;
    switch (quarter) {
    case 0: return {of_sine, of_cosine};
    case 1: return {of_cosine, -of_sine};
    case 2: return {-of_sine, -of_cosine};
    default: return {-of_cosine, of_sine};
    }
}

} // namespace qray
