// Vectors of float and of q32 in one register each, where a processor has such (lanes.hpp): the functions of
// vec_parts.hpp for these number systems, and what else is done to all components at once. Ranges, units and results
// are those of the functions by parts, of q32 and of Float, bit for bit; tests/lanes compares them.
#pragma once

#include "vec_parts.hpp"

#if QRAY_LANES

namespace qray {

// A vector's components and its register are one place; GCC and Clang define what reading one after writing the other
// gives. What the fourth element holds does not count.
template <>
struct Vec<float> {
    union {
        struct {
            float x, y, z;
        };
        Float4 lanes;
    };
    Vec() = default;
    constexpr Vec(float a, float b, float c) : lanes{a, b, c, 0} {}
    explicit QRAY_INLINE constexpr Vec(Float4 v) : lanes(v) {}

    QRAY_INLINE friend constexpr Vec operator+(Vec a, Vec b) { return Vec(a.lanes + b.lanes); }
    QRAY_INLINE friend constexpr Vec operator-(Vec a, Vec b) { return Vec(a.lanes - b.lanes); }
    QRAY_INLINE constexpr Vec operator-() const { return Vec(-lanes); }
    friend constexpr bool operator==(const Vec& a, const Vec& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

template <int Frac>
struct Vec<Fixed<Frac, 32>> {
    using Number = Fixed<Frac, 32>;
    union {
        struct {
            Number x;
            int32_t above_x;
            Number y;
            int32_t above_y;
            Number z;
        };
        Word4 lanes;
    };
    Vec() = default;
    constexpr Vec(Number a, Number b, Number c) : lanes{word(a), word(b), word(c), 0} {}
    explicit QRAY_INLINE constexpr Vec(Word4 v) : lanes(v) {}

    QRAY_INLINE friend constexpr Vec operator+(Vec a, Vec b) { return Vec(lane_add(a.lanes, b.lanes)); }
    QRAY_INLINE friend constexpr Vec operator-(Vec a, Vec b) { return Vec(lane_sub(a.lanes, b.lanes)); }
    QRAY_INLINE constexpr Vec operator-() const { return Vec(lane_sub(Word4{}, lanes)); }
    friend constexpr bool operator==(const Vec& a, const Vec& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

private:
    static constexpr uint64_t word(Number v) { return static_cast<uint32_t>(v.raw); }
};

// Products of a number, or of numbers, and what has a Unit's bits behind the point: rounded once.
template <FloatLanes N>
QRAY_INLINE Float4 product(Float4 a, Float4 b)
{
    return a * b;
}
template <FixedLanes N>
QRAY_INLINE Word4 product(Word4 a, Word4 b)
{
    return lane_rounded(lane_mul(a, b), N::Unit::frac);
}
QRAY_INLINE Float4 all_lanes(float k) { return Float4{k, k, k, k}; }
template <int Frac>
QRAY_INLINE Word4 all_lanes(Fixed<Frac, 32> k) { return words(all_halves(k.raw)); }

template <FloatLanes N, class A, class B>
QRAY_INLINE float dot(const Vec<A>& a, const Vec<B>& b)
{
    return lane_dot(a.lanes, b.lanes);
}
template <FixedLanes N, class A, class B>
QRAY_INLINE auto dot(const Vec<A>& a, const Vec<B>& b)
{
    return Wide<A::frac + B::frac, 32>{lane_sum(lane_mul(a.lanes, b.lanes))};
}

template <AnyLanes N>
QRAY_INLINE auto norm2(const Vec<typename N::Length>& a)
{
    return dot<N>(a, a);
}

template <AnyLanes N>
QRAY_INLINE auto along(typename N::Length t, const Vec<typename N::Unit>& d)
{
    return Vec<typename N::Length>(product<N>(all_lanes(t), d.lanes));
}
template <AnyLanes N, class T>
QRAY_INLINE Vec<T> scaled(typename N::Unit k, const Vec<T>& v)
{
    return Vec<T>(product<N>(all_lanes(k), v.lanes));
}
template <AnyLanes N>
QRAY_INLINE auto filtered(const Vec<typename N::Colour>& light, const Vec<typename N::Unit>& m)
{
    return Vec<typename N::Colour>(product<N>(light.lanes, m.lanes));
}

template <FloatLanes N>
QRAY_INLINE Vec<float> step_off(const Vec<typename N::Length>& q, const Vec<typename N::Unit>& g, bool outward)
{
    const Float4 size = lane_absolute(q.lanes);
    const Float4 largest = lane_max(lane_max(size, lane_turned<1>(size)), lane_turned<2>(size));
    const float step = largest[0] * (N::leave_relative * N::epsilon) + N::leave_least * N::epsilon;
    return Vec<float>(q.lanes + (outward ? step : -step) * g.lanes);
}
template <FixedLanes N>
QRAY_INLINE auto step_off(const Vec<typename N::Length>& q, const Vec<typename N::Unit>& g, bool outward)
{
    const Word4 o = lane_add((outward ? g : -g).lanes, 1 << (N::Unit::frac - 2));
    return q + Vec<typename N::Length>(words(halves(o) >> (N::Unit::frac - 1)));
}

template <FloatLanes N, class T>
QRAY_INLINE bool normalise(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    const float l2 = norm2<N>(v);
    if (!(l2 > 0))
        return false;
    u = Vec<float>(v.lanes * (1 / sqrt_float(l2)));
    return true;
}
template <FixedLanes N, class T>
    requires(sizeof(T) == 4)
QRAY_INLINE bool normalise(const Vec<T>& v, Vec<typename N::Unit>& u)
{
    const uint64_t square = static_cast<uint64_t>(lane_sum(lane_mul(v.lanes, v.lanes)));
    if (square == 0)
        return false;
    const int zeros = count_leading_zeros(square) / 2;
    // As unit_vector(); as a signed number the mantissa is too small by 2^32.
    const int32_t m = static_cast<int32_t>(detail::rsqrt_mantissa(square << (2 * zeros)));
    const Word4 p = lane_mul(m, v.lanes) + (v.lanes << 32);
    u = Vec<typename N::Unit>(zeros != 0 ? upper_halves((p << (zeros - 1)) + (uint64_t{1} << 31))
                                         : words(halves(upper_halves(p + (uint64_t{1} << 32))) >> 1));
    return true;
}

template <FloatLanes N>
QRAY_INLINE void sharpen(Vec<typename N::Unit>& n)
{
    const float h = (norm2<N>(n) - 1) / 2;
    n = n - scaled<N>(h, n);
}
template <FixedLanes N>
QRAY_INLINE void sharpen(Vec<typename N::Unit>& n)
{
    const typename N::Cosine excess = dot<N>(n, n) - N::one * N::one;
    n = n - scaled<N>({static_cast<int32_t>(excess.raw >> (N::Unit::frac + 1))}, n);
}

template <FloatLanes N>
QRAY_INLINE Vec<float> saturating_sub(const Vec<typename N::Length>& a, const Vec<typename N::Length>& b)
{
    return a - b;
}
template <FixedLanes N>
QRAY_INLINE auto saturating_sub(const Vec<typename N::Length>& a, const Vec<typename N::Length>& b)
{
    const Half8 x = halves(a.lanes), y = halves(b.lanes), d = halves(lane_sub(a.lanes, b.lanes));
    const Half8 over = ((x ^ y) & (x ^ d)) >> 31;
    // One less than the least, where a is below 0.
    const Half8 limit = ((x >> 31) ^ INT32_MAX) | 1;
    return Vec<typename N::Length>(words((d & ~over) | (limit & over)));
}

template <AnyLanes N>
QRAY_INLINE void add_scaled(Vec<typename N::Colour>& sum, typename N::Unit k, const Vec<typename N::Colour>& light)
{
    sum = sum + scaled<N>(k, light);
}
template <FloatLanes N>
QRAY_INLINE void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light)
{
    sum = sum + light;
}
template <FixedLanes N>
QRAY_INLINE void saturating_add(Vec<typename N::Colour>& sum, const Vec<typename N::Colour>& light)
{
    const UnsignedHalf8 added = unsigned_halves(lane_add(sum.lanes, light.lanes));
    const UnsignedHalf8 most = unsigned_halves(all_words(INT32_MAX));
    sum = Vec<typename N::Colour>(reinterpret_cast<Word4>(added < most ? added : most));
}

template <FloatLanes N>
QRAY_INLINE Vec<float> ratio(const Vec<float>& v, float inverse_r)
{
    return Vec<float>(v.lanes * inverse_r);
}
template <FixedLanes N>
QRAY_INLINE auto ratio(const Vec<typename N::Length>& v, typename N::Scale inverse_r)
{
    const int up = inverse_r.shift;
    const Word4 w = up >= 0 ? v.lanes << up : words(halves(v.lanes) >> -up);
    return Vec<typename N::Unit>(lane_rounded(lane_mul(inverse_r.mantissa, w), 61 - N::Unit::frac));
}

template <FixedLanes N>
QRAY_INLINE auto step_along(const Vec<typename N::Length>& q, const Vec<typename N::Unit>& d)
{
    const Word4 v = lane_add(d.lanes, 1 << (N::Unit::frac - 6));
    return q + Vec<typename N::Length>(words(halves(v) >> (N::Unit::frac - 5)));
}

template <FloatLanes N>
QRAY_INLINE Vec<float> fine_offset(typename N::Length middle, const Vec<typename N::Unit>& d,
                                   const Vec<typename N::Length>& v, int32_t)
{
    return along<N>(middle, d) - v;
}
template <FixedLanes N>
QRAY_INLINE auto fine_offset(typename N::Length middle, const Vec<typename N::Unit>& d,
                             const Vec<typename N::Length>& v, int32_t fine)
{
    // What v's upper halves leave in the two highest bits is not among those that are kept.
    const Word4 w = lane_mul(middle.raw, d.lanes) - (v.lanes << N::Unit::frac);
    return Vec<typename N::Length>(lane_rounded(w, N::Unit::frac - fine));
}

template <FloatLanes N>
QRAY_INLINE Vec<float> coarse(const Vec<typename N::Length>& p, int32_t)
{
    return p;
}
template <FixedLanes N>
QRAY_INLINE auto coarse(const Vec<typename N::Length>& p, int32_t fine)
{
    return Vec<typename N::Length>(words(halves(lane_add(p.lanes, 1 << fine >> 1)) >> fine));
}

// Is any component beyond +-r?
template <FixedLanes N>
QRAY_INLINE bool outside_cube(const Vec<typename N::Length>& v, typename N::Length r)
{
    const Half8 w = halves(v.lanes), edge = all_halves(r.raw);
    return any_of_three((w > edge) | (w < -edge));
}

// Three 16-bit integers, of a type aligned to 8 bytes.
template <FixedLanes N, class Short3>
QRAY_INLINE auto lengths_of(const Short3& v)
{
    typedef int16_t Short4 __attribute__((vector_size(8)));
    typedef int64_t SignedWord4 __attribute__((vector_size(32)));
    return Vec<typename N::Length>(
        reinterpret_cast<Word4>(__builtin_convertvector(__builtin_bit_cast(Short4, v), SignedWord4)));
}

// Light as bytes, as Sample has it.
template <FloatLanes N>
QRAY_INLINE void clamped_bytes(const Vec<float>& light, int, uint8_t (&rgb)[3])
{
    constexpr float half = 0.5f + 32 * N::epsilon;
    const Float4 one = {1, 1, 1, 1}, v = lane_min(lane_max(light.lanes, Float4{}), one);
    const Signed4 bytes = __builtin_convertvector(v * 255 + half, Signed4);
    for (int i = 0; i < 3; i++)
        rgb[i] = static_cast<uint8_t>(bytes[i]);
}
template <FixedLanes N>
QRAY_INLINE void clamped_bytes(const Vec<typename N::Colour>& light, int exposure, uint8_t (&rgb)[3])
{
    constexpr int frac = N::Colour::frac;
    const Half8 limit = all_halves((1 << frac) >> exposure), v = halves(light.lanes);
    const Half8 level = (v < limit ? v : limit) << exposure;
    const Word4 bytes = lane_rounded(lane_mul(255, lane_add(words(level), 4)), frac);
    for (int i = 0; i < 3; i++)
        rgb[i] = static_cast<uint8_t>(bytes[i]);
}

// Here all three floors at once.
template <FloatLanes N, class Step>
QRAY_INLINE bool sum_of_cells(const Step& x, const Step& y, const Step& z, const Vec<float>& q, uint32_t& sum)
{
    const Float4 p = q.lanes * Float4{x.row, y.row, z.row} + Float4{x.inside, y.inside, z.inside};
    const Float4 limit = {0x1p31f, 0x1p31f, 0x1p31f, 0x1p31f};
    if (!all_of_three(lane_absolute(p) < limit))
        return false;
    const Signed4 whole = __builtin_convertvector(lane_floor(p), Signed4);
    sum = static_cast<uint32_t>(whole[0] ^ whole[1] ^ whole[2]) ^ x.index ^ y.index ^ z.index;
    return true;
}

template <FloatLanes N>
struct Pencil<N> : Vec<float> {
    using Vec<float>::Vec;
    bool unit(Vec<float>& d) const { return normalise<N>(*this, d); }
    friend Pencil operator+(const Pencil& a, const Pencil& b) { return Pencil(a.lanes + b.lanes); }
    friend Pencil operator*(const Pencil& a, int32_t k) { return Pencil(a.lanes * static_cast<float>(k)); }
};
template <FixedLanes N>
struct Pencil<N> {
    union {
        struct {
            int64_t x, y, z;
        };
        Word4 lanes;
    };
    Pencil() = default;
    constexpr Pencil(int64_t a, int64_t b, int64_t c)
        : lanes{static_cast<uint64_t>(a), static_cast<uint64_t>(b), static_cast<uint64_t>(c), 0}
    {
    }
    explicit QRAY_INLINE constexpr Pencil(Word4 v) : lanes(v) {}
    QRAY_INLINE friend Pencil operator+(const Pencil& a, const Pencil& b) { return Pencil(a.lanes + b.lanes); }
    QRAY_INLINE friend Pencil operator*(const Pencil& a, int32_t k)
    {
        return Pencil(a.lanes * static_cast<uint64_t>(int64_t{k}));
    }
    // As q32::normalise.
    QRAY_INLINE bool unit(Vec<typename N::Unit>& d) const
    {
        const int zeros = count_leading_zeros(lane_any(lane_magnitude(lanes)));
        const int up = zeros < 32 ? zeros - 1 : 31;
        return normalise<N>(Vec<typename N::Unit>(upper_halves(lanes << up)), d);
    }
};

} // namespace qray

#endif
