#include "../src/scene/description.hpp"
#include "roomy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace {

using namespace qray::scene;
using qray::Kind;
using qray::TextureKind;

Description& scene = qray::test::kept<Description>();
Error error;

// Files beside the scene, and rooms of just the size that is asked for.
std::map<std::string, std::string> beside;
bool grow(Room& room, size_t size) {
    if (size <= room.size)
        return true;
    auto* const larger = static_cast<uint8_t*>(std::aligned_alloc(Layout::alignment, (size + 63) / 64 * 64));
    if (room.at != nullptr)
        std::memcpy(larger, room.at, room.size);
    std::free(room.at);
    room = {larger, size};
    return true;
}
const char* append(const char* path, size_t most, Bytes& to) {
    const auto found = beside.find(path);
    if (found == beside.end())
        return "there is none";
    const std::string text = found->second.substr(0, most + 1);
    grow(to.room, to.size + text.size());
    std::memcpy(to.room.at + to.size, text.data(), text.size());
    to.size += text.size();
    return nullptr;
}
constexpr Files files{append, grow};

// The copy has exactly the text's size, so that a sanitizer sees the parser read beyond it.
bool parsed(const std::string& text, const char* name = "scene.nff") {
    const std::vector<char> copy(text.begin(), text.end());
    return parse(name, copy.data(), copy.size(), scene, error, &files);
}

#define ASSERT_PARSES(scene_text) ASSERT_TRUE(parsed(scene_text)) << error.text

// A view in one line; what follows it starts in line 2.
#define VIEW "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 4 3\n"

const std::string view = VIEW;

void expect_vector(const Vec3d& v, double x, double y, double z) {
    EXPECT_EQ(v.x, x);
    EXPECT_EQ(v.y, y);
    EXPECT_EQ(v.z, z);
}

// The fill that an object gets after `text`.
Fill fill_after(const std::string& text) {
    EXPECT_TRUE(parsed(view + text + " s 0 0 0 1")) << error.text;
    EXPECT_EQ(scene.fill_count, 1u);
    return scene.fills[0];
}

// What scenes say.

TEST(Parser, ViewAlone) {
    ASSERT_PARSES("v from 1 2 3 at 4 5.5 -6 up 0 0.1 1e0 angle 45.5 hither 0.01 resolution 640 +480");
    expect_vector(scene.view.from, 1, 2, 3);
    expect_vector(scene.view.at, 4, 5.5, -6);
    expect_vector(scene.view.up, 0, 0.1, 1);
    EXPECT_EQ(scene.view.angle, 45.5);
    EXPECT_EQ(scene.view.width, 640u);
    EXPECT_EQ(scene.view.height, 480u);

    expect_vector(scene.background, 0, 0, 0);
    expect_vector(scene.ambient, 0.2, 0.2, 0.2);
    EXPECT_TRUE(scene.shadows);
    EXPECT_EQ(scene.far, 0);
    EXPECT_EQ(scene.object_count, 0u);
    EXPECT_EQ(scene.vertex_count, 0u);
    EXPECT_EQ(scene.fill_count, 0u);
    EXPECT_EQ(scene.light_count, 0u);
    EXPECT_EQ(scene.dropped, 0u);
    EXPECT_EQ(scene.nonplanar.count, 0u);
    EXPECT_STREQ(scene.comment, "");
    EXPECT_STREQ(error.text, "");
}

const char* const nff = "# NFF as Haines's programs write it\n"
                        "b 0.078 0.361 0.753\n"
                        "v\nfrom 2.1 1.3 1.7\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.01\nresolution 512 512\n"
                        "l 4 3 2\n"
                        "l 1 -4 4 0.5 0.25 1\n"
                        "f 1 0.75 0.33 0.8 0.1 3.0827 0.5 1.5\n"
                        "p 4\n12 12 -0.5\n-12 12 -0.5\n-12 -12 -0.5\n12 -12 -0.5\n"
                        "f 0 1 1 0.7 0 100000 0 0\n"
                        "s 0 0 0 0.5\n"
                        "c\n0.25 -2.55836e-17 0\n0.125\n1 0 0\n0\n"
                        "pp 3\n0 0 0 0 0 1\n1 0 0 0.5 0 1\n0 1 0 0 5e-18 -1\n";

TEST(Parser, PlainNff) {
    ASSERT_PARSES(nff);
    EXPECT_STREQ(scene.comment, "NFF as Haines's programs write it");
    expect_vector(scene.background, 0.078, 0.361, 0.753);

    ASSERT_EQ(scene.light_count, 2u);
    EXPECT_FALSE(scene.lights[0].sun);
    expect_vector(scene.lights[0].at, 4, 3, 2);
    EXPECT_NEAR(scene.lights[0].colour.x, 0.70710678118654752, 2e-16);
    EXPECT_EQ(scene.lights[0].colour.y, scene.lights[0].colour.x);
    EXPECT_EQ(scene.lights[0].colour.z, scene.lights[0].colour.x);
    expect_vector(scene.lights[1].at, 1, -4, 4);
    expect_vector(scene.lights[1].colour, 0.5, 0.25, 1);

    ASSERT_EQ(scene.fill_count, 2u);
    const Fill& fill = scene.fills[0];
    expect_vector(fill.colour, 1, 0.75, 0.33);
    EXPECT_EQ(fill.ambient, 0.8);
    EXPECT_EQ(fill.diffuse, 0.8);
    EXPECT_EQ(fill.highlight, 0.1);
    EXPECT_EQ(fill.mirror, 0.1);
    EXPECT_EQ(fill.shine, 3.0827);
    EXPECT_EQ(fill.transmit, 0.5);
    EXPECT_EQ(fill.ior, 1.5);
    EXPECT_EQ(fill.texture.kind, TextureKind::none);
    EXPECT_EQ(scene.fills[1].ior, 1);
    EXPECT_EQ(scene.fills[1].shine, 100000);

    ASSERT_EQ(scene.object_count, 4u);
    ASSERT_EQ(scene.vertex_count, 7u);
    const Object* o = scene.objects;
    EXPECT_EQ(o[0].kind, Kind::polygon);
    EXPECT_EQ(o[0].fill, 0u);
    EXPECT_EQ(o[0].vertex, 0u);
    EXPECT_EQ(o[0].count, 4u);
    expect_vector(scene.vertices[0], 12, 12, -0.5);
    expect_vector(scene.vertices[3], 12, -12, -0.5);
    EXPECT_EQ(o[1].kind, Kind::sphere);
    EXPECT_EQ(o[1].fill, 1u);
    expect_vector(o[1].a, 0, 0, 0);
    EXPECT_EQ(o[1].ra, 0.5);
    EXPECT_EQ(o[2].kind, Kind::cone);
    EXPECT_EQ(o[2].fill, 1u);
    expect_vector(o[2].a, 0.25, -2.55836e-17, 0);
    EXPECT_EQ(o[2].ra, 0.125);
    expect_vector(o[2].b, 1, 0, 0);
    EXPECT_EQ(o[2].rb, 0);
    EXPECT_EQ(o[3].kind, Kind::patch);
    EXPECT_EQ(o[3].fill, 1u);
    EXPECT_EQ(o[3].vertex, 4u);
    EXPECT_EQ(o[3].count, 3u);
    expect_vector(scene.vertices[4], 0, 0, 0);
    expect_vector(scene.vertices[6], 0, 1, 0);
    expect_vector(scene.normals[4], 0, 0, 1);
    expect_vector(scene.normals[5], 0.5, 0, 1);
    expect_vector(scene.normals[6], 0, 5e-18, -1);
}

TEST(Parser, LineEndsAndBlanksMeanNothing) {
    for (const char* end : {"\r", "\r\n", " ", "\t", "\f", "\v", "\n\n", "# comment \x80\x01\n", "#\r"}) {
        std::string text;
        for (const char* c = strchr(nff, '\n'); *c != 0; ++c)
            text += *c == '\n' ? end : std::string(1, *c);
        ASSERT_PARSES(text) << end;
        EXPECT_EQ(scene.object_count, 4u);
        EXPECT_EQ(scene.light_count, 2u);
        expect_vector(scene.normals[6], 0, 5e-18, -1);
    }
}

TEST(Parser, CountsAreNumbersLikeAllOthers) {
    ASSERT_PARSES("v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1.6e2 120.0\n"
                  "p 3. 0 0 0 1 0 0 0 1 0\npp 40e-1 0 0 0 0 0 1 1 0 0 0 0 1 1 1 0 0 0 1 0 1 0 0 0 1");
    EXPECT_EQ(scene.view.width, 160u);
    EXPECT_EQ(scene.view.height, 120u);
    ASSERT_EQ(scene.object_count, 2u);
    EXPECT_EQ(scene.objects[0].count, 3u);
    EXPECT_EQ(scene.objects[1].count, 4u);
}

