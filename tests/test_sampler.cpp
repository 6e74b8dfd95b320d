#include <qray/picture/sampler.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct SamplerTest : ::testing::Test {};
TYPED_TEST_SUITE(SamplerTest, NumberSystems, SystemNames);

template <class N>
double level(typename Sample<N>::Level v)
{
    return static_cast<double>(v) / static_cast<double>(Sample<N>::one);
}

TYPED_TEST(SamplerTest, ColoursAreClampedToOne)
{
    using N = TypeParam;
    using M = make<N>;
    for (int exposure : {0, 1, 3, 7}) {
        const double k = N::is_fixed ? std::ldexp(1, -exposure) : 1;
        for (double c : {0.0, 0.25, 0.75, 1.0, 1.25, 7.5, 1e-3}) {
            const auto colour = M::colour(c * k);
            const double expected = std::fmin(1, value(colour) / k);
            EXPECT_EQ(level<N>(Sample<N>::clamped(colour, exposure)), expected) << c << " " << exposure;
        }
    }
    if constexpr (N::is_fixed) {
        EXPECT_EQ(level<N>(Sample<N>::clamped(typename N::Colour{INT32_MAX}, 5)), 1);
    }
}

TYPED_TEST(SamplerTest, BytesAreTheNearest)
{
    using N = TypeParam;
    for (int i = 0; i <= 255; i++) {
        // The middle of each byte's range, and near either end.
        for (double off : {-0.499, 0.0, 0.499}) {
            const double v = std::fmin(1, std::fmax(0, (i + off) / 255));
            const auto l = static_cast<typename Sample<N>::Level>(v * static_cast<double>(Sample<N>::one));
            EXPECT_EQ(Sample<N>::byte(l), i) << off;
        }
    }
    EXPECT_EQ(Sample<N>::byte(0), 0);
    EXPECT_EQ(Sample<N>::byte(Sample<N>::one), 255);
    EXPECT_EQ(Sample<N>::byte(Sample<N>::one / 2), 128); // 127.5: halves up
}

TYPED_TEST(SamplerTest, RoundDecimalsThatEndOnAHalfGoUp)
{
    using N = TypeParam;
    // 255 v = 25.5, 76.5, 178.5 and 229.5: v as a Colour is at most half a step below.
    const struct {
        double v;
        int byte;
    } halves[] = {{0.1, 26}, {0.3, 77}, {0.7, 179}, {0.9, 230}, {0.5, 128}};
    if constexpr (NarrowFixed<N>)
        EXPECT_EQ(Sample<N>::byte(Sample<N>::clamped(make<N>::colour(0.5), 0)), 128); // of the five it holds this one
    else if constexpr (N::is_fixed)
        for (const auto& h : halves)
            EXPECT_EQ(Sample<N>::byte(Sample<N>::clamped(make<N>::colour(h.v), 0)), h.byte) << h.v;
    else
        EXPECT_EQ(Sample<N>::byte(Sample<N>::clamped(0.5, 0)), 128);
}

TYPED_TEST(SamplerTest, PixelHasTheThreeBytes)
{
    using N = TypeParam;
    const Pixel p = pixel_of(Sample<N>{0, Sample<N>::one, Sample<N>::one / 2});
    EXPECT_EQ(p.r, 0);
    EXPECT_EQ(p.g, 255);
    EXPECT_EQ(p.b, 128);
}

} // namespace
