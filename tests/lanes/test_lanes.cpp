// Vectors in registers: every function gives the bits that the number system's own give for each component, which their
// tests hold to closed forms; at the ends of ranges, too.
#include <qray/scene/camera.hpp>
#include <qray/light/light.hpp>
#include <qray/picture/sampler.hpp>

#include "../number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

using Length = q32::Length;
using Unit = q32::Unit;
using Colour = q32::Colour;
constexpr int trials = 200000;

// Of any size, small ones as often as large ones; the ends among them.
int32_t any_bits(Random& random, int bits)
{
    const int32_t most = static_cast<int32_t>((uint32_t{1} << bits) - 1);
    const double v = random.uniform(0, 8);
    if (v < 1)
        return v < 0.25 ? most : v < 0.5 ? -most : v < 0.75 ? 0 : -1;
    const double size = std::ldexp(random.uniform(0.5, 1), static_cast<int>(random.uniform(0, bits + 0.99)));
    const int32_t whole = static_cast<int32_t>(std::fmin(size, most));
    return random.uniform(-1, 1) < 0 ? -whole : whole;
}
template <class T>
Vec<T> any_vec(Random& random, int bits)
{
    return {{any_bits(random, bits)}, {any_bits(random, bits)}, {any_bits(random, bits)}};
}
template <class T>
void expect_raw(const Vec<T>& v, int32_t x, int32_t y, int32_t z)
{
    ASSERT_EQ(v.x.raw, x);
    ASSERT_EQ(v.y.raw, y);
    ASSERT_EQ(v.z.raw, z);
}

TEST(Lanes, AddSubtractAndNegate)
{
    Random random(1);
    for (int i = 0; i < trials; i++) {
        const auto a = any_vec<Length>(random, 30), b = any_vec<Length>(random, 30);
        expect_raw(a + b, a.x.raw + b.x.raw, a.y.raw + b.y.raw, a.z.raw + b.z.raw);
        expect_raw(a - b, a.x.raw - b.x.raw, a.y.raw - b.y.raw, a.z.raw - b.z.raw);
        expect_raw(-a, -a.x.raw, -a.y.raw, -a.z.raw);
    }
}

TEST(Lanes, DotIsExactAfterSumsToo)
{
    Random random(2);
    for (int i = 0; i < trials; i++) {
        // What a sum or a rounding leaves in the unused halves does not count.
        const auto a = any_vec<Length>(random, 29) - any_vec<Length>(random, 29);
        const auto b = scaled<q32>(Unit{any_bits(random, 30)}, any_vec<Unit>(random, 30));
        const __int128 exact = static_cast<__int128>(a.x.raw) * b.x.raw + static_cast<__int128>(a.y.raw) * b.y.raw
            + static_cast<__int128>(a.z.raw) * b.z.raw;
        ASSERT_TRUE(dot<q32>(a, b).raw == exact);
        const auto c = any_vec<Length>(random, 29);
        ASSERT_EQ(norm2<q32>(c).raw, q32::norm2(c.x, c.y, c.z).raw);
    }
}

TEST(Lanes, ProductsAreRoundedOnce)
{
    Random random(3);
    for (int i = 0; i < trials; i++) {
        const Length t{any_bits(random, 31)};
        const auto d = any_vec<Unit>(random, 30), m = any_vec<Unit>(random, 30);
        expect_raw(along<q32>(t, d), q32::length(t * d.x).raw, q32::length(t * d.y).raw, q32::length(t * d.z).raw);
        const auto c = any_vec<Colour>(random, 31);
        expect_raw(scaled<q32>(d.x, c), q32::colour(c.x * d.x).raw, q32::colour(c.y * d.x).raw,
                   q32::colour(c.z * d.x).raw);
        expect_raw(filtered<q32>(c, m), q32::colour(c.x * m.x).raw, q32::colour(c.y * m.y).raw,
                   q32::colour(c.z * m.z).raw);
    }
}

TEST(Lanes, BlockScales)
{
    Random random(4);
    for (int i = 0; i < trials; i++) {
        const int32_t fine = static_cast<int32_t>(random.uniform(0, 20.99));
        const auto d = any_vec<Unit>(random, 30);
        const Length middle{any_bits(random, 30)};
        // v is so near to the point that the difference fits.
        const auto near = any_vec<Length>(random, 29 - fine);
        const auto v = along<q32>(middle, d) - near;
        expect_raw(fine_offset<q32>(middle, d, v, fine), q32::fine_sub(middle * d.x, v.x, fine).raw,
                   q32::fine_sub(middle * d.y, v.y, fine).raw, q32::fine_sub(middle * d.z, v.z, fine).raw);
        expect_raw(coarse<q32>(near, fine), q32::coarse(near.x, fine).raw, q32::coarse(near.y, fine).raw,
                   q32::coarse(near.z, fine).raw);
        const FixedScale scale{static_cast<int32_t>(random.uniform(0x40000000, 0x7fffffff)),
                               static_cast<int32_t>(random.uniform(-3, 8))};
        const auto w = any_vec<Length>(random, scale.shift > 0 ? 30 - scale.shift : 30);
        expect_raw(ratio<q32>(w, scale), q32::ratio(w.x, scale).raw, q32::ratio(w.y, scale).raw,
                   q32::ratio(w.z, scale).raw);
    }
}