TEST(Parser, OwnShapes) {
    ASSERT_PARSES(view + "plane 1 2 3 0 2 0 disc 4 5 6 -1 0 1e-3 -0.75");
    ASSERT_EQ(scene.object_count, 2u);
    EXPECT_EQ(scene.objects[0].kind, Kind::disc);
    EXPECT_EQ(scene.objects[0].ra, HUGE_VAL);
    expect_vector(scene.objects[0].a, 1, 2, 3);
    expect_vector(scene.objects[0].b, 0, 2, 0);
    EXPECT_EQ(scene.objects[1].kind, Kind::disc);
    expect_vector(scene.objects[1].a, 4, 5, 6);
    expect_vector(scene.objects[1].b, -1, 0, 1e-3);
    EXPECT_EQ(scene.objects[1].ra, 0.75);
}

TEST(Parser, RadiiLoseTheirSign) {
    ASSERT_PARSES(view + "s 0 0 0 -2 c 0 0 0 -3 0 0 1 -4");
    EXPECT_EQ(scene.objects[0].ra, 2);
    EXPECT_EQ(scene.objects[1].ra, 3);
    EXPECT_EQ(scene.objects[1].rb, 4);
}

TEST(Parser, LightsWithoutColourShareOne) {
    ASSERT_PARSES(view + "l 1 0 0 sun 0 1 0 64 0 0.5 sun 0 0 -2 l 0 0 1 b 0 0 0");
    ASSERT_EQ(scene.light_count, 4u);
    EXPECT_FALSE(scene.lights[0].sun);
    expect_vector(scene.lights[0].colour, 0.5, 0.5, 0.5);
    EXPECT_TRUE(scene.lights[1].sun);
    expect_vector(scene.lights[1].at, 0, 1, 0);
    expect_vector(scene.lights[1].colour, 64, 0, 0.5);
    EXPECT_TRUE(scene.lights[2].sun);
    expect_vector(scene.lights[2].at, 0, 0, -2);
    expect_vector(scene.lights[2].colour, 0.5, 0.5, 0.5);
    expect_vector(scene.lights[3].colour, 0.5, 0.5, 0.5);
    // A panel counts as one.
    ASSERT_PARSES(view + "panel 3 1 2 3 4 0 0 0 0 -5 l 0 0 0 sun 0 1 0 panel 16 0 0 0 0 0 0 0 0 1 1 2 3");
    ASSERT_EQ(scene.light_count, 4u);
    EXPECT_EQ(scene.lights[0].places, 3u);
    expect_vector(scene.lights[0].at, 1, 2, 3);
    expect_vector(scene.lights[0].u, 4, 0, 0);
    expect_vector(scene.lights[0].v, 0, 0, -5);
    expect_vector(scene.lights[0].colour, 0.5, 0.5, 0.5);
    EXPECT_EQ(scene.lights[1].places, 0u);
    EXPECT_EQ(scene.lights[3].places, 16u);
    expect_vector(scene.lights[3].colour, 1, 2, 3);
    // Before the view, with the colour in another line or at the end of the file.
    ASSERT_PARSES("l 1 0 0 " + view + "l 4 5 6\n\n+1\n.5 # comment\n0");
    ASSERT_EQ(scene.light_count, 2u);
    expect_vector(scene.lights[1].colour, 1, 0.5, 0);
    ASSERT_PARSES(view + "l 4 5 6");
    expect_vector(scene.lights[0].colour, 1, 1, 1);
}

TEST(Parser, SceneWordsStandAnywhereAndTheLastCounts) {
    ASSERT_PARSES("b 1 1 1 ambientlight 1 1 1 shadows on far 3 radiosity 2 " + view +
                  "s 0 0 0 1 b 64 0.25 0 ambientlight 0 64 0.5 shadows off far 1e-3 radiosity 0.5");
    expect_vector(scene.background, 64, 0.25, 0);
    expect_vector(scene.ambient, 0, 64, 0.5);
    EXPECT_FALSE(scene.shadows);
    EXPECT_EQ(scene.far, 1e-3);
    EXPECT_EQ(scene.radiosity, 0.5);
    ASSERT_PARSES("shadows off " + view + "shadows on");
    EXPECT_TRUE(scene.shadows);
}

TEST(Parser, MaterialNamesWhatDiffersFromTheDefaults) {
    const Fill defaults = fill_after("");
    expect_vector(defaults.colour, 1, 1, 1);
    EXPECT_EQ(defaults.ambient, 1);
    EXPECT_EQ(defaults.diffuse, 1);
    EXPECT_EQ(defaults.highlight, 0);
    EXPECT_EQ(defaults.shine, 1);
    EXPECT_EQ(defaults.mirror, 0);
    EXPECT_EQ(defaults.transmit, 0);
    EXPECT_EQ(defaults.ior, 1);
    EXPECT_EQ(defaults.emission, 0);
    EXPECT_EQ(defaults.texture.kind, TextureKind::none);
    EXPECT_EQ(fill_after("f 0 0 0 0 0 0 0 0 material"), defaults);

    const Fill all =
        fill_after("material emission 64 ior 1.25 transmit 0.7 mirror 0.6 shine 5e5 highlight 0.4 diffuse 0.3 "
                   "ambient 0.2 colour 0.1 0 1");
    expect_vector(all.colour, 0.1, 0, 1);
    EXPECT_EQ(all.ambient, 0.2);
    EXPECT_EQ(all.diffuse, 0.3);
    EXPECT_EQ(all.highlight, 0.4);
    EXPECT_EQ(all.shine, 5e5);
    EXPECT_EQ(all.mirror, 0.6);
    EXPECT_EQ(all.transmit, 0.7);
    EXPECT_EQ(all.ior, 1.25);
    EXPECT_EQ(all.emission, 64);

    const Fill one = fill_after("material colour 0 0 0 mirror 1 material diffuse 0.5");
    expect_vector(one.colour, 1, 1, 1);
    EXPECT_EQ(one.mirror, 0);
    EXPECT_EQ(one.diffuse, 0.5);
}

TEST(Parser, IorOfZeroOrLessReadsAsOne) {
    for (const char* ior : {"0", "-0", "-1.5", "-1e300", "1e-400", "1"}) {
        EXPECT_EQ(fill_after("f 1 1 1 1 0 1 0 " + std::string(ior)).ior, 1) << ior;
        EXPECT_EQ(fill_after("material ior " + std::string(ior)).ior, 1) << ior;
    }
    EXPECT_EQ(fill_after("material ior 0.125").ior, 0.125);
    EXPECT_EQ(fill_after("material ior 8").ior, 8);
}

TEST(Parser, EachTexture) {
    const struct {
        const char* text;
        TextureKind kind;
        double x, y, z;
    } cases[] = {
        {"checker 0.1 0.2 0.3 4", TextureKind::checker, 0, 0, 0},
        {"stripes 0.1 0.2 0.3 4 1 0 -1", TextureKind::stripes, 1, 0, -1},
        {"gradient 0.1 0.2 0.3 4 0 2 0", TextureKind::gradient, 0, 2, 0},
        {"rings 0.1 0.2 0.3 4", TextureKind::rings, 0, 0, 0},
        {"noise 0.1 0.2 0.3 4", TextureKind::noise, 0, 0, 0},
        {"marble 0.1 0.2 0.3 4 0 0 3", TextureKind::marble, 0, 0, 3},
        {"wood 0.1 0.2 0.3 4 1e-9 0 0", TextureKind::wood, 1e-9, 0, 0},
        {"brick 0.1 0.2 0.3 4", TextureKind::brick, 0, 0, 0},
    };
    for (const auto& [text, kind, x, y, z] : cases) {
        SCOPED_TRACE(text);
        const Fill fill = fill_after("material colour 1 0 0 diffuse 0.5 texture " + std::string(text));
        EXPECT_EQ(fill.texture.kind, kind);
        expect_vector(fill.texture.colour, 0.1, 0.2, 0.3);
        EXPECT_EQ(fill.texture.size, 4);
        expect_vector(fill.texture.axis, x, y, z);
        expect_vector(fill.colour, 1, 0, 0);
        EXPECT_EQ(fill.diffuse, 0.5);
    }
}

TEST(Parser, TextureLastsUntilTheNextFill) {
    ASSERT_PARSES(view +
                  "texture checker 0 0 0 1 s 0 0 0 1 s 0 0 0 2 texture stripes 0 0 0 1 1 0 0 s 0 0 0 3 "
                  "texture noise 0 0 0 1 s 0 0 0 4 material s 0 0 0 5 texture rings 0 0 0 1 "
                  "f 1 1 1 1 0 1 0 1 s 0 0 0 6");
    ASSERT_EQ(scene.object_count, 6u);
    const TextureKind kinds[] = {TextureKind::checker, TextureKind::checker, TextureKind::stripes,
                                 TextureKind::noise,   TextureKind::none,    TextureKind::none};
    for (uint32_t i = 0; i < 6; ++i)
        EXPECT_EQ(scene.fills[scene.objects[i].fill].texture.kind, kinds[i]) << i;
    // What the noise left of the stripes: nothing.
    expect_vector(scene.fills[scene.objects[3].fill].texture.axis, 0, 0, 0);
}

