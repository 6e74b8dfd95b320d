// Vectors in double precision: what the parser checks and the builder computes with.
#pragma once

#include <math.h>

namespace qray::scene {

struct Vec3d {
    double x = 0, y = 0, z = 0;
    friend bool operator==(const Vec3d&, const Vec3d&) = default;
};

inline Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3d operator*(const Vec3d& a, double k) { return {a.x * k, a.y * k, a.z * k}; }
inline double dot(const Vec3d& a, const Vec3d& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// The size of the largest component.
inline double largest(const Vec3d& a) { return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))); }

// Twice the area of a triangle, across it: counter-clockwise seen from where it points.
inline Vec3d triangle_area(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    return cross(b - a, c - b);
}

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

} // namespace qray::scene
