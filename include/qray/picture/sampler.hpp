// Pixels from samples (scenes/README.md, section 5).
#pragma once

#include "../trace/trace.hpp"

namespace qray {

// A sample's colour, clamped to [0, 1]: Q4.28 in fixed point, Q12.20 where products have 32 bits.
template <class N>
struct Sample {
    using Level = uint32_t;
    static constexpr int frac = NarrowFixed<N> ? 20 : 28;
    static constexpr Level one = uint32_t{1} << frac;
    Level r, g, b;

    // Light is never negative.
    static constexpr Level clamped(typename N::Colour c, int exposure)
    {
        const int32_t limit = (int32_t{1} << N::Colour::frac) >> exposure;
        return static_cast<uint32_t>((c.raw < limit ? c.raw : limit) << exposure) << (frac - N::Colour::frac);
    }
    // The nearest byte, halves up. Colours are often round decimals, whose 255-fold ends on a half: those that
    // rounding left up to 4 ulp below it count as on it.
    static constexpr uint8_t byte(Level v)
    {
        if constexpr (NarrowFixed<N>)
            return static_cast<uint8_t>((v * 255 + (one >> 1)) >> frac);
        else
            return static_cast<uint8_t>((wide_mul(v + 4, uint32_t{255}) + (one >> 1)) >> frac);
    }
};
template <class N>
    requires(!N::is_fixed)
struct Sample<N> {
    using Level = typename N::Colour;
    static constexpr Level one = 1;
    Level r, g, b;

    // Light is never negative: of float in the order of its bits.
    static constexpr Level clamped(Level c, int)
    {
        if constexpr (sizeof(Level) == 4) {
            const int32_t bits = __builtin_bit_cast(int32_t, c), most = __builtin_bit_cast(int32_t, one);
            return __builtin_bit_cast(Level, bits < most ? bits : most);
        } else {
            return c < one ? c : one;
        }
    }
    // As above: the 255-fold of a mean of round decimals may end 32 epsilon below a half.
    static constexpr uint8_t byte(Level v)
    {
        return static_cast<uint8_t>(static_cast<uint32_t>(v * 255 + (Level(0.5) + 32 * N::epsilon)));
    }
};

// Samples, each weighed by 4^k: of weights that add up to 2^24 at most.
template <class N>
struct SampleSum {
    using Sum = ByNumber<N, uint64_t, typename N::Colour>;
    Sum r = 0, g = 0, b = 0;
    constexpr void add(const Sample<N>& s, int k = 0)
    {
        const auto weighed = [k](Sum v) {
            if constexpr (N::is_fixed)
                return v << 2 * k;
            else
                return v * static_cast<Sum>(uint32_t{1} << 2 * k);
        };
        r += weighed(s.r);
        g += weighed(s.g);
        b += weighed(s.b);
    }
    // Where they add up to n, to the nearest.
    constexpr Sample<N> mean(uint32_t n) const
    {
        const auto part = [n](Sum sum) {
            if constexpr (N::is_fixed)
                return static_cast<uint32_t>(divide(static_cast<int64_t>(sum), n, 0));
            else
                return sum / static_cast<Sum>(n);
        };
        return {part(r), part(g), part(b)};
    }
    // Where they add up to 4^k, k >= 1, without a division.
    constexpr Sample<N> mean_of_fours(int k) const
    {
        const auto part = [k](Sum sum) {
            if constexpr (N::is_fixed)
                return static_cast<uint32_t>((sum + (Sum{1} << (2 * k - 1))) >> 2 * k);
            else
                return sum * (1 / static_cast<Sum>(uint32_t{1} << 2 * k));
        };
        return {part(r), part(g), part(b)};
    }
};

template <class N, Effects E>
QRAY_INLINE constexpr Ray<N> eye_ray(const Scene<N, E>& scene, const Pencil<N>& at)
{
    Ray<N> ray = scene.camera.ray(at);
    if constexpr (E.eye_surface)
        leave(scene.eye_surface.value, ray);
    return ray;
}

template <class N, Effects E, class Count, class... Place>
constexpr Sample<N> sample(const Scene<N, E>& scene, const Pencil<N>& at, Count& count, Place... place)
{
    Rgb<N> c{}; // set apart: with its initialisation the M3 spills more registers
    // Where the stack is deepest, the ray is not kept twice; the M0 has too few registers for that but with a tree.
    if constexpr (E.flat_tree || (E.spawns() && !E.tree && has_wide_multiply)) {
        Ray<N> ray = eye_ray(scene, at);
        c = trace<N, E, Ray<N>&>(scene, ray, count, place...);
    } else {
        c = trace(scene, eye_ray(scene, at), count, place...);
    }
    if constexpr (Explains<Count>)
        count.comes_back(c);
    return {Sample<N>::clamped(c.x, scene.exposure), Sample<N>::clamped(c.y, scene.exposure),
            Sample<N>::clamped(c.z, scene.exposure)};
}

// Which sample it is at (x, y), counted as camera.hpp has it, of those whose cells are 2^half such steps wide.
template <class N>
QRAY_INLINE constexpr EyeSample eye_sample(const Camera<N>& c, int32_t x, int32_t y, int half)
{
    return {static_cast<uint32_t>((x + c.grid * c.width) >> half),
            static_cast<uint32_t>((y + c.grid * c.height) >> half)};
}

// That sample, at x in the row of y.
template <class N, Effects E, class Count>
QRAY_INLINE constexpr Sample<N> sample_at(const Scene<N, E>& scene, const Pencil<N>& row, int32_t x,
                                          [[maybe_unused]] int32_t y, [[maybe_unused]] int half, Count& count)
{
    const Camera<N>& c = scene.camera;
    if constexpr (Explains<Count>)
        count.sample(c, x, y);
    if constexpr (E.panel)
        return sample(scene, row + c.right * x, count, eye_sample(c, x, y, half));
    else
        return sample(scene, row + c.right * x, count);
}

struct Pixel {
    uint8_t r, g, b;
};

template <class N>
constexpr Pixel pixel_of(const Sample<N>& s)
{
    return {Sample<N>::byte(s.r), Sample<N>::byte(s.g), Sample<N>::byte(s.b)};
}

// The pixel of one sample: of its parts, or of its register at once.
template <InParts N, Effects E, class Count, class... Place>
QRAY_INLINE constexpr Pixel pixel_at(const Scene<N, E>& scene, const Pencil<N>& at, Count& count, Place... place)
{
    return pixel_of(sample(scene, at, count, place...));
}
template <class N, Effects E, class Count, class... Place>
QRAY_INLINE Pixel pixel_along(const Scene<N, E>& scene, Ray<N>& ray, Count& count, Place... place)
{
    uint8_t rgb[3]{};
    clamped_bytes<N>(trace<N, E, Ray<N>&>(scene, ray, count, place...), scene.exposure, rgb);
    return {rgb[0], rgb[1], rgb[2]};
}
template <class N, Effects E, class Count, class... Place>
QRAY_INLINE Pixel pixel_at(const Scene<N, E>& scene, const Pencil<N>& at, Count& count, Place... place)
{
    Ray<N> ray = eye_ray(scene, at); // a copy would wait for what was just written in parts
    return pixel_along(scene, ray, count, place...);
}

} // namespace qray