TEST(Parser, FillsAreStoredOnceAndOnlyIfUsed) {
    ASSERT_PARSES(view + "f 0 0 0 1 1 1 1 1 f 1 0 0 0.5 0.25 8 0 1 s 0 0 0 1 " // 0; the first is never used
                         "material s 0 0 0 1 "                                 // 1
                         "f 1 -0 -0.0 0.5 0.25 8 -0 0 s 0 0 0 1 "              // 0
                         "material shine 8 ambient .5 diffuse 5e-1 highlight 0.25 mirror 0.25 colour 1 0 0 "
                         "s 0 0 0 1 "                                 // 0
                         "texture wood 0 0 0 1 0 1 0 s 0 0 0 1 "      // 2
                         "material colour 0.5 0 0 s 0 0 0 0 "         // an object without extent uses none
                         "material s 0 0 0 1 "                        // 1
                         "texture wood 0 0 0 1 0 1 1e-17 s 0 0 0 1"); // 3
    const uint32_t fills[] = {0, 1, 0, 0, 2, 1, 3};
    ASSERT_EQ(scene.object_count, 7u);
    EXPECT_EQ(scene.fill_count, 4u);
    for (uint32_t i = 0; i < 7; ++i)
        EXPECT_EQ(scene.objects[i].fill, fills[i]) << i;
    expect_vector(scene.fills[0].colour, 1, 0, 0);
    EXPECT_EQ(scene.fills[3].texture.axis.z, 1e-17);
}

// Each of the numbers of a fill tells it from another.
TEST(Parser, FillsThatDifferInOneNumberAreTwo) {
    const std::string base = "material colour .1 .1 .1 ambient .1 diffuse .1 highlight .1 shine .1 mirror .1 "
                             "transmit .1 ior .2 texture marble .1 .1 .1 .1 .1 .1 .1 ";
    size_t numbers = 0;
    for (size_t i = base.find('.'); i != std::string::npos; i = base.find('.', i + 1), ++numbers) {
        std::string other = base;
        other[i + 1] = '3';
        ASSERT_PARSES(view + base + "s 0 0 0 1 " + other + "s 0 0 0 1 " + base + "s 0 0 0 1");
        EXPECT_EQ(scene.fill_count, 2u) << other;
        EXPECT_EQ(scene.objects[0].fill, 0u);
        EXPECT_EQ(scene.objects[1].fill, 1u);
        EXPECT_EQ(scene.objects[2].fill, 0u);
    }
    EXPECT_EQ(numbers, 17u);
}

TEST(Parser, DropsAndCountsWhatHasNoExtent) {
    const char* const without[] = {
        "s 1 2 3 0",
        "s 1 2 3 -0",
        "s 1 2 3 1e-400",
        "s 1 2 3 1e-61",
        "disc 0 0 0 0 1 0 0",
        "c 0 0 0 0 1 0 0 0",
        "p 3 1 2 3 1 2 3 1 2 3",
        "p 3 0 0 0 1 1 1 2 2 2",
        "p 3 0.1 0.2 0.3 0.2 0.4 0.6 0.3 0.6 0.9",
        "p 4 0 0 0 1 0 0 3 0 0 2 0 0",
        "p 3 0 0 0 1e-61 0 0 0 1e-61 0",
        "pp 3 0 0 0 0 0 1 1 1 1 0 0 1 2 2 2 0 0 1",
        "pp 5 0 0 0 0 0 1 1 0 0 0 0 1 2 0 0 0 0 1 3 0 0 0 0 1 4 0 0 0 0 1",
    };
    for (const char* text : without) {
        ASSERT_PARSES(view + text + " p 3 0 0 0 1 0 0 0 1 0") << text;
        EXPECT_EQ(scene.dropped, 1u) << text;
        ASSERT_EQ(scene.object_count, 1u) << text;
        EXPECT_EQ(scene.vertex_count, 3u) << text;
        EXPECT_EQ(scene.objects[0].vertex, 0u) << text;
        expect_vector(scene.vertices[1], 1, 0, 0);
    }
    const char* const with[] = {
        "s 1 2 3 1e-59",
        "c 0 0 0 0 1 0 0 -1",
        "c 0 0 0 1 0 0 1e-59 0",
        "disc 0 0 0 0 1 0 1e-30",
        "p 3 0 0 0 1 0 0 0 1e-12 0",           // thin
        "p 3 5 5 5 5.000001 5 5 5 5.000001 5", // small
        "p 4 0 0 0 1 0 0 2 0 0 1 1 0",         // first three corners in line
        "p 4 0 0 0 0 0 0 1 0 0 0 1 0",         // first two the same
        "p 4 0 0 0 1 1 0 1 0 0 0 1 0",         // two lobes that cancel
    };
    for (const char* text : with) {
        ASSERT_PARSES(view + text) << text;
        EXPECT_EQ(scene.dropped, 0u) << text;
        EXPECT_EQ(scene.object_count, 1u) << text;
    }
    ASSERT_PARSES(view + "s 0 0 0 0 s 0 0 0 0 s 0 0 0 1 p 3 0 0 0 0 0 0 0 0 0");
    EXPECT_EQ(scene.dropped, 3u);
    EXPECT_EQ(scene.object_count, 1u);
}

// A square's last corner, which has no part in the plane of the first three: to 1 % of the diagonal of the box.
TEST(Parser, CornersOffThePlaneAreCounted) {
    const auto square = [](double height) { return " p 4 0 0 0 10 0 0 10 10 0 0 10 " + std::to_string(height); };
    ASSERT_PARSES(view + square(0.1414) + "\n" + square(0.1416) + "\n" + square(-3) + "\n" + square(-0.1414));
    EXPECT_EQ(scene.nonplanar.count, 2u);
    EXPECT_EQ(scene.nonplanar.line, 3u);
    ASSERT_PARSES(view + "pp 4 0 0 0 0 0 1 10 0 0 0 0 1 10 10 0 0 0 1 0 10 5 0 0 1\n"); // each triangle has its own
    EXPECT_EQ(scene.nonplanar.count, 0u);
}

// A good patch may have triangles without area, which are dropped as any other.
TEST(Parser, CountsTheDroppedTrianglesOfAPatch)
{
    ASSERT_PARSES(view + "pp 4 0 0 0 0 0 1 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1");
    EXPECT_EQ(scene.object_count, 1u);
    EXPECT_EQ(scene.dropped, 1u);
    ASSERT_PARSES(view + "pp 5 0 0 0 0 0 1 1 0 0 0 0 1 2 0 0 0 0 1 2 2 0 0 0 1 2 2 0 0 0 1");
    EXPECT_EQ(scene.object_count, 1u);
    EXPECT_EQ(scene.dropped, 2u);
}

TEST(Parser, ResetsWhatAnotherSceneLeft) {
    ASSERT_PARSES("# first\n" + view +
                  "b 1 1 1 ambientlight 1 1 1 shadows off far 3 l 0 0 0 0 0 0 f 0 0 0 0 0 0 0 0 " +
                  "s 0 0 0 0 p 3 0 0 0 1 0 0 0 1 0");
    ASSERT_EQ(scene.object_count, 1u);
    ASSERT_PARSES(view);
    expect_vector(scene.background, 0, 0, 0);
    expect_vector(scene.ambient, 0.2, 0.2, 0.2);
    EXPECT_TRUE(scene.shadows);
    EXPECT_EQ(scene.far, 0);
    EXPECT_EQ(scene.object_count + scene.vertex_count + scene.fill_count + scene.light_count + scene.dropped,
              0u);
    EXPECT_STREQ(scene.comment, "");
    ASSERT_FALSE(parsed("x"));
    ASSERT_PARSES(view);
    EXPECT_STREQ(error.text, "");
}

TEST(Parser, CommentIsCleanAndFits) {
    ASSERT_PARSES("#\x1b[31mred\tball\x7f\x01 \n" + view);
    EXPECT_STREQ(scene.comment, " [31mred ball  ");
    ASSERT_PARSES(view + "# B\xc3\xa4lle\n# second");
    EXPECT_STREQ(scene.comment, "B\xc3\xa4lle");
    ASSERT_PARSES("#" + std::string(255, 'a') + "\n" + view);
    EXPECT_EQ(scene.comment, std::string(255, 'a'));
    ASSERT_PARSES("#" + std::string(256, 'a') + "\n" + view);
    EXPECT_EQ(scene.comment, std::string(255, 'a'));
    ASSERT_PARSES("#" + std::string(254, 'a') + "\xc3\xa4 and on\n" + view);
    EXPECT_EQ(scene.comment, std::string(254, 'a'));
}

