// The trees only leave out what a ray cannot meet: with one and without it every hit is the same.
// RAYS and SCENES in the environment: how many of each; SEED: which. See tests/hostile/hostile.mk.
#include "hostile/random_scene.hpp"
#include "scene_helpers.hpp"

namespace {

using namespace qray;
using namespace qray::test;

template <class N>
struct TreeTest : ::testing::Test {};
#if defined(__SANITIZE_ADDRESS__) // which takes long to compile
using TreeSystems = ::testing::Types<q32, Float>;
#else
using TreeSystems = NumberSystems;
#endif
TYPED_TEST_SUITE(TreeTest, TreeSystems, SystemNames);

enum class Over { none, desktop, compiled };

constexpr Effects shapes(Over tree)
{
    Effects e;
#define QRAY_TAKE(Type, name, table) e.name = true;
    QRAY_SHAPES(QRAY_TAKE)
#undef QRAY_TAKE
    e.tree = tree == Over::desktop;
    e.flat_tree = tree == Over::compiled;
    return e;
}

std::string numbers(std::initializer_list<double> list)
{
    std::string text;
    for (double v : list)
        text += " " + std::to_string(v);
    return text;
}

// `count` objects of all kinds, of the size that lets some be hit and some not; `spread` apart.
std::string objects(Random& random, int count, double spread, double size)
{
    std::string text;
    for (int i = 0; i < count; i++) {
        const Vec3 p = random.point(spread), q = p + random.direction() * size, r = p + random.direction() * size;
        switch (random.bits() % 5) {
        case 0: text += "s" + numbers({p.x, p.y, p.z, size * random.uniform(0.1, 1)}); break;
        case 1: text += "disc" + numbers({p.x, p.y, p.z, q.x - p.x, q.y - p.y, q.z - p.z, size}); break;
        case 2: text += "c" + numbers({p.x, p.y, p.z, size * 0.5, q.x, q.y, q.z, size * 0.25}); break;
        case 3: text += "p 3" + numbers({p.x, p.y, p.z, q.x, q.y, q.z, r.x, r.y, r.z}); break;
        default:
            text += "pp 3" + numbers({p.x, p.y, p.z, 0, 0, 1, q.x, q.y, q.z, 0, 1, 0, r.x, r.y, r.z, 1, 0, 0});
        }
        text += "\n";
    }
    return text;
}

// Functions of their own, so that what is asked is compiled once for all who ask it.
template <class N, Effects E>
[[gnu::noinline]] bool found(const Scene<N, E>& scene, const Ray<N>& ray, Hit<N>& hit)
{
    return nearest(scene, ray, hit);
}
template <class N, Effects E>
[[gnu::noinline]] bool blocked(const Scene<N, E>& scene, const Ray<N>& ray, typename N::Length distance)
{
    return light_blocked(scene, ray, distance);
}

template <class N, Over tree>
void expect_same_hits(uint64_t seed, int count, double size, int rays)
{
    Random random(seed);
    const double spread = 8;
    ASSERT_TRUE(loaded<N>("v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3\n"
                          + objects(random, count, spread, size),
                          compiled(tree == Over::compiled)));
    if (tree == Over::compiled && storage<N>().entries.count == 0)
        return; // too few
    const auto with = storage<N>().template view<shapes(tree)>();
    const auto without = storage<N>().template view<shapes(Over::none)>();
    const double k = value(with.camera.eye.z) / 8 * 1.2;
    int hits = 0;
    for (int i = 0; i < rays; i++) {
        const Vec3 from = random.point(spread * k);
        // At an object's place, or anywhere.
        const auto ray = make<N>::ray(from, i % 2 == 0 ? random.direction() : random.point(spread * k) - from);
        Hit<N> a{}, b{};
        const bool hit = found(with, ray, a);
        ASSERT_EQ(hit, found(without, ray, b)) << count << " objects, ray " << i;
        hits += hit;
        if (hit) {
            ASSERT_EQ(value(a.t), value(b.t)) << count << " objects, ray " << i;
            ASSERT_TRUE(a.tag == b.tag);
            ASSERT_EQ(a.index, b.index);
        }
        const auto distance = make<N>::length(random.uniform(1, 20));
        ASSERT_EQ(blocked(with, ray, distance), blocked(without, ray, distance))
            << count << " objects, ray " << i;
    }
    EXPECT_GT(hits, 0) << count;
}

TYPED_TEST(TreeTest, HitsAreTheSameForEveryNumberOfObjects)
{
    for (int count = 1; count <= 45; count++) {
        expect_same_hits<TypeParam, Over::desktop>(static_cast<uint64_t>(count), count, 4, 300);
        expect_same_hits<TypeParam, Over::compiled>(static_cast<uint64_t>(count), count, 4, 300);
    }
}

TYPED_TEST(TreeTest, HitsAreTheSameAmongManyObjects)
{
    expect_same_hits<TypeParam, Over::desktop>(1001, 200, 2, 1000);
    expect_same_hits<TypeParam, Over::desktop>(1002, 1500, 0.5, 1000);
    expect_same_hits<TypeParam, Over::desktop>(1003, 5000, 0.25, 300);
    expect_same_hits<TypeParam, Over::compiled>(1001, 200, 2, 1000);
    expect_same_hits<TypeParam, Over::compiled>(1002, 1500, 0.5, 1000);
    expect_same_hits<TypeParam, Over::compiled>(1003, 5000, 0.25, 300);
}

TYPED_TEST(TreeTest, HitsAreTheSameAmongTinyObjects)
{
    expect_same_hits<TypeParam, Over::desktop>(1004, 300, 1, 500);
    expect_same_hits<TypeParam, Over::compiled>(1004, 300, 1, 500);
    using N = TypeParam;
    // Balls of a thousandth (in q16, whose directions are no finer, of a twentieth), each aimed at: none may be lost to
    // the rounding of binary32.
    Random random(1005);
    std::string text = "v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3\n";
    for (int i = 0; i < 400; i++) {
        const Vec3 p = random.point(8);
        text += "s" + numbers({p.x, p.y, p.z, NarrowFixed<N> ? 0.05 : 0.001}) + "\n";
    }
    const auto find_all = [&]<Over tree>() {
        ASSERT_TRUE(loaded<N>(text, compiled(tree == Over::compiled)));
        const auto with = storage<N>().template view<shapes(tree)>();
        for (uint32_t i = 0; i < with.spheres.count; i++) {
            const Vec3 centre = value(with.spheres[i].centre);
            const Vec3 from = random.point(30);
            Hit<N> hit{};
            ASSERT_TRUE(found(with, make<N>::ray(from, centre - from), hit)) << i;
            EXPECT_LE(value(hit.t), length(centre - from) + (NarrowFixed<N> ? 0.05 : 1e-3));
        }
    };
    find_all.template operator()<Over::desktop>();
    find_all.template operator()<Over::compiled>();
}

// What a box test may get wrong, by its own boxes: those that it holds rays against, in the moved and scaled scene.
class HostileRays {
public:
    HostileRays(uint64_t seed, const scene::Array<scene::SplitBox>& from) : random(seed), boxes(from) {}

