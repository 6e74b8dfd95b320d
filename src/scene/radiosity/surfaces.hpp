// The flat surfaces that light one another: their figures, cells and walls.
#pragma once

#include <algorithm>

#include "../builder.hpp"
#include "../radiosity.hpp"
#include "walls.hpp"

namespace qray::scene::radiosity {

inline constexpr uint32_t none = UINT32_MAX; // for the number of anything

inline bool no_memory(Error& error)
{
    return error.say("not enough memory for the light of surfaces");
}
// Cuts arrays from a room, which is made as large as they need.
template <class Cut>
bool lay_out(Room& room, const Solving& with, Error& error, Cut cut)
{
    if (!with.make_room(room, lay_out_in(room, cut)))
        return no_memory(error);
    lay_out_in(room, cut);
    return true;
}

// Calls part(i) for all i below count, by any threads.
template <class F>
void run(const Solving& with, uint32_t count, F part)
{
    with.run([](void* work, uint32_t i) { (*static_cast<F*>(work))(i); }, &part, count, with);
}

// A surface that takes part, in the moved and scaled scene.
struct FlatSurface {
    Vec3d origin, u, v, n; // a corner of its rectangle, and unit vectors
    double width, height;  // of a cell; at first of all
    Extent box;
    uint32_t columns, rows;
    uint32_t outline, corners; // in the plane, along u and v from the origin
    uint32_t cell;             // the first of those outside; those inside follow
    uint32_t fill, place;
    Kind kind;

    uint32_t cells() const { return columns * rows; }
    Vec3d at(const Point2& p) const { return origin + u * p.x + v * p.y; }
    Point2 place_of(const Vec3d& p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
    Vec3d normal(uint32_t side) const { return side == 0 ? n : n * -1; }
    // The k-th of so many equal parts of its rectangle.
    Quad part(uint32_t of_columns, uint32_t of_rows, uint32_t k) const
    {
        const double wide = width * columns / of_columns, high = height * rows / of_rows;
        const Point2 low{k % of_columns * wide, k / of_columns * high};
        return {low, {low.x + wide, low.y + high}};
    }
};

class Surfaces {
public:
    Surfaces(Description& of, const Frame& in) : d(of), frame(in) {}

    Walls walls{}; // of the side that find_walls() was last asked for
    Ring cut{};    // what cut_out() left

    const FlatSurface* begin() const { return all; }
    const FlatSurface* end() const { return all + count; }
    uint32_t size() const { return count; }
    const FlatSurface& operator[](uint32_t number) const { return all[number]; }
    uint32_t number(const FlatSurface& s) const { return static_cast<uint32_t>(&s - all); }
    // Of a place in the scene: its surface, or none where that takes no part.
    uint32_t of(uint32_t place) const { return of_place[place]; }
    const Fill& fill(const FlatSurface& s) const { return d.fills[s.fill]; }

    // All that takes part, with a rectangle of cells for each.
    bool find(Room& room, const Solving& with, Error& error)
    {
        uint32_t most_surfaces = 0, corners = 0, most = 0, places = 0;
        for (uint32_t i = 0; i < d.object_count; places += surfaces_of(d.objects[i++])) {
            uint32_t own = 0;
            outline(d.objects[i], [&](const Vec3d&) { own++; });
            most_surfaces += own != 0;
            corners += own;
            most = std::max(most, own);
        }
        walls.most = 4 * most_surfaces;
        const auto cut_arrays = [&](Layout& layout) {
            all = layout.array<FlatSurface>(most_surfaces);
            outlines = layout.array<Point2>(corners);
            figure = layout.array<Vec3d>(most);
            cut.at = layout.array<Point2>(6 * size_t{most} + 16);
            spare.at = layout.array<Point2>(6 * size_t{most} + 16);
            walls.all = layout.array<Wall>(walls.most);
            of_place = layout.array<uint32_t>(places);
        };
        if (!lay_out(room, with, error, cut_arrays))
            return false;
        double needed = 0;
        uint32_t place = 0, corner = 0;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            uint32_t own = 0;
            outline(o, [&](const Vec3d& p) { figure[own++] = p; });
            for (uint32_t k = surfaces_of(o); k-- > 0;)
                of_place[place + k] = own != 0 ? count : none;
            if (own != 0) {
                FlatSurface& s = all[count++];
                s.fill = o.fill;
                s.place = place;
                s.kind = o.kind;
                s.outline = corner;
                s.corners = own;
                corner += own;
                lay_plane(s);
            }
            place += surfaces_of(o);
        }
        for (uint32_t i = 0; i < count; i++)
            lay_cells(all[i], needed);
        if (needed > Limits::cells) {
            error.at = d.radiosity_at;
            return error.say("'radiosity %g' needs %.0f cells of light; expected at most %u (limit 'cells')",
                             d.radiosity, needed, Limits::cells);
        }
        d.cell_count = static_cast<uint32_t>(needed);
        return true;
    }

