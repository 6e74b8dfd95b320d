// Shapes of a number system from their plain measures, each as its header documents its fields, with what they are
// asked.
#pragma once

#include <qray/scene/lists.hpp>

#include <vector>

#include "../src/scene/vec3d.hpp"
#include "number_helpers.hpp"

namespace qray::test {

// A ray that leaves the surface named by tag.
template <class N>
Ray<N> ray_from(const Vec3& origin, const Vec3& along, Tag tag, bool outward)
{
    Ray<N> ray = make<N>::ray(origin, along);
    ray.from = tag;
    ray.outward = outward;
    return ray;
}

// The block scale that a ball of this size may have, or a cone's ball.
template <class N>
int32_t fine_for(double size, Blocks::Of Blocks::*of)
{
    return block_scale<N>(make<N>::length(size), of);
}

// A shape and its corners, if it has any.
template <template <class> class Shape, class N>
struct ShapeOf {
    using Length = typename N::Length;
    using M = make<N>;
    Shape<N> shape{};
    std::vector<Point<N>> points;
    std::vector<Direction<N>> normals;

    explicit ShapeOf(Tag tag) { shape.tag = tag; }
    // The corners, and the ball that holds them.
    ShapeOf(const std::vector<Vec3>& corners, Tag tag) : ShapeOf(tag)
    {
        scene::Extent box;
        for (const Vec3& c : corners) {
            points.push_back(M::point(c));
            box.add({c.x, c.y, c.z});
        }
        const scene::Vec3d middle = box.middle();
        const Vec3 centre{middle.x, middle.y, middle.z};
        double far = 0;
        for (const Vec3& c : corners)
            far = std::fmax(far, length(c - centre));
        shape.normal = M::direction(cross(corners[1] - corners[0], corners[2] - corners[1]));
        shape.middle = M::point(centre);
        shape.bound = M::length(far * (1 + 1e-6) + 4 * M::length_ulp(far));
    }

    Corners<N> corners() const { return {points.data(), normals.data()}; }
    bool hit(const Ray<N>& ray, Length limit, Length& t) const
    {
        Local<N> local{};
        return intersect(shape, corners(), ray, limit, t, local);
    }
    // Where the ray meets it, and the normal there; both zero where it does not.
    void surface(const Ray<N>& ray, Vec3& point, Vec3& normal) const
    {
        Length t{};
        Local<N> local{};
        Point<N> q{};
        Direction<N> n{};
        if (intersect(shape, corners(), ray, N::length_max, t, local))
            surface_of(shape, corners(), ray, t, local, q, n);
        point = value(q);
        normal = value(n);
    }
    Vec3 normal(const Ray<N>& ray) const
    {
        Vec3 point, n;
        surface(ray, point, n);
        return n;
    }
    Vec3 shading(const Ray<N>& ray) const
    {
        return value(shading_normal(shape, corners(), ray, normal_of(shape, corners())));
    }
    int crossings(const Ray<N>& ray, Length distance) const
    {
        return qray::crossings(shape, corners(), ray, distance);
    }
};

template <class N>
struct SphereOf : ShapeOf<Sphere, N> {
    using ShapeOf<Sphere, N>::shape;

    SphereOf(const Vec3& centre, double r, Tag tag = make_tag(0, 0))
        : SphereOf(centre, r, tag, fine_for<N>(r, &Blocks::ball))
    {
    }
    SphereOf(const Vec3& centre, double r, Tag tag, int32_t fine) : ShapeOf<Sphere, N>(tag)
    {
        shape.centre = make<N>::point(centre);
        shape.radius = make<N>::length(std::ldexp(r, fine));
        shape.inverse_radius = make<N>::inverse(shape.radius);
        shape.fine = fine;
    }
    double radius() const { return std::ldexp(value(shape.radius), -shape.fine); }
};

template <class N>
struct DiscOf : ShapeOf<Disc, N> {
    using ShapeOf<Disc, N>::shape;

    DiscOf(const Vec3& centre, const Vec3& normal, double r, Tag tag = make_tag(0, 0)) : ShapeOf<Disc, N>(tag)
    {
        shape.centre = make<N>::point(centre);
        shape.normal = make<N>::direction(normal);
        shape.radius = make<N>::length(r);
    }
};

// From base to apex, with a radius at either end.
template <class N>
struct ConeOf : ShapeOf<Cone, N> {
    using ShapeOf<Cone, N>::shape;
    using typename ShapeOf<Cone, N>::M;

    ConeOf(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius, Tag tag = make_tag(0, 0))
        : ShapeOf<Cone, N>(tag)
    {
        const double height = length(apex - base);
        const Vec3 axis = unit(apex - base);
        const double growth = (apex_radius - base_radius) / height;
        const double cosine = 1 / std::sqrt(1 + growth * growth);
        const Vec3 other = std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 e1 = unit(cross(other, axis)), e2 = cross(axis, e1);
        const double bound = std::hypot(height / 2, std::fmax(base_radius, apex_radius));
        shape.fine = fine_for<N>(bound, &Blocks::cone);
        const double up = std::ldexp(1, shape.fine);
        shape.middle = M::point((base + apex) * 0.5);
        shape.e1 = M::direction(e1);
        shape.e2 = M::direction(e2);
        shape.axis = M::direction(axis);
        shape.rho0 = M::length(cosine * (base_radius + apex_radius) / 2 * up);
        shape.half = M::length(height / 2 * up);
        shape.bound = M::length(bound * up * (1 + 1e-6) + 4 * M::length_ulp(bound));
        shape.cosine = M::unit(cosine);
        shape.sine = M::unit(growth * cosine);
    }
};

template <class N>
struct PolygonOf : ShapeOf<Polygon, N> {
    explicit PolygonOf(const std::vector<Vec3>& corners, Tag tag = make_tag(0, 0)) : ShapeOf<Polygon, N>(corners, tag)
    {
        this->shape.count = static_cast<uint32_t>(corners.size());
    }
};

// The triangle of corners 0, 1 and 2, with a normal at each corner.
template <class N>
struct PatchOf : ShapeOf<Patch, N> {
    PatchOf(const std::vector<Vec3>& corners, const std::vector<Vec3>& corner_normals, Tag tag = make_tag(0, 0))
        : ShapeOf<Patch, N>(corners, tag)
    {
        for (const Vec3& n : corner_normals)
            this->normals.push_back(make<N>::direction(n));
        this->shape.second = 1;
    }
};

// What every test of a shape says first.
#define QRAY_SHAPE_TEST                        \
    using N = TypeParam;                       \
    using M [[maybe_unused]] = make<N>;        \
    [[maybe_unused]] const auto limit = N::length_max; \
    [[maybe_unused]] typename N::Length t{}

} // namespace qray::test