TEST(Parser, ExtremesAreIn) {
    ASSERT_PARSES(
        "v from 1e15 -1e15 0 at 1e-300 0 0 up 0 0 1e-60 angle 1e-9 hither -1e300 resolution 32768 1");
    EXPECT_EQ(scene.view.width, 32768u);
    ASSERT_PARSES(
        "v from 0 0 0 at 1e-60 0 0 up 1 1.1e-9 0 angle 179.99999999999997 hither 1 resolution 1 32768");
    EXPECT_EQ(scene.view.height, 32768u);
    const Fill fill = fill_after("material shine 1e6 texture checker 1 1 1 1e-60");
    EXPECT_EQ(fill.shine, 1e6);
    EXPECT_EQ(fill.texture.size, 1e-60);
}

// What scenes must not say. '@' marks where the message points; it is taken out before parsing.
struct Bad {
    const char* text;
    const char* message; // a part of it
};

void expect_error(const std::string& marked, const std::string& message) {
    SCOPED_TRACE(marked);
    const size_t at = marked.find('@');
    ASSERT_NE(at, std::string::npos);
    size_t line = 1, line_start = 0;
    for (size_t i = 0; i < at; ++i) {
        if (marked[i] == '\n') {
            ++line;
            line_start = i + 1;
        }
    }
    const std::string where =
        "scene.nff:" + std::to_string(line) + ":" + std::to_string(at - line_start + 1) + ": ";
    ASSERT_FALSE(parsed(marked.substr(0, at) + marked.substr(at + 1)));
    const std::string text = error.text;
    EXPECT_EQ(text.substr(0, where.size()), where) << text;
    EXPECT_NE(text.find(message), std::string::npos) << text;
}

TEST(ParserError, Text) {
    EXPECT_FALSE(parsed(view + "s 0 0 0\n"));
    EXPECT_STREQ(error.text, "scene.nff:3:1: the file ends where the radius of a sphere was expected");
    EXPECT_FALSE(parsed(view + "  s 0 zero 0 1"));
    EXPECT_STREQ(error.text,
                 "scene.nff:2:7: expected y of the centre of a sphere, found 'zero', which is not a number");
    EXPECT_FALSE(parsed(view + "f 1 2 1 1 0 1 0 0"));
    EXPECT_STREQ(error.text,
                 "scene.nff:2:5: green of the colour of a fill is 2; expected a number from 0 to 1");
}

TEST(ParserError, LinesEndWithLfCrOrBoth) {
    EXPECT_FALSE(parsed("\r\n\r\r\n\n#\r  x"));
    EXPECT_EQ(std::string(error.text).substr(0, 15), "scene.nff:6:3: ");
}

TEST(ParserError, Structure) {
    const Bad cases[] = {
        {"@", "the file ends without a view; expected 'v'"},
        {"b 0 0 0\n@", "the file ends without a view"},
        {"# only a comment@", "the file ends without a view"},
        {VIEW "@sphere 0 0 0 1", "unknown entity 'sphere'; expected one of v b l f ambientlight sun"},
        {VIEW "@S 0 0 0 1", "unknown entity 'S'"},
        {VIEW "@x", "unknown entity 'x'"},
        {VIEW "@nan", "unknown entity 'nan'"},
        {VIEW "@s0 0 0 1", "unknown entity 's0'"},
        {VIEW "@ppp", "unknown entity 'ppp'"},
        {VIEW "@\"s\"", "unknown entity '\"s\"'"},
        {VIEW "material\n\n@colours",
         "unknown word 'colours' in 'material'; did you mean 'colour'? expected one of colour ambient diffuse "
         "highlight shine mirror transmit ior emission, or an entity"},
        {VIEW "material colour 1 1 1 @Defuse 1", "did you mean 'diffuse'? expected one of colour ambient"},
        {VIEW "material @color 1 0 0", "did you mean 'colour'?"},
        {VIEW "material @trasnmit 1", "did you mean 'transmit'?"},
        {VIEW "material @ball 0 0 0 1", "unknown word 'ball' in 'material'; expected one of colour ambient"},
        {VIEW "material shine 3 @palne 0 0 0", "unknown entity 'palne'; did you mean 'plane'? expected one of v b l"},
        {VIEW "@Material shine 3", "unknown entity 'Material'; did you mean 'material'? expected"},
        {VIEW "@ambient_light 1 1 1", "unknown entity 'ambient_light'; did you mean 'ambientlight'? expected"},
        {VIEW "@dics 0 0 0", "unknown entity 'dics'; did you mean 'disc'? expected"},
        {VIEW "@S 0 0 0 1", "unknown entity 'S'; did you mean 's'? expected"},
        {VIEW "@colour 1 0 0", "found 'colour', which stands in 'material'"},
        {VIEW "s 0 0 0 1 @shine 3", "found 'shine', which stands in 'material'"},
        {VIEW "@at 0 0 0", "found 'at', which stands in 'v'"},
        {VIEW "@checker 0 0 0 1", "found 'checker', which stands in 'texture'"},
        {VIEW "@on", "found 'on', which stands in 'shadows'"},
        {"@1 2 3", "expected an entity, found '1'"},
        {VIEW "s 0 0 0 1 @2", "expected an entity, found '2'; the 's' in line 2 is complete without it"},
        {VIEW "\n\nmaterial ior 2\n@-x", "found '-x'; the 'material' in line 4 is complete"},
        {VIEW "l 1 2 3 4 5 6 @7", "the 'l' in line 2 is complete"},
        {VIEW "s 0 0 0\n@s 0 0 0 1", "expected the radius of a sphere, found 's'"},
        {"@s 0 0 0 1\n" VIEW, "an object before the view; expected 'v' first"},
        {"@s 0 0 0 0\n" VIEW, "an object before the view"},
        {"@p 3 0 0 0 1 0 0 0 1 0\n" VIEW, "an object before the view"},
        {"@pp", "an object before the view"},
        {"@c", "an object before the view"},
        {"@plane", "an object before the view"},
        {"f 1 1 1 1 0 1 0 1\n@disc", "an object before the view"},
        {VIEW "s 0 0 0 1\ns 1 1 1 1\n@l 1 2 3", "a light after the first object, which is in line 2"},
        {VIEW "s 0 0 0 0\n@sun 1 2 3", "a light after the first object, which is in line 2"},
        {VIEW "\n @v from", "a second view; the first is in line 1"},
        {VIEW "s 0 0 0 1 @v", "a second view"},
        {VIEW "shadows @On", "expected 'on' or 'off' after 'shadows', found 'On'"},
        {VIEW "shadows@", "the file ends where 'on' or 'off' after 'shadows' was expected"},
        {VIEW "shadows @1", "expected 'on' or 'off'"},
    };
    for (const Bad& bad : cases)
        expect_error(bad.text, bad.message);
}

TEST(ParserError, Bytes) {
    const struct {
        std::string text;
        const char* byte;
    } cases[] = {
        {view + "s 0 @" + std::string(1, '\0') + " 0 1", "0x00"},
        {view + "s 0 0 0 1@\x1b[0m", "0x1b"},
        {view + "@\x7f", "0x7f"},
        {view + "material @\x80", "0x80"},
        {view + "l 1 2 3 @\xff", "0xff"},
        {view + "texture @\x01", "0x01"},
        {view + "shadows o@\xc3\xb6n", "0xc3"},
        {view + "p @\x02", "0x02"},
        {"v fr@\x03om", "0x03"},
    };
    for (const auto& [text, byte] : cases)
        expect_error(text, std::string("found the byte ") + byte + "; outside");
}

