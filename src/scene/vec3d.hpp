// Vectors and extents in double precision: what the parser checks and the builder computes with.
#pragma once

#include <math.h>
#include <stdint.h>

namespace qray::scene {

struct Vec3d {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3d&, const Vec3d&) = default;
};

inline Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3d operator*(const Vec3d& a, double k) { return {a.x * k, a.y * k, a.z * k}; }
inline Vec3d times(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The size of the largest component.
inline double largest(const Vec3d& a) { return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))); }

// Twice the area of a triangle, across it: counter-clockwise seen from where it points.
inline Vec3d triangle_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return cross(b - a, c - b); }

// Scaled first: squares of components near either end of double's range neither overflow nor vanish.
inline double length(const Vec3d& a)
{
    const double m = largest(a);
    if (m == 0)
        return 0;
    const Vec3d b{a.x / m, a.y / m, a.z / m};
    return m * sqrt(dot(b, b));
}
inline Vec3d unit(const Vec3d& a) // not zero
{
    const double m = largest(a);
    const Vec3d b{a.x / m, a.y / m, a.z / m};
    return b * (1 / sqrt(dot(b, b)));
}

struct Extent {
    Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    void add(const Vec3d& p, const Vec3d& extent = {})
    {
        low = {fmin(low.x, p.x - extent.x), fmin(low.y, p.y - extent.y), fmin(low.z, p.z - extent.z)};
        high = {fmax(high.x, p.x + extent.x), fmax(high.y, p.y + extent.y), fmax(high.z, p.z + extent.z)};
    }
    Vec3d middle() const { return (low + high) * 0.5; }
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

// The same where components of n are rounded numbers: near 1, what is left to 1 would be of their error's root.
inline Vec3d circle_across(const Vec3d& n, double r)
{
    const auto side = [r](double a, double b) { return r * sqrt(a * a + b * b); };
    return {side(n.y, n.z), side(n.z, n.x), side(n.x, n.y)};
}

// A unit vector across the unit vector n.
inline Vec3d unit_across(const Vec3d& n)
{
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    return unit(cross(x <= y && x <= z ? Vec3d{1, 0, 0} : y <= z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, n));
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

inline Vec3d grey(double v) { return {v, v, v}; }

// A point as seen from a surface that it is near, or not: how far outward it is, and which way that is, 0 at an apex.
struct Above {
    bool near = false;
    double height = 0;
    Vec3d outward;
};

// Of the plane through `at` with normal n.
inline Above above_plane(const Vec3d& at, const Vec3d& n, const Vec3d& p, double off)
{
    const double height = dot(p - at, n);
    return {fabs(height) <= off, height, n};
}

} // namespace qray::scene
