#include "study/flip.hpp"

#include "random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using namespace qray;
using study::Flip;

struct Rgb {
    uint8_t r, g, b;
};

std::vector<double> flip_of(const std::vector<Rgb>& one, const std::vector<Rgb>& other, uint32_t width,
                            double pixels_per_degree = Flip::default_pixels_per_degree)
{
    const auto height = static_cast<uint32_t>(one.size() / width);
    const Flip flip{pixels_per_degree};
    std::vector<double> work(Flip::room(width)), out(one.size());
    for (uint32_t y = 0; y < height; y++)
        flip.row(&one[0].r, &other[0].r, width, height, y, work.data(), &out[y * width]);
    return out;
}

// The formulas as the paper has them, in long double: kernels in two dimensions, and channels with their factors.
using Long = long double;
constexpr Long pi = 3.141592653589793238462643383279502884L;
struct Triple {
    Long x, y, z;
};

Long light_of(uint8_t byte)
{
    const Long v = byte / 255.0L;
    return v <= 0.04045L ? v / 12.92L : std::pow((v + 0.055L) / 1.055L, 2.4L);
}
// Of XYZ, from the primaries of Rec. 709 and D65, in whole numbers.
constexpr Long matrix[3][3] = {{10135552 / 24577794.0L, 8788810 / 24577794.0L, 4435075 / 24577794.0L},
                               {2613072 / 12288897.0L, 8788810 / 12288897.0L, 887015 / 12288897.0L},
                               {1425312 / 73733382.0L, 8788810 / 73733382.0L, 70074185 / 73733382.0L}};
Triple times(const Long (&m)[3][3], Triple v)
{
    const auto row = [&](int i) { return m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z; };
    return {row(0), row(1), row(2)};
}
Triple linear_from(Triple xyz)
{
    Long inverse[3][3], determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inverse[i][j] = matrix[a][c] * matrix[b][d] - matrix[a][d] * matrix[b][c];
        }
    for (int j = 0; j < 3; j++)
        determinant += matrix[0][j] * inverse[j][0];
    const Triple v = times(inverse, xyz);
    return {v.x / determinant, v.y / determinant, v.z / determinant};
}
Triple relative_to_white(Triple xyz)
{
    const Triple white = times(matrix, {1, 1, 1});
    return {xyz.x / white.x, xyz.y / white.y, xyz.z / white.z};
}
Triple hunt_lab_of(Triple linear)
{
    const Triple c = relative_to_white(times(matrix, linear));
    const auto f = [](Long t) {
        return t > 216 / 24389.0L ? std::cbrt(t) : t * 841 / 108.0L + 4 / 29.0L;
    };
    const Long lightness = 116 * f(c.y) - 16;
    return {lightness, lightness / 100 * 500 * (f(c.x) - f(c.y)), lightness / 100 * 200 * (f(c.y) - f(c.z))};
}
Long hyab(Triple a, Triple b)
{
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}
// Of plain pictures, where nothing but the colours differs.
Long colour_term(Triple a, Triple b)
{
    const Long most = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), 0.7L);
    const Long e = std::pow(hyab(hunt_lab_of(a), hunt_lab_of(b)), 0.7L), bend = 0.4L * most;
    return e < bend ? 0.95L * e / bend : 0.95L + (e - bend) / (most - bend) * 0.05L;
}
Triple linear_of(Rgb c)
{
    return {light_of(c.r), light_of(c.g), light_of(c.b)};
}

struct Kernel {
    int radius;
    std::vector<Long> weights;
    template <class Weight>
    Kernel(Long reach, const Weight& weight) : radius(static_cast<int>(std::ceil(reach)))
    {
        for (int y = -radius; y <= radius; y++)
            for (int x = -radius; x <= radius; x++)
                weights.push_back(weight(x, y));
    }
    // Positive weights to the sum 1, negative ones to -1.
    void normalise()
    {
        Long above = 0, below = 0;
        for (Long w : weights)
            (w > 0 ? above : below) += w;
        for (Long& w : weights)
            w /= w > 0 ? above : -below;
    }
    template <class Channel>
    Long at(const Channel& channel, int x, int y) const
    {
        Long sum = 0;
        auto weight = weights.begin();
        for (int j = -radius; j <= radius; j++)
            for (int i = -radius; i <= radius; i++)
                sum += *weight++ * channel(x + i, y + j);
        return sum;
    }
};