TEST(ParserError, View) {
    const Bad cases[] = {
        {"v@", "the file ends where the field 'from' of 'v' was expected"},
        {"v @at 0 0 0", "expected the field 'from' of 'v', found 'at'"},
        {"v from 0 0 5 @up 0 1 0", "expected the field 'at' of 'v', found 'up'"},
        {"v from 0 0 5 @6 at", "expected the field 'at' of 'v', found '6'"},
        {"v from 0 0 5 at 0 0 0\n@angle 45", "expected the field 'up' of 'v', found 'angle'"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 @hither", "expected the field 'angle' of 'v', found 'hither'"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 @resolution", "expected the field 'hither' of 'v', found"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 @s",
         "expected the field 'resolution' of 'v', found 's'"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1\n@",
         "the file ends where the field 'resolution' of 'v' was expected"},
        {"v from 0 0@", "the file ends where z of 'from' was expected"},
        {"v from 1 2 3 at @1 2 3 up 0 1 0", "'at' is where 'from' is"},
        {"v from 1 2 3 at @1 2 3.0 up 0 1 0", "'at' is where 'from' is"},
        {"v from 0 0 0 at @0 1e-61 0 up 0 1 0", "'at' is where 'from' is"},
        {"v from 0 0 5 at 0 0 0 up @0 0 0", "'up' is zero"},
        {"v from 0 0 5 at 0 0 0 up @0 0 7", "'up' lies along the view"},
        {"v from 0 0 5 at 0 0 0 up @0 0 -1e-9", "'up' lies along the view"},
        {"v from 1 2 3 at 2 4 6 up @0.1 0.2 0.3", "'up' lies along the view"},
        {"v from 0 0 0 at 1 0 0 up @1 0.9e-9 0", "'up' lies along the view"},
        {"v from 0 0 0 at 1e-60 0 0 up @1e-60 0.9e-69 0", "'up' lies along the view"},
        {"v from 0 0 0 at 1e15 0 0 up @1e15 0.9e6 0", "'up' lies along the view"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle @0", "'angle' is 0; expected a number above 0 and below 180"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle @180", "'angle' is 180; expected"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle @-45", "'angle' is -45; expected"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle @1e-400", "'angle' is 1e-400; expected"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither @inf",
         "expected 'hither', found 'inf', which is not a finite"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @0 3",
         "the width of 'resolution' is 0; expected at least 1"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4 @0",
         "the height of 'resolution' is 0"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4 @32769",
         "the height of 'resolution' is 32769; expected at most 32768 (limit 'resolution')"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @99999999999999999999 4",
         "the width of 'resolution' is 99999999999999999999; expected at most 32768"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @-4 3",
         "expected the width of 'resolution', found '-4', which is negative"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @4.5 3",
         "expected the width of 'resolution', found '4.5', which is not a whole number"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4 @1e-3",
         "found '1e-3', which is not a whole number"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @1e400 3",
         "found '1e400', which is too large for a number"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution @inf 3",
         "expected the width of 'resolution', found 'inf', which is not a finite number"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4 @x",
         "expected the height of 'resolution', found 'x', which is not a number"},
        {"v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 0 resolution 4@",
         "the file ends where the height of 'resolution' was expected"},
    };
    for (const Bad& bad : cases)
        expect_error(bad.text, bad.message);
}

TEST(ParserError, Numbers) {
    const char* const plain = "which is not a number in plain decimal or e-notation";
    const Bad cases[] = {
        {VIEW "s 0 0 0 @1.2.3", plain},
        {VIEW "s 0 0 0 @12abc", plain},
        {VIEW "s 0 0 0 @0x10", plain},
        {VIEW "s 0 0 0 @1e", plain},
        {VIEW "s 0 0 0 @1,5", plain},
        {VIEW "s 0 0 0 @--1", plain},
        {VIEW "s 0 0 0 @-", plain},
        {VIEW "s 0 0 0 @.", plain},
        {VIEW "s 0 0 0 @nan", "found 'nan', which is not a finite number"},
        {VIEW "s @inf 0 0 1",
         "expected x of the centre of a sphere, found 'inf', which is not a finite number"},
        {VIEW "s 0 @-Infinity 0 1",
         "y of the centre of a sphere, found '-Infinity', which is not a finite number"},
        {VIEW "s 0 0 @1e400 1",
         "z of the centre of a sphere, found '1e400', which is too large for a number"},
        {VIEW "s 0 0 0 @-1e400", "found '-1e400', which is too large for a number"},
        {VIEW "s 0 0 0 @one", "found 'one', which is not a number"},
        {VIEW "s @1.1e15 0 0 1",
         "x of the centre of a sphere is 1.1e15; expected a number from -1e15 to 1e15"},
        {VIEW "s 0 0 @-1e300 1", "z of the centre of a sphere is -1e300; expected"},
        {VIEW "s 0 0 0 @-2e15", "the radius of a sphere is -2e15; expected a number from -1e15 to 1e15"},
        {VIEW "l @1e16 0 0", "x of the place of a light is 1e16"},
        {VIEW "sun 0 @1e16 0", "y of the direction of a sun is 1e16"},
        {VIEW "disc 0 0 0 0 @1e16 0 1", "y of the normal of a disc is 1e16"},
        {VIEW "disc 0 0 0 0 1 0 @1e16", "the radius of a disc is 1e16"},
        {VIEW "c 0 0 0 @1e16 1 0 0 1", "the base radius of a cone is 1e16"},
        {VIEW "p 3 0 0 0 1 0 @1e16", "z of a vertex of a polygon is 1e16"},
        {VIEW "pp 3 0 0 0 0 0 1 @1e16", "x of a vertex of a patch is 1e16"},
        {"v from 0 @1e16 0", "y of 'from' is 1e16"},
        {VIEW "s 0 0 0 @aaaaaaaaaabbbbbbbbbbccccccccccddddddddddeeeeeeeeee",
         "found 'aaaaaaaaaabbbbbbbbbbccccccccccddddddd...', which"},
        {VIEW "s 0 0 0 @aaaaaaaaaabbbbbbbbbbccccccccccdddddddddd",
         "found 'aaaaaaaaaabbbbbbbbbbccccccccccdddddddddd', which"},
    };
    for (const Bad& bad : cases)
        expect_error(bad.text, bad.message);
}

TEST(ParserError, Ranges) {
    const char *const share = "expected a number from 0 to 1", *const light =
                                                                   "expected a number from 0 to 64";
    const char *const shine = "expected a number from 0 to 1e6", *const ior =
                                                                     "expected a number from 0.125 to 8";
    const char* const above = "expected a number above 0";
    const Bad cases[] = {
        {"b @-0.1 0 0", "red of the background is -0.1; expected a number from 0 to 64"},
        {"b 0 @64.1 0", light},
        {"ambientlight 0 0 @65", "blue of the ambient light is 65; expected a number from 0 to 64"},
        {"ambientlight @-1e-300 0 0", light},
        {"l 0 0 0 1 @65 1", "green of the colour of a light is 65; expected a number from 0 to 64"},
        {"sun 0 1 0 1 1 @-1", "blue of the colour of a light is -1"},
        {"panel @0 0 0 0 1 0 0 0 1 0", "the number of places of a panel is 0; expected at least 1"},
        {"panel @17 0 0 0 1 0 0 0 1 0", "the number of places of a panel is 17; expected at most 16 (limit 'places')"},
        {"panel 4 0 0 0 1 0 0 0 1@", "the file ends where z of v of a panel was expected"},
        {"panel 4 0 0 0 1 0 0 0 1 0 1 1 @65", "blue of the colour of a light is 65"},
        {"f @1.1 1 1 1 1 1 1 1", "red of the colour of a fill is 1.1; expected a number from 0 to 1"},
        {"f 1 @-0.5 1 1 1 1 1 1", share},
        {"f 1 1 @1.0000000000000003 1 1 1 1 1", share},
        {"f 1 1 1 1 1 @-0.5 1 1", "the shine of a fill is -0.5; expected a number from 0 to 1e6"},
        {"f 1 1 1 1 1 @1000001 1 1", shine},
        {"material ior @0.12", ior},
        {"material ior @1e-300", ior},
        {"material colour 0 0 @2", "blue of 'colour' is 2; expected a number from 0 to 1"},
        {"material ambient @1.1", "'ambient' is 1.1; expected a number from 0 to 1"},
        {"material diffuse @-0.1", "'diffuse' is -0.1; expected a number from 0 to 1"},
        {"material highlight @2", "'highlight' is 2; expected a number from 0 to 1"},
        {"material shine @1e7", "'shine' is 1e7; expected a number from 0 to 1e6"},
        {"material mirror @2", "'mirror' is 2; expected a number from 0 to 1"},
        {"material transmit @2", "'transmit' is 2; expected a number from 0 to 1"},
        {"material emission @64.5", "'emission' is 64.5; expected a number from 0 to 64"},
        {"material ior @9", "'ior' is 9; expected a number from 0.125 to 8"},
        {"texture checker 1 @-1 1 1",
         "green of the colour of a texture is -1; expected a number from 0 to 1"},
        {"texture checker 1 1 1 @0", "the size of a texture is 0; expected a number above 0"},
        {"texture wood 1 1 1 @-2 0 1 0", above},
        {"texture noise 1 1 1 @1e16", above},
        {"texture noise 1 1 1 @1e-61", above},
        {"far @0", "'far' is 0; expected a number above 0"},
        {"radiosity @0", "'radiosity' is 0; expected a number above 0, from 1e-60 to 1e15"},
        {"radiosity @-2", "'radiosity' is -2; expected a number above 0, from 1e-60 to 1e15"},
        {"radiosity @off", "found 'off', which is not a number"},
        {"far @-3", above},
        {"far @1e-400", above},
    };
    for (const Bad& bad : cases)
        expect_error(bad.text, bad.message);
}