    // What stands on a side, as walls; but not along its edges.
    void find_walls(const FlatSurface& s, uint32_t side)
    {
        const double near = 1e-3 * edge();
        const Vec3d n = s.normal(side);
        walls.count = 0;
        for (const FlatSurface& w : *this) {
            const Vec3d low = w.box.low - s.box.high, high = s.box.low - w.box.high;
            if (&w == &s || fmax(fmax(low.x, low.y), low.z) > near || fmax(fmax(high.x, high.y), high.z) > near)
                continue;
            Wall wall{{}, {}, {dot(w.n, s.u), dot(w.n, s.v)}, dot(w.n, w.origin - s.origin), number(w)};
            const double across = sqrt(wall.n.x * wall.n.x + wall.n.y * wall.n.y);
            if (across < 1e-3)
                continue;
            wall.n = {wall.n.x / across, wall.n.y / across};
            wall.height /= across;
            const auto height = [&](uint32_t i) { return dot(w.at(outlines[w.outline + i]) - s.origin, n) - near; };
            // Where its outline goes through the plane, in order along the line.
            constexpr uint32_t most = 32;
            double ways[most];
            uint32_t crossed = 0;
            for (uint32_t i = 0; i < w.corners && crossed < most; i++) {
                const uint32_t next = i + 1 < w.corners ? i + 1 : 0;
                const double a = height(i), b = height(next);
                if ((a > 0) == (b > 0))
                    continue;
                const Vec3d from = w.at(outlines[w.outline + i]), to = w.at(outlines[w.outline + next]);
                const Point2 p = s.place_of(from + (to - from) * (a / (a - b)));
                ways[crossed++] = p.y * wall.n.x - p.x * wall.n.y;
            }
            std::sort(ways, ways + crossed);
            if (crossed < 2 || !parts_area(s, wall))
                continue;
            const auto point = [&wall](double way) {
                return Point2{wall.n.x * wall.height - wall.n.y * way, wall.n.y * wall.height + wall.n.x * way};
            };
            for (uint32_t i = 0; i + 1 < crossed && walls.count < walls.most; i += 2) {
                wall.a = point(ways[i]);
                wall.b = point(ways[i + 1]);
                walls.all[walls.count++] = wall;
            }
        }
    }
    bool has_walls(const FlatSurface& s, uint32_t side)
    {
        find_walls(s, side);
        return walls.count != 0;
    }

