// Images: files of every kind and fault, and what image and globe look up in them.
#include "scene_helpers.hpp"
#include "texture_helpers.hpp"

#include <array>
#include <cstring>
#include <map>

namespace {

using namespace qray;
using namespace qray::test;
using scene::Files;

std::map<std::string, std::string, std::less<>> files; // what stands beside a scene
int reads = 0;

bool grow(scene::Room& room, size_t size)
{
    room.at = static_cast<uint8_t*>(std::realloc(room.at, size));
    room.size = size;
    return true;
}
constexpr Files beside{
    [](const char* path, size_t, scene::Bytes& to) -> const char* {
        const std::string_view name = path;
        const auto found = files.find(name.substr(name.rfind('/') + 1));
        if (found == files.end())
            return "No such file or directory";
        reads++;
        const std::string& text = found->second;
        grow(to.room, to.size + text.size() + 1);
        std::memcpy(to.room.at + to.size, text.data(), text.size());
        to.size += text.size();
        return nullptr;
    },
    grow};

std::string ppm(int width, int height, const std::string& rgb, const std::string& white = "255")
{
    return "P6\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + white + "\n" + rgb;
}
std::string little(uint32_t v)
{
    return {static_cast<char>(v), static_cast<char>(v >> 8), static_cast<char>(v >> 16), static_cast<char>(v >> 24)};
}
std::string bmp(uint32_t width, uint32_t height, const std::string& rows, uint32_t bits = 24, uint32_t method = 0,
    uint32_t head = 40)
{
    return "BM" + little(54 + static_cast<uint32_t>(rows.size())) + little(0) + little(54) + little(head)
        + little(width)
        + little(height) + little(1 | bits << 16) + little(method) + std::string(20, '\0') + rows;
}

const std::string view = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 9 9\n";

bool parsed(const std::string& text, scene::Error& error)
{
    return parse("a/b.nff", text.data(), text.size(), description(), error, &beside);
}
// The pixels of an image as the parser has them.
std::string pixels(const std::string& file)
{
    files = {{"x", file}};
    scene::Error error;
    EXPECT_TRUE(parsed(view + "texture globe x 0 0 0 s 0 0 0 1", error)) << error.text;
    const scene::ImageSource& image = description().images[0];
    return {reinterpret_cast<const char*>(description().image_bytes.room.at) + image.first,
        3 * size_t{image.width} * image.height};
}

TEST(ImageFile, RowsGoFromTheBottomInRedGreenBlue)
{
    const std::string expected = "abcdefghiABCDEFGHI"; // 3 x 2
    EXPECT_EQ(pixels(ppm(3, 2, "ABCDEFGHIabcdefghi")), expected);
    EXPECT_EQ(pixels("P6 # a comment\n#and one 9 9\n 3#\n2 \t\r\n# 1\n255 ABCDEFGHIabcdefghi and more"), expected);
    const std::string low = "cbafedihg...", high = "CBAFEDIHG..."; // padded to 12 bytes
    EXPECT_EQ(pixels(bmp(3, 2, low + high)), expected);
    EXPECT_EQ(pixels(bmp(3, 2, low + "CBAFEDIHG")), expected); // the last row's end may lack
    EXPECT_EQ(pixels(bmp(3, static_cast<uint32_t>(-2), high + low)), expected);
    EXPECT_EQ(description().images[0].width, 3u);
    EXPECT_EQ(description().images[0].height, 2u);
}

TEST(ImageFile, ValuesUpToAnotherWhiteAreScaledToTheNearest)
{
    const std::string out = pixels(ppm(2, 1, std::string("\0\1\2\3\4\5", 6), "4"));
    EXPECT_EQ(out, std::string("\x00\x40\x80\xbf\xff\xff", 6)); // 63.75, 127.5, 191.25
    EXPECT_EQ(pixels(ppm(1, 1, std::string("\0\1\7", 3), "1")), std::string("\0\xff\xff", 3));
}

TEST(ImageFile, EveryFaultIsNamedAtTheScenesPlace)
{
    const std::string short_head = bmp(3, 2, "").substr(0, 53), row(9, 'x');
    const struct {
        std::string file, message;
    } cases[] = {
        {"", "is empty; expected a BMP of 24 bits a pixel or a binary PPM"},
        {"GIF89a", "is neither of these"},
        {"P3 1 1 255 1 2 3", "is neither of these"},
        {short_head, "is short: it has 53 bytes, less than the header of a BMP"},
        {bmp(3, 1, row, 8), "is a BMP of 8 bits a pixel"},
        {bmp(3, 1, row, 24, 1), "is a BMP that is compressed, by method 1"},
        {bmp(3, 1, row, 24, 0, 12), "has a header of 12 bytes, not 40 or more"},
        {bmp(0, 1, row), "has 0 x 1 texels"},
        {bmp(3, 0, row), "has 3 x 0 texels"},
        {bmp(16385, 1, row), "has 16385 x 1 texels, more than 16384 each way (limit 'image_size')"},
        {bmp(1, 0x80000000, row), "has 1 x 2147483648 texels, more than"},
        {bmp(3, 2, row), "is short: it has 63 bytes, and its texels end at 75"},
        {bmp(3, 1, row.substr(1)), "is short: it has 62 bytes, and its texels end at 63"},
        {"P6", "is a PPM whose header ends at byte 2"},
        {"P63 1 255 " + row, "is a PPM whose header ends at byte 2"},
        {"P6 3 -1 255 " + row, "is a PPM whose header ends at byte 5"},
        {"P6 3 1 # 255", "is a PPM whose header ends at byte 12"},
        {ppm(0, 0, ""), "has 0 x 0 texels"},
        {ppm(99999, 1, ""), "has 99999 x 1 texels, more than 16384"},
        {"P6 4294967299 1 255\n" + row, "has 99999999 x 1 texels, more than 16384"},
        {ppm(3, 1, row, "0"), "is a PPM of values up to 0, not 1 to 255"},
        {ppm(3, 1, row, "65535"), "is a PPM of values up to 65535, not 1 to 255"},
        {ppm(3, 1, row.substr(1)), "is short: it has 19 bytes, and its texels end at 20"},
        {"P6 3 1 255" + row + "\n", "is a PPM whose header ends at byte 10"},
        {"P6 3 1 255# white\n" + row, "is a PPM whose header ends at byte 10"},
        {"P6 3 1 255", "is short: it has 10 bytes, and its texels end at 20"},
    };
    for (const auto& c : cases) {
        files = {{"p.bmp", c.file}};
        scene::Error error;
        EXPECT_FALSE(parsed(view + " material texture image p.bmp 0 0 0 1 0 0 0 1 0 s 0 0 0 1", error));
        EXPECT_EQ(std::string(error.text).find("a/b.nff:2:25: 'p.bmp' " + c.message), 0u) << error.text;
    }
    files.clear();
    scene::Error error;
    EXPECT_FALSE(parsed(view + "texture globe q.ppm 0 0 0", error));
    EXPECT_STREQ(error.text,
        "a/b.nff:2:15: cannot read 'q.ppm': No such file or directory; expected an image, BMP or PPM");
    files = {{"o", ppm(1, 1, "abc")}};
    EXPECT_FALSE(parsed(view + "texture image o 0 0 0 0 0 0 0 1 0", error));
    EXPECT_STREQ(error.text, "a/b.nff:2:23: u of an image is zero; expected a vector with a direction");
    EXPECT_FALSE(parsed(view + "texture image o 0 0 0 1 0 0 0 0 0", error));
    EXPECT_STREQ(error.text, "a/b.nff:2:29: v of an image is zero; expected a vector with a direction");
}

TEST(ImageFile, IsReadAndKeptOnce)
{
    files = {{"a", ppm(1, 2, "abcdef")}, {"b", bmp(1, 2, "fed.cba.")}, {"c", ppm(2, 1, "abcdef")}};
    reads = 0;
    scene::Error error;
    ASSERT_TRUE(parsed(view + "material texture globe a 0 0 0 s 0 0 0 1 material texture globe c 0 0 0 s 0 0 0 1\n"
                              "material texture image a 0 0 0 1 0 0 0 1 0 s 0 0 0 1 "
                              "material texture globe b 0 0 0 s 0 0 0 1",
                       error)) << error.text;
    EXPECT_EQ(reads, 3);
    const scene::Description& d = description();
    EXPECT_EQ(d.image_count, 2u);
    EXPECT_EQ(d.image_bytes.size, 12u);
    EXPECT_EQ(d.fill_count, 3u); // b is a
    EXPECT_EQ(d.fills[2].texture.image, 0u);
}

TEST(ImageFile, LimitsAreNamed)
{
    files.clear();
    std::string text = view;
    for (int i = 0; i <= 64; i++) {
        const std::string name = "n" + std::to_string(i);
        files[name] = ppm(1, 1, std::string(3, static_cast<char>(i)));
        text += "material texture globe " + name + " 0 0 0 s 0 0 0 1\n";
    }
    scene::Error error;
    EXPECT_FALSE(parsed(text, error));
    EXPECT_STREQ(error.text, "a/b.nff:66:24: too many images; expected at most 64 (limit 'images')");
    files = {{"x", ppm(4096, 4096, std::string(size_t{3} << 24, 'x'))},
        {"y", ppm(4096, 2048, std::string(size_t{3} << 23, 'y'))}};
    EXPECT_FALSE(parsed(view + "texture globe x 0 0 0 texture globe y 0 0 0", error));
    EXPECT_STREQ(error.text,
        "a/b.nff:2:37: images of 75497472 bytes; expected at most 67108864 of all (limit 'image_bytes')");
}

template <class N>
struct TexelsTest : ::testing::Test {};
TYPED_TEST_SUITE(TexelsTest, NumberSystems, SystemNames);

// An image of so many colours, each by its number, in its storage.
std::string numbered(int width, int height, int colours)
{
    std::string rgb;
    for (int i = 0; i < width * height; i++) {
        const int k = i % colours;
        rgb += {static_cast<char>(k), static_cast<char>(k >> 8), static_cast<char>(255 - k % 256)};
    }
    return rgb;
}

TYPED_TEST(TexelsTest, AreIndicesOfUpTo256Colours)
{
    using N = TypeParam;
    for (const int colours : {1, 2, 255, 256, 257, 600}) {
        files = {{"a", ppm(40, 25, numbered(40, 25, colours))}, {"b", ppm(1, 1, "xyz")}};
        ASSERT_TRUE(loaded<N>(view
            + "material texture globe b 0 0 0 s 0 0 0 1 material texture globe a 0 0 0 s 0 0 0 1", {}, &beside));
        const scene::Storage<N>& s = storage<N>();
        const Texels<N>& texels = s.globes.data[1].texels;
        EXPECT_EQ(texels.colours != nullptr, colours <= 256) << colours;
        EXPECT_EQ(s.texels.count, 3u + (colours <= 256 ? 1000u + 3 * static_cast<uint32_t>(colours) : 3000u));
        for (uint32_t i = 0; i < 1000; i++) {
            const int k = static_cast<int>((24 - i / 40) * 40 + i % 40) % colours; // rows from the bottom
            const Vec3 expected = Vec3{k % 256 / 255.0, k / 256 / 255.0, (255 - k % 256) / 255.0};
            ASSERT_LE(distance(value(texels.texel(i % 40, i / 40)), expected), make<N>::unit_ulp()) << k;
        }
    }
    EXPECT_EQ(value(Texels<N>{reinterpret_cast<const uint8_t*>("\xff\0\xff"), nullptr, 1, 1}.at(0, 0)),
        (Vec3{1, 0, 1}));
}

// An image whose texels say where they are.
constexpr uint16_t wide = 37, high = 23;
const std::vector<uint8_t> places = [] {
    std::vector<uint8_t> rgb;
    for (uint8_t row = 0; row < high; row++)
        for (uint8_t column = 0; column < wide; column++)
            rgb.insert(rgb.end(), {column, row, 0});
    return rgb;
}();
using Place = std::array<int, 2>; // column, row
template <class N>
constexpr Texels<N> texels_of_places() { return {places.data(), nullptr, wide, high}; }

template <class N, class Texture>
Place shown(const Texture& texture, const Point<N>& q)
{
    const Vec3 c = value(texture(make<N>::vector(0, 0, 0), q));
    return {static_cast<int>(std::lround(c.x * 255)), static_cast<int>(std::lround(c.y * 255))};
}
Real wrapped(Real x) { return x - std::floor(x); }

TYPED_TEST(TexelsTest, ImageGoesAlongItsEdgesAgainAndAgain)
{
    using N = TypeParam;
    Random random(310);
    int checked = 0;
    for (int i = 0; i < 4000; i++) {
        const Vec3 corner = random.point(3);
        const double u_length = std::exp2(random.uniform(-1, 4)), v_length = std::exp2(random.uniform(-1, 4));
        const Placing by_u{u_length, random.point(8)}, by_v{v_length, by_u.origin};
        const Vec3 u = random.direction(), v = random.direction();
        const auto offset = [&](const Vec3& edge, double size) { return -dot(edge, corner) / size; };
        const Image<N> image{make_axis<N>(by_u, u, offset(u, u_length), true),
            make_axis<N>(by_v, v, offset(v, v_length), true),
                             texels_of_places<N>()};
        const Point<N> q = make<N>::point(random.point(15));
        const Vec<Real> r = real(q) + real(by_u.origin) - real(corner);
        const Real s = dot(r, real(u)) / u_length * wide, t = dot(r, real(v)) / v_length * high;
        if (from_integer(s) <= wide * place_tolerance<N>(by_u, 32)
            || from_integer(t) <= high * place_tolerance<N>(by_v, 32))
            continue;
        checked++;
        ASSERT_EQ(shown<N>(image, q), (Place{static_cast<int>(wrapped(s / wide) * wide),
            static_cast<int>(wrapped(t / high) * high)}));
    }
    EXPECT_GT(checked, 3000);
}

TYPED_TEST(TexelsTest, GlobeIsLookedUpByLongitudeAndLatitude)
{
    using N = TypeParam;
    Random random(311);
    int checked = 0;
    for (int i = 0; i < 4000; i++) {
        const Vec3 centre = random.point(8), d = random.direction() * random.uniform(1, 4);
        const Globe<N> globe{make<N>::point(centre), 0, texels_of_places<N>()};
        const Point<N> q = make<N>::point(centre + d);
        const Vec<Real> e = real(q) - real(globe.centre);
        const Real across = std::sqrt(e.x * e.x + e.z * e.z), pi = std::acos(Real(-1));
        const Real s = (0.5 + std::atan2(e.x, e.z) / (2 * pi)) * wide, t = (0.5 + std::atan2(e.y, across) / pi) * high;
        // In q16 and float e is rounded to 2^-14 and 2^-24; a degree of longitude is shorter near a pole.
        const Real off = NarrowFixed<N> ? 0x1p-12 : 0x1p-21;
        if (from_integer(s) <= off * wide * length(e) / across || from_integer(t) <= off * high)
            continue;
        checked++;
        ASSERT_EQ(shown<N>(globe, q), (Place{static_cast<int>(s), static_cast<int>(t)}));
    }
    EXPECT_GT(checked, 3000);
}

// The seam is behind, at negative z: its texels are the first on the one side, the last on the other. Poles are of the
// lowest and the highest row, and of the column in front.
TYPED_TEST(TexelsTest, GlobeHasASeamAndPoles)
{
    using N = TypeParam;
    for (const double radius : {0.25, 1.0, 20.0}) {
        const Globe<N> globe{make<N>::point(1, 2, 3), 0, texels_of_places<N>()};
        const auto at = [&](double x, double y, double z) {
            return shown<N>(globe, make<N>::point(1 + radius * x, 2 + radius * y, 3 + radius * z));
        };
        EXPECT_EQ(at(0, 0, 1), (Place{wide / 2, high / 2}));
        EXPECT_EQ(at(0, 0, -1), (Place{0, high / 2}));
        EXPECT_EQ(at(0.01, 0, -1), (Place{wide - 1, high / 2}));
        EXPECT_EQ(at(-0.01, 0, -1), (Place{0, high / 2}));
        EXPECT_EQ(at(0, 1, 0), (Place{wide / 2, high - 1}));
        EXPECT_EQ(at(0, -1, 0), (Place{wide / 2, 0}));
        EXPECT_EQ(at(1, 0, 0), (Place{wide * 3 / 4, high / 2}));
        EXPECT_EQ(at(-1, 0, 0), (Place{wide / 4, high / 2}));
        EXPECT_EQ(at(0, 0, 0), (Place{wide / 2, high / 2})); // no direction
    }
    // From far away all is seen along one direction: up, and to the right.
    if constexpr (N::is_fixed) {
        const Globe<N> far{make<N>::point(-2, -8, 0), 20, texels_of_places<N>()};
        EXPECT_EQ(shown<N>(far, make<N>::point(60, -60, 60)), (Place{wide * 3 / 4, high - 2}));
    }
}

// From text to pixels: the chart below fills the view, its right half shown once, mirrored by an edge to the left.
TYPED_TEST(TexelsTest, PicturesShowImages)
{
    using N = TypeParam;
    files = {{"chart", ppm(3, 2, std::string("\xff\0\0\0\xff\0\0\0\xff\x80\x80\0\0\x80\x80\x80\0\x80", 18))}};
    const std::string head = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 90 hither 1 resolution 6 6\nambientlight 1 1 1\n";
    ASSERT_TRUE(loaded<N>(head + "material texture image chart 5 -5 0 -10 0 0 0 10 0\n disc 0 0 0 0 0 1 30", {},
        &beside));
    const Picture p = draw<N>();
    const std::array<uint8_t, 3> rows[2][3] = {{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}},
        {{128, 128, 0}, {0, 128, 128}, {128, 0, 128}}};
    for (uint32_t j = 0; j < 6; j++)
        for (uint32_t i = 0; i < 6; i++) {
            const auto& c = rows[j / 3][2 - i / 2];
            EXPECT_EQ((std::array{p.at(i, j).r, p.at(i, j).g, p.at(i, j).b}), c) << i << " " << j;
        }
}

} // namespace