TEST(ParserError, Shapes) {
    const Bad cases[] = {
        {VIEW "p @2 0 0 0 1 0 0", "the number of vertices of a polygon is 2; expected at least 3"},
        {VIEW "p @0", "the number of vertices of a polygon is 0; expected at least 3"},
        {VIEW "pp @1", "the number of vertices of a patch is 1; expected at least 3"},
        {VIEW "p @-3", "expected the number of vertices of a polygon, found '-3', which is negative"},
        {VIEW "p @3.5 0 0 0", "found '3.5', which is not a whole number"},
        {VIEW "pp @s", "expected the number of vertices of a patch, found 's'"},
        {VIEW "p@", "the file ends where the number of vertices of a polygon was expected"},
        {VIEW "p 3 0 0 0 1 0 0 0 1@", "the file ends where z of a vertex of a polygon was expected"},
        {VIEW "p 4 0 0 0 1 0 0 0 1 0\n@s 0 0 0 1", "expected x of a vertex of a polygon, found 's'"},
        {VIEW "pp 3 0 0 0 0 0 1 1 0 0 0 0 @p", "expected z of a normal of a patch, found 'p'"},
        {VIEW "pp 3 0 0 0 0 0 1 1 0 0 @0 0 0 0 1 0 0 0 1", "a normal of a patch is zero"},
        {VIEW "pp 3 0 0 0 @1e-61 0 0 1 0 0 0 0 1 0 1 0 0 0 1", "a normal of a patch is zero"},
        {VIEW "plane 0 0 0 @0 0 0", "the normal of a plane is zero; expected a vector with a direction"},
        {VIEW "disc 0 0 0 @0 -0 0 1", "the normal of a disc is zero"},
        {VIEW "disc 0 0 0 @0 0 0 0", "the normal of a disc is zero"},
        {VIEW "c 1 2 3 1 @1 2 3 1", "the apex of a cone is where its base is"},
        {VIEW "c 1 2 3 0 @1 2 3 0", "the apex of a cone is where its base is"},
        {VIEW "c 0 0 0 1 @0 0 1e-61 1", "the apex of a cone is where its base is"},
        {VIEW "sun @0 0 0", "the direction of a sun is zero"},
        {VIEW "texture stripes 0 0 0 1 @0 0 0", "the axis of a texture is zero"},
        {VIEW "texture gradient 0 0 0 1 @0 0 0", "the axis of a texture is zero"},
        {VIEW "texture marble 0 0 0 1 @0 0 0", "the axis of a texture is zero"},
        {VIEW "texture wood 0 0 0 1 @0 0 0", "the axis of a texture is zero"},
        {VIEW "texture globe @a.bmp 0 0 0", "cannot read 'a.bmp': there is none; expected an image"},
        {VIEW "texture image@", "the file ends where an image, BMP or PPM was expected"},
        {VIEW "texture @tartan 0 0 0 1", "expected a texture (checker "}, // and all others
        {VIEW "texture @tartan 0 0 0 1", "), found 'tartan'"},
        {VIEW "texture @marbel 0 0 0 1",
         "unknown texture 'marbel'; did you mean 'marble'? expected one of checker stripes"},
        {VIEW "texture@", "the file ends where a texture"},
        {VIEW "texture @1", "expected a texture"},
        {VIEW "texture brick 0 0 0@", "the file ends where the size of a texture was expected"},
        {VIEW "texture wood 0 0 0 1 @s", "expected x of the axis of a texture, found 's'"},
        {VIEW "texture checker 0 0 0 1 @1 0 0", "expected an entity, found '1'; the 'texture' in line 2"},
    };
    for (const Bad& bad : cases)
        expect_error(bad.text, bad.message);
}

// Each entity, cut after any of its tokens: the end is missed, where the text ends.
TEST(ParserError, EarlyEnd) {
    const char* const entities[] = {
        "v from 0 0 5 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 4 3",
        VIEW "b 0 0 0",
        VIEW "l 1 2 3 1 1 1",
        VIEW "f 1 1 1 1 0 1 0 1",
        VIEW "s 0 0 0 1",
        VIEW "c 0 0 0 1 1 0 0 1",
        VIEW "p 3 0 0 0 1 0 0 0 1 0",
        VIEW "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1",
        VIEW "ambientlight 1 1 1",
        VIEW "sun 0 1 0 1 1 1",
        VIEW "material colour 1 0 0",
        VIEW "material ior 1",
        VIEW "plane 0 0 0 0 1 0",
        VIEW "disc 0 0 0 0 1 0 1",
        VIEW "texture wood 0 0 0 1 0 1 0",
        VIEW "shadows on",
        VIEW "far 1",
    };
    for (const char* entity : entities) {
        const std::string text = entity;
        ASSERT_PARSES(text);
        const size_t newline = text.find('\n'), start = newline == std::string::npos ? 0 : newline + 1;
        for (size_t i = start; (i = text.find(' ', i)) != std::string::npos; ++i) {
            const std::string cut = text.substr(start, i - start);
            // These are whole without the rest.
            if (cut == "material" || cut == "l 1 2 3" || cut == "sun 0 1 0") {
                ASSERT_PARSES(text.substr(0, i));
                continue;
            }
            expect_error(text.substr(0, i) + "@", "the file ends where ");
            expect_error(text.substr(0, i) + "\n@", "the file ends where ");
        }
    }
}

TEST(ParserError, Names) {
    EXPECT_FALSE(parsed("x", "-"));
    EXPECT_EQ(std::string(error.text).substr(0, 6), "-:1:1:");
    EXPECT_FALSE(parsed("x", "a\n\x1b[b"));
    EXPECT_EQ(std::string(error.text).substr(0, 17), "a\\x0a\\x1b[b:1:1: ");
    const std::string path = std::string(5000, '/') + "\xc3\xa4/scene.nff";
    EXPECT_FALSE(parsed("x", path.c_str()));
    EXPECT_EQ(std::string(error.text).substr(0, 10), "...///////");
    EXPECT_NE(std::string(error.text).find("\xc3\xa4/scene.nff:1:1: unknown entity 'x'"), std::string::npos);
    EXPECT_FALSE(parsed("x", std::string(5000, '\n').c_str()));
    EXPECT_NE(std::string(error.text).find("\\x0a:1:1: unknown entity 'x'"), std::string::npos);
}

TEST(ParserLimit, Lights) {
    std::string text = view;
    for (int i = 0; i < 64; ++i)
        text += i % 2 != 0 ? "l 0 0 0\n" : "sun 1 1 1\n";
    ASSERT_PARSES(text);
    EXPECT_EQ(scene.light_count, 64u);
    expect_vector(scene.lights[63].colour, 0.125, 0.125, 0.125);
    expect_error(text + "@l 0 0 0", "too many lights; expected at most 64 (limit 'lights')");
    expect_error(text + "@sun 0 1 0", "too many lights; expected at most 64 (limit 'lights')");
}

TEST(ParserLimit, Materials) {
    std::string text = view;
    for (int round = 0; round < 2; ++round) {
        for (int i = 0; i < 4096; ++i)
            text += "material shine " + std::to_string(i) + " s 0 0 0 1\n";
    }
    text += "material shine 4096 s 0 0 0 0\n"; // without extent, so its fill is not used
    ASSERT_PARSES(text);
    EXPECT_EQ(scene.object_count, 8192u);
    ASSERT_EQ(scene.fill_count, 4096u);
    for (uint32_t i = 0; i < 4096; ++i) {
        ASSERT_EQ(scene.fills[i].shine, i);
        ASSERT_EQ(scene.objects[i].fill, i);
        ASSERT_EQ(scene.objects[i + 4096].fill, i);
    }
    expect_error(text + "@s 0 0 0 1", "too many different fills; expected at most 4096 (limit 'materials')");
}

// As NFF bounds none of them; a colour and the shine are still errors.
TEST(Parser, ClampsWhatOneLetterFillsHaveOutOfRange) {
    const Fill fill = fill_after("f 1 1 1 1.5 -1 5 2 9");
    EXPECT_EQ(fill.ambient, 1);
    EXPECT_EQ(fill.diffuse, 1);
    EXPECT_EQ(fill.highlight, 0);
    EXPECT_EQ(fill.mirror, 0);
    EXPECT_EQ(fill.shine, 5);
    EXPECT_EQ(fill.transmit, 1);
    EXPECT_EQ(fill.ior, 8);
    EXPECT_EQ(scene.clamped.count, 4u);
    EXPECT_EQ(scene.clamped.line, 2u);
    EXPECT_EQ(scene.clamped.column, 9u);
    EXPECT_STREQ(scene.clamped.text, "Kd of a fill is 1.5, outside of 0 to 1; 1 is taken");
    EXPECT_EQ(fill_after("f 1 1 1 1 1 5 1\n1e-300").ior, 0.125);
    EXPECT_EQ(scene.clamped.count, 1u);
    EXPECT_EQ(scene.clamped.line, 3u);
    EXPECT_EQ(scene.clamped.column, 1u);
    EXPECT_STREQ(scene.clamped.text, "the ior of a fill is 1e-300, outside of 0.125 to 8; 0.125 is taken");
    EXPECT_EQ(fill_after("f 0 0 0 0 1 5 0 -3").ior, 1);
    EXPECT_EQ(scene.clamped.count, 0u);
    expect_error(view + "f 1 1 1 2 2 2 2 @x", "expected the ior of a fill, found 'x'");
    expect_error(view + "f 1 1 1 1 1 1 @1e999 1", "too large for a number");
}

