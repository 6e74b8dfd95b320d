// Registers that hold several numbers, and what is done to all of them at once. Everywhere, binary32 numbers for bounds
// that are tested together: nothing that reaches a picture is computed in them. Where a processor has AVX2 and FMA also
// whole vectors of float and q32 (vec_lanes.hpp), whose bytes are the same as without.
#pragma once

#include "base.hpp"

// 1 or 0, the same in a whole program; -D decides, or else the processor that is compiled for.
#ifndef QRAY_LANES
#if defined(__AVX2__) && defined(__FMA__) && __has_builtin(__builtin_shufflevector)
#define QRAY_LANES 1
#else
#define QRAY_LANES 0
#endif
#endif

// Of a step of a shape's test: by itself, so that it takes stack for a while only; in lanes the compiler decides.
#if QRAY_LANES
#define QRAY_STAGE
#else
#define QRAY_STAGE QRAY_NOINLINE
#endif

namespace qray {

// Bounds: as many as fit one register.
inline constexpr uint32_t bound_lanes = QRAY_LANES ? 8 : 4;
typedef float Bounds __attribute__((vector_size(4 * bound_lanes)));
typedef int32_t BoundMask __attribute__((vector_size(4 * bound_lanes)));

QRAY_INLINE Bounds all_bounds(float x)
{
#if QRAY_LANES
    return Bounds{x, x, x, x, x, x, x, x};
#else
    return Bounds{x, x, x, x};
#endif
}

// Bit i tells whether the sign of element i of m is set.
QRAY_INLINE uint32_t mask_bits(BoundMask m)
{
#if QRAY_LANES
    return static_cast<uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Bounds>(m)));
#elif defined(__SSE2__)
    return static_cast<uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Bounds>(m)));
#else
    return (static_cast<uint32_t>(m[0]) >> 31) | (static_cast<uint32_t>(m[1]) >> 31 << 1)
        | (static_cast<uint32_t>(m[2]) >> 31 << 2) | (static_cast<uint32_t>(m[3]) >> 31 << 3);
#endif
}

// The lower and the higher of each.
QRAY_INLINE Bounds lower(const Bounds& a, const Bounds& b)
{
#if QRAY_LANES
    return __builtin_ia32_minps256(a, b);
#else
    return a < b ? a : b;
#endif
}
QRAY_INLINE Bounds higher(const Bounds& a, const Bounds& b)
{
#if QRAY_LANES
    return __builtin_ia32_maxps256(a, b);
#else
    return a > b ? a : b;
#endif
}

// Element i of the result is that behind v's element i, in each four of them round and round.
QRAY_INLINE Bounds next_in_four(const Bounds& v)
{
#if QRAY_LANES
    return __builtin_shufflevector(v, v, 1, 2, 3, 0, 5, 6, 7, 4);
#else
    return Bounds{v[1], v[2], v[3], v[0]};
#endif
}

// a b + c, rounded once or twice.
QRAY_INLINE Bounds mul_add(const Bounds& a, const Bounds& b, const Bounds& c)
{
#if QRAY_LANES
    return __builtin_ia32_vfmaddps256(a, b, c);
#else
    return a * b + c;
#endif
}

#if QRAY_LANES

// x, y, z and a number that does not count.
typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Signed4 __attribute__((vector_size(16)));
typedef uint32_t Unsigned4 __attribute__((vector_size(16)));

QRAY_INLINE Float4 lane_floor(Float4 v) { return __builtin_ia32_roundps(v, 9); }
QRAY_INLINE Float4 lane_absolute(Float4 v)
{
    return reinterpret_cast<Float4>(reinterpret_cast<Signed4>(v) & INT32_MAX);
}
QRAY_INLINE bool all_of_three(Signed4 m)
{
    return (__builtin_ia32_movmskps(reinterpret_cast<Float4>(m)) & 7) == 7;
}

// Element i of the result is v's element i + By, modulo 4.
template <int By>
QRAY_INLINE Float4 lane_turned(Float4 v)
{
    return __builtin_shufflevector(v, v, By, (By + 1) & 3, (By + 2) & 3, (By + 3) & 3);
}

