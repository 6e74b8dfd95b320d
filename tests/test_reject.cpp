// The reject may turn away what a ray misses, and never what it meets.
#include <qray/shape/reject.hpp>

#include "scene_helpers.hpp"
#include "shape_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct RejectTest : ::testing::Test {};
TYPED_TEST_SUITE(RejectTest, NumberSystems, SystemNames);

// Points anywhere in the world that a builder may fill.
Vec3 in_world(Random& random)
{
    for (;;) {
        const Vec3 p = random.point(62);
        if (length(p) <= 62)
            return p;
    }
}

TYPED_TEST(RejectTest, NoBallThatIsMetIsTurnedAway)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(110);
    int met = 0, missed = 0, turned_away = 0, wrong = 0;
    for (int i = 0; i < 200000; i++) {
        const auto centre = M::point(in_world(random));
        const auto radius = M::length(std::exp2(random.uniform(-20, 4)));
        if (!(radius > N::length_zero))
            continue;
        // Aimed to pass at up to two radii, so that many graze.
        const Vec3 from = in_world(random);
        const Vec3 aim = value(centre) + random.direction() * (value(radius) * random.uniform(0, 2));
        const auto ray = M::ray(from, i % 7 == 0 ? from - aim : aim - from);
        const auto v = real(centre) - real(ray.origin), d = real(ray.direction);
        const Real along = dot(v, d), rho = length(cross(v, d));
        bool meets = rho <= value(radius) && (along >= 0 || length(v) <= value(radius));
        if constexpr (NarrowFixed<N>) { // the exact test is no finer, and is what counts
            typename N::Length t{};
            const int32_t fine = std::min(0, fine_for<N>(value(radius), &Blocks::ball)); // what is squared must fit
            meets = SphereOf<N>(value(centre), value(radius), make_tag(0, 0), fine).hit(ray, N::length_max, t);
        }
        const bool away = RejectRay<N>(ray).misses_ball(centre, N::coarse_above(radius, 0));
        met += meets;
        missed += !meets;
        turned_away += away;
        wrong += meets && away;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(met, 50000);
    EXPECT_LE(turned_away, missed);
}

// As built, from corners that are rounded to where the bounding ball, rounded too, may not reach.
TYPED_TEST(RejectTest, NoTriangleThatIsMetAtACornerIsTurnedAway)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(113);
    int met = 0, wrong = 0;
    for (int i = 0; i < 100; i++) {
        std::string text = "v from 0 0 0 at 0 0 1 up 0 1 0 angle 40 hither 1 resolution 1 1\nmaterial\n"
                           "s -36 -36 -36 0.1\n s 36 36 36 0.1\n"; // so that lengths are kept as they are
        for (int k = 0; k < 20; k++) {
            const Vec3 middle = random.point(34);
            const double size = std::exp2(random.uniform(-5, 4));
            text += k % 2 == 0 ? "p 3\n" : "pp 3\n";
            for (int corner = 0; corner < 3; corner++) {
                char line[200];
                const Vec3 c = middle + random.direction() * size;
                std::snprintf(line, sizeof line, "%.17g %.17g %.17g%s\n", c.x, c.y, c.z, k % 2 == 0 ? "" : "  0 0 1");
                text += line;
            }
        }
        ASSERT_TRUE(loaded<N>(text));
        const auto& s = storage<N>();
        const auto aim = [&](const auto& shape, const uint32_t (&at)[3]) {
            Vec3 corner[3];
            for (int k = 0; k < 3; k++)
                corner[k] = value(s.vertices.data[at[k]]);
            for (int k = 0; k < 200; k++) {
                const double inward = std::exp2(random.uniform(-14, -1));
                const Vec3 others = corner[(k + 1) % 3] + corner[(k + 2) % 3];
                const Vec3 to = corner[k % 3] * (1 - inward) + others * (inward / 2);
                // Across the ball's radius there, which it touches.
                const Vec3 out = unit(corner[k % 3] - value(shape.middle)), side = random.direction();
                const Vec3 from = to + unit(side - out * dot(side, out)) * random.uniform(1, 40);
                if (length(from) > 60)
                    continue;
                const auto ray = M::ray(from, to - from);
                typename N::Length t{};
                Local<N> local{};
                if (!intersect(shape, Corners<N>{s.vertices.data, s.normals.data}, ray, N::length_max, t, local))
                    continue;
                met++;
                wrong += surely_missed(shape, RejectRay<N>(ray));
            }
        };
        for (uint32_t k = 0; k < s.polygons.count; k++) {
            const Polygon<N>& p = s.polygons.data[k];
            aim(p, {p.first, p.first + 1, p.first + 2});
        }
        for (uint32_t k = 0; k < s.patches.count; k++) {
            const Patch<N>& p = s.patches.data[k];
            aim(p, {p.first, p.second, p.second + 1});
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(met, 100000);
}

TYPED_TEST(RejectTest, NoPlaneThatIsMetIsTurnedAway)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(111);
    int met = 0, wrong = 0;
    for (int i = 0; i < 200000; i++) {
        const auto centre = M::point(in_world(random));
        const auto normal = M::direction(random.direction());
        const Vec3 from = in_world(random);
        // Often close to the plane, and nearly along it.
        const Vec3 n = value(normal);
        const Vec3 start =
            i % 3 == 0 ? from - n * (dot(n, from - value(centre)) * (1 - std::exp2(random.uniform(-20, 0)))) : from;
        Vec3 d = random.direction();
        if (i % 2 == 0)
            d = unit(d - n * (dot(n, d) * (1 - std::exp2(random.uniform(-12, 0)))));
        if (length(start) > 62)
            continue;
        const auto ray = M::ray(start, d);
        const Real num = dot(real(normal), real(centre) - real(ray.origin)),
                   den = dot(real(normal), real(ray.direction));
        const bool meets = den != 0 && num / den > 0;
        met += meets;
        wrong += meets && RejectRay<N>(ray).misses_plane(centre, normal);
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(met, 50000);
}

TYPED_TEST(RejectTest, MostOfWhatIsFarOffIsTurnedAwayWhereItPays)
{
    using N = TypeParam;
    using M = make<N>;
    Random random(112);
    int missed = 0, turned_away = 0;
    for (int i = 0; i < 20000; i++) {
        const auto centre = M::point(in_world(random));
        const auto ray = M::ray(in_world(random), random.direction());
        const auto v = real(centre) - real(ray.origin);
        if (length(cross(v, real(ray.direction))) < 2)
            continue;
        missed++;
        turned_away += RejectRay<N>(ray).misses_ball(centre, N::coarse_above(M::length(1), 0));
    }
    if (N::is_fixed)
        EXPECT_EQ(turned_away, missed); // a whole length off is far more than 16 bits lose
    else
        EXPECT_LE(turned_away, missed);
}

} // namespace
