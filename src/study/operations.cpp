// How often drawing a scene of balls, planes and checkers asks for each operation of floor.py.
//   operations SCENE WxH
// One `name: value` a line. Counted is the tracer itself, in a number system of its own, for which the functions below
// come before the tracer's: each counts and then asks the tracer's.
#include <qray/qray.hpp>

#include "../cli/input.hpp"
#include "../scene/builder.hpp"
#include "../scene/effect_names.hpp"

#include <algorithm>
#include <bit>

#include <stdio.h>

namespace qray {

namespace {

struct Counting : Double {};
using Shot = Ray<Counting>;

// Of a shape: `test`, a ray and a shape; `ahead`, the ball is not all behind the ray; `met`, the ray enters the ball,
// or meets the disc's plane nearer than what was met before; `seen`, the hit that is shaded.
struct {
    uint32_t pixel, sample, ray, test, sphere_test, sphere_ahead, sphere_met, sphere_seen, disc_test, disc_met,
        disc_seen, hit, lamp, lit, shine, shine_square, mirrored, checker;
} counts;
constexpr const char* names[] = {"pixel",     "sample",    "ray",      "test",      "sphere_test", "sphere_ahead",
                                 "sphere_met", "sphere_seen", "disc_test", "disc_met", "disc_seen", "hit",
                                 "lamp",      "lit",       "shine",    "shine_square", "mirrored",  "checker"};
static_assert(sizeof names / sizeof *names == sizeof counts / sizeof(uint32_t));

double product(const Vec<double>& a, const Vec<double>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

void count_test(const Sphere<Counting>& s, const Shot& ray, double)
{
    const Vec<double> v = s.centre - ray.origin;
    const double along = product(v, ray.direction);
    const bool near = along > -s.radius && product(v, v) - along * along <= s.radius * s.radius;
    counts.sphere_test++;
    counts.sphere_ahead += along > -s.radius;
    counts.sphere_met += near && !(ray.from == s.tag && ray.outward);
}

void count_test(const Disc<Counting>& s, const Shot& ray, double limit)
{
    const double t = product(s.centre - ray.origin, s.normal) / product(ray.direction, s.normal);
    counts.disc_test++;
    counts.disc_met += !(ray.from == s.tag) && t > 0 && t <= limit;
}

// These stand in for the tracer's functions of the same names.
template <Effects E>
bool nearest(const Scene<Counting, E>& scene, const Shot& ray, Hit<Counting>& hit)
{
    counts.ray++;
    double limit = Counting::length_max;
    for_each_shape(scene, [&](const auto& shape, Kind, uint32_t) {
        counts.test++;
        count_test(shape, ray, limit);
        double t = 0;
        Local<Counting> local{};
        if (intersect(shape, corners_of(scene), ray, limit, t, local))
            limit = std::min(limit, t);
        return false;
    });
    return qray::nearest<Counting, E>(scene, ray, hit);
}

template <Effects E>
double light_through(const Scene<Counting, E>& scene, const Shot& ray, double distance)
{
    for_each_shape(scene, [&](const auto& shape, Kind, uint32_t) {
        counts.test++;
        count_test(shape, ray, distance);
        return crossings(shape, corners_of(scene), ray, distance) != 0;
    });
    return qray::light_through<Counting, E>(scene, ray, distance);
}

template <Effects E, class Count>
Rgb<Counting> local_light(const Scene<Counting, E>& scene, const Seen<Counting>& at, Count& count)
{
    counts.hit++;
    (at.kind == Kind::sphere ? counts.sphere_seen : counts.disc_seen)++;
    counts.checker += scene.textures[at.material].kind != TextureKind::none;
    const Highlight<Counting>& h = scene.highlights[at.material];
    for (uint32_t i = 0; i < scene.lights.count; i++) {
        counts.lamp++;
        Vec<double> l{};
        double distance = 0;
        if (!towards(scene.lights[i], at.surface.point, l, distance))
            continue;
        const double n_l = product(at.surface.normal, l);
        counts.lit += n_l > 0;
        if (n_l > 0 && h.amount > 0 && mirrored_cosine<Counting>(l, at.direction, n_l, at.surface.n_d) > 0) {
            counts.shine++;
            counts.shine_square += static_cast<uint32_t>(std::bit_width(h.shine.whole));
        }
    }
    return qray::local_light<Counting, E>(scene, at, count);
}

void count_ray(RayKind kind)
{
    counts.sample += kind == RayKind::camera;
    counts.mirrored += kind == RayKind::mirrored;
}

scene::Description description;
scene::Storage<Counting> storage;

// With see-through shadows, as then light_through() is asked for all light.
constexpr Effects counted()
{
    Effects e;
    e.sphere = e.disc = e.checker = e.light = e.shadow = e.see_through = e.highlight = e.mirror = true;
    e.depth = scene::Settings::max_depth;
    return e;
}

int count(const char* file)
{
    for (const scene::EffectName& e : scene::effect_names)
        if (storage.effects.*e.effect && !(counted().*e.effect) && e.effect != &Effects::tree) {
            fprintf(stderr, "operations: %s calls for %s, of which no least cost is known\n", file, e.name);
            return 1;
        }
    const auto view = storage.view<counted()>();
    for (uint32_t j = 0; j < view.camera.height; j++)
        for (uint32_t i = 0; i < view.camera.width; i++, counts.pixel++)
            render_pixel(view, i, j, count_ray);
    const uint32_t* value = &counts.pixel;
    for (const char* name : names)
        printf("%s: %u\n", name, *value++);
    return 0;
}

} // namespace

} // namespace qray

int main(int argc, char** argv)
{
    using namespace qray;
    scene::Settings settings;
    if (argc != 3 || sscanf(argv[2], "%ux%u", &settings.width, &settings.height) != 2) {
        fputs("usage: operations SCENE WxH\n", stderr);
        return 2;
    }
    scene::Error error;
    if (!cli::read_scene(argv[1], description, error)
        || !scene::Builder<Counting>(description, settings, storage).build(error)) {
        fprintf(stderr, "%s\n", error.text);
        return 1;
    }
    return count(argv[1]);
}
