// Shapes in double, in the scene's own units: how far they reach, and what lies on them.
#pragma once

#include <math.h>

#include "description.hpp"
#include "vec3d.hpp"

namespace qray::scene {

struct Box {
    Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    void add(const Vec3d& p, const Vec3d& extent = {})
    {
        low = {fmin(low.x, p.x - extent.x), fmin(low.y, p.y - extent.y), fmin(low.z, p.z - extent.z)};
        high = {fmax(high.x, p.x + extent.x), fmax(high.y, p.y + extent.y), fmax(high.z, p.z + extent.z)};
    }
    bool holds(const Vec3d& p) const
    {
        return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y && p.z <= high.z;
    }
};

// Half the extent of a circle of radius r across the unit vector n.
inline Vec3d circle_extent(const Vec3d& n, double r)
{
    const auto side = [r](double c) { return r * sqrt(fmax(0, 1 - c * c)); };
    return {side(n.x), side(n.y), side(n.z)};
}

inline void add_object(Box& box, const Description& d, const Object& o)
{
    switch (o.shape) {
    case Shape::sphere: box.add(o.a, {o.ra, o.ra, o.ra}); break;
    case Shape::disc: box.add(o.a, circle_extent(unit(o.b), o.ra)); break;
    case Shape::cone: {
        const Vec3d axis = unit(o.b - o.a);
        box.add(o.a, circle_extent(axis, o.ra));
        box.add(o.b, circle_extent(axis, o.rb));
        break;
    }
    case Shape::polygon:
    case Shape::patch:
        for (uint32_t i = 0; i < o.count; i++)
            box.add(d.vertices[o.vertex + i]);
        break;
    case Shape::plane: break;
    }
}

// A unit vector across the unit vector n.
inline Vec3d unit_across(const Vec3d& n)
{
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return unit(cross(x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, n));
}

// A cone's ball: around the middle of the axis, through the wider rim.
inline double cone_bound(const Object& o)
{
    const double half = length(o.b - o.a) / 2;
    const double r = fmax(o.ra, o.rb);
    return sqrt(half * half + r * r);
}

// Across a polygon, of any length: by its first three corners or, where these are in line, by all of them (Newell).
inline Vec3d across(const Vec3d* v, uint32_t count)
{
    const Vec3d g = triangle_area(v[0], v[1], v[2]);
    if (length(g) > 1e-12 * length(v[1] - v[0]) * length(v[2] - v[1]))
        return g;
    Vec3d sum;
    for (uint32_t i = 1; i + 1 < count; i++)
        sum = sum + cross(v[i] - v[0], v[i + 1] - v[0]);
    return sum;
}

// A patch of n corners is n - 2 triangles, each a surface of its own.
inline uint32_t surfaces_of(const Object& o)
{
    return o.shape == Shape::patch ? o.count - 2 : 1;
}

// The greatest radius of what is curved.
inline double widest(const Object& o)
{
    return o.shape == Shape::sphere || o.shape == Shape::cone ? fmax(o.ra, o.rb) : HUGE_VAL;
}

// Is p no farther than `off` from an object, of a patch from the part-th triangle? Then also the outward normal there,
// 0 at an apex, and how far outward p is. Polygons are taken for what their boxes hold of their planes: a ray from there meets nothing of them.
inline bool lies_on(const Description& d, const Object& o, uint32_t part, const Vec3d& p, double off, Vec3d& outward,
                    double& above)
{
    const auto in_plane = [&](const Vec3d& at, const Vec3d& n) {
        outward = n;
        above = dot(p - at, n);
        return fabs(above) <= off;
    };
    const auto in_polygon = [&](const Vec3d* corners, uint32_t count) {
        Box box;
        for (uint32_t i = 0; i < count; i++)
            box.add(corners[i], {off, off, off});
        if (!box.holds(p)) // of a large mesh, nearly all
            return false;
        const Vec3d g = across(corners, count);
        return length(g) > 0 && in_plane(corners[0], unit(g));
    };
    const Vec3d* v = d.vertices + o.vertex;
    switch (o.shape) {
    case Shape::sphere: {
        const double distance = length(p - o.a);
        above = distance - o.ra;
        if (!(distance > 0) || fabs(above) > off)
            return false;
        outward = unit(p - o.a);
        return true;
    }
    case Shape::plane: return in_plane(o.a, unit(o.b));
    case Shape::disc: return length(p - o.a) <= o.ra + off && in_plane(o.a, unit(o.b));
    case Shape::cone: {
        const Vec3d axis = unit(o.b - o.a);
        const double height = length(o.b - o.a), growth = (o.rb - o.ra) / height;
        const double cosine = 1 / sqrt(1 + growth * growth);
        const double z = dot(p - o.a, axis), r = o.ra + growth * z;
        const Vec3d radial = p - o.a - axis * z;
        const double rho = length(radial);
        outward = r > off && rho > 0 ? (radial * (1 / rho) - axis * growth) * cosine : Vec3d{};
        above = (rho - r) * cosine;
        return z >= -off && z <= height + off && fabs(above) <= off;
    }
    case Shape::polygon: return in_polygon(v, o.count);
    case Shape::patch: {
        const Vec3d corners[3] = {v[0], v[part + 1], v[part + 2]};
        return in_polygon(corners, 3);
    }
    }
    return false;
}

} // namespace qray::scene
