#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct RenderTest : ::testing::Test {};
TYPED_TEST_SUITE(RenderTest, NumberSystems, SystemNames);

constexpr Effects balls(bool grid)
{
    Effects e;
    e.sphere = e.light = true;
    e.grid = grid;
    return e;
}

const std::string scene_text =
    "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 13 7\n b 0.1 0.5 0.9\n l 3 4 5 1 1 1\n"
    "material colour 0.9 0.5 0.2\n s 0.3 0.1 0 1\n shadows off\n";

TYPED_TEST(RenderTest, APictureOfNothingIsItsBackground)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 3 2\n b 0 1 0.5"));
    const Picture p = draw<N, Effects{}>();
    EXPECT_EQ(p.rgb,
              (std::vector<uint8_t>{0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128, 0, 255, 128}));
}

TYPED_TEST(RenderTest, RowsAreTheSameHoweverManyAtATime)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Picture whole = draw<N, balls(false)>(7);
    for (uint32_t rows : {1u, 2u, 3u, 4u, 6u, 8u, 100u})
        EXPECT_TRUE((draw<N, balls(false)>(rows) == whole)) << rows;
}

TYPED_TEST(RenderTest, BlocksComeFromTheTopAndFitTheirBuffer)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Scene<N, balls(false)> s = storage<N>().template view<balls(false)>();
    std::vector<uint8_t> buffer(3 * 13 * 3 + 1, 0xcd);
    std::vector<uint32_t> seen;
    RayCount counted;
    EXPECT_TRUE(render<Rgb888>(
        s, buffer.data(), 3,
        [&](uint32_t first, uint32_t rows, const uint8_t* bytes, uint32_t size) {
            EXPECT_EQ(bytes, buffer.data());
            EXPECT_EQ(size, rows * 13 * 3);
            seen.push_back(first);
            seen.push_back(rows);
            return true;
        },
        counted));
    EXPECT_EQ(seen, (std::vector<uint32_t>{0, 3, 3, 3, 6, 1}));
    EXPECT_EQ(buffer.back(), 0xcd);
    EXPECT_EQ(counted[RayKind::camera], 13u * 7);
}

TYPED_TEST(RenderTest, StopsWhereTheSinkSaysSo)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Scene<N, balls(false)> s = storage<N>().template view<balls(false)>();
    std::vector<uint8_t> buffer(13 * 3);
    uint32_t rows_seen = 0;
    RayCount counted;
    EXPECT_FALSE(render<Rgb888>(
        s, buffer.data(), 1, [&](uint32_t, uint32_t, const uint8_t*, uint32_t) { return ++rows_seen < 3; }, counted));
    EXPECT_EQ(rows_seen, 3u);
    EXPECT_EQ(counted[RayKind::camera], 3u * 13);
}

TYPED_TEST(RenderTest, PixelsAreThoseOfTheirRows)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Scene<N, balls(false)> s = storage<N>().template view<balls(false)>();
    const Picture p = draw<N, balls(false)>();
    RayCount counted;
    for (uint32_t j = 0; j < 7; j++)
        for (uint32_t i = 0; i < 13; i++) {
            const Pixel a = render_pixel(s, i, j, counted), b = p.at(i, j);
            ASSERT_TRUE(a.r == b.r && a.g == b.g && a.b == b.b);
        }
    // In another format the pixels are the same.
    std::vector<uint8_t> row(13 * 2);
    render_row<Rgb565Big>(s, 3, row.data(), counted);
    for (uint32_t i = 0; i < 13; i++) {
        const Pixel b = p.at(i, 3);
        ASSERT_EQ(row[2 * i] << 8 | row[2 * i + 1], (b.r & 0xf8) << 8 | (b.g & 0xfc) << 3 | b.b >> 3);
    }
}

TYPED_TEST(RenderTest, OneSampleOnAGridIsThePlainPicture)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    EXPECT_TRUE((draw<N, balls(true)>() == draw<N, balls(false)>()));
}

} // namespace
