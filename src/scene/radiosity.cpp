#include "radiosity.hpp"

#include "builder.hpp"

#include <qray/trace/trace.hpp>

#include <algorithm>

namespace qray::scene {

namespace {

// What light between surfaces asks of the tracer.
constexpr Effects solver_effects()
{
    Effects e = everything(1);
    e.highlight = e.fractional_shine = e.mirror = e.transmit = e.grid = e.adaptive = e.eye_surface = false;
    e.triangle = e.smooth_triangle = e.flat_tree = false;
    return e;
}
using View = Scene<Double, solver_effects()>;

Vec3d times(const Vec3d& a, const Vec3d& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Vec3d vec(const Vec<double>& a) { return {a.x, a.y, a.z}; }
Vec<double> vec(const Vec3d& a) { return {a.x, a.y, a.z}; }

// atan(y / x) for x, y >= 0, not both 0: error below 1e-12.
double arc_tangent(double y, double x)
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

struct Point2 {
    double x, y;
};

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
};

struct SurfaceCell {
    Vec3d at;      // where light is gathered
    Vec3d colour;  // M
    Vec3d base;    // what arrives and never changes
    Vec3d own;     // what it sends on of the light of lamps, and its own, unless that is taken apart
    Vec3d arrives; // H, less the light of what is taken apart
    Vec3d sent;    // B, likewise
    uint32_t surface;
    uint8_t side;
    bool seen; // it holds some of the surface
    uint32_t links;
};

// Where a ray of a cell ends, and how much of the cell's light comes along it.
struct Link {
    uint32_t cell;
    float weight;
};

// A part of what glows, whose light is gathered by itself.
struct Piece {
    Vec3d at, light;
    uint32_t corner, corners, surface;
};

// A place where the light of a surface is known.
struct LightNode {
    uint32_t surface, cell; // whose middle it is, or UINT32_MAX
    Point2 at;
    uint8_t side;
    bool seen, filled; // it lies on the surface; it has light, at least of its neighbours
};

// Where a surface that stands on another, or goes through it, meets its plane: from a to b, on a line
// where n.p = height.
struct Wall {
    Point2 a, b, n;
    double height;
    uint32_t surface;
    double above(const Point2& p) const { return n.x * p.x + n.y * p.y - height; }
};

// What is between four nodes of a side.
struct Quad {
    Point2 low, high;
};

// A part of that: on which sides of walls it lies.
struct QuadPart {
    static constexpr uint32_t most = 8;
    uint32_t link; // where its cut is to have its number
    uint32_t count;
    const Wall* walls[most];
    bool above[most];
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

class Solver {
public:
    struct Rooms {
        Storage<Double> storage;
        Room surfaces, cells;
    };

    Solver(Description& to, const Solving& how, Rooms& in)
        : d(to), with(how), rooms(in), builder(to, settings, in.storage)
    {
    }

    bool solve(Error& error)
    {
        d.grid_count = 0;
        if (!with.make_room(rooms.storage.room, rooms.storage.lay_out(d, false)))
            return no_memory(error);
        if (!builder.build(error) || !find_surfaces(error) || !find_cells(error))
            return false;
        view = rooms.storage.view<solver_effects()>();
        find_directions();
        take_glow_apart();
        if (!lay_nodes(error))
            return false;
        run<&Solver::prepare>();
        run_nodes<&Solver::light_by_glow>();
        std::copy_n(d.light, d.light_size, glows);
        run<&Solver::gather_links>();
        if (!settle(error))
            return false;
        run_nodes<&Solver::light_by_others>();
        for (uint32_t i = 0; i < d.light_size; i++)
            d.light[i] = d.light[i] + glows[i];
        count_rays();
        const Frame& f = builder.frame;
        for (uint32_t i = 0; i < d.cut_count; i++) // back to where the text has it
            d.cuts[i].height = d.cuts[i].height / f.scale + dot(d.cuts[i].normal, f.origin);
        return true;
    }

private:
    static constexpr uint32_t most_through = 8;
    static constexpr uint32_t most_rounds = 1000;
    static constexpr uint32_t most_pieces = 2048; // of what glows
    static uint32_t pieces_of(uint32_t cells) { return std::max(cells, 4u); }

    Description& d;
    const Solving& with;
    Rooms& rooms;
    const Settings settings;
    Builder<Double> builder;
    View view{};

    FlatSurface* surfaces = nullptr;
    uint32_t surface_count = 0;
    Point2* outlines = nullptr;
    Vec3d* figure = nullptr;        // corners of one
    Ring rings[2] = {};             // it, cut
    Wall* walls = nullptr;          // of a side
    uint32_t wall_count = 0, most_walls = 0;
    uint32_t* surface_of = nullptr; // by place; `none` of what takes no part
    static constexpr uint32_t none = UINT32_MAX;

    SurfaceCell* cells = nullptr;
    uint32_t cell_count = 0;
    Link* links = nullptr;
    uint32_t most_links = 0; // of a cell
    Piece* pieces = nullptr;
    Vec3d* piece_corners = nullptr;
    uint32_t piece_count = 0;
    Vec3d* rays = nullptr;
    uint32_t ray_count = 0;

