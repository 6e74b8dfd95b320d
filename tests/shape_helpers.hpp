// Shapes of a number system from their plain measures, each as its header documents its fields.
#pragma once

#include <qray/cone.hpp>
#include <qray/disc.hpp>
#include <qray/patch.hpp>
#include <qray/polygon.hpp>
#include <qray/sphere.hpp>

#include <vector>

#include "number_helpers.hpp"

namespace qray::test {

template <class N>
Sphere<N> make_sphere(const Vec3& centre, double r, Tag tag = make_tag(0, 0))
{
    const auto radius = make<N>::length(r);
    return {make<N>::point(centre), radius, make<N>::inverse(radius), tag};
}

template <class N>
Disc<N> make_disc(const Vec3& centre, const Vec3& normal, double r, Tag tag = make_tag(0, 0))
{
    return {make<N>::point(centre), make<N>::direction(normal), make<N>::length(r), tag};
}

// From base to apex, with a radius at either end.
template <class N>
Cone<N> make_cone(const Vec3& base, double base_radius, const Vec3& apex, double apex_radius,
                  Tag tag = make_tag(0, 0))
{
    using M = make<N>;
    const double height = length(apex - base);
    const Vec3 axis = unit(apex - base);
    const double growth = (apex_radius - base_radius) / height;
    const double cosine = 1 / std::sqrt(1 + growth * growth);
    const Vec3 other = std::fabs(axis.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 e1 = unit(cross(other, axis)), e2 = cross(axis, e1);
    const double bound = std::hypot(height / 2, std::fmax(base_radius, apex_radius));
    return {M::point((base + apex) * 0.5),
            M::direction(e1),
            M::direction(e2),
            M::direction(axis),
            M::length(cosine * (base_radius + apex_radius) / 2),
            M::length(height / 2),
            M::length(bound * (1 + 1e-6) + 4 * M::length_ulp(bound)),
            M::unit(cosine),
            M::unit(growth * cosine),
            tag};
}

// A polygon, or a fan of patches, and the table that holds its corners.
template <class N>
struct Corners {
    std::vector<Point<N>> at;
    Point<N> middle{};
    typename N::Length bound{};

    explicit Corners(const std::vector<Vec3>& corners)
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
struct PolygonOf : Corners<N> {
    Polygon<N> shape;

    explicit PolygonOf(const std::vector<Vec3>& corners, Tag tag = make_tag(0, 0))
        : Corners<N>(corners), shape{make<N>::direction(cross(corners[1] - corners[0], corners[2] - corners[1])),
                                     this->middle, this->bound, 0, static_cast<uint32_t>(corners.size()), tag}
    {
    }
    bool hit(const Ray<N>& ray, typename N::Length limit, typename N::Length& t) const
    {
        return intersect(shape, this->at.data(), ray, limit, t);
    }
};

// One triangle with a normal at each corner.
template <class N>
struct PatchOf : Corners<N> {
    std::vector<Direction<N>> normals;
    Patch<N> shape;

    PatchOf(const std::vector<Vec3>& corners, const std::vector<Vec3>& corner_normals, Tag tag = make_tag(0, 0))
        : Corners<N>(corners), shape{make<N>::direction(cross(corners[1] - corners[0], corners[2] - corners[1])),
                                     this->middle, this->bound, 0, 1, tag}
    {
        for (const Vec3& n : corner_normals)
            normals.push_back(make<N>::direction(n));
    }
    bool hit(const Ray<N>& ray, typename N::Length limit, typename N::Length& t) const
    {
        return intersect(shape, this->at.data(), ray, limit, t);
    }
    Direction<N> normal(const Ray<N>& ray) const
    {
        return shading_normal(shape, this->at.data(), normals.data(), ray);
    }
};

} // namespace qray::test
