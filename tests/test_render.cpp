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
    for (uint32_t i = 0; i < 13; i++)
        ASSERT_EQ(row[2 * i] << 8 | row[2 * i + 1], rgb565(p.at(i, 3)));
}

// Their rows follow one another, and pixels stand where they stand in the picture: dithered alike, in the same bits.
TYPED_TEST(RenderTest, RectanglesAreCutFromThePicture)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Scene<N, balls(false)> s = storage<N>().template view<balls(false)>();
    RayCount counted;
    const auto expect = [&]<class Format>(Format, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
        const uint32_t bytes = row_bytes<Format>(width);
        std::vector<uint8_t> whole(row_bytes<Format>(13)), part(bytes * height + 1, 0xcd);
        render_rect<Format>(s, x, y, width, height, part.data(), counted);
        for (uint32_t k = 0; k < height; k++) {
            render_row<Format>(s, y + k, whole.data(), counted);
            for (uint32_t i = 0; i < bytes; i++)
                EXPECT_EQ(part[k * bytes + i], whole[x / Format::pixels * Format::bytes + i]) << k << " " << i;
        }
        EXPECT_EQ(part.back(), 0xcd);
    };
    expect(Rgb888{}, 2, 1, 6, 3);
    expect(Dithered<Rgb565Little>{}, 3, 2, 10, 5);
    expect(Dithered<Mono>{}, 8, 1, 5, 6); // the last byte has three bits of nothing
    expect(Dithered<Grey4>{}, 2, 3, 10, 3);
    EXPECT_EQ(counted[RayKind::camera], 6u * 3 + 10 * 5 + 5 * 6 + 10 * 3 + (3 + 5 + 6 + 3) * 13);
}

TYPED_TEST(RenderTest, CoarseToFineEndsInThePicture)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    const Scene<N, balls(false)> s = storage<N>().template view<balls(false)>();
    const Picture whole = draw<N, balls(false)>();
    for (uint32_t size : {1u, 2u, 4u, 8u, 64u}) {
        Picture seen{13, 7, std::vector<uint8_t>(13 * 7 * 3)};
        RayCount counted;
        uint32_t first = 0; // of the first pass: rectangles
        EXPECT_TRUE(render_progressively(
            s, size,
            [&](uint32_t x, uint32_t y, uint32_t width, uint32_t height, const Pixel& p) {
                EXPECT_TRUE(width >= 1 && height >= 1 && x + width <= 13 && y + height <= 7);
                first += width == (13 - x < size ? 13 - x : size) && height == (7 - y < size ? 7 - y : size)
                    && x % size == 0 && y % size == 0;
                for (uint32_t j = y; j < y + height; j++)
                    for (uint32_t i = x; i < x + width; i++)
                        Rgb888::put(p, i, j, seen.rgb.data() + 3 * (13 * j + i));
                // Once the coarse picture is there, every pixel is that of its corner.
                if (counted[RayKind::camera] == ((13 + size - 1) / size) * ((7 + size - 1) / size)) {
                    for (uint32_t j = 0; j < 7; j++)
                        for (uint32_t i = 0; i < 13; i++)
                            EXPECT_EQ(seen.at(i, j).g, whole.at(i / size * size, j / size * size).g);
                }
                return true;
            },
            counted));
        EXPECT_TRUE(seen == whole);
        EXPECT_EQ(counted[RayKind::camera], 13u * 7) << "each pixel once";
        EXPECT_EQ(first, ((13 + size - 1) / size) * ((7 + size - 1) / size));
    }
    uint32_t calls = 0;
    EXPECT_FALSE(render_progressively(s, 8, [&](auto...) { return ++calls < 3; }));
    EXPECT_EQ(calls, 3u);
}

TYPED_TEST(RenderTest, OneSampleOnAGridIsThePlainPicture)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>(scene_text));
    EXPECT_TRUE((draw<N, balls(true)>() == draw<N, balls(false)>()));
}

} // namespace
