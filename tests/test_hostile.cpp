// A million random hostile rays at each shape in each number system: see hostile/trial.hpp for what is asked, and
// `make soak` for a hundred million.
#include "hostile/run.hpp"
#include "number_helpers.hpp"
#include "tracer.hpp"

namespace {

using namespace hostile;

#if defined(__SANITIZE_ADDRESS__)
constexpr uint64_t rays = 20000;
#else
constexpr uint64_t rays = 1000000;
#endif

// Wrong answers per million that q32 may give: ordinary, small and far, grazing, needles. The edges of figures are
// exact.
struct Allowed {
    double wrong[4];
};
constexpr Allowed exact_shape = {{0, 2, 20, 0}}, figure = {{0, 0, 0, 0}};

template <class N>
struct HostileTest : ::testing::Test {};
TYPED_TEST_SUITE(HostileTest, qray::test::NumberSystems, qray::test::SystemNames);

template <class N, template <class> class Trial>
void expect_steady(const Allowed& allowed)
{
    constexpr bool is_q32 = std::is_same_v<N, qray::q32>, is_q16 = qray::ShortFixed<N>;
    rows_of<N, Trial>({}, rays, [&allowed](const Row& row) {
        SCOPED_TRACE(regime_names[row.regime]);
        const Tally& t = row.tally;
        EXPECT_GT(t.hits, t.rays / 8);
        EXPECT_GT(t.rebounds, t.rays / 4);
        EXPECT_EQ(t.self_hits, 0u);
        EXPECT_EQ(t.leaks, 0u);
        // Float and q24 cannot tell entering from leaving on a chord of 5e-4 in a ball of 1; nor q16, whose directions
        // are known to 6e-5, at a few times that to the wall of a cone: 12 of 1000 grazing rays.
        const uint64_t least = is_q16 ? (row.regime == static_cast<int>(Regime::grazing) ? 60 : 50000) : 100000;
        const uint64_t parity = qray::NarrowFixed<N> || std::is_same_v<N, qray::Float> ? t.rays / least : 0;
        EXPECT_LE(t.parity, parity);
        // A twin may be met within 2e-7 of a tangent, within 1e-3 in q16.
        EXPECT_LE(t.twin_hits, t.rebounds / (is_q16 ? 250 : 1000));
        if (is_q32) {
            if (rays >= 1000000 || allowed.wrong[row.regime] == 0) { // fewer tell nothing of a rate
                EXPECT_LE(static_cast<double>(t.wrong) * 1e6, allowed.wrong[row.regime] * static_cast<double>(t.rays));
            }
            if (row.regime < 2) {
                EXPECT_LE(t.sum, 1e-7 * static_cast<double>(t.measured)) << "mean error of t";
            }
        }
    });
}

TYPED_TEST(HostileTest, Sphere) { expect_steady<TypeParam, SphereTrial>(exact_shape); }
TYPED_TEST(HostileTest, Plane) { expect_steady<TypeParam, PlaneTrial>(exact_shape); }
TYPED_TEST(HostileTest, Disc) { expect_steady<TypeParam, DiscTrial>(exact_shape); }
TYPED_TEST(HostileTest, Cylinder) { expect_steady<TypeParam, CylinderTrial>(exact_shape); }
TYPED_TEST(HostileTest, Cone) { expect_steady<TypeParam, ConeTrial>(exact_shape); }
TYPED_TEST(HostileTest, Polygon) { expect_steady<TypeParam, PolygonTrial>(figure); }
TYPED_TEST(HostileTest, Patch) { expect_steady<TypeParam, PatchTrial>(figure); }

// Rays of a soak of 10^8 whose chord begins at the surface, close to an apex: rho is small there, and an error of the
// discriminant counts much more than elsewhere. In q32 they find its end whether or not they name the surface.
struct Chord {
    Double3 a, b;
    double ra, rb;
    Double3 origin, direction;
};
template <class N>
void expect_end(const Chord& chord, bool named)
{
    ConeTrial<N> trial;
    auto o = trial.bench.object(qray::Kind::cone);
    o.a = chord.a;
    o.b = chord.b;
    o.ra = chord.ra;
    o.rb = chord.rb;
    trial.bench.build(o);
    using M = qray::test::make<N>;
    const Double3 &from = chord.origin, &d = chord.direction;
    const qray::Ray<N> ray{M::point(from.x, from.y, from.z), M::vector(d.x, d.y, d.z),
                           named ? trial.shape.tag : qray::Tag{qray::Tag::none}, false};
    const Meetings<Quad> m = trial.template meet<Quad>(ray);
    ASSERT_EQ(m.count, 2);
    ASSERT_TRUE(m.t[0] < 0 && m.t[1] > 0 && m.within[1] > 0);
    qray::Hit<N> hit{};
    ASSERT_TRUE(qray::nearest(trial.bench.storage.template view<ConeTrial<N>::effects>(), ray, hit));
    EXPECT_NEAR(exact<double>(hit.t), static_cast<double>(m.t[1]), static_cast<double>(m.t[1]) / 4);
}
TEST(Hostile, EndOfAChordAtAnApexIsFound)
{
    for (const bool named : {true, false})
        expect_end<qray::q32>({{-20.459991247690368, -13.060712326711764, 9.8856985417749996},
                               {-8.3780807009584173, 12.578355652169902, 16.403276987542732}, 12.561939584337001, 0,
                               {-8.3795323371887207, 12.576979994773865, 16.402350723743439},
                               {-0.3759525828063488, -0.61507947091013193, -0.69306341651827097}}, named);
    expect_end<qray::Double>({{-19.115747066010197, -8.7343361674195421, 16.599205667964856},
                              {-16.737939894751868, -16.849943115465919, 20.781076998985434}, 9.2484474692168366, 0,
                              {-16.773993083901178, -16.834280489910171, 20.737870274964568},
                              {-0.61782823264208109, 0.26824232931729525, -0.73914432130186469}}, true);
}

#if !defined(__SANITIZE_ADDRESS__) // too few rays to compare rates
TEST(Hostile, FixedPointIsWrongLessOftenThanFloatInEveryRow)
{
    std::vector<double> fixed, single;
    const auto into = [](std::vector<double>& list) {
        return [&list](const Row& row) {
            list.push_back(static_cast<double>(row.tally.wrong) / static_cast<double>(row.tally.rays));
        };
    };
    rows_in<qray::q32>({}, rays / 8, into(fixed));
    rows_in<qray::Float>({}, rays / 8, into(single));
    ASSERT_EQ(fixed.size(), 23u);
    ASSERT_EQ(single.size(), 23u);
    for (size_t i = 0; i < fixed.size(); i++)
        EXPECT_LE(fixed[i], single[i]) << "row " << i;
}
#endif

} // namespace
