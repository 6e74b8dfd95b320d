// Shapes of a number system from their plain measures, each as its header documents its fields, and with one
// interface: hit(), normal() and crossings(), whatever their headers need to be told.
#pragma once

#include <qray/shape/cone.hpp>
#include <qray/shape/disc.hpp>
#include <qray/shape/patch.hpp>
#include <qray/shape/polygon.hpp>
#include <qray/shape/sphere.hpp>

#include <vector>

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

// The block scale that a curved surface of this size may have: at most 2^fine size = 32 is well within Length.
template <class N>
int32_t fine_for(double size)
{
    int32_t fine = 0;
    if constexpr (N::is_fixed)
        while (fine < 10 && std::ldexp(size, fine + 1) <= 32)
            fine++;
    return fine;
}

// What tests ask of every shape. Derived holds `shape` and says where its corners are.
template <class N, class Derived>
struct Asked {
    using Length = typename N::Length;
    bool hit(const Ray<N>& ray, Length limit, Length& t) const
    {
        Local<N> local{};
        return intersect(self().shape, self().corner_points(), ray, limit, t, local);
    }
    // Where the ray meets it, and the normal there; both zero where it does not.
    void surface(const Ray<N>& ray, Vec3& point, Vec3& normal) const
    {
        Length t{};
        Local<N> local{};
        Point<N> q{};
        Direction<N> n{};
        if (intersect(self().shape, self().corner_points(), ray, N::length_max, t, local))
            surface_of(self().shape, self().corner_points(), ray, t, local, q, n);
        point = value(q);
        normal = value(n);
    }
    Vec3 normal(const Ray<N>& ray) const
    {
        Vec3 point, n;
        surface(ray, point, n);
        return n;
    }
    int crossings(const Ray<N>& ray, Length distance) const
    {
        return qray::crossings(self().shape, self().corner_points(), ray, distance);
    }
    qray::Corners<N> corner_points() const { return {}; }

private:
    const Derived& self() const { return static_cast<const Derived&>(*this); }
};

template <class N>
struct SphereOf : Asked<N, SphereOf<N>> {
    Sphere<N> shape{};

    SphereOf(const Vec3& centre, double r, Tag tag = make_tag(0, 0)) : SphereOf(centre, r, tag, fine_for<N>(r)) {}
    SphereOf(const Vec3& centre, double r, Tag tag, int32_t fine)
    {
        shape.centre = make<N>::point(centre);
        shape.radius = make<N>::length(std::ldexp(r, fine));
        shape.inverse_radius = make<N>::inverse(shape.radius);
        shape.fine = fine;
        shape.tag = tag;
    }
    double radius() const { return std::ldexp(value(shape.radius), -shape.fine); }
};

template <class N>
struct DiscOf : Asked<N, DiscOf<N>> {
    Disc<N> shape{};

    DiscOf(const Vec3& centre, const Vec3& normal, double r, Tag tag = make_tag(0, 0))
    {
        shape.centre = make<N>::point(centre);
        shape.normal = make<N>::direction(normal);
        shape.radius = make<N>::length(r);
        shape.tag = tag;
    }
};

// From base to apex, with a radius at either end.
template <class N>
struct ConeOf : Asked<N, ConeOf<N>> {
    using M = make<N>;
    Cone<N> shape{};

    ConeOf(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius, Tag tag = make_tag(0, 0))
    {
        const double height = length(apex - base);
        const Vec3 axis = unit(apex - base);
        const double growth = (apex_radius - base_radius) / height;
        const double cosine = 1 / std::sqrt(1 + growth * growth);
        const Vec3 other = std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 e1 = unit(cross(other, axis)), e2 = cross(axis, e1);
        const double bound = std::hypot(height / 2, std::fmax(base_radius, apex_radius));
        shape.fine = fine_for<N>(bound);
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
        shape.tag = tag;
    }
};

// Corners, and the ball that holds them.
template <class N>
struct Figure {
    std::vector<Point<N>> at;
    Point<N> middle{};
    typename N::Length bound{};

    explicit Figure(const std::vector<Vec3>& corners)
    {
        Vec3 low = corners[0], high = corners[0];
        for (const Vec3& c : corners) {
            at.push_back(make<N>::point(c));
            low = {std::fmin(low.x, c.x), std::fmin(low.y, c.y), std::fmin(low.z, c.z)};
            high = {std::fmax(high.x, c.x), std::fmax(high.y, c.y), std::fmax(high.z, c.z)};
        }
        const Vec3 centre = (low + high) * 0.5;
        double far = 0;
        for (const Vec3& c : corners)
            far = std::fmax(far, length(c - centre));
        middle = make<N>::point(centre);
        bound = make<N>::length(far * (1 + 1e-6) + 4 * make<N>::length_ulp(far));
    }
};

template <class N>
struct PolygonOf : Asked<N, PolygonOf<N>> {
    Figure<N> corners;
    Polygon<N> shape{};

    explicit PolygonOf(const std::vector<Vec3>& c, Tag tag = make_tag(0, 0)) : corners(c)
    {
        shape.normal = make<N>::direction(cross(c[1] - c[0], c[2] - c[1]));
        shape.middle = corners.middle;
        shape.bound = corners.bound;
        shape.first = 0;
        shape.count = static_cast<uint32_t>(c.size());
        shape.tag = tag;
    }
    qray::Corners<N> corner_points() const { return {corners.at.data(), nullptr}; }
};

// One triangle with a normal at each corner.
template <class N>
struct PatchOf : Asked<N, PatchOf<N>> {
    Figure<N> corners;
    std::vector<Direction<N>> normals;
    Patch<N> shape{};

    PatchOf(const std::vector<Vec3>& c, const std::vector<Vec3>& corner_normals, Tag tag = make_tag(0, 0)) : corners(c)
    {
        for (const Vec3& n : corner_normals)
            normals.push_back(make<N>::direction(n));
        shape.normal = make<N>::direction(cross(c[1] - c[0], c[2] - c[1]));
        shape.middle = corners.middle;
        shape.bound = corners.bound;
        shape.first = 0;
        shape.second = 1;
        shape.tag = tag;
    }
    Vec3 shading(const Ray<N>& ray) const { return value(shading_normal(shape, corner_points(), ray)); }
    qray::Corners<N> corner_points() const { return {corners.at.data(), normals.data()}; }
};

// What every test of a shape says first.
#define QRAY_SHAPE_TEST                        \
    using N = TypeParam;                       \
    using M [[maybe_unused]] = make<N>;        \
    [[maybe_unused]] const auto limit = N::length_max; \
    [[maybe_unused]] typename N::Length t{}

} // namespace qray::test