// a > b ? a : b and a < b ? a : b.
QRAY_INLINE Float4 lane_max(Float4 a, Float4 b) { return __builtin_ia32_maxps(a, b); }
QRAY_INLINE Float4 lane_min(Float4 a, Float4 b) { return __builtin_ia32_minps(a, b); }

// ax bx + ay by + az bz, summed in this order.
QRAY_INLINE float lane_dot(Float4 a, Float4 b)
{
    return __builtin_ia32_dpps(a, b, 0x71)[0];
}

// x, y, z and a number that does not count, each in the lower half of 64 bits; the upper half does not count either,
// as products are of lower halves alone.
typedef uint64_t Word4 __attribute__((vector_size(32)));
typedef int32_t Half8 __attribute__((vector_size(32)));
typedef uint32_t UnsignedHalf8 __attribute__((vector_size(32)));

QRAY_INLINE Word4 words(Half8 v) { return reinterpret_cast<Word4>(v); }
QRAY_INLINE Half8 halves(Word4 v) { return reinterpret_cast<Half8>(v); }
QRAY_INLINE UnsignedHalf8 unsigned_halves(Word4 v) { return reinterpret_cast<UnsignedHalf8>(v); }
QRAY_INLINE Half8 all_halves(int32_t k) { return Half8{k, k, k, k, k, k, k, k}; }
QRAY_INLINE Word4 all_words(uint64_t k) { return Word4{k, k, k, k}; }

// Of the lower halves; what does not fit wraps, as what the upper halves hold may, which is why no signed sum is made.
QRAY_INLINE Word4 lane_add(Word4 a, Word4 b)
{
    return reinterpret_cast<Word4>(unsigned_halves(a) + unsigned_halves(b));
}
QRAY_INLINE Word4 lane_add(Word4 v, int32_t k) { return lane_add(v, words(all_halves(k))); }
QRAY_INLINE Word4 lane_sub(Word4 a, Word4 b)
{
    return reinterpret_cast<Word4>(unsigned_halves(a) - unsigned_halves(b));
}

// The exact products, 64 bits each.
QRAY_INLINE Word4 lane_mul(Word4 a, Word4 b)
{
    return reinterpret_cast<Word4>(__builtin_ia32_pmuldq256(halves(a), halves(b)));
}
QRAY_INLINE Word4 lane_mul(int32_t k, Word4 v) { return lane_mul(words(all_halves(k)), v); }

// The upper half of each, as a number.
QRAY_INLINE Word4 upper_halves(Word4 v)
{
    const Half8 h = halves(v);
    return words(__builtin_shufflevector(h, h, 1, 1, 3, 3, 5, 5, 7, 7));
}

// Products / 2^shift to the nearest, halves up, as numbers of 32 bits. shift is in [1, 32]: no sign is shifted in.
QRAY_INLINE Word4 lane_rounded(Word4 p, int shift) { return (p + (uint64_t{1} << (shift - 1))) >> shift; }

// The sum of the first three.
QRAY_INLINE int64_t lane_sum(Word4 p)
{
    typedef uint64_t Word2 __attribute__((vector_size(16)));
    const Word2 low = __builtin_shufflevector(p, p, 0, 1), high = __builtin_shufflevector(p, p, 2, 3);
    return static_cast<int64_t>((low + __builtin_shufflevector(low, low, 1, 1) + high)[0]);
}

// Magnitudes of signed numbers, those of negative ones less one.
QRAY_INLINE Word4 lane_magnitude(Word4 v)
{
    typedef int64_t SignedWord4 __attribute__((vector_size(32)));
    return v ^ reinterpret_cast<Word4>(reinterpret_cast<SignedWord4>(v) < 0);
}

// All bits of the first three.
QRAY_INLINE uint64_t lane_any(Word4 v)
{
    typedef uint64_t Word2 __attribute__((vector_size(16)));
    const Word2 low = __builtin_shufflevector(v, v, 0, 1), high = __builtin_shufflevector(v, v, 2, 3);
    return (low | __builtin_shufflevector(low, low, 1, 1) | high)[0];
}

// Is any of the first three halves set?
QRAY_INLINE bool any_of_three(Half8 m)
{
    return (__builtin_ia32_movmskps256(reinterpret_cast<Bounds>(m)) & 0x15) != 0;
}

#endif

} // namespace qray