std::vector<Long> paper(const std::vector<Rgb>& one, const std::vector<Rgb>& other, int width, Long ppd)
{
    const int height = static_cast<int>(one.size()) / width;
    const Long reach = 3 * std::sqrt(0.04L / (2 * pi * pi)) * ppd;
    const auto csf = [&](Long a1, Long b1, Long a2, Long b2) {
        Kernel kernel(reach, [&](int x, int y) {
            const Long d = (x * x + y * y) / (ppd * ppd);
            return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d / b1)
                + a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d / b2);
        });
        kernel.normalise();
        return kernel;
    };
    const Kernel blurs[] = {csf(1, 0.0047L, 0, 1), csf(1, 0.0053L, 0, 1), csf(34.1L, 0.04L, 13.5L, 0.025L)};
    const Long sigma = 0.5L * 0.082L * ppd;
    const auto feature = [&](bool is_point, bool is_upright) {
        Kernel kernel(3 * sigma, [&](int x, int y) {
            const Long along = is_upright ? y : x;
            return (is_point ? along * along / (sigma * sigma) - 1 : -along)
                * std::exp(-(x * x + y * y) / (2 * sigma * sigma));
        });
        kernel.normalise();
        return kernel;
    };
    const Kernel features[2][2] = {{feature(false, false), feature(false, true)},
                                   {feature(true, false), feature(true, true)}};
    struct Seen {
        Triple linear;
        Long features[2];
    };
    const auto seen = [&](const std::vector<Rgb>& picture, int x, int y) {
        std::vector<Triple> channels;
        for (Rgb c : picture) {
            const Triple v = relative_to_white(times(matrix, linear_of(c)));
            channels.push_back({116 * v.y - 16, 500 * (v.x - v.y), 200 * (v.y - v.z)});
        }
        const auto at = [&](int i, int j) {
            return channels[static_cast<size_t>(std::clamp(j, 0, height - 1) * width + std::clamp(i, 0, width - 1))];
        };
        const Long light = (blurs[0].at([&](int i, int j) { return at(i, j).x; }, x, y) + 16) / 116;
        const Long red = blurs[1].at([&](int i, int j) { return at(i, j).y; }, x, y) / 500;
        const Long blue = blurs[2].at([&](int i, int j) { return at(i, j).z; }, x, y) / 200;
        const Triple white = times(matrix, {1, 1, 1});
        const Triple v = linear_from({(light + red) * white.x, light * white.y, (light - blue) * white.z});
        Seen out{{std::clamp(v.x, 0.0L, 1.0L), std::clamp(v.y, 0.0L, 1.0L), std::clamp(v.z, 0.0L, 1.0L)}, {}};
        const auto y_of = [&](int i, int j) { return (at(i, j).x + 16) / 116; };
        for (int k = 0; k < 2; k++)
            out.features[k] = std::hypot(features[k][0].at(y_of, x, y), features[k][1].at(y_of, x, y));
        return out;
    };
    std::vector<Long> out;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const Seen a = seen(one, x, y), b = seen(other, x, y);
            const Long edges = std::abs(a.features[0] - b.features[0]);
            const Long points = std::abs(a.features[1] - b.features[1]);
            const Long feature_term = std::sqrt(std::max(edges, points) / std::sqrt(2.0L));
            out.push_back(std::pow(colour_term(a.linear, b.linear), 1 - feature_term));
        }
    return out;
}

std::vector<Rgb> plain(Rgb colour, size_t pixels = 6 * 4)
{
    return std::vector<Rgb>(pixels, colour);
}
std::vector<Rgb> speckled(uint64_t seed, size_t pixels)
{
    SplitMix random{seed};
    std::vector<Rgb> out;
    const auto byte = [&random] { return static_cast<uint8_t>(random.bits()); };
    for (size_t i = 0; i < pixels; i++)
        out.push_back({byte(), byte(), byte()});
    return out;
}
constexpr Rgb black{0, 0, 0}, white{255, 255, 255}, red{255, 0, 0}, green{0, 255, 0}, blue{0, 0, 255};

TEST(Flip, ArithmeticIsThatOfLongDouble)
{
    const auto exactly = [](double x) { return static_cast<Long>(x); };
    for (double x = -690; x < 690; x += 0.0137) {
        const Long ratio = exactly(study::flip::exponential(x)) / std::exp(exactly(x));
        EXPECT_NEAR(static_cast<double>(ratio), 1, 1e-15) << x;
    }
    for (double x = 1e-290; x < 1e290; x *= 1.0173) {
        const Long exact = std::log(exactly(x));
        EXPECT_NEAR(static_cast<double>(exactly(study::flip::logarithm(x)) - exact), 0,
                    1e-15 * static_cast<double>(std::max(1.0L, std::abs(exact)))) << x;
    }
    EXPECT_EQ(study::flip::logarithm(1), 0);
    EXPECT_EQ(study::flip::exponential(0), 1);
    EXPECT_EQ(study::flip::power(0, 0), 1);
    EXPECT_EQ(study::flip::power(0, 0.5), 0);
}