TEST(Lanes, UnitVectors)
{
    Random random(5);
    for (int i = 0; i < trials; i++) {
        const auto v = any_vec<Length>(random, 31);
        Vec<Unit> u{}, expected{};
        const bool is = normalise<q32>(v, u);
        ASSERT_EQ(is, q32::normalise(v.x, v.y, v.z, expected.x, expected.y, expected.z));
        if (is)
            expect_raw(u, expected.x.raw, expected.y.raw, expected.z.raw);

        const auto wide = [&random] {
            return static_cast<int64_t>(std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(0, 60.99))));
        };
        const Pencil<q32> a{wide(), wide(), wide()}, b{wide() / 65536, wide() / 65536, wide() / 65536};
        const int32_t k = any_bits(random, 14);
        const Pencil<q32> p = a + b * k;
        const int64_t x = a.x + b.x * k, y = a.y + b.y * k, z = a.z + b.z * k;
        ASSERT_TRUE(p.x == x && p.y == y && p.z == z);
        ASSERT_EQ(p.unit(u), q32::normalise(x, y, z, expected.x, expected.y, expected.z));
        if ((x | y | z) != 0)
            expect_raw(u, expected.x.raw, expected.y.raw, expected.z.raw);
    }
}

TEST(Lanes, MakesUnitAgain)
{
    Random random(6);
    for (int i = 0; i < trials; i++) {
        const auto v = any_vec<Length>(random, 31);
        Vec<Unit> u{};
        if (!normalise<q32>(v, u))
            continue;
        u = scaled<q32>(Unit{q32::one.raw - any_bits(random, 14)}, u);
        Unit x = u.x, y = u.y, z = u.z;
        q32::sharpen(x, y, z);
        sharpen<q32>(u);
        expect_raw(u, x.raw, y.raw, z.raw);
    }
}

TEST(Lanes, StepOffSurfaces)
{
    Random random(7);
    for (int i = 0; i < trials; i++) {
        const auto q = any_vec<Length>(random, 30);
        const auto g = any_vec<Unit>(random, 30);
        for (const bool outward : {false, true}) {
            const auto leave = [outward](Unit n) { return q32::leave(outward ? n : -n).raw; };
            expect_raw(step_off<q32>(q, g, outward), q.x.raw + leave(g.x), q.y.raw + leave(g.y), q.z.raw + leave(g.z));
        }
        expect_raw(step_along<q32>(q, g), q.x.raw + q32::leave_along(g.x).raw, q.y.raw + q32::leave_along(g.y).raw,
                   q.z.raw + q32::leave_along(g.z).raw);
    }
}

TEST(Lanes, Saturate)
{
    Random random(8);
    for (int i = 0; i < trials; i++) {
        const auto a = any_vec<Length>(random, 31), b = any_vec<Length>(random, 31);
        expect_raw(saturating_sub<q32>(a, b), q32::saturating_sub(a.x, b.x).raw, q32::saturating_sub(a.y, b.y).raw,
                   q32::saturating_sub(a.z, b.z).raw);
        const auto positive = [&random] { return Colour{any_bits(random, 31) & INT32_MAX}; };
        const Vec<Colour> c{positive(), positive(), positive()};
        Vec<Colour> sum{positive(), positive(), positive()}, expected = sum;
        saturating_add<q32>(sum, c);
        expect_raw(sum, q32::saturating_add(expected.x, c.x).raw, q32::saturating_add(expected.y, c.y).raw,
                   q32::saturating_add(expected.z, c.z).raw);
    }
}

TEST(Lanes, AskCubes)
{
    Random random(9);
    for (int i = 0; i < trials; i++) {
        const auto v = any_vec<Length>(random, 31);
        const Length r{any_bits(random, 31) & INT32_MAX};
        const auto out = [r](Length x) { return x > r || x < -r; };
        ASSERT_EQ(outside_cube<q32>(v, r), out(v.x) || out(v.y) || out(v.z));
    }
    const Length r{1000};
    for (int k = 0; k < 3; k++)
        for (const int32_t far : {1000, 1001, -1000, -1001}) {
            int32_t c[3] = {};
            c[k] = far;
            EXPECT_EQ(outside_cube<q32>(Vec<Length>{{c[0]}, {c[1]}, {c[2]}}, r), far > 1000 || far < -1000);
        }
}