TEST(Parser, ByteOrderMarks) {
    ASSERT_PARSES("\xef\xbb\xbf" + view + "s 0 0 0 1");
    EXPECT_EQ(scene.object_count, 1u);
    EXPECT_FALSE(parsed("\xef\xbb\xbf x"));
    EXPECT_EQ(std::string(error.text).find("scene.nff:1:2: unknown entity 'x'"), 0u) << error.text;
    for (const int bytes : {2, 4})
        for (const bool little : {false, true})
            for (const bool mark : {false, true}) {
                std::string text;
                const auto put = [&](int c) {
                    for (int i = 0; i < bytes; i++)
                        text += static_cast<char>(c >> 8 * (little ? i : bytes - 1 - i));
                };
                if (mark)
                    put(0xfeff);
                for (const char c : view)
                    put(c);
                EXPECT_FALSE(parsed(text));
                EXPECT_EQ("scene.nff:1:1: the text is in UTF-" + std::to_string(8 * bytes)
                              + "; expected ASCII or UTF-8",
                          error.text);
            }
    expect_error(view + "@\xef\xbb\xbf", "found the byte 0xef");
}

// Of the shortest texts of so many objects and corners, in a room of just the size that is asked for.
TEST(Parser, RoomIsEnough) {
    const std::string corners = " 0 0 0 1 0 0 0 1 0 1 1 1 2 2 2 3 3 3 4 4 4";
    std::string spheres, polygon = "p 1400";
    for (int i = 0; i < 1000; i++)
        spheres += "s 0 0 0 1 ";
    for (int i = 0; i < 200; i++)
        polygon += corners;
    for (const std::string& text :
         {view + spheres, view + polygon, view + polygon + " 0", view + "pp 9 0 0 0 0 0 1 0"}) {
        Description tight;
        const size_t bytes = tight.lay_out(text.size());
        std::vector<uint8_t> room(bytes + Layout::alignment);
        uint8_t* const at = room.data() + (-reinterpret_cast<uintptr_t>(room.data()) & (Layout::alignment - 1));
        tight.room = {at, bytes};
        parse("x", text.data(), text.size(), tight, error);
        EXPECT_EQ(std::string(error.text).find("memory"), std::string::npos) << error.text;
        tight.room.size = bytes - 1;
        EXPECT_FALSE(parse("x", text.data(), text.size(), tight, error));
        EXPECT_STREQ(error.text, "x:1:1: not enough memory");
    }
}

// Meshes.

TEST(ParserMesh, Forms) {
    beside = {{"a.obj", "# a square, in all forms\nv 0 0 0\nv 1 0 0 1\n"
                        "v 1 \\\n 1 \\\r\n\t0\nv 0 1 0\nvn 0 0 2\nvn 1 0 \\\n1\n"
                        "vt 0 0\n"
                        "f 1 2 3 4\nf -4/1 2/1/1 -2 \\\n 4//1\nf 1//1 2/7/1 3//2 -1//-2\n\r\n"
                        "usemtl x \xc3\xb6 f\nf 4 4 1\nf 1 3 3\n"}};
    ASSERT_PARSES(view + "material s 5 0 0 1 mesh a.obj s 6 0 0 1 "
                         "material colour 1 0 0 mesh a.obj 2 10 20 30.5 s 7 0 0 1");
    ASSERT_EQ(scene.object_count, 3u + 2 * 5);
    EXPECT_EQ(scene.dropped, 4u);
    EXPECT_EQ(scene.fill_count, 2u);
    for (uint32_t i : {1u, 2u, 3u, 4u}) {
        EXPECT_EQ(scene.objects[i].kind, Kind::polygon);
        EXPECT_EQ(scene.objects[i].count, 3u);
        const Vec3d* v = scene.vertices + scene.objects[i].vertex;
        expect_vector(v[0], 0, 0, 0);
        expect_vector(v[1], 1, i % 2 == 0, 0);
        expect_vector(v[2], i % 2, 1, 0);
    }
    for (uint32_t i : {5u, 11u}) {
        const Object& o = scene.objects[i];
        EXPECT_EQ(o.kind, Kind::patch);
        EXPECT_EQ(o.line, 2u);
        EXPECT_EQ(o.fill, i / 7);
        ASSERT_EQ(o.count, 4u);
        for (uint32_t k : {0u, 1u, 3u})
            expect_vector(scene.normals[o.vertex + k], 0, 0, 2);
        expect_vector(scene.normals[o.vertex + 2], 1, 0, 1);
    }
    const uint32_t scaled = scene.objects[11].vertex;
    expect_vector(scene.vertices[scaled], 10, 20, 30.5);
    expect_vector(scene.vertices[scaled + 2], 12, 22, 30.5);
    expect_vector(scene.objects[12].a, 7, 0, 0);
    EXPECT_EQ(scene.passed_over.count, 2u);
    EXPECT_STREQ(scene.passed_over.text, "passed over in 'a.obj': 3 lines, the first 'v' in line 3");
}

// What is found where, and that a scene's tables grow with what they hold.
TEST(ParserMesh, IsBesideTheScene) {
    std::string mesh = "v 0 0 0 v\nv 1 0 0\nv 0 1 0\n";
    for (int i = 0; i < 500; i++)
        mesh += "f 1 2 3\n";
    beside = {{"x/a.obj", mesh}, {"/b/a.obj", mesh}};
    const std::string text = view + "s 1 2 3 4 mesh a.obj pp 3 0 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1 mesh /b/a.obj "
                                    "mesh a.obj s 5 6 7 8";
    Description small;
    grow(small.room, small.lay_out(text.size()));
    ASSERT_TRUE(parse("x/y.nff", text.data(), text.size(), small, error, &files)) << error.text;
    ASSERT_EQ(small.object_count, 1503u);
    expect_vector(small.objects[0].a, 1, 2, 3);
    expect_vector(small.objects[1502].a, 5, 6, 7);
    for (uint32_t i = 1; i < 1502; i++) {
        ASSERT_EQ(small.objects[i].kind, i == 501 ? Kind::patch : Kind::polygon);
        const uint32_t v = small.objects[i].vertex;
        ASSERT_EQ(v, 3 * (i - 1));
        expect_vector(small.vertices[v + 1], 1, 0, 0);
    }
    expect_vector(small.normals[1500], 0, 0, 1);
    std::free(small.room.at);
    std::free(small.files.room.at);
    EXPECT_FALSE(parsed(text));
    EXPECT_STREQ(error.text, "scene.nff:2:16: cannot read 'a.obj': there is none; expected a Wavefront OBJ file");
    EXPECT_FALSE(parsed(view + "mesh " + std::string(5000, 'x')));
    EXPECT_NE(std::string(error.text).find("': the name is too long; expected"), std::string::npos) << error.text;
    EXPECT_FALSE(parse("a", text.data(), text.size(), scene, error));
    EXPECT_STREQ(error.text, "a:2:16: cannot read 'a.obj': the scene has no folder; expected a Wavefront OBJ file");
}