    bool holds(const FlatSurface& s, const Point2& p) const
    {
        bool inside = false;
        const Point2* const v = outlines + s.outline;
        for (uint32_t i = 0, before = s.corners - 1; i < s.corners; before = i++) {
            const Point2 &a = v[i], &b = v[before];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y))
                inside = !inside;
        }
        return inside;
    }
    // What of a surface lies in a rectangle and on some sides of walls, into `cut`: twice its area, and its middle. 0
    // where it is next to nothing.
    double cut_out(const FlatSurface& s, const Quad& quad, const QuadPart* part, Point2& middle)
    {
        begin_cut(s);
        cut_off([&](const Point2& p) { return p.x - quad.low.x; });
        cut_off([&](const Point2& p) { return quad.high.x - p.x; });
        cut_off([&](const Point2& p) { return p.y - quad.low.y; });
        cut_off([&](const Point2& p) { return quad.high.y - p.y; });
        for (uint32_t i = 0; part != nullptr && i < part->count; i++)
            cut_off([&](const Point2& p) { return part->height(i, p); });
        const double area = cut.area(middle);
        return area > 1e-6 * (quad.high.x - quad.low.x) * (quad.high.y - quad.low.y) ? area : 0;
    }

private:
    Description& d;
    const Frame& frame;
    FlatSurface* all = nullptr;
    uint32_t count = 0;
    Point2* outlines = nullptr;
    Vec3d* figure = nullptr; // corners of one
    Ring spare{};
    uint32_t* of_place = nullptr;

    // The corners of a figure, or none where it takes no part, in the moved and scaled scene.
    template <class F>
    void outline(const Object& o, F f) const
    {
        with_host(o.kind, [&](auto host) { host.outline(d, o, [&](const Vec3d& p) { f(frame.point(p)); }); });
    }

    // The rectangle of `figure`, along its longest edge.
    void lay_plane(FlatSurface& s) const
    {
        s.n = unit(across(figure, s.corners));
        Vec3d longest;
        for (uint32_t i = 0; i < s.corners; i++)
            if (const Vec3d edge = figure[i + 1 < s.corners ? i + 1 : 0] - figure[i];
                length(edge) > 1.001 * length(longest))
                longest = edge;
        s.u = unit(longest - s.n * dot(longest, s.n));
        s.v = cross(s.n, s.u);
        s.origin = figure[0];
        s.box = {};
        Point2 low{}, high{};
        for (uint32_t i = 0; i < s.corners; i++) {
            const Point2 p = s.place_of(figure[i]);
            low = {fmin(low.x, p.x), fmin(low.y, p.y)};
            high = {fmax(high.x, p.x), fmax(high.y, p.y)};
            s.box.add(figure[i]);
        }
        s.origin = s.at(low);
        for (uint32_t i = 0; i < s.corners; i++)
            outlines[s.outline + i] = s.place_of(figure[i]);
        s.width = high.x - low.x;
        s.height = high.y - low.y;
    }

    // `needed` counts cells.
    void lay_cells(FlatSurface& s, double& needed)
    {
        const auto parts = [this](double size) { return fmin(fmax(ceil(size / edge() - 1e-9), 1), 1e9); };
        double columns = parts(s.width), rows = parts(s.height);
        for (uint32_t side = 0; side < 2; side++)
            if (columns * rows > 1 || has_walls(s, side)) { // so that there is something between
                columns = fmax(columns, 2);
                rows = fmax(rows, 2);
            }
        s.cell = needed < Limits::cells ? static_cast<uint32_t>(needed) : 0;
        needed += 2 * columns * rows;
        s.columns = static_cast<uint32_t>(columns);
        s.rows = static_cast<uint32_t>(rows);
        s.width /= columns;
        s.height /= rows;
    }
    double edge() const { return d.radiosity * frame.scale; }

    // Does its line leave some of the surface on both sides?
    bool parts_area(const FlatSurface& s, const Wall& wall)
    {
        Point2 middle{};
        const auto area = [&](double sign) {
            begin_cut(s);
            cut_off([&](const Point2& p) { return sign * wall.above(p); });
            return cut.area(middle);
        };
        const double above = area(1), below = area(-1);
        return fmin(above, below) > 1e-3 * fmax(above, below);
    }
    void begin_cut(const FlatSurface& s)
    {
        std::copy_n(outlines + s.outline, s.corners, cut.at);
        cut.count = s.corners;
    }
    template <class F>
    void cut_off(F side)
    {
        cut.cut(spare, side);
        std::swap(cut, spare);
    }
};

} // namespace qray::scene::radiosity