TEST(Lanes, LightBecomesBytes)
{
    Random random(10);
    for (int i = 0; i < trials; i++) {
        const int exposure = static_cast<int>(random.uniform(0, 8.99));
        const auto positive = [&random] { return Colour{any_bits(random, 31) & INT32_MAX}; };
        const Vec<Colour> c{positive(), positive(), positive()};
        uint8_t rgb[3]{};
        clamped_bytes<q32>(c, exposure, rgb);
        const Colour parts[] = {c.x, c.y, c.z};
        for (int k = 0; k < 3; k++)
            ASSERT_EQ(rgb[k], Sample<q32>::byte(Sample<q32>::clamped(parts[k], exposure)));

        const float f[] = {static_cast<float>(random.uniform(0, 1.5)), static_cast<float>(random.uniform(0, 1)),
                           static_cast<float>(static_cast<int>(random.uniform(0, 255)) + 0.5) / 255};
        clamped_bytes<Float>(Vec<float>{f[0], f[1], f[2]}, 0, rgb);
        for (int k = 0; k < 3; k++)
            ASSERT_EQ(rgb[k], Sample<Float>::byte(Sample<Float>::clamped(f[k], 0)));
    }
}

TEST(Lanes, FloatsAreThoseOfTheirComponents)
{
    Random random(11);
    const auto any = [&random] {
        return static_cast<float>(std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-20, 7))));
    };
    for (int i = 0; i < trials; i++) {
        const float a[] = {any(), any(), any()}, b[] = {any(), any(), any()}, t = any();
        const Vec<float> u{a[0], a[1], a[2]}, v{b[0], b[1], b[2]};
        ASSERT_EQ(dot<Float>(u, v), Float::dot(a[0], a[1], a[2], b[0], b[1], b[2]));
        ASSERT_EQ(norm2<Float>(u), Float::norm2(a[0], a[1], a[2]));
        ASSERT_TRUE(along<Float>(t, u) == (Vec<float>{t * a[0], t * a[1], t * a[2]}));
        Vec<float> n{};
        float x = 0, y = 0, z = 0;
        ASSERT_EQ(normalise<Float>(u, n), Float::normalise(a[0], a[1], a[2], x, y, z));
        ASSERT_TRUE(n == (Vec<float>{x, y, z}));
        n = scaled<Float>(1 + t * 0x1p-20f, n);
        x = n.x;
        y = n.y;
        z = n.z;
        const Vec<float> g = n;
        sharpen<Float>(n);
        Float::sharpen(x, y, z);
        ASSERT_TRUE(n == (Vec<float>{x, y, z}));
        const float step = Float::leave(a[0], a[1], a[2]);
        ASSERT_TRUE(step_off<Float>(u, g, true)
                    == (Vec<float>{a[0] + g.x * step, a[1] + g.y * step, a[2] + g.z * step}));
        ASSERT_TRUE(step_off<Float>(u, g, false)
                    == (Vec<float>{a[0] - g.x * step, a[1] - g.y * step, a[2] - g.z * step}));
    }
}

TEST(Lanes, UnitVectorOfNothingIsNone)
{
    Vec<Unit> u{{1}, {2}, {3}};
    EXPECT_FALSE(normalise<q32>(Vec<Length>{}, u));
    expect_raw(u, 1, 2, 3);
    Vec<float> f{1, 2, 3};
    EXPECT_FALSE(normalise<Float>(Vec<float>{}, f));
    EXPECT_TRUE(f == (Vec<float>{1, 2, 3}));
}

// As if each light's had been added in its turn: more than a register has, some without any, shines of all kinds.
TEST(Lanes, HighlightsTogether)
{
    Random random(97);
    for (const Float::Shine shine :
         {Float::Shine{0, 0}, {1, 0}, {30, 0}, {0, 0.3f}, {4, 0.81884f}, {1000000, 0x1p-24f}}) {
        for (int i = 0; i < 2000; i++) {
            const Highlight<Float> h{i % 7 == 0 ? 0 : static_cast<float>(random.uniform(0, 1)), shine};
            LateHighlights<Float> late;
            Rgb<Float> expected{0, 0, 0}, sum = expected, colours[11];
            for (Rgb<Float>& colour : colours) {
                const double size = random.uniform(0, 5);
                const float x = size < 1 ? 0 : size < 2 ? 1 : static_cast<float>(std::exp2(-std::pow(size - 2, 5)));
                const float share = static_cast<float>(random.uniform(0, 1));
                colour = {static_cast<float>(random.uniform(0, 1)), 0, 1};
                const float part = h.amount * Float::power(x, shine) * share;
                expected = {expected.x + part * colour.x, 0, expected.z + part};
                late.add(h, x, share, colour, sum);
            }
            late.finish(h, sum);
            EXPECT_EQ(sum, expected) << shine.whole << ' ' << shine.fraction;
        }
    }
}

} // namespace