    // An origin and a direction.
    std::pair<Vec3, Vec3> next()
    {
        const Vec3 at = place(), anywhere = random.point(31);
        Vec3 d = at - anywhere;
        switch (random.bits() % 8) {
        case 0: return {anywhere, random.direction()};
        case 1: return {anywhere, d};                    // grazes a box
        case 2: return {at, random.direction()};         // starts on its face, or inside
        case 3: return {at, place() - at};               // from one to another
        case 4: return {beyond(at, axis()), axis()};     // along an axis, in faces
        case 5: return {at - axis() * random.uniform(0, 60), axis()};
        case 6: (&d.x)[random.bits() % 3] = 0; return {at - d, d};
        default: // almost without a component
            (&d.x)[random.bits() % 3] = std::ldexp(random.uniform(-1, 1), -static_cast<int>(random.bits() % 40));
            return {at - d, d};
        }
    }

private:
    Random random;
    const scene::Array<scene::SplitBox>& boxes;

    double within(float low, float high)
    {
        switch (random.bits() % 4) {
        case 0: return double{low};
        case 1: return double{high};
        case 2: return random.uniform(double{low}, double{high});
        default: return (random.bits() % 2 ? double{low} : double{high}) + random.uniform(-2e-4, 2e-4);
        }
    }
    // On a face, an edge or a corner of a box, or inside.
    Vec3 place()
    {
        const scene::SplitBox& b = boxes.data[random.bits() % boxes.count];
        return {within(b.low[0], b.high[0]), within(b.low[1], b.high[1]), within(b.low[2], b.high[2])};
    }
    Vec3 axis()
    {
        Vec3 d{};
        (&d.x)[random.bits() % 3] = random.bits() % 2 ? 1 : -1;
        return d;
    }
    static Vec3 beyond(const Vec3& at, const Vec3& d)
    {
        return {d.x != 0 ? -31 * d.x : at.x, d.y != 0 ? -31 * d.y : at.y, d.z != 0 ? -31 * d.z : at.z};
    }
};

#if defined(__SANITIZE_ADDRESS__)
constexpr int few_rays = 3000, few_scenes = 10;
#else
constexpr int few_rays = 500000, few_scenes = 200;
#endif
int as_told(const char* name, int otherwise)
{
    const char* const told = std::getenv(name);
    return told != nullptr ? std::atoi(told) : otherwise;
}
const int hostile_rays = as_told("RAYS", few_rays), random_scenes = as_told("SCENES", few_scenes);
const uint64_t first_seed = static_cast<uint64_t>(as_told("SEED", 0)) << 32;

template <class N, Over tree>
void expect_hostile_rays_hit_the_same()
{
    Random random(2001 + first_seed);
    std::string text = "v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3\n" + objects(random, 30, 8, 3)
        + objects(random, 20, 8, 0.5) + "p 20";
    for (int i = 0; i < 20; i++) // a star
        text += numbers({(i % 2 ? 3 : 6) * cos(i * M_PI / 10), (i % 2 ? 3 : 6) * sin(i * M_PI / 10), 1});
    for (int i = 0; i < 9; i++) // and boxes that touch
        text += "\np 4" + numbers({-8.0 + i, -8, 2, -7.0 + i, -8, 2, -7.0 + i, -7, 2, -8.0 + i, -7, 2});
    ASSERT_TRUE(loaded<N>(text + "\n", compiled(tree == Over::compiled)));
    const auto with = storage<N>().template view<shapes(tree)>();
    const auto without = storage<N>().template view<shapes(Over::none)>();
    if constexpr (tree == Over::desktop)
        ASSERT_EQ(with.tree.value.ball_nodes, 0u);
    else
        ASSERT_NE(with.entries.count, 0u);
    HostileRays rays(2002, storage<N>().split_shapes);
    int hits = 0;
    for (int i = 0; i < hostile_rays; i++) {
        const auto [from, d] = rays.next();
        if (length(d) < 1e-9)
            continue;
        const auto inside = [](double v) { return std::clamp(v, -31.0, 31.0); };
        const auto ray = make<N>::ray({inside(from.x), inside(from.y), inside(from.z)}, d);
        Hit<N> a{}, b{};
        const bool hit = found(with, ray, a);
        const bool same = hit == found(without, ray, b) && (!hit || (value(a.t) == value(b.t) && a.tag == b.tag));
        const auto distance = hit && i % 2 ? a.t : make<N>::length(random.uniform(0, 60));
        const bool as_dark = blocked(with, ray, distance) == blocked(without, ray, distance);
        hits += hit;
        ASSERT_TRUE(same && as_dark) << "ray " << i << numbers({from.x, from.y, from.z, d.x, d.y, d.z});
    }
    EXPECT_GT(hits, hostile_rays / 4);
}

TYPED_TEST(TreeTest, HostileRaysHitTheSame)
{
    expect_hostile_rays_hit_the_same<TypeParam, Over::desktop>();
    expect_hostile_rays_hit_the_same<TypeParam, Over::compiled>();
}

TYPED_TEST(TreeTest, CoincidentObjectsAreToldApartByTheirPlace)
{
    using N = TypeParam;
    // 100 copies of one ball: the first in the file is hit, whatever the order of the tree.
    std::string text = "v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3\n s 3 0 0 1\n";
    for (int i = 0; i < 100; i++)
        text += "s 0 0 0 1\n disc 0 0 1 0 0 1 1\n";
    const auto find_first = [&]<Over tree>() {
        ASSERT_TRUE(loaded<N>(text, compiled(tree == Over::compiled)));
        const auto with = storage<N>().template view<shapes(tree)>();
        Hit<N> hit{};
        ASSERT_TRUE(found(with, make<N>::ray(value(with.camera.eye), {0, 0, -1}), hit));
        EXPECT_EQ(hit.tag.place(), 1u);
    };
    find_first.template operator()<Over::desktop>();
    find_first.template operator()<Over::compiled>();
}

// A place on an object, or within rounding of it, or beside its outline.
Vec3 place_at(Random& random, const scene::Description& d, const scene::Object& o)
{
    const auto from = [](const scene::Vec3d& v) { return Vec3{v.x, v.y, v.z}; };
    const auto share = [&random] { return random.uniform(-0.2, 1.2); };
    const Vec3 a = from(o.a), b = from(o.b), way = random.direction();
    Vec3 at = a, out = way;
    double size = std::min(o.ra, 1e15);
    if (o.count != 0) {
        const scene::Vec3d* const v = d.vertices + o.vertex;
        at = from(v[0]) + from(v[1] - v[0]) * share() + from(v[2] - v[1]) * share();
        out = from(unit(across(v, o.count)));
        size = scene::length(v[1] - v[0]);
    } else if (o.kind == Kind::disc) {
        out = from(unit(o.b));
        at = a + cross(out, way) * (scene::is_endless(o) ? 1 : o.ra * share());
    } else if (o.kind == Kind::sphere) {
        at = a + way * o.ra;
    } else if (const double along = share(); length(cross(b - a, way)) > 0) {
        at = a + (b - a) * along + unit(cross(b - a, way)) * (o.ra + (o.rb - o.ra) * along);
    }
    constexpr double off[] = {0, 1e-10, 1e-8, 1e-7, 1e-6, 1e-4, 1e-2};
    return at + out * (size * off[random.bits() % 7] * random.uniform(-1, 1));
}

constexpr Effects pictures(Over tree)
{
    Effects e = shapes(tree);
    e.light = e.sun = e.panel = e.shadow = e.see_through = e.highlight = true;
    e.mirror = e.transmit = e.eye_surface = e.light_surface = true;
    e.triangle = e.smooth_triangle = tree == Over::compiled;
    return e;
}

// A panel that reaches beyond what it lies in: that is crossed at those places alone that it holds, also by a ray
// almost in its plane, whose line passes inside of it elsewhere.
template <class N, Over tree>
void expect_crossed_where_a_panel_lies_in_it(const std::string& others)
{
    Random random(5001);
    const std::string text = "v from 0 0 8 at 0 0 -8 up 0 1 0 angle 45 hither 1 resolution 3 3 "
                             "panel 3 0 0 0 6 0 0 0 6 0\ndisc 1 1 0 0 0 1 2 "
                             "p 3 -3 -3 0 -1 -3 0 -3 -1 0 pp 3 -3 1 0 0 0 1 -1 1 0 0 0 1 -3 3 0 0 0 1\n"
                             "p 4 1 -3 0 3 -3 0 3 -2 0 1 -2 0\n" + others;
    ASSERT_TRUE(loaded<N>(text, compiled(tree == Over::compiled)));
    ASSERT_EQ(storage<N>().light_surfaces.count, 4u);
    for (uint32_t i = 0; i < 4; i++) // as if it lay just before them
        storage<N>().light_surfaces.data[i].side = 1;
    const auto scene = storage<N>().template view<pictures(tree)>();
    const Disc<N>& disc = scene.discs[0];
    const double scale = value(disc.radius) / 2; // the scene is moved and scaled
    const Vec3 origin = value(disc.centre) - Vec3{scale, scale, 0};
    int crossed = 0, seen = 0;
    for (int i = 0; i < 4000; i++) {
        const Vec3 place{random.uniform(-6, 6), random.uniform(-6, 6), 0};
        Vec3 d = random.direction();
        d.z = std::fabs(d.z) * std::ldexp(1, -(i % 12));
        const Vec3 from = place - unit(d) * random.uniform(1, 9);
        const auto ray = make<N>::ray(origin + from * scale, place - from);
        const auto distance = make<N>::length(length(place - from) * scale);
        // How far outside of each, negative within.
        const double x = place.x, y = place.y,
                     outside[] = {std::hypot(x - 1, y - 1) - 2, std::max({-3 - x, -3 - y, (x + y + 4) / std::sqrt(2)}),
                                  std::max({-3 - x, 1 - y, (x + y) / std::sqrt(2)}),
                                  std::max({1 - x, x - 3, -3 - y, y + 2})};
        const double nearest_edge = *std::min_element(std::begin(outside), std::end(outside));
        const bool flat = unit(d).z < 0.2;
        const bool blocked = light_blocked(scene, ray, distance, PanelNumber{0});
        if (nearest_edge > (flat ? 4.5 : 0.1)) {
            seen++;
            ASSERT_FALSE(blocked) << i << numbers({from.x, from.y, from.z, x, y});
        } else if (nearest_edge < -0.1 && !flat) {
            crossed++;
            ASSERT_TRUE(blocked) << i << numbers({from.x, from.y, from.z, x, y});
        }
        if constexpr (tree == Over::desktop) {
            const auto plain = storage<N>().template view<pictures(Over::none)>();
            ASSERT_EQ(blocked, light_blocked(plain, ray, distance, PanelNumber{0}))
                << i << numbers({from.x, from.y, from.z, x, y});
        }
    }
    EXPECT_GT(seen, 100);
    EXPECT_GT(crossed, 50);
}

TYPED_TEST(TreeTest, WhatAPanelLiesInIsCrossedWhereItHoldsIt)
{
    using N = TypeParam;
    std::string others; // behind, so that there is a tree
    for (int i = 0; i < 50; i++)
        others += "s " + std::to_string(i % 10) + " " + std::to_string(i / 10) + " 12 0.1\n";
    expect_crossed_where_a_panel_lies_in_it<N, Over::none>("");
    expect_crossed_where_a_panel_lies_in_it<N, Over::desktop>("");
    expect_crossed_where_a_panel_lies_in_it<N, Over::desktop>(others);
    expect_crossed_where_a_panel_lies_in_it<N, Over::compiled>(others);
}

TYPED_TEST(TreeTest, PicturesOfRandomScenesAreTheSame)
{
    using N = TypeParam;
    scene::Settings desktop, board = compiled();
    desktop.width = board.width = 16;
    desktop.height = board.height = 12;
    auto& s = storage<N>();
    int drawn = 0, lit = 0;
    for (int i = 47; i < 47 + 15 * random_scenes; i += 15) { // so that a few have two that trees once drew otherwise
        SCOPED_TRACE(i);
        const uint64_t seed = 3000 + first_seed + static_cast<uint64_t>(i);
        Random random(seed);
        const std::string text = hostile::RandomScene(seed).text(false, 20 + static_cast<uint32_t>(i % 70));
        scene::Error error;
        auto& d = description();
        if (!parse("test.nff", text.data(), text.size(), d, error))
            continue;
        for (uint32_t k = 0; k < d.light_count && i % 4 != 0; k++)
            if (!d.lights[k].sun) {
                const Vec3 at = place_at(random, d, d.objects[random.bits() % d.object_count]);
                d.lights[k].at = {at.x, at.y, at.z};
            }
        if (!scene::Builder<N>(d, desktop, s).build(error))
            continue;
        drawn++;
        lit += s.effects.light_surface;
        const Picture without = draw<N, pictures(Over::none)>(), with = draw<N, pictures(Over::desktop)>();
        ASSERT_TRUE(with == without) << text;
        // As on boards: first with polygons and patches, then with what is made of them.
        std::vector<TreeEntry<N>> entries(2 * s.split_shapes.count + 1);
        std::vector<uint32_t> tests(2 * s.split_shapes.count);
        s.entries.data = entries.data();
        s.tests.data = tests.data();
        scene::Flattener<N>(s).flatten();
        ASSERT_TRUE((draw<N, pictures(Over::compiled)>() == without)) << text;
        ASSERT_TRUE(scene::Builder<N>(d, board, s).build(error));
        if (s.entries.count != 0) {
            ASSERT_TRUE((draw<N, pictures(Over::compiled)>() == without)) << text;
        }
    }
    EXPECT_GT(drawn, random_scenes / 3);
    EXPECT_GT(lit, random_scenes / 20);
}

// A ball so small that a ray that left it inward starts behind it.
TYPED_TEST(TreeTest, TheOtherEndOfAShortChordIsFound)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 0 8 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 3 3 s 0 0 0 0.05"));
    const auto with = storage<N>().template view<shapes(Over::desktop)>();
    const auto without = storage<N>().template view<shapes(Over::none)>();
    const Sphere<N>& ball = with.spheres[0];
    const double r = std::ldexp(value(ball.radius), -ball.fine);
    Random random(4001);
    for (int i = 0; i < 1000; i++) {
        const Vec3 d = random.direction();
        auto ray = make<N>::ray(value(ball.centre) + d * (r + 2 * make<N>::length_ulp()), d);
        ray.from = ball.tag;
        ray.outward = false;
        Hit<N> a{}, b{};
        EXPECT_TRUE(found(without, ray, b));
        ASSERT_TRUE(found(with, ray, a)) << i;
        EXPECT_EQ(value(a.t), value(b.t));
    }
}

// A compiled scene of a few shapes has none. Whoever asks for it all the same sees nothing, and sees it at once.
TYPED_TEST(TreeTest, NoneEndsAtOnce)
{
    using N = TypeParam;
    ASSERT_TRUE(loaded<N>("v from 0 0 8 at 0 0 0 up 0 1 0 angle 45 hither 1 resolution 1 1 s 0 0 0 1", compiled()));
    EXPECT_EQ(storage<N>().entries.count, 0u);
    const auto scene = storage<N>().template view<shapes(Over::compiled)>();
    Hit<N> hit{};
    EXPECT_FALSE(found(scene, make<N>::ray(value(scene.camera.eye), {0, 0, -1}), hit));
}

} // namespace
