// Figures in a plane, and how much of what is around a place one of them takes.
#pragma once

#include "../vec3d.hpp"

namespace qray::scene::radiosity {

struct Point2 {
    double x, y;
};

// A rectangle along the axes.
struct Quad {
    Point2 low, high;
};

// A figure that is cut.
struct Ring {
    Point2* at;
    uint32_t count;

    // What of it has side(p) >= 0.
    template <class F>
    void cut(Ring& to, F side) const
    {
        to.count = 0;
        for (uint32_t i = 0; i < count; i++) {
            const Point2 &a = at[i], &b = at[i + 1 < count ? i + 1 : 0];
            const double ha = side(a), hb = side(b);
            if (ha >= 0)
                to.at[to.count++] = a;
            if ((ha >= 0) != (hb >= 0)) {
                const double k = ha / (ha - hb);
                to.at[to.count++] = {a.x + (b.x - a.x) * k, a.y + (b.y - a.y) * k};
            }
        }
    }
    // Twice the area, and the middle of its mass.
    double area(Point2& middle) const
    {
        double sum = 0, x = 0, y = 0;
        for (uint32_t i = 1; i + 1 < count; i++) {
            const Point2 a{at[i].x - at[0].x, at[i].y - at[0].y}, b{at[i + 1].x - at[0].x, at[i + 1].y - at[0].y};
            const double part = a.x * b.y - a.y * b.x;
            sum += part;
            x += part * (a.x + b.x);
            y += part * (a.y + b.y);
        }
        if (sum != 0)
            middle = {at[0].x + x / (3 * sum), at[0].y + y / (3 * sum)};
        return fabs(sum);
    }
};

// atan(y / x) for x, y >= 0, not both 0: error below 1e-12.
inline double arc_tangent(double y, double x)
{
    constexpr double quarter = 0.78539816339744830962;
    const double low = fmin(x, y), high = fmax(x, y);
    const bool large = low > 0.41421356237309505 * high;
    const double z = large ? (low - high) / (low + high) : low / high, square = z * z; // |z| <= tan(pi / 8)
    double sum = 0;
    for (int i = 29; i > 0; i -= 2)
        sum = 1.0 / i - square * sum;
    const double angle = z * sum + (large ? quarter : 0);
    return y > x ? 2 * quarter - angle : angle;
}

// The share of the half sphere around the unit vector n that a figure takes, seen from the origin and weighted by the
// cosine (Lambert's formula). `corner(i)` is one of its `count` corners; what is below the horizon is cut off.
template <class F>
double form_factor(uint32_t count, F corner, const Vec3d& n)
{
    double sum = 0;
    Vec3d first, last;
    bool begun = false;
    const auto to = [&](const Vec3d& p) {
        if (begun) {
            const Vec3d c = cross(last, p);
            if (const double size = sqrt(dot(c, c)), along = dot(last, p); size > 0) {
                const double acute = arc_tangent(size, fabs(along));
                sum += dot(c, n) / size * (along < 0 ? M_PI - acute : acute);
            }
        } else {
            first = p;
            begun = true;
        }
        last = p;
    };
    Vec3d before = corner(count - 1);
    double height = dot(before, n);
    for (uint32_t i = 0; i < count; i++) {
        const Vec3d p = corner(i);
        const double h = dot(p, n);
        if ((h > 0) != (height > 0))
            to(before + (p - before) * (height / (height - h)));
        if (h > 0)
            to(p);
        before = p;
        height = h;
    }
    if (begun)
        to(first);
    return fabs(sum) / (2 * M_PI);
}

} // namespace qray::scene::radiosity