    // From places, and to pieces of what glows; not those that go on behind glass.
    void count_rays()
    {
        d.light_rays = 0;
        for (uint32_t i = 0; i < cell_count; i++)
            d.light_rays += cells[i].seen ? ray_count : 0;
        for (const LightNode* n = light_nodes; n != light_nodes + d.light_size; n++)
            d.light_rays += n->seen ? piece_count + (n->cell == none ? ray_count : 0) : 0;
    }

    static bool no_memory(Error& error)
    {
        snprintf(error.text, sizeof error.text, "not enough memory for the light of surfaces");
        return false;
    }
    template <void (Solver::*part)(SurfaceCell&)>
    void run()
    {
        const auto one = [](void* me, uint32_t i) {
            Solver& s = *static_cast<Solver*>(me);
            if (s.cells[i].seen)
                (s.*part)(s.cells[i]);
        };
        with.run(one, this, cell_count, with);
    }

    // The corners of a figure, or none where it takes no part, in the moved and scaled scene.
    template <class F>
    void outline(const Object& o, F f) const
    {
        with_host(o.kind, [&](auto host) { host.outline(d, o, [&](const Vec3d& p) { f(builder.frame.point(p)); }); });
    }

    // All that takes part, with a rectangle of cells for each.
    bool find_surfaces(Error& error)
    {
        uint32_t count = 0, all = 0, most = 0, places = 0;
        for (uint32_t i = 0; i < d.object_count; places += surfaces_of(d.objects[i++])) {
            uint32_t own = 0;
            outline(d.objects[i], [&](const Vec3d&) { own++; });
            count += own != 0;
            all += own;
            most = std::max(most, own);
        }
        most_walls = 4 * count;
        const auto lay_out = [&] {
            return lay_out_in(rooms.surfaces, [&](Layout& layout) {
                surfaces = layout.array<FlatSurface>(count);
                outlines = layout.array<Point2>(all);
                figure = layout.array<Vec3d>(most);
                rings[0].at = layout.array<Point2>(6 * size_t{most} + 16);
                rings[1].at = layout.array<Point2>(6 * size_t{most} + 16);
                walls = layout.array<Wall>(most_walls);
                surface_of = layout.array<uint32_t>(places);
            });
        };
        if (!with.make_room(rooms.surfaces, lay_out()))
            return no_memory(error);
        lay_out();
        double needed = 0;
        uint32_t place = 0, corner = 0;
        surface_count = 0;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            uint32_t own = 0;
            outline(o, [&](const Vec3d& p) { figure[own++] = p; });
            for (uint32_t k = surfaces_of(o); k-- > 0;)
                surface_of[place + k] = own != 0 ? surface_count : none;
            if (own != 0) {
                FlatSurface& s = surfaces[surface_count++];
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
        for (uint32_t i = 0; i < surface_count; i++)
            lay_cells(surfaces[i], needed);
        if (needed > Limits::cells) {
            error.at = d.radiosity_at;
            snprintf(error.text, sizeof error.text,
                     "'radiosity %g' needs %.0f cells of light; expected at most %u (limit 'cells')",
                     d.radiosity, needed,
                     Limits::cells);
            return false;
        }
        d.cell_count = cell_count = static_cast<uint32_t>(needed);
        return true;
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
            if (columns * rows > 1 || (find_walls(s, side), wall_count != 0)) { // so that there is something between
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
    double edge() const { return d.radiosity * builder.frame.scale; }

    // What stands on a side, as walls; but not along its edges.
    void find_walls(const FlatSurface& s, uint32_t side)
    {
        const double near = 1e-3 * edge();
        const Vec3d n = s.normal(side);
        wall_count = 0;
        for (uint32_t k = 0; k < surface_count; k++) {
            const FlatSurface& w = surfaces[k];
            const Vec3d low = w.box.low - s.box.high, high = s.box.low - w.box.high;
            if (&w == &s || fmax(fmax(low.x, low.y), low.z) > near || fmax(fmax(high.x, high.y), high.z) > near)
                continue;
            Wall wall{{}, {}, {dot(w.n, s.u), dot(w.n, s.v)}, dot(w.n, w.origin - s.origin), k};
            const double across = sqrt(wall.n.x * wall.n.x + wall.n.y * wall.n.y);
            if (across < 1e-3)
                continue;
            wall.n = {wall.n.x / across, wall.n.y / across};
            wall.height /= across;
            const auto height = [&](uint32_t i) { return dot(w.at(outlines[w.outline + i]) - s.origin, n) - near; };
            // Where its outline goes through the plane, in order along the line.
            constexpr uint32_t most = 32;
            double ways[most];
            uint32_t count = 0;
            for (uint32_t i = 0; i < w.corners && count < most; i++) {
                const uint32_t next = i + 1 < w.corners ? i + 1 : 0;
                const double a = height(i), b = height(next);
                if ((a > 0) == (b > 0))
                    continue;
                const Vec3d from = w.at(outlines[w.outline + i]), to = w.at(outlines[w.outline + next]);
                const Point2 p = s.place_of(from + (to - from) * (a / (a - b)));
                ways[count++] = p.y * wall.n.x - p.x * wall.n.y;
            }
            std::sort(ways, ways + count);
            if (count < 2 || !parts_area(s, wall))
                continue;
            const auto point = [&wall](double way) {
                return Point2{wall.n.x * wall.height - wall.n.y * way, wall.n.y * wall.height + wall.n.x * way};
            };
            for (uint32_t i = 0; i + 1 < count && wall_count < most_walls; i += 2) {
                wall.a = point(ways[i]);
                wall.b = point(ways[i + 1]);
                walls[wall_count++] = wall;
            }
        }
    }
    // Does its line leave some of the surface on both sides?
    bool parts_area(const FlatSurface& s, const Wall& wall)
    {
        Point2 middle{};
        const auto area = [&](double sign) {
            begin_ring(s);
            rings[0].cut(rings[1], [&](const Point2& p) { return sign * wall.above(p); });
            return rings[1].area(middle);
        };
        const double above = area(1), below = area(-1);
        return fmin(above, below) > 1e-3 * fmax(above, below);
    }
    void begin_ring(const FlatSurface& s)
    {
        std::copy_n(outlines + s.outline, s.corners, rings[0].at);
        rings[0].count = s.corners;
    }

    bool find_cells(Error& error)
    {
        bool clear = false;
        for (uint32_t i = 0; i < d.fill_count; i++)
            clear = clear || d.fills[i].transmit > 0;
        most_links = with.rays * (clear ? most_through : 1);
        uint32_t all_pieces = 0, most_corners = 0;
        for (uint32_t i = 0; i < surface_count; i++)
            if (const FlatSurface& s = surfaces[i]; d.fills[s.fill].emission > 0) {
                const uint32_t own = pieces_of(s.columns) * pieces_of(s.rows);
                all_pieces += own;
                most_corners += own * 4 + s.corners * 6 + 8;
            }
        const auto lay_out = [&] {
            return lay_out_in(rooms.cells, [&](Layout& layout) {
                rays = layout.array<Vec3d>(with.rays);
                pieces = layout.array<Piece>(all_pieces);
                piece_corners = layout.array<Vec3d>(most_corners);
                cells = layout.array<SurfaceCell>(most_cells());
                links = layout.array<Link>(size_t{most_cells()} * most_links);
            });
        };
        if (!with.make_room(rooms.cells, lay_out()))
            return no_memory(error);
        lay_out();
        for (uint32_t i = 0; i < surface_count; i++) {
            const FlatSurface& s = surfaces[i];
            for (uint32_t k = 0; k < s.cells(); k++) {
                SurfaceCell cell{};
                cell.surface = i;
                Point2 p{(k % s.columns + 0.5) * s.width, (k / s.columns + 0.5) * s.height};
                cell.seen = holds(s, p) || cut_out(s, cell_of(s, s.columns, s.rows, k), nullptr, p) > 0;
                cell.at = s.at(p);
                cells[s.cell + k] = cell;
                cell.side = 1;
                cells[s.cell + s.cells() + k] = cell;
            }
        }
        return true;
    }

    uint32_t most_cells() const { return 2 * d.cell_count + 1024; } // parts among them

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

    static Quad cell_of(const FlatSurface& s, uint32_t columns, uint32_t rows, uint32_t number)
    {
        const double width = s.width * s.columns / columns, height = s.height * s.rows / rows;
        const Point2 low{number % columns * width, number / columns * height};
        return {low, {low.x + width, low.y + height}};
    }
    // What of a surface lies in a rectangle and on some sides of walls, into rings[0]: twice its area, and its middle.
    // 0 where it is next to nothing.
    double cut_out(const FlatSurface& s, const Quad& quad, const QuadPart* part, Point2& middle)
    {
        begin_ring(s);
        rings[0].cut(rings[1], [&](const Point2& p) { return p.x - quad.low.x; });
        rings[1].cut(rings[0], [&](const Point2& p) { return quad.high.x - p.x; });
        rings[0].cut(rings[1], [&](const Point2& p) { return p.y - quad.low.y; });
        rings[1].cut(rings[0], [&](const Point2& p) { return quad.high.y - p.y; });
        for (uint32_t i = 0; part != nullptr && i < part->count; i++) {
            rings[0].cut(rings[1],
                         [&](const Point2& p) { return part->walls[i]->above(p) * (part->above[i] ? 1 : -1); });
            std::swap(rings[0], rings[1]);
        }
        const double area = rings[0].area(middle);
        return area > 1e-6 * (quad.high.x - quad.low.x) * (quad.high.y - quad.low.y) ? area : 0;
    }

    // Of the half sphere, more where the cosine is more: points of a circle, lifted.
    void find_directions()
    {
        ray_count = 0;
        double x = 0.5, y = 0.5;
        while (ray_count < with.rays) {
            x += 0.75487766624669276; // Roberts' sequence R2
            y += 0.56984029099805327;
            x -= floor(x);
            y -= floor(y);
            const double a = 2 * x - 1, b = 2 * y - 1, rest = 1 - a * a - b * b;
            if (rest > 0)
                rays[ray_count++] = {a, b, sqrt(rest)};
        }
    }

    Ray<Double> leaving_ray(const FlatSurface& s, const Vec3d& at, uint32_t side, const Vec3d& along) const
    {
        return {step_off<Double>(vec(at), vec(s.n), side == 0), vec(along), make_tag(s.place, s.fill), side == 0};
    }

    // What a cell is and sends on by itself, as the mean of some places.
    void prepare(SurfaceCell& cell)
    {
        const FlatSurface& s = surfaces[cell.surface];
        const Direction<Double> normal = vec(s.normal(cell.side)), down = -normal;
        NoCount count;
        uint32_t places = 0;
        const auto add = [&](const Vec3d& at) {
            const Point<Double> q = vec(at);
            const Surface<Double> surface{q, vec(s.n), normal, -1, cell.side != 0, step_off<Double>(q, normal, true)};
            const Tag tag = make_tag(s.place, s.fill);
            const Seen<Double> seen{surface, s.kind, tag, s.fill, down};
            cell.own = cell.own + vec(local_light(view, seen, count, PanelMiddle{}));
            cell.colour = cell.colour + vec(colour_at(view, s.fill, q));
            places++;
        };
        const Point2 middle = s.place_of(cell.at);
        for (int i = -1; i <= 1; i++)
            for (int k = -1; k <= 1; k++)
                if (const Point2 p{middle.x + i * s.width / 3, middle.y + k * s.height / 3};
                    holds(s, p) && &cells[find(2 * cell.surface + cell.side, s.at(p)).cell] == &cell)
                    add(s.at(p));
        if (places == 0)
            add(cell.at);
        cell.own = cell.own * (1.0 / places);
        cell.colour = cell.colour * (1.0 / places);
        if (piece_count != 0)
            cell.own = cell.own - cell.colour * d.fills[s.fill].emission;
        cell.sent = cell.own;
    }

    // Light of what glows comes exactly, where nothing is between, and the rest by rays; in a room that glows all over,
    // rays know it as well.
    void take_glow_apart()
    {
        uint32_t shining = 0, all_pieces = 0;
        const auto shines = [this](const FlatSurface& s) { return d.fills[s.fill].emission > 0; };
        for (uint32_t i = 0; i < surface_count; i++)
            if (shines(surfaces[i])) {
                shining++;
                all_pieces += pieces_of(surfaces[i].columns) * pieces_of(surfaces[i].rows);
            }
        piece_count = 0;
        if (shining == surface_count || all_pieces > most_pieces)
            return;
        uint32_t corner = 0;
        for (uint32_t i = 0; i < surface_count; i++) {
            const FlatSurface& s = surfaces[i];
            if (!shines(s))
                continue;
            const double emission = d.fills[s.fill].emission;
            const uint32_t columns = pieces_of(s.columns), rows = pieces_of(s.rows);
            for (uint32_t k = 0; k < columns * rows; k++) {
                Point2 middle{};
                if (cut_out(s, cell_of(s, columns, rows, k), nullptr, middle) == 0)
                    continue;
                const Vec3d at = s.at(middle);
                pieces[piece_count++] = {at, vec(colour_at(view, s.fill, vec(at))) * emission, corner,
                                         rings[0].count, i};
                for (uint32_t c = 0; c < rings[0].count; c++)
                    piece_corners[corner++] = s.at(rings[0].at[c]);
            }
        }
    }

    // What arrives at a place from what glows by itself.
    Vec3d glow_at(const FlatSurface& s, const Vec3d& at, uint32_t side) const
    {
        Vec3d sum;
        const Vec3d n = s.normal(side);
        for (const Piece* p = pieces; p != pieces + piece_count; p++) {
            const double share =
                form_factor(p->corners, [&](uint32_t i) { return piece_corners[p->corner + i] - at; }, n);
            if (!(share > 1e-12) || surfaces[p->surface].place == s.place)
                continue;
            const Vec3d way = p->at - at;
            const double distance = length(way);
            const Ray<Double> ray = leaving_ray(s, at, side, way * (1 / distance));
            sum = sum + p->light * (share * light_through(view, ray, distance * (1 - 1e-9)));
        }
        return sum;
    }

    // Of the rays of a place: calls met(cell, weight) where they meet what takes part; the sum of the light that others
    // send.
    template <class Met>
    Vec3d gather(const FlatSurface& s, const Vec3d& at, uint32_t side, Met met) const
    {
        Vec3d sum;
        const Vec3d n = s.normal(side);
        NoCount count;
        for (uint32_t i = 0; i < ray_count; i++) {
            double weight = 1.0 / ray_count;
            Ray<Double> ray = leaving_ray(s, at, side, s.u * rays[i].x + s.v * rays[i].y + n * rays[i].z);
            for (uint32_t through = 0; through < most_through && weight > 0; through++) {
                Hit<Double> hit;
                if (!nearest(view, ray, hit)) {
                    sum = sum + d.background * weight;
                    break;
                }
                const Surface<Double> surface = surface_at(view, ray, hit);
                const uint32_t material = hit.tag.material(), number = surface_of[hit.tag.place()];
                if (number != none) {
                    const Near near = find(2 * number + surface.turned, vec(surface.point));
                    met(near.cell, weight);
                    sum = sum + times(cells[near.cell].colour, near.light(glows)) * weight;
                } else {
                    const Seen<Double> seen{surface, hit.kind, hit.tag, material, ray.direction};
                    sum = sum + vec(local_light(view, seen, count, PanelMiddle{})) * weight;
                }
                weight *= d.fills[material].transmit;
                ray = leaving<Double, solver_effects()>(surface, hit.kind, hit.tag, ray.direction, false);
            }
        }
        return sum;
    }

    void gather_links(SurfaceCell& cell)
    {
        const FlatSurface& s = surfaces[cell.surface];
        Link* const own = links + static_cast<size_t>(&cell - cells) * most_links;
        cell.links = 0;
        cell.base = gather(s, cell.at, cell.side, [&](uint32_t to, double weight) {
            own[cell.links++] = {to, static_cast<float>(weight)};
        });
    }

    // Light goes round until it no longer changes.
    bool settle(Error& error)
    {
        for (d.light_rounds = 1; d.light_rounds <= most_rounds; d.light_rounds++) {
            double most = 0;
            d.light_change = 0;
            for (uint32_t i = 0; i < cell_count; i++) {
                SurfaceCell& cell = cells[i];
                if (!cell.seen)
                    continue;
                Vec3d sum = cell.base;
                const Link* const own = links + size_t{i} * most_links;
                for (const Link* l = own; l != own + cell.links; l++)
                    sum = sum + cells[l->cell].sent * static_cast<double>(l->weight);
                cell.arrives = sum;
                const Vec3d sent = cell.own + times(cell.colour, sum) * d.fills[surfaces[cell.surface].fill].diffuse;
                d.light_change = fmax(d.light_change, largest(sent - cell.sent));
                most = fmax(most, largest(sent));
                cell.sent = sent;
            }
            if (d.light_change <= 1e-6 * most)
                return true;
        }
        error.at = d.radiosity_at;
        snprintf(error.text, sizeof error.text,
                 "the light of surfaces still changes by %.3g after %u rounds; a room that loses none has no picture",
                 d.light_change, most_rounds);
        return false;
    }

    // Where light will be known: at the middles of cells, and between them where that of what glows changes within one.
    bool lay_nodes(Error& error)
    {
        uint32_t axes = 0, steps = 0, lights = 0, walled = 0;
        for (uint32_t i = 0; i < surface_count; i++) {
            const FlatSurface& s = surfaces[i];
            axes += 2 * (fine * (s.columns + s.rows) + 8);
            lights += 2 * most_lights(s);
            find_walls(s, 0);
            walled += wall_count != 0 ? most_lights(s) : 0;
            find_walls(s, 1);
            walled += wall_count != 0 ? most_lights(s) : 0;
            steps = std::max(steps, (fine * s.columns + 1) * (fine * s.rows + 1));
        }
        const auto lay_out = [&] {
            return lay_out_in(d.light_room, [&](Layout& layout) {
                d.grids = layout.array<LightGrid>(2 * surface_count);
                d.nodes = layout.array<uint16_t>(axes);
                d.cuts = layout.array<WallCut>(most_cells());
                d.roots = layout.array<uint32_t>(walled);
                part_cells = layout.array<uint32_t>(2 * surface_count);
                d.light = layout.array<Vec3d>(lights + 4 * most_cells());
                light_nodes = layout.array<LightNode>(lights + 4 * most_cells());
                glows = layout.array<Vec3d>(lights + 4 * most_cells());
                glows_seen = layout.array<Glow>(steps);
            });
        };
        if (!with.make_room(d.light_room, lay_out()))
            return no_memory(error);
        lay_out();
        d.grid_count = d.node_count = d.cut_count = d.root_count = d.light_size = 0;
        for (uint32_t i = 0; i < surface_count; i++)
            for (uint32_t side = 0; side < 2; side++)
                lay_nodes(surfaces[i], side);
        return true;
    }
    template <Vec3d (Solver::*light)(const LightNode&)>
    void run_nodes()
    {
        const auto one = [](void* me, uint32_t i) {
            Solver& s = *static_cast<Solver*>(me);
            if (const LightNode& node = s.light_nodes[i]; node.seen)
                s.d.light[i] = (s.*light)(node) * s.d.fills[s.surfaces[node.surface].fill].diffuse;
        };
        with.run(one, this, d.light_size, with);
        for (uint32_t i = 0; i < d.grid_count; i++)
            fill_unseen(d.grids[i]);
    }

    static constexpr uint32_t fine = 8; // steps of a cell
    static uint32_t most_lights(const FlatSurface& s) { return s.cells() > 1 ? 4 * s.cells() + 600 : 1; }
    LightNode* light_nodes = nullptr;
    uint32_t* part_cells = nullptr; // of a side, the cell of its first part
    Vec3d* glows = nullptr; // by node, of what is taken apart alone
    struct Glow {
        Vec3d light;
        bool known, seen;
    };
    Glow* glows_seen = nullptr; // of a side, by steps

    Point2 step_place(const FlatSurface& s, uint32_t x, uint32_t y) const
    {
        const auto at = [](uint32_t k, uint32_t parts, double size) {
            return fmin(fmax(k, 0.25), fine * parts - 0.25) * (size / fine);
        };
        return {at(x, s.columns, s.width), at(y, s.rows, s.height)};
    }
    const Glow& glow_of(const FlatSurface& s, uint32_t side, uint32_t x, uint32_t y)
    {
        Glow& g = glows_seen[y * (fine * s.columns + 1) + x];
        if (!g.known) {
            const Point2 p = step_place(s, x, y);
            g.known = true;
            g.seen = holds(s, p);
            g.light = g.seen ? glow_at(s, s.at(p), side) * d.fills[s.fill].diffuse : Vec3d{};
        }
        return g;
    }

    void lay_nodes(const FlatSurface& s, uint32_t side)
    {
        LightGrid& grid = d.grids[d.grid_count++];
        const double scale = builder.frame.scale;
        const auto start = [&](NodeAxis& axis, const Vec3d& along, double size, uint32_t cells_along) {
            axis = {along * (fine * scale / size), fine * cells_along, d.node_count, cells_along};
            for (uint32_t i = 0; i < cells_along; i++)
                d.nodes[d.node_count++] = static_cast<uint16_t>(fine * i + fine / 2);
            d.node_count += (fine - 1) * cells_along + 4;
        };
        grid.place = s.place;
        grid.origin = s.origin * (1 / scale) + builder.frame.origin;
        start(grid.x, s.u, s.width, s.columns);
        start(grid.y, s.v, s.height, s.rows);
        if (s.cells() > 1 && piece_count != 0 && s.columns < 128 && s.rows < 128) {
            memset(static_cast<void*>(glows_seen), 0,
                   (fine * s.columns + 1) * (fine * s.rows + 1) * sizeof *glows_seen);
            for (uint32_t gap = fine; gap > 1; gap /= 2) {
                refine(s, side, grid.x, grid.y, gap, false);
                refine(s, side, grid.y, grid.x, gap, true);
            }
        }
        grid.first = d.light_size;
        const uint32_t surface = static_cast<uint32_t>(&s - surfaces);
        for (uint32_t y = 0; y < grid.y.count; y++)
            for (uint32_t x = 0; x < grid.x.count; x++) {
                const uint32_t kx = d.nodes[grid.x.first + x], ky = d.nodes[grid.y.first + y];
                const bool middle = kx % fine == fine / 2 && ky % fine == fine / 2;
                const Point2 p = step_place(s, kx, ky);
                const uint32_t cell = s.cell + side * s.cells() + ky / fine * s.columns + kx / fine;
                push_node({surface, middle ? cell : none, middle ? s.place_of(cells[cell].at) : p,
                    static_cast<uint8_t>(side),
                           middle ? cells[cell].seen : holds(s, p), false});
            }
        cut_by_walls(s, side, grid);
    }
    void push_node(const LightNode& node)
    {
        d.light[d.light_size] = {};
        light_nodes[d.light_size++] = node;
    }

    // Where walls stand between nodes.
    void cut_by_walls(const FlatSurface& s, uint32_t side, LightGrid& grid)
    {
        grid.cuts = grid.parts = 0;
        grid.first_cut = d.cut_count;
        grid.first_root = d.root_count;
        part_cells[d.grid_count - 1] = cell_count;
        find_walls(s, side);
        if (wall_count == 0 || grid.x.count < 2)
            return;
        const auto edge_of = [this](const NodeAxis& axis, uint32_t i, double step) {
            return (i == 0 ? 0 : i + 1 == axis.count ? axis.steps : d.nodes[axis.first + i]) * step;
        };
        const double wide = s.width / fine, high = s.height / fine;
        for (uint32_t y = 0; y + 1 < grid.y.count; y++)
            for (uint32_t x = 0; x + 1 < grid.x.count; x++) {
                const Quad quad{{edge_of(grid.x, x, wide), edge_of(grid.y, y, high)},
                                {edge_of(grid.x, x + 1, wide), edge_of(grid.y, y + 1, high)}};
                Point2 corners[4];
                for (uint32_t c = 0; c < 4; c++)
                    corners[c] = step_place(s, d.nodes[grid.x.first + x + c % 2], d.nodes[grid.y.first + y + c / 2]);
                d.roots[d.root_count++] = cut_quad(s, side, grid, quad, corners);
            }
    }

    // The root of what walls make of what is between four nodes, or 0.
    uint32_t cut_quad(const FlatSurface& s, uint32_t side, LightGrid& grid, const Quad& quad, const Point2* corners)
    {
        constexpr uint32_t most = 16;
        QuadPart parts[most];
        uint32_t count = 1;
        parts[0] = {none, 0, {}, {}};
        uint32_t root = 0;
        WallCut* const cuts = d.cuts + grid.first_cut;
        const auto set = [&](uint32_t link, uint32_t number) {
            (link == none ? root : link % 2 != 0 ? cuts[link / 2].above : cuts[link / 2].below) = number;
        };
        for (const Wall* wall = walls; wall != walls + wall_count; wall++)
            for (uint32_t i = 0, now = count; i < now; i++) {
                QuadPart& part = parts[i];
                if (part.count == QuadPart::most || count == most || cell_count + count >= most_cells()
                    || !(overlap(*wall, quad, part) > 1e-6 * (s.width + s.height)))
                    continue;
                QuadPart above = part, below = part;
                above.walls[part.count] = below.walls[part.count] = wall;
                above.above[above.count++] = true;
                below.above[below.count++] = false;
                Point2 middle{};
                if (cut_out(s, quad, &above, middle) == 0 || cut_out(s, quad, &below, middle) == 0)
                    continue;
                const FlatSurface& w = surfaces[wall->surface];
                const uint32_t cut = grid.cuts++;
                d.cut_count++;
                set(part.link, 2 * cut + 1);
                cuts[cut] = {w.n, dot(w.n, w.origin), 0, 0};
                above.link = 2 * cut + 1;
                below.link = 2 * cut;
                part = above;
                parts[count++] = below;
            }
        const Point2 between{(quad.low.x + quad.high.x) / 2, (quad.low.y + quad.high.y) / 2};
        if (count == 1 && (cell_count >= most_cells() || !parted(s, between)))
            return 0;
        for (uint32_t i = 0; i < count; i++) {
            const QuadPart& part = parts[i];
            SurfaceCell cell{};
            Point2 middle{};
            cut_out(s, quad, &part, middle);
            cell.at = s.at(middle);
            cell.surface = static_cast<uint32_t>(&s - surfaces);
            cell.side = static_cast<uint8_t>(side);
            cell.seen = true;
            cells[cell_count++] = cell;
            set(part.link, 2 * ++grid.parts);
            for (uint32_t c = 0; c < 4; c++) {
                const Point2 at = inside(part, corners[c], middle);
                push_node({cell.surface, none, holds(s, at) ? at : middle, cell.side, true, true});
            }
        }
        return root;
    }
    // Does a wall stand between a place and the middle of its cell?
    bool parted(const FlatSurface& s, const Point2& p) const
    {
        const Point2 middle{(floor(p.x / s.width) + 0.5) * s.width, (floor(p.y / s.height) + 0.5) * s.height};
        for (const Wall* w = walls; w != walls + wall_count; w++) {
            const double a = w->above(p), b = w->above(middle);
            if ((a > 0) == (b > 0))
                continue;
            const Point2 at{p.x + (middle.x - p.x) * a / (a - b), p.y + (middle.y - p.y) * a / (a - b)};
            if ((at.x - w->a.x) * (at.x - w->b.x) + (at.y - w->a.y) * (at.y - w->b.y) < 0)
                return true;
        }
        return false;
    }
    // How much of a wall stands in a part.
    static double overlap(const Wall& wall, const Quad& quad, const QuadPart& part)
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
        for (uint32_t i = 0; i < part.count; i++) {
            const double sign = part.above[i] ? 1 : -1;
            keep(sign * part.walls[i]->above(wall.a), sign * part.walls[i]->above(wall.b));
        }
        const double x = wall.b.x - wall.a.x, y = wall.b.y - wall.a.y;
        return (to - from) * sqrt(x * x + y * y);
    }
    // The place of a part that is next to a corner, or a little inside.
    static Point2 inside(const QuadPart& part, const Point2& corner, const Point2& middle)
    {
        double way = 0;
        for (uint32_t i = 0; i < part.count; i++) {
            const double sign = part.above[i] ? 1 : -1;
            const double at = sign * part.walls[i]->above(corner), in = sign * part.walls[i]->above(middle);
            if (at < 0.05 * in)
                way = fmax(way, (0.05 * in - at) / (in - at));
        }
        return {corner.x + (middle.x - corner.x) * way, corner.y + (middle.y - corner.y) * way};
    }

    // Halves gaps between nodes along an axis where the light between them, at a node across, is not the mean; and adds
    // nodes at the edges where it is not as at the outermost.
    void refine(const FlatSurface& s, uint32_t side, NodeAxis& axis, const NodeAxis& other, uint32_t gap, bool across)
    {
        uint16_t* const node = d.nodes + axis.first;
        const uint16_t* const others = d.nodes + other.first;
        const auto glow = [&](uint32_t along, uint32_t k) -> const Glow& {
            return across ? glow_of(s, side, others[k], along) : glow_of(s, side, along, others[k]);
        };
        const auto bent = [&](uint32_t low, uint32_t middle, uint32_t high) {
            for (uint32_t k = 0; k < other.count; k++) {
                const Glow &a = glow(low, k), &b = glow(high, k), &m = glow(middle, k);
                if (a.seen && b.seen && m.seen && largest(seen_light(a) + seen_light(b) - seen_light(m) * 2) > 2 * bend)
                    return true;
            }
            return false;
        };
        const auto ends = [&](uint32_t at, uint32_t next) {
            for (uint32_t k = 0; k < other.count; k++)
                if (const Glow &a = glow(at, k), &b = glow(next, k);
                    a.seen && b.seen && largest(seen_light(a) - seen_light(b)) > 2 * bend)
                    return true;
            return false;
        };
        uint32_t count = 0;
        uint16_t made[2 * 255 + 4];
        if (gap == fine && ends(0, node[0]))
            made[count++] = 0;
        made[count++] = node[0];
        for (uint32_t i = 1; i < axis.count; i++) {
            const uint32_t middle = (node[i - 1u] + node[i]) / 2u;
            if (node[i] - node[i - 1u] == static_cast<int>(gap) && bent(node[i - 1u], middle, node[i]))
                made[count++] = static_cast<uint16_t>(middle);
            made[count++] = node[i];
        }
        if (gap == fine && ends(axis.steps, node[axis.count - 1]))
            made[count++] = static_cast<uint16_t>(axis.steps);
        if (count > 255 || count * other.count > most_lights(s))
            return;
        memcpy(node, made, count * sizeof *node);
        axis.count = count;
    }
    static constexpr double bend = 1.0 / 64, white = 4;
    static Vec3d seen_light(const Glow& g)
    {
        return {fmin(g.light.x, white), fmin(g.light.y, white), fmin(g.light.z, white)};
    }

    Vec3d light_by_glow(const LightNode& node)
    {
        const FlatSurface& s = surfaces[node.surface];
        return glow_at(s, s.at(node.at), node.side);
    }
    Vec3d light_by_others(const LightNode& node)
    {
        if (node.cell != none)
            return cells[node.cell].arrives;
        const FlatSurface& s = surfaces[node.surface];
        Vec3d sent;
        const Vec3d rest = gather(s, s.at(node.at), node.side, [&](uint32_t cell, double weight) {
            sent = sent + cells[cell].sent * weight;
        });
        return sent + rest;
    }

    // The four lights around a point of a side, and the cell that sends on what arrives there.
    struct Near {
        uint32_t lights[4], cell;
        double u, v;
        Vec3d light(const Vec3d* of) const
        {
            return (of[lights[0]] * (1 - u) + of[lights[1]] * u) * (1 - v)
                + (of[lights[2]] * (1 - u) + of[lights[3]] * u) * v;
        }
    };
    Near find(uint32_t number, const Vec3d& at) const
    {
        const LightGrid& grid = d.grids[number];
        const FlatSurface& s = surfaces[number / 2];
        const auto place = [this](const NodeAxis& axis, double steps, double& part) {
            const uint16_t* const node = d.nodes + axis.first;
            if (axis.count == 1)
                return 0u;
            const auto i = static_cast<uint32_t>(std::upper_bound(node + 1, node + axis.count - 1, steps) - node - 1);
            part = fmin(fmax((steps - node[i]) / (node[i + 1] - node[i]), 0), 1);
            return i;
        };
        const auto index = [](double v, uint32_t parts) {
            return v > 0 ? std::min(static_cast<uint32_t>(v), parts - 1) : 0;
        };
        const Point2 p = s.place_of(at);
        Near near{};
        const uint32_t x = place(grid.x, p.x * fine / s.width, near.u),
                       y = place(grid.y, p.y * fine / s.height, near.v);
        near.cell = s.cell + number % 2 * s.cells() + index(p.y / s.height, s.rows) * s.columns
            + index(p.x / s.width, s.columns);
        uint32_t low = grid.first + y * grid.x.count + x, high = low + (grid.y.count > 1 ? grid.x.count : 0);
        if (grid.cuts != 0)
            if (uint32_t link = d.roots[grid.first_root + y * (grid.x.count - 1) + x]; link != 0) {
                while (link % 2 != 0) {
                    const WallCut& cut = d.cuts[grid.first_cut + link / 2];
                    link = dot(cut.normal, at) > cut.height ? cut.above : cut.below;
                }
                near.cell = part_cells[number] + link / 2 - 1;
                low = grid.first + grid.x.count * grid.y.count + 2 * link - 4;
                high = low + 2;
            }
        const uint32_t next = grid.x.count > 1;
        near.lights[0] = low;
        near.lights[1] = low + next;
        near.lights[2] = high;
        near.lights[3] = high + next;
        return near;
    }

    // Nodes beside the surface are as those around them.
    void fill_unseen(const LightGrid& grid)
    {
        const uint32_t end = grid.first + grid.x.count * grid.y.count;
        for (uint32_t i = grid.first; i < end; i++)
            light_nodes[i].filled = light_nodes[i].seen;
        for (bool more = true; more;) {
            more = false;
            for (uint32_t i = grid.first; i < end; i++) {
                const uint32_t x = (i - grid.first) % grid.x.count, y = (i - grid.first) / grid.x.count;
                Vec3d sum;
                uint32_t count = 0;
                for (uint32_t b = y - (y > 0); b <= y + 1 && b < grid.y.count && !light_nodes[i].filled; b++)
                    for (uint32_t a = x - (x > 0); a <= x + 1 && a < grid.x.count; a++)
                        if (const uint32_t from = grid.first + b * grid.x.count + a; light_nodes[from].filled) {
                            sum = sum + d.light[from];
                            count++;
                        }
                if (count != 0) {
                    d.light[i] = sum * (1.0 / count);
                    light_nodes[i].filled = more = true;
                }
            }
        }
    }
};

} // namespace

bool solve_radiosity(Description& d, const Solving& with, Error& error)
{
    static Solver::Rooms rooms;
    return d.radiosity == 0 || Solver(d, with, rooms).solve(error);
}

} // namespace qray::scene