TEST(Flip, EqualPicturesDoNotDiffer)
{
    const auto picture = speckled(1, 20 * 15);
    for (double value : flip_of(picture, picture, 20))
        EXPECT_EQ(value, 0);
}

// Slopes of plain pictures are 0 but for some 1e-17, of which the feature term takes the root.
TEST(Flip, PlainColoursDifferByTheColourTermAlone)
{
    for (Rgb a : {black, white, red, green, blue, Rgb{127, 128, 129}, Rgb{3, 200, 90}})
        for (Rgb b : {black, white, red, green, blue, Rgb{128, 128, 128}, Rgb{250, 20, 9}})
            for (double value : flip_of(plain(a), plain(b), 6))
                EXPECT_NEAR(value, static_cast<double>(colour_term(linear_of(a), linear_of(b))), 1e-8);
}

// The paper scales by its largest difference, which is that of green and blue: 41.2761 in published implementations,
// in the metric raised to 0.7. Black and white are 100 apart: 100^0.7 = 25.1189 of it, above the bend at 0.4.
TEST(Flip, KnownColours)
{
    EXPECT_NEAR(study::flip::most(), 41.2761, 5e-5);
    EXPECT_NEAR(flip_of(plain(green), plain(blue), 6)[0], 1, 1e-12);
    const double e = std::pow(100, 0.7) / 41.2761;
    EXPECT_NEAR(flip_of(plain(black), plain(white), 6)[0], 0.95 + 0.05 * (e - 0.4) / 0.6, 1e-6);
}

// Kernels in two dimensions against rows and columns, at pictures smaller and larger than these, near and far.
TEST(Flip, PicturesDifferAsThePaperSays)
{
    struct Case {
        int width, height;
        double pixels_per_degree;
    };
    constexpr Case cases[] = {{9, 7, 67}, {16, 9, 20}, {1, 6, 40}, {8, 1, 67}, {3, 2, 230}, {3, 3, 1}};
    for (const Case& c : cases) {
        const auto pixels = static_cast<size_t>(c.width * c.height);
        auto one = speckled(2, pixels), other = one;
        for (size_t i = 0; i < pixels; i += 3)
            other[i] = i % 2 ? Rgb{static_cast<uint8_t>(one[i].r / 2), one[i].g, 255} : white;
        const auto found = flip_of(one, other, static_cast<uint32_t>(c.width), c.pixels_per_degree);
        const auto exact = paper(one, other, c.width, static_cast<Long>(c.pixels_per_degree));
        for (size_t i = 0; i < pixels; i++)
            EXPECT_NEAR(found[i], static_cast<double>(exact[i]), 1e-11) << i << " of " << c.width << " x " << c.height;
        EXPECT_EQ(found, flip_of(other, one, static_cast<uint32_t>(c.width), c.pixels_per_degree)); // either way round
    }
}

TEST(Flip, GrowsWithTheDifference)
{
    double last = 0;
    for (uint8_t level = 101; level < 255; level++) {
        const double now = flip_of(plain({100, 100, 100}, 1), plain({level, level, level}, 1), 1)[0];
        EXPECT_GT(now, last);
        last = now;
    }
    // One pixel off is seen from near by, and hardly from far away.
    auto dot = plain({90, 90, 90}, 31 * 31);
    dot[15 * 31 + 15] = white;
    last = 1;
    for (double pixels_per_degree : {10.0, 20.0, 40.0, 67.0, 120.0}) {
        const double now = flip_of(plain({90, 90, 90}, 31 * 31), dot, 31, pixels_per_degree)[15 * 31 + 15];
        EXPECT_LT(now, last);
        last = now;
    }
}

// Greys 2.3 apart in lightness are at the threshold: L = 50 and 52.3.
TEST(Flip, ThresholdIsOneNoticeableStep)
{
    const auto grey = [](Long lightness) {
        const Long light = std::pow((lightness + 16) / 116, 3.0L);
        return Triple{light, light, light};
    };
    EXPECT_NEAR(Flip{}.threshold(), static_cast<double>(colour_term(grey(50), grey(52.3L))), 1e-12);
    EXPECT_NEAR(Flip{}.threshold(), std::pow(2.3, 0.7) / 41.2761 * 0.95 / 0.4, 1e-6);
}

} // namespace
