// The number system of the study, which rounds each step of the tracer by itself.
#include "scene_helpers.hpp"

#include "../src/study/stepped.hpp"
#include "random.hpp"

#include <fstream>
#include <iterator>

namespace {

using namespace qray;
using namespace qray::test;
using study::Rounding;
using study::Step;
using study::Stepped;
using study::Widths;

TEST(Rounding, IsToTheNearestHalvesUp)
{
    // k / 2^24 to 2^-10, in integers: floor((k + 2^13) / 2^14).
    const Rounding ten(10);
    SplitMix random{1};
    for (int i = 0; i < 100000; i++) {
        const int64_t k = static_cast<int64_t>(random.bits()) >> 33;
        const int64_t rounded = (k + (1 << 13)) >> 14;
        EXPECT_EQ(ten(static_cast<double>(k) * 0x1p-24), static_cast<double>(rounded) * 0x1p-10) << k;
    }
    const Rounding four(4);
    EXPECT_EQ(four(0.5 / 16), 1.0 / 16);
    EXPECT_EQ(four(-0.5 / 16), 0);
    EXPECT_EQ(four(1.5 / 16), 2.0 / 16);
    EXPECT_EQ(four(-1.5 / 16), -1.0 / 16);
    EXPECT_EQ(Rounding(0)(2.5), 3);
}

TEST(Rounding, CutsDownward)
{
    const Rounding four(4, true);
    EXPECT_EQ(four(1.9 / 16), 1.0 / 16);
    EXPECT_EQ(four(2.0 / 16), 2.0 / 16);
    EXPECT_EQ(four(-0.1 / 16), -1.0 / 16);
    EXPECT_EQ(four(-2.0 / 16), -2.0 / 16);
    EXPECT_EQ(Rounding(study::exact, true)(0.1), 0.1);
}

TEST(Rounding, LeavesWhatHasNoMoreBits)
{
    const double all[] = {0.1, -1e300, 0x1p52 + 1, INFINITY, 3.0000000000000004};
    for (double v : all)
        EXPECT_EQ(Rounding(study::exact)(v), v);
    const double even[] = {0x1p51, -0x1p49, 1e300, INFINITY, -INFINITY, 40.25};
    for (double v : even)
        EXPECT_EQ(Rounding(2)(v), v);
    EXPECT_TRUE(std::signbit(Rounding(study::exact)(-0.0)));
    EXPECT_TRUE(std::isnan(Rounding(10)(NAN)));
}

TEST(Rounding, OfSignificantBitsGoesWithTheFirst)
{
    EXPECT_EQ(study::significant(1 + 0x1p-15, 15, 1), 1 + 0x1p-14); // half a step of 2^-14
    EXPECT_EQ(study::significant(1 + 0x1p-16, 15, 1), 1);
    EXPECT_EQ(study::significant(100.3, 8, 100.3), 100.5); // steps of 2^-1 from 64 on
    EXPECT_EQ(study::significant(0.3, 8, 100.3), 0.5);     // as large ones have them
    EXPECT_EQ(study::significant(-0x1.23p-30, 5, 0x1p-30), -0x1.2p-30);
    EXPECT_EQ(study::significant(0, 5, 0), 0);
    EXPECT_EQ(study::significant(0.1, study::exact, 0.1), 0.1);
}

Picture stepped(const std::string& text, const Widths& widths)
{
    study::set(widths);
    EXPECT_TRUE(loaded<Stepped>(text));
    study::round_tables(storage<Stepped>());
    return draw<Stepped, study::stepped_effects<false>()>();
}

// Of scenes/, in a size.
std::string scene_of(const std::string& name, const std::string& size)
{
    std::ifstream file("scenes/" + name + ".nff");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const size_t at = text.find("resolution ");
    return text.substr(0, at) + "resolution " + size + text.substr(text.find('\n', at));
}

TEST(Stepped, IsDoubleWhereNothingIsRounded)
{
    for (const char* name : {"glass", "showcase", "castle", "cornell"}) {
        const std::string text = scene_of(name, "32 24");
        ASSERT_TRUE(loaded<Double>(text));
        EXPECT_EQ(stepped(text, Widths()), draw<Double>()) << name;
    }
}

TEST(Stepped, RoundsColours)
{
    // 0.3 is 4.8 / 16, 0.6 is 9.6 / 16 and 9 / 32 is half way from 4 / 16 to 5 / 16.
    const std::string text = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 1 1\n b 0.3 0.6 0.28125\n";
    Widths w;
    EXPECT_EQ(stepped(text, w).rgb, (std::vector<uint8_t>{77, 153, 72}));
    w[Step::colour] = 4;
    EXPECT_EQ(stepped(text, w).rgb, (std::vector<uint8_t>{80, 159, 80})); // 5, 10 and 5 / 16 of 255, to the nearest
}

TEST(Stepped, RoundsCoordinatesAfterTheBuildersScale)
{
    // Black between two white figures from x = -0.6 to 0.6; with one bit behind the point from -0.5 to 0.5, and where
    // what is larger than 62 is scaled by 1/2, which makes them +-0.3, from -1 to 1.
    for (const auto& [far, edge] : {std::pair{20, 0.5}, {70, 1.0}}) {
        char text[400];
        snprintf(text, sizeof text,
                 "v from 0 0 32 at 0 0 0 up 0 1 0 angle %.17g hither 1 resolution 40 1\n ambientlight 1 1 1\n"
                 "material colour 1 1 1 ambient 1 diffuse 0\n p 4 0.6 -%d 0 %d -%d 0 %d %d 0 0.6 %d 0\n"
                 "p 4 -0.6 -%d 0 -%d -%d 0 -%d %d 0 -0.6 %d 0\n",
                 std::atan(0.05 / 32) * 360 / M_PI, far, far, far, far, far, far, far, far, far, far, far, far);
        Widths w;
        w[Step::coordinate] = 1;
        const Picture exact = stepped(text, Widths()), coarse = stepped(text, w);
        for (uint32_t i = 0; i < 40; i++) {
            const double x = std::fabs((i + 0.5) * 0.1 - 2); // of the pixel's middle
            EXPECT_EQ(exact.at(i, 0).r, x > 0.6 ? 255 : 0) << x;
            EXPECT_EQ(coarse.at(i, 0).r, x > edge ? 255 : 0) << x << " " << far;
        }
    }
}

TEST(Stepped, CutsSharesOfColours)
{
    // What is painted 0.9, 0.5 and 0.05 under light of 1: 14.4, 8 and 0.8 of 16.
    const std::string text = "v from 0 0 5 at 0 0 0 up 0 1 0 angle 40 hither 1 resolution 1 1\n ambientlight 1 1 1\n"
                             "material colour 0.9 0.5 0.05 ambient 1 diffuse 0\n s 0 0 0 1\n";
    Widths w;
    EXPECT_EQ(stepped(text, w).rgb, (std::vector<uint8_t>{230, 128, 13}));
    w[Step::share] = 4;
    EXPECT_EQ(stepped(text, w).rgb, (std::vector<uint8_t>{223, 128, 16})); // 14, 8 and 1 of 16
    w.cuts[static_cast<int>(Step::share)] = true;
    EXPECT_EQ(stepped(text, w).rgb, (std::vector<uint8_t>{223, 128, 0})); // 14, 8 and 0
}

TEST(Stepped, RaysStartOffTheSurfaceByBitsOfTheHitPoint)
{
    // Above the middle of a mirror, a ceiling 0.2 away that ends at x = 0.1: a ray that comes down at 45 degrees along
    // x and starts h above the mirror meets it 0.2 - h farther on. With 5 bits of a point, h is 2 / 32 or 6 / 32. So
    // large a scene is not scaled.
    const std::string text = "v from -80 80 0 at 0 0 0 up 0 0 1 angle 0.001 hither 1 resolution 1 1\n b 0 0 0\n"
                             "ambientlight 1 1 1\n material colour 0 0 0 mirror 1\n p 4 -1 0 -1 -1 0 1 1 0 1 1 0 -1\n"
                             "material colour 1 1 1 ambient 1 diffuse 0\n"
                             "p 4 0.1 0.2 -1 0.1 0.2 1 1 0.2 1 1 0.2 -1\n";
    Widths w;
    EXPECT_EQ(stepped(text, w).rgb[0], 255);
    w[Step::point] = 5;
    EXPECT_EQ(stepped(text, w).rgb[0], 255); // 0.2 - 1/16 = 0.1375
    w.leave = 6;
    EXPECT_EQ(stepped(text, w).rgb[0], 0); // 0.0125
}

TEST(Stepped, KeepsWhatRoundingTookOfACentre)
{
    // A ball from x = -0.47 to 0.53, in pixels of 0.012. Another beside the picture makes -1 the scene's middle, from
    // where its centre is at 1.03, and 0.03 is less than half of 1 / 16. So large a scene is not scaled.
    char text[300];
    snprintf(text, sizeof text,
             "v from 0 0 80 at 0 0 0 up 0 1 0 angle %.17g hither 1 resolution 100 1\n ambientlight 1 1 1\n"
             "material colour 1 1 1 ambient 1 diffuse 0\n s 0.03 0 0 0.5\n s -2.03 0 0 0.5\n",
             std::atan(0.006 / 80) * 360 / M_PI);
    const Picture exact = stepped(text, Widths());
    Widths w;
    w.blocks = &q32::blocks;
    w.length = q32::Length::frac;
    EXPECT_EQ(stepped(text, w), exact);
    w[Step::coordinate] = 4;
    EXPECT_NE(stepped(text, w), exact);
    w.keeps_rest = true;
    EXPECT_EQ(stepped(text, w), exact);
}

TEST(Stepped, ReachesEachStep)
{
    for (int step = 0; step < study::steps; step++) {
        const std::string text = scene_of(Step{step} == Step::map ? "cornell" : "glass", "40 30");
        const Picture exact = stepped(text, Widths());
        Widths w;
        w.bits[step] = 3;
        EXPECT_FALSE(stepped(text, w) == exact) << step;
    }
}

// The bits that q24's header tells of, and those that differ from q32's.
TEST(Stepped, HasTheWidthsOfQ24)
{
    const Widths w = study::widths_of<q24>(2);
    EXPECT_EQ(w[Step::camera], 20);
    EXPECT_EQ(w[Step::point], 16);
    EXPECT_EQ(w.leave, 4);
    EXPECT_EQ(w[Step::eta], 17);
    EXPECT_EQ(w[Step::colour], 11);
    EXPECT_EQ(w[Step::share], 14);
    EXPECT_TRUE(w.cuts[static_cast<int>(Step::share)]);
    EXPECT_EQ(w[Step::curved], 15);
    EXPECT_EQ(w[Step::row], 21);
    EXPECT_EQ(study::widths_of<q32>(0)[Step::curved], 30);
    EXPECT_TRUE(study::widths_of<q32>(0).keeps_rest);
    EXPECT_FALSE(w.keeps_rest);
    EXPECT_EQ(study::widths_of<q16>(0)[Step::quotient], 15);
}

} // namespace
