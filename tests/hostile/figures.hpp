// Shapes with corners: polygons and patches, as shapes.hpp has the others.
#pragma once

#include "bench.hpp"

namespace hostile {

// Random star-shaped figures in a plane, most of them concave.
struct Figure {
    Double3 centre, normal, e1, e2;
    double size;
    uint32_t count;
    Double3 corners[16];

    void make(Random& random, Regime regime, uint32_t n)
    {
        using namespace qray::scene;
        size = random_size(random, regime);
        centre = random_place(random, regime, size);
        normal = direction(random);
        e1 = across(random, normal);
        e2 = cross(normal, e1);
        count = n;
        double angle[16];
        for (uint32_t i = 0; i < count; i++)
            angle[i] = (i + random.in(0.05, 0.95)) * (2 * M_PI / count);
        const double squash = regime == Regime::needle ? random.logarithmic(1e-5, 1) : 1;
        for (uint32_t i = 0; i < count; i++) {
            const double r = size * (count == 3 ? 1 : random.in(0.2, 1));
            corners[i] = centre + e1 * (r * std::cos(angle[i])) + e2 * (r * squash * std::sin(angle[i]));
        }
    }
    template <class N>
    qray::Ray<N> aim(Random& random, Regime regime) const
    {
        using namespace qray::scene;
        const uint32_t i = random.below(count);
        const double share = random.unit();
        const Double3 edge = corners[i] + (corners[(i + 1) % count] - corners[i]) * share;
        const Double3 inside = edge + (centre - edge) * random.in(-0.3, 1);
        if (regime == Regime::ordinary || regime == Regime::small_far)
            return ray_at<N>(random, regime, inside);
        if (random.chance(0.5))
            return ray_along<N>(random, edge + (centre - edge) * random.in(-1e-3, 1e-3), direction(random));
        return ray_along<N>(random, inside, unit(across(random, normal) + normal * random.in(-1e-3, 1e-3)));
    }
};

// The plane of a figure and the crossing parity of its corners around a line, both as stored.
template <class R, class N, class M>
Meetings<R> meet_figure(const qray::Point<N>* corners, uint32_t count, const qray::Direction<N>& normal,
                        const qray::Ray<M>& ray)
{
    const Vec3<R> d = exact3<R>(ray.direction), o = exact3<R>(ray.origin), n = exact3<R>(normal);
    Meetings<R> m;
    if (dot(d, n) == 0)
        return m;
    R t = dot(exact3<R>(corners[0]) - o, n) / dot(d, n);
    // Across the ray, in its own length.
    const R ax = size(d.x), ay = size(d.y), az = size(d.z);
    const auto turned = [&](const Vec3<R>& v) {
        return ax >= ay && ax >= az ? Vec3<R>{v.y, v.z, v.x} : ay >= az ? Vec3<R>{v.z, v.x, v.y} : v;
    };
    const Vec3<R> e = turned(d);
    Vec3<R> flat[16];
    R low = 1000, high = -1000;
    for (uint32_t i = 0; i < count; i++) {
        const Vec3<R> corner = exact3<R>(corners[i]) - o, v = turned(corner);
        const R depth = dot(corner, d) / dot(d, d);
        low = depth < low ? depth : low;
        high = depth > high ? depth : high;
        flat[i] = {v.x * e.z - v.z * e.x, v.y * e.z - v.z * e.y, 0};
    }
    bool inside = false;
    R nearest = 1000;
    for (uint32_t i = 0; i < count; i++) {
        const Vec3<R>&a = flat[i], &b = flat[i + 1 == count ? 0 : i + 1];
        const R area = a.x * b.y - b.x * a.y;
        if ((a.y > 0) != (b.y > 0) && (b.y > 0 ? area > 0 : area < 0))
            inside = !inside;
        const Vec3<R> ab = b - a;
        const R l2 = dot(ab, ab);
        R k = l2 > 0 ? -dot(a, ab) / l2 : R(0);
        k = k < 0 ? R(0) : k > 1 ? R(1) : k;
        const R distance = length(a + ab * k);
        nearest = distance < nearest ? distance : nearest;
    }
    // Almost edge on the stored normal says less than the corners do.
    t = t < low ? low : t > high ? high : t;
    m.add(t, inside ? nearest : -nearest, size(dot(d, n)));
    return m;
}

// What polygons and patches have alike: the one shape in its table, and the figure that it was made of.
template <class N, template <class> class Shape, qray::scene::Array<Shape<N>> qray::scene::Storage<N>::*table>
struct FigureTrial {
    static constexpr bool curved = false;
    Bench<N> bench;
    const Shape<N>& shape = (bench.storage.*table).data[0];
    Figure figure;

    qray::Ray<N> aim(Random& random, Regime regime) const { return figure.aim<N>(random, regime); }
    template <class R, class M>
    Meetings<R> meet(const qray::Ray<M>& ray) const
    {
        return meet_figure<R, N>(bench.storage.vertices.data, figure.count, shape.normal, ray);
    }
    Wide outside(const Vec3<Wide>& p) const
    {
        return dot(p - exact3<Wide>(bench.storage.vertices.data[0]), exact3<Wide>(shape.normal));
    }

protected:
    // Until the builder leaves one in.
    template <class Normals>
    void make(Random& random, Regime regime, qray::Kind kind, uint32_t least, uint32_t more, Normals normals)
    {
        do {
            figure.make(random, regime, least + (more > 0 ? random.below(more) : 0));
            auto o = bench.object(kind);
            o.count = figure.count;
            for (uint32_t i = 0; i < o.count; i++) {
                bench.from.vertices[i] = figure.corners[i];
                normals(bench.from.normals[i]);
            }
            bench.build(o);
        } while ((bench.storage.*table).count == 0);
    }
};

template <class N>
struct PolygonTrial : FigureTrial<N, qray::Polygon, &qray::scene::Storage<N>::polygons> {
    static constexpr const char* name = "polygon";
    static constexpr Effects effects{.polygon = true};

    void make(Random& random, Regime regime)
    {
        PolygonTrial::FigureTrial::make(random, regime, qray::Kind::polygon, 3, 10, [](Double3&) {});
    }
};

template <class N>
struct PatchTrial : FigureTrial<N, qray::Patch, &qray::scene::Storage<N>::patches> {
    static constexpr const char* name = "patch";
    static constexpr Effects effects{.patch = true};

    void make(Random& random, Regime regime)
    {
        const auto beside = [&](Double3& normal) {
            using namespace qray::scene;
            normal = this->figure.normal + in_ball(random, 0.8);
        };
        PatchTrial::FigureTrial::make(random, regime, qray::Kind::patch, 3, 0, beside);
    }
};

} // namespace hostile
