// The tracer itself, in a number system of its own, for which the functions below come before the tracer's:
// each counts and then asks the tracer's.
#include "counts.hpp"

#include <qray/render.hpp>

#include "../scene/builder.hpp"

#include <algorithm>
#include <bit>

namespace qray::cli {

namespace {

struct Counting : Double {};
using Shot = Ray<Counting>;

OperationCounts counts;

void add(Operation o, double n = 1) { counts[o] += n; }

double product(const Vec<double>& a, const Vec<double>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Where a ball lies to a ray: whether it is ahead at all, and whether the ray's line enters it before
// `limit`.
struct Place {
    bool ahead, met;
};
Place place(const Vec<double>& centre, double radius, const Shot& ray, double limit)
{
    const Vec<double> v = centre - ray.origin;
    const double along = product(v, ray.direction);
    const bool ahead = along > -radius;
    return {ahead, ahead && along - radius <= limit && product(v, v) - along * along <= radius * radius};
}

// A plane is ahead where it lies between the ray's origin and `limit`.
bool plane_ahead(const Vec<double>& point, const Vec<double>& normal, const Shot& ray, double limit)
{
    const double towards = product(ray.direction, normal);
    const double t = product(point - ray.origin, normal) / towards;
    return t > 0 && t <= limit;
}

template <class S>
void count_test(const S& shape, const Vec<double>* vertices, const Shot& ray, double limit)
{
    add(Operation::test);
    if constexpr (requires { shape.half; }) {
        const Place at = place(shape.middle, shape.bound, ray, limit);
        add(Operation::cone_test);
        add(Operation::cone_near, at.ahead);
        add(Operation::cone_met, at.met);
    } else if constexpr (requires { shape.inverse_radius; }) {
        const Place at = place(shape.centre, shape.radius, ray, limit);
        add(Operation::sphere_test);
        add(Operation::sphere_ahead, at.ahead);
        add(Operation::sphere_met, at.met && !(ray.from == shape.tag && ray.outward));
    } else if constexpr (requires { shape.radius; }) {
        add(Operation::disc_test);
        add(Operation::disc_ahead,
            !(ray.from == shape.tag) && plane_ahead(shape.centre, shape.normal, ray, limit));
    } else {
        const bool ahead = !(ray.from == shape.tag)
            && plane_ahead(vertices[shape.first], shape.normal, ray, limit);
        const bool met = ahead && place(shape.middle, shape.bound, ray, limit).met;
        if constexpr (requires { shape.count; }) {
            add(Operation::polygon_test);
            add(Operation::polygon_ahead, ahead);
            add(Operation::polygon_corner, met ? shape.count : 0);
        } else {
            add(Operation::patch_test);
            add(Operation::patch_ahead, ahead);
            add(Operation::patch_met, met);
        }
    }
}

constexpr Operation seen[] = {Operation::sphere_seen, Operation::disc_seen, Operation::cone_seen,
                              Operation::polygon_seen, Operation::patch_seen};
constexpr Operation textures[] = {Operation::pixel,    Operation::checker, Operation::stripes,
                                  Operation::gradient, Operation::rings,   Operation::noise,
                                  Operation::marble,   Operation::wood,    Operation::brick};

void count_ray(RayKind kind)
{
    switch (kind) {
    case RayKind::camera: add(Operation::sample); break;
    case RayKind::shadow: add(Operation::shadow_ray); break;
    case RayKind::mirrored: add(Operation::mirrored); break;
    case RayKind::refracted: add(Operation::refracted); break;
    }
}

// These stand in for the tracer's functions of the same names.
template <Effects E>
bool nearest(const Scene<Counting, E>& scene, const Shot& ray, Hit<Counting>& hit)
{
    add(Operation::ray);
    double limit = Counting::length_max;
    for_each_shape(scene, [&](const auto& shape, Kind, uint32_t) {
        count_test(shape, scene.vertices.data, ray, limit);
        double t = 0;
        Local<Counting> local{};
        if (intersect_in(scene, shape, ray, limit, t, local))
            limit = std::min(limit, t);
        return false;
    });
    return qray::nearest<Counting, E>(scene, ray, hit);
}

template <Effects E>
double light_through(const Scene<Counting, E>& scene, const Shot& ray, double distance)
{
    const double through = qray::light_through<Counting, E>(scene, ray, distance);
    for_each_shape(scene, [&](const auto& shape, Kind, uint32_t) {
        count_test(shape, scene.vertices.data, ray, distance);
        return through == 0 && crossings_in(scene, shape, ray, distance) != 0
            && scene.transmits[shape.tag.material()].amount == 0;
    });
    return through;
}

template <Effects E, class Count>
Rgb<Counting> local_light(const Scene<Counting, E>& scene, const Seen<Counting>& at, Count& count)
{
    add(Operation::hit);
    add(seen[static_cast<int>(at.kind)]);
    const TextureRef texture = scene.textures[at.material];
    if (texture.kind != TextureKind::none)
        add(textures[static_cast<int>(texture.kind)]);
    const Highlight<Counting>& h = scene.highlights[at.material];
    const auto lamp = [&](const Vec<double>& l) {
        const double n_l = product(at.surface.normal, l);
        if (!(n_l > 0))
            return;
        add(Operation::lit);
        if (h.amount > 0 && mirrored_cosine<Counting>(l, at.direction, n_l, at.surface.n_d) > 0) {
            add(Operation::shine);
            add(Operation::shine_square, std::bit_width(h.shine.whole));
            add(Operation::shine_fraction, h.shine.fraction > 0);
        }
    };
    for (uint32_t i = 0; i < scene.lights.count; i++) {
        Vec<double> l{};
        double distance = 0;
        if (towards(scene.lights[i], at.surface.point, l, distance))
            lamp(l);
    }
    for (uint32_t i = 0; i < scene.suns.count; i++)
        lamp(scene.suns[i].from);
    return qray::local_light<Counting, E>(scene, at, count);
}

constexpr Effects without_tree()
{
    Effects e = everything(scene::Settings::max_depth);
    e.tree = false;
    return e;
}

scene::Storage<Counting> storage;

} // namespace

OperationCounts count_operations(const scene::Description& description, const scene::Settings& settings,
                                 uint32_t stride)
{
    counts = {};
    scene::Error error;
    if (!scene::Builder<Counting>(description, settings, storage).build(error))
        return counts;
    const auto view = storage.template view<without_tree()>();
    double rows = 0;
    for (uint32_t j = stride / 2; j < storage.camera.height; j += stride, rows++)
        for (uint32_t i = 0; i < storage.camera.width; i++) {
            add(Operation::pixel);
            render_pixel(view, i, j, count_ray);
        }
    for (double& n : counts.of)
        n *= storage.camera.height / rows;
    return counts;
}

} // namespace qray::cli
