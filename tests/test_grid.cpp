#include <qray/picture/grid.hpp>

#include "number_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct GridTest : ::testing::Test {};
TYPED_TEST_SUITE(GridTest, NumberSystems, SystemNames);

TYPED_TEST(GridTest, MeanOfEqualSamplesIsTheSample)
{
    using N = TypeParam;
    using Level = typename Sample<N>::Level;
    for (uint32_t n : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 16u, 33u, 64u})
        for (double v : {0.0, 0.25, 0.625, 1.0}) {
            const auto l = static_cast<Level>(v * static_cast<double>(Sample<N>::one));
            SampleSum<N> sum;
            for (uint32_t i = 0; i < n * n; i++)
                sum.add({l, 0, l});
            const Sample<N> mean = sum.mean(n * n);
            EXPECT_EQ(mean.r, l) << n;
            EXPECT_EQ(mean.g, Level(0)) << n;
            EXPECT_EQ(mean.b, l) << n;
        }
}

TYPED_TEST(GridTest, MeanIsTheNearest)
{
    using N = TypeParam;
    using Level = typename Sample<N>::Level;
    Random random(100);
    for (uint32_t n : {1u, 4u, 9u, 25u, 49u, 256u, 4096u}) {
        SampleSum<N> sum;
        Real exact = 0;
        for (uint32_t i = 0; i < n; i++) {
            const auto l = static_cast<Level>(random.uniform(0, 1) * static_cast<double>(Sample<N>::one));
            sum.add({l, l, 0});
            exact += static_cast<Real>(l);
        }
        exact /= n;
        const double off = static_cast<double>(std::fabs(static_cast<Real>(sum.mean(n).r) - exact));
        // In floating point every addition rounds, to half a step of the sum so far.
        EXPECT_LE(off, N::is_fixed ? 0.5 : (n + 2) / 2. * make<N>::unit_ulp()) << n;
    }
}

} // namespace
