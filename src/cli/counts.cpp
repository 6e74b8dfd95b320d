// The tracer itself, in a number system of its own, for which the functions below come before the tracer's:
// each counts and then asks the tracer's.
#include "counts.hpp"

#include <qray/picture/render.hpp>

#include "../scene/builder.hpp"
#include "../scene/window_builder.hpp"

#include <algorithm>
#include <bit>

namespace qray::cli {

namespace {

struct Counting : Double {};
using Shot = Ray<Counting>;

OperationCounts counts;
Effects effects; // of the scene that is counted

void add(Operation o, double n = 1) { counts[o] += n; }

double product(const Vec<double>& a, const Vec<double>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Where a ball lies to a ray: not all behind it; entered by its whole line; and not all beyond `limit`.
struct Place {
    bool ahead, line, within;
    bool near() const { return ahead && line; }
};
Place place(const Vec<double>& centre, double radius, const Shot& ray, double limit)
{
    const Vec<double> v = centre - ray.origin;
    const double along = product(v, ray.direction);
    return {along > -radius, product(v, v) - along * along <= radius * radius, along - radius <= limit};
}

// Where the ray, not its line, meets a plane; 0 where it does not.
double plane_distance(const Vec<double>& point, const Vec<double>& normal, const Shot& ray)
{
    const double t = product(point - ray.origin, normal) / product(ray.direction, normal);
    return t > 0 ? t : 0;
}
bool within(double t, double limit) { return t > 0 && t <= limit; }

// Does the ray's line meet the cone's unbounded surface? See cone.hpp.
bool has_roots(const Cone<Counting>& s, const Shot& ray)
{
    const Vec<double> v = s.middle - ray.origin;
    const double along = product(v, ray.direction);
    const Vec<double>& d = ray.direction;
    const Vec<double> o = Vec<double>{d.x * along, d.y * along, d.z * along} - v;
    const double ox = product(o, s.e1), oy = product(o, s.e2), rho = s.rho0 + s.sine * product(o, s.axis);
    const double dx = product(ray.direction, s.e1), dy = product(ray.direction, s.e2);
    const double ds = s.sine * product(ray.direction, s.axis), c = s.cosine * s.cosine;
    const double a = c * (dx * dx + dy * dy) - ds * ds, b = c * (ox * dx + oy * dy) - rho * ds;
    return b * b - a * (c * (ox * ox + oy * oy) - rho * rho) >= 0;
}

// The operations that follow `test`, and `ahead`, in their order.
void add_test(Operation test, uint32_t count)
{
    add(Operation::test);
    add(test);
    add(static_cast<Operation>(static_cast<int>(test) + 1 + (count > 1) + (count > 8)));
}
void add_place(Operation ahead, const Place& at)
{
    add(ahead, at.ahead);
    add(static_cast<Operation>(static_cast<int>(ahead) + 1), at.line);
}

// Edges that end on either side of the ray, across its dominant axis: see corners.hpp.
uint32_t edges_across(const Polygon<Counting>& s, const Vec<double>* vertices, const Shot& ray)
{
    const Shear<Counting> shear(ray.direction);
    const auto above = [&](uint32_t i) { return shear(vertices[s.first + i] - ray.origin).y > 0; };
    uint32_t n = 0;
    for (uint32_t i = 0; i < s.count; i++)
        n += above(i) != above(i == 0 ? s.count - 1 : i - 1);
    return n;
}

template <Effects E, class S>
void count_test(const Scene<Counting, E>& scene, const S& shape, const Shot& ray, double limit)
{
    const Vec<double>* vertices = scene.vertices.data;
    const bool own = ray.from == shape.tag;
    if constexpr (requires { shape.half; }) {
        const Place at = place(shape.middle, shape.bound, ray, limit);
        const bool near = at.near() && at.within && !(own && ray.outward);
        add_test(Operation::cone_test, scene.cones.count);
        add(Operation::cone_opaque, !effects.see_through);
        add_place(Operation::cone_ahead, at);
        add(Operation::cone_near, near);
        add(Operation::cone_met, near && has_roots(shape, ray));
        add(Operation::cone_inward, near && own);
    } else if constexpr (requires { shape.inverse_radius; }) {
        const Place at = place(shape.centre, shape.radius, ray, limit);
        add_test(Operation::sphere_test, scene.spheres.count);
        add_place(Operation::sphere_ahead, at);
        add(Operation::sphere_met, at.near() && !(own && ray.outward));
    } else if constexpr (requires { shape.radius; }) {
        const double t = plane_distance(shape.centre, shape.normal, ray);
        add_test(Operation::disc_test, scene.discs.count);
        add(Operation::disc_ahead, t > 0);
        add(Operation::disc_met, !own && within(t, limit));
    } else {
        const Place at = place(shape.middle, shape.bound, ray, limit);
        const bool near = at.near() && !own;
        const bool met = near && within(plane_distance(vertices[shape.first], shape.normal, ray), limit);
        if constexpr (requires { shape.count; }) {
            add_test(Operation::polygon_test, scene.polygons.count);
            add(Operation::polygon_opaque, !effects.see_through);
            add_place(Operation::polygon_ahead, at);
            add(Operation::polygon_near, near);
            add(Operation::polygon_met, met);
            add(Operation::polygon_corner, met ? shape.count : 0);
            add(Operation::polygon_edge, met ? edges_across(shape, vertices, ray) : 0);
        } else {
            add_test(Operation::patch_test, scene.patches.count);
            add(Operation::patch_opaque, !effects.see_through);
            add_place(Operation::patch_ahead, at);
            add(Operation::patch_near, near);
            add(Operation::patch_met, met);
        }
    }
}

// That a ray meets a shape, at its corners.
template <class S>
void count_found(const S& shape)
{
    if constexpr (requires { shape.count; }) {
        add(Operation::polygon_inside);
        add(Operation::polygon_found, shape.count);
    } else if constexpr (requires { shape.second; }) {
        add(Operation::patch_found);
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

// Is the shape in the set?
template <Effects E>
bool has(const Scene<Counting, E>& scene, ShapeSet set, Kind kind, uint32_t index)
{
    const uint32_t before[] = {0, scene.spheres.count, scene.cones.count, scene.polygons.count, scene.patches.count};
    constexpr Kind kinds[] = {Kind::sphere, Kind::cone, Kind::polygon, Kind::patch, Kind::disc};
    for (int i = 0; i < 5; i++) {
        index += before[i];
        if (kinds[i] == kind)
            break;
    }
    return set == every_shape || (set & set_of(index)) != 0;
}

// These stand in for the tracer's functions of the same names.
template <Effects E>
bool nearest(const Scene<Counting, E>& scene, const Shot& ray, Hit<Counting>& hit, ShapeSet set = every_shape)
{
    add(Operation::ray);
    double limit = Counting::length_max;
    for_each_shape(scene, [&](const auto& shape, Kind kind, uint32_t index) {
        if (!has(scene, set, kind, index))
            return false;
        count_test(scene, shape, ray, limit);
        add(Operation::nearest_test);
        double t = 0;
        Local<Counting> local{};
        if (intersect_in(scene, shape, ray, limit, t, local)) {
            limit = std::min(limit, t);
            add(Operation::found);
            count_found(shape);
        }
        return false;
    });
    return qray::nearest<Counting, E>(scene, ray, hit);
}

template <Effects E>
double light_through(const Scene<Counting, E>& scene, const Shot& ray, double distance, ShapeSet set = every_shape)
{
    add(Operation::veiled_ray, effects.see_through);
    const double through = qray::light_through<Counting, E>(scene, ray, distance);
    for_each_shape(scene, [&](const auto& shape, Kind kind, uint32_t index) {
        if (!has(scene, set, kind, index))
            return false;
        count_test(scene, shape, ray, distance);
        add(Operation::veiled_test, effects.see_through);
        if (crossings_in(scene, shape, ray, distance) == 0)
            return false;
        count_found(shape);
        return through == 0 && scene.transmits[shape.tag.material()].amount == 0;
    });
    return through;
}

template <Effects E, class Count>
Rgb<Counting> local_light(const Scene<Counting, E>& scene, const Seen<Counting, E.windows>& at, Count& count)
{
    add(Operation::hit);
    add(seen[static_cast<int>(at.kind)]);
    add(Operation::glass, scene.transmits[at.material].amount > 0);
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
    add(Operation::lamp, scene.lights.count);
    add(Operation::lamp_several, scene.lights.count > 1 ? scene.lights.count : 0);
    for (uint32_t i = 0; i < scene.lights.count; i++) {
        Vec<double> l{};
        double distance = 0;
        if (towards(scene.lights[i], at.surface.point, l, distance))
            lamp(l);
    }
    add(Operation::sun_lamp, scene.suns.count);
    for (uint32_t i = 0; i < scene.suns.count; i++)
        lamp(scene.suns[i].from);
    return qray::local_light<Counting, E>(scene, at, count);
}

constexpr Effects without_tree(bool windows)
{
    Effects e = everything(scene::Settings::max_depth);
    e.tree = false;
    e.windows = windows;
    return e;
}

scene::Storage<Counting> storage;

// Returns how many rows.
template <Effects E>
double count_rows(const Scene<Counting, E>& view, uint32_t stride)
{
    double rows = 0;
    for (uint32_t j = stride / 2; j < storage.camera.height; j += stride, rows++)
        for (uint32_t i = 0; i < storage.camera.width; i++) {
            add(Operation::pixel);
            render_pixel(view, i, j, count_ray);
        }
    return rows;
}

} // namespace

OperationCounts count_operations(const scene::Description& description, const scene::Settings& settings,
                                 uint32_t stride, bool windows)
{
    counts = {};
    scene::Error error;
    if (!scene::Builder<Counting>(description, settings, storage).build(error))
        return counts;
    effects = storage.effects;
    double rows = 0;
    scene::WindowBuilder<Counting> builder;
    if (windows && builder.build(storage)) {
        auto view = storage.template view<without_tree(true)>();
        view.windows.value = builder.windows();
        rows = count_rows(view, stride);
    } else {
        rows = count_rows(storage.template view<without_tree(false)>(), stride);
    }
    for (double& n : counts.of)
        n *= storage.camera.height / rows;
    return counts;
}

} // namespace qray::cli