// @ stands where the fault is.
TEST(ParserMesh, ErrorsNameTheLineOfTheMesh) {
    const struct {
        std::string mesh;
        const char* message;
    } cases[] = {
        {"@", "the file ends where 'f' and a face was expected"},
        {"v 0 0 0\nvn 0 0 1\n@", "the file ends where 'f' and a face was expected"},
        {"v 0 0 @", "the file ends where z of a vertex was expected"},
        {"v 0 0 @\xff", "found the byte 0xff"},
        {"v 0 0 0\n@\xffo", "found the byte 0xff"},
        {"v 1 2\n@vn 1 2 3", "expected z of a vertex, found 'vn', which is not a number"},
        {"v 1 2\n@3\n", "expected z of a vertex in the line before, found '3'"},
        {"v 0 0 0\nvn \n\n@1 2 3\n", "expected x of a normal in the line before, found '1'"},
        {"v 1 \\\n2\n@3\n", "expected z of a vertex in the line before, found '3'"},
        {"v 1 \\\n@x 3\n", "expected y of a vertex, found 'x'"},
        {"v 1 @nan 0", "expected y of a vertex, found 'nan'"},
        {"v 1 @1e16 0", "y of a vertex is 1e16; expected a number from -1e15 to 1e15"},
        {"vn @0 0 0", "a normal is zero; expected a vector with a direction"},
        {"@3 1 2 3", "expected a word such as 'v' or 'f', found '3'"},
        {"v 0 0 0\n@f 1 1\nf 1 1 1", "a face of 2 corners; expected at least 3"},
        {"@f", "a face of 0 corners; expected at least 3"},
        {"v 0 0 0\nf 1 @2 1", "'2' names vertex 2; expected one of the 1 before it"},
        {"v 0 0 0\nf 1 1 @0//1", "'0//1' names vertex 0; expected one of the 1 before it"},
        {"v 0 0 0\nf 1 1 @-2", "'-2' names vertex -2; expected"},
        {"v 0 0 0\nf @1//1 1 1", "'1//1' names normal 1; expected one of the 0 before it"},
        {"v 0 0 0\nvn 0 0 1\nf @1//0 1 1", "'1//0' names normal 0; expected one of the 1 before it"},
        {"v 0 0 0\nvn 0 0 1\nf 1 1 @1/1/-0", "'1/1/-0' names normal 0; expected one of the 1 before it"},
        {"v 0 0 0\nf 1 @1/ 1", "expected a corner such as 3, 3/1, 3//2 or 3/1/2, found '1/'"},
        {"v 0 0 0\nf 1 @1/1/1/1 1", "expected a corner"},
        {"v 0 0 0\nf 1 @1// 1", "expected a corner"},
        {"v 0 0 0\nf 1 @1.5 1", "expected a corner"},
        {"v 0 0 0\nf 1 @99999999999999999999 1", "expected a corner"},
        {"v 0 0 0\nf 1 1 @\xfe", "found the byte 0xfe"},
        {"v 0 1e14 0\nf @1 1 1", "the scaled vertex has a coordinate of 2e+15; expected a number from -1e15 to 1e15"},
    };
    for (const auto& [marked, message] : cases) {
        SCOPED_TRACE(marked);
        const size_t at = marked.find('@'), start = marked.rfind('\n', at) + 1;
        const auto lines = std::count(marked.begin(), marked.begin() + static_cast<ptrdiff_t>(at), '\n');
        beside["bad.obj"] = marked.substr(0, at) + marked.substr(at + 1);
        ASSERT_FALSE(parsed(view + "mesh bad.obj 20 0 0 0"));
        const std::string where = "bad.obj:" + std::to_string(lines + 1) + ":" + std::to_string(at - start + 1) + ": ";
        const std::string text = error.text;
        EXPECT_EQ(text.substr(0, where.size()), where) << text;
        EXPECT_NE(text.find(message), std::string::npos) << text;
    }
    beside["a.obj"] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3";
    const std::pair<std::string, const char*> scenes[] = {
        {view + "mesh@", "the file ends where a Wavefront OBJ file was expected"},
        {view + "mesh a.obj @0 0 0 0", "the scale of a mesh is 0; expected a number above 0"},
        {view + "mesh a.obj 1 2 @s", "expected y of the place of a mesh, found 's'"},
        {view + "mesh a.obj 1 2 3 4 @5", "the 'mesh' in line 2 is complete without it"},
        {"@mesh a.obj", "an object before the view"},
        {view + "mesh a.obj @l 0 0 0", "a light after the first object, which is in line 2"},
    };
    for (const auto& [marked, message] : scenes)
        expect_error(marked, message);
}

// A damaged file is read no farther than it goes, and gets one line.
TEST(ParserMesh, SurvivesBrokenFiles) {
    const std::string whole = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 2\nf 1//1 2//1 3/4/1\nf 1 2 3 -1\n";
    const char alphabet[] = " \n\r#0123456789+-./\\eEfvn\x80";
    uint32_t state = 1, good = 0;
    const auto random = [&state](size_t below) {
        state = state * 1664525 + 1013904223;
        return (state >> 8) % static_cast<uint32_t>(below);
    };
    for (int i = 0; i < 5000; i++) {
        std::string text = whole;
        for (uint32_t n = random(4); n-- > 0;)
            text[random(text.size())] = alphabet[random(sizeof alphabet - 1)];
        beside["bad.obj"] = text.substr(0, random(3) == 0 ? random(text.size()) : text.size());
        if (parsed(view + "mesh bad.obj"))
            good++;
        else
            EXPECT_TRUE(std::string(error.text).starts_with("bad.obj:")) << error.text;
    }
    EXPECT_GT(good, 1000u);
    EXPECT_LT(good, 4000u);
}

TEST(ParserLimit, Objects) {
    std::string text = view;
    for (int i = 0; i < 1'048'576; ++i)
        text += "s 0 0 0 1\n";
    text += "s 0 0 0 0 "; // without extent, so it takes no room
    ASSERT_PARSES(text);
    EXPECT_EQ(scene.object_count, 1'048'576u);
    EXPECT_EQ(scene.dropped, 1u);
    expect_error(text + "@s 0 0 0 1", "too many objects; expected at most 1048576 (limit 'objects')");
}

TEST(ParserLimit, Vertices) {
    expect_error(
        view + "p @3145729 0 0 0",
        "3145729 vertices are too many after the 0 so far; expected at most 3145728 (limit 'vertices')");
    expect_error(
        view + "p 3 0 0 0 1 0 0 0 1 0 pp @3145726",
        "3145726 vertices are too many after the 3 so far; expected at most 3145728 (limit 'vertices')");
    expect_error(view + "p @99999999999999999999", "99999999999999999999 vertices are too many");
    expect_error(view + "p @4294967295", "4294967295 vertices are too many");

    std::string text = view + "p 3145728 1 0 0 0 1 0";
    for (int i = 2; i < 3'145'728; ++i)
        text += " 0 0 0";
    ASSERT_PARSES(text);
    EXPECT_EQ(scene.vertex_count, 3'145'728u);
    expect_error(text + "\np @3", "3 vertices are too many after the 3145728 so far");
}

TEST(ParserLimit, Text) {
    std::string text = view;
    text.resize(size_t{256} << 20, ' ');
    ASSERT_PARSES(text);
    text += ' ';
    EXPECT_FALSE(parsed(text));
    EXPECT_STREQ(error.text,
                 "scene.nff:1:1: a text of 268435457 bytes; expected at most 268435456 (limit 'text')");
}

// No text, however broken, is read beyond its end, and each gives a scene in range or one line of text.
TEST(Parser, SurvivesBrokenTexts) {
    const std::string whole =
        std::string(nff) +
        "material colour 0.5 0.5 0.5 ior 1.5 texture wood 0 0 0 1 0 1 0\n"
        "plane 0 -1 0 0 1 0 disc 1 2 3 1 0 0 1.5e-1 shadows off far 100 ambientlight 0 0 0\n";
    const char alphabet[] = " \n\r\t#0123456789+-.eEinfavblscpmt\x80\x00\x1f";
    uint32_t state = 1;
    const auto random = [&state](size_t below) {
        state = state * 1664525 + 1013904223;
        return (state >> 8) % static_cast<uint32_t>(below);
    };
    uint32_t good = 0, bad = 0;
    for (int i = 0; i < 20'000; ++i) {
        std::string text = whole;
        const uint32_t changes = random(4);
        for (uint32_t n = 0; n != changes && !text.empty(); ++n) {
            const char c = alphabet[random(sizeof alphabet - 1)];
            const uint32_t at = random(text.size());
            switch (random(4)) {
            case 0:
                text[at] = c;
                break;
            case 1:
                text.insert(at, 1, c);
                break;
            case 2:
                text.erase(at, 1 + random(8));
                break;
            default:
                text.resize(at);
                break;
            }
        }
        if (parsed(text)) {
            ++good;
            ASSERT_STREQ(error.text, "");
            ASSERT_LE(scene.object_count, 6u);
            for (uint32_t k = 0; k < scene.object_count; ++k) {
                const Object& object = scene.objects[k];
                ASSERT_LT(object.fill, scene.fill_count);
                ASSERT_LE(object.vertex + object.count, scene.vertex_count);
                ASSERT_TRUE((object.ra >= 0 && object.ra <= 1e15)
                            || (object.kind == Kind::disc && object.ra == HUGE_VAL));
                ASSERT_TRUE(object.rb >= 0 && object.rb <= 1e15);
            }
        } else {
            ++bad;
            ASSERT_EQ(strncmp(error.text, "scene.nff:", 10), 0) << error.text;
            for (const char* c = error.text; *c != 0; ++c)
                ASSERT_TRUE(*c >= 0x20 && *c < 0x7f) << error.text;
        }
    }
    EXPECT_GT(good, 2'000u);
    EXPECT_GT(bad, 2'000u);
}

} // namespace
