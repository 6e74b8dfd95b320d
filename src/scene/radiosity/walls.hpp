// Walls on a side of a surface, and what they part.
#pragma once

#include "figures.hpp"

namespace qray::scene::radiosity {

// Where a surface that stands on another, or goes through it, meets its plane: from a to b, on a line
// where n.p = height.
struct Wall {
    Point2 a, b, n;
    double height;
    uint32_t surface;
    double above(const Point2& p) const { return n.x * p.x + n.y * p.y - height; }
};

// Those on a side.
struct Walls {
    Wall* all;
    uint32_t count, most;

    const Wall* begin() const { return all; }
    const Wall* end() const { return all + count; }
    // Does one stand between two places?
    bool part(const Point2& p, const Point2& q) const
    {
        for (const Wall& w : *this) {
            const double a = w.above(p), b = w.above(q);
            if ((a > 0) == (b > 0))
                continue;
            const Point2 at{p.x + (q.x - p.x) * a / (a - b), p.y + (q.y - p.y) * a / (a - b)};
            if ((at.x - w.a.x) * (at.x - w.b.x) + (at.y - w.a.y) * (at.y - w.b.y) < 0)
                return true;
        }
        return false;
    }
};

// A part of what is between four nodes of a side: on which sides of walls it lies.
struct QuadPart {
    static constexpr uint32_t most = 8;
    uint32_t link; // where its cut is to have its number
    uint32_t count;
    const Wall* walls[most];
    bool above[most];

    // Not negative where p is on the part's side of the i-th wall.
    double height(uint32_t i, const Point2& p) const { return walls[i]->above(p) * (above[i] ? 1 : -1); }
    // How much of a wall stands in it.
    double holds(const Wall& wall, const Quad& quad) const
    {
        double from = 0, to = 1;
        const auto keep = [&](double a, double b) { // what is not negative, from a to b
            if (a < 0 && b < 0)
                to = -1;
            else if (a < 0)
                from = fmax(from, a / (a - b));
            else if (b < 0)
                to = fmin(to, a / (a - b));
        };
        keep(wall.a.x - quad.low.x, wall.b.x - quad.low.x);
        keep(quad.high.x - wall.a.x, quad.high.x - wall.b.x);
        keep(wall.a.y - quad.low.y, wall.b.y - quad.low.y);
        keep(quad.high.y - wall.a.y, quad.high.y - wall.b.y);
        for (uint32_t i = 0; i < count; i++)
            keep(height(i, wall.a), height(i, wall.b));
        const double x = wall.b.x - wall.a.x, y = wall.b.y - wall.a.y;
        return (to - from) * sqrt(x * x + y * y);
    }
    // The place next to a corner, or a little inside.
    Point2 near(const Point2& corner, const Point2& middle) const
    {
        double way = 0;
        for (uint32_t i = 0; i < count; i++) {
            const double at = height(i, corner), in = height(i, middle);
            if (at < 0.05 * in)
                way = fmax(way, (0.05 * in - at) / (in - at));
        }
        return {corner.x + (middle.x - corner.x) * way, corner.y + (middle.y - corner.y) * way};
    }
};

} // namespace qray::scene::radiosity
