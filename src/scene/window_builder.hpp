// Finds the windows of a compiled scene: see windows.hpp. The pixels in which a cone of rays from the eye meets a ball,
// the ball's image in the floor, or the floor in the ball's shadow, fill a conic each: a quadratic form in the ray's
// direction, and so in the pixel's place. Its box is that of the dual conic (Hartley and Zisserman, Multiple View
// Geometry, 2.2.3).
#pragma once

#include <math.h>

#include <algorithm>

#include "storage.hpp"
#include "vec3d.hpp"

namespace qray::scene {

struct Matrix3 { // rows
    Vec3d x, y, z;
};
inline Vec3d operator*(const Matrix3& m, const Vec3d& v) { return {dot(m.x, v), dot(m.y, v), dot(m.z, v)}; }
inline Matrix3 operator*(const Matrix3& m, double k) { return {m.x * k, m.y * k, m.z * k}; }
inline Matrix3 operator+(const Matrix3& a, const Matrix3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Matrix3 transposed(const Matrix3& m)
{
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
inline Matrix3 operator*(const Matrix3& a, const Matrix3& b)
{
    const Matrix3 t = transposed(b);
    return {t * a.x, t * a.y, t * a.z};
}
inline Matrix3 outer(const Vec3d& a, const Vec3d& b) { return {b * a.x, b * a.y, b * a.z}; }
constexpr Matrix3 identity{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

template <class N>
class WindowBuilder {
public:
    using Edges = Array<Edge, 2 * 3 * set_capacity + 1>;
    Edges columns, rows;
    uint32_t blockers[set_capacity], octants[set_capacity][8];
    Tag floor{Tag::none};

    // False where there are no shapes, or too many.
    bool build(const Storage<N>& s)
    {
        columns.count = rows.count = count = 0;
        const uint32_t all = s.spheres.count + s.discs.count + s.cones.count + s.polygons.count + s.patches.count;
        if (all == 0 || all > set_capacity)
            return false;
        view(s.camera);
        for (uint32_t i = 0; i < s.spheres.count; i++)
            add_ball(s.spheres.data[i].centre, s.spheres.data[i].radius);
        for (uint32_t i = 0; i < s.cones.count; i++)
            add_ball(s.cones.data[i].middle, s.cones.data[i].bound);
        for (uint32_t i = 0; i < s.polygons.count; i++)
            add_ball(s.polygons.data[i].middle, s.polygons.data[i].bound, true);
        for (uint32_t i = 0; i < s.patches.count; i++)
            add_ball(s.patches.data[i].middle, s.patches.data[i].bound, true);
        for (uint32_t i = 0; i < s.discs.count; i++)
            add_flat(s.discs.data[i].centre, s.discs.data[i].radius, s.discs.data[i].normal, s.discs.data[i].tag);
        find_floor();
        for (uint32_t i = 0; i < count; i++)
            add_windows(s, i);
        for (uint32_t i = 0; i < s.spheres.count; i++)
            add_sphere(s, i);
        finish(columns);
        finish(rows);
        return true;
    }
    Windows windows() const { return {columns.data, rows.data, blockers, octants, floor}; }

private:
    // More than any rounding on the way to a hit, in a world of 62, can amount to.
    static constexpr double slack = 1e-3, relative = 1e-4;

    // A ball around a shape, or a disc.
    struct Solid {
        Vec3d centre;
        double radius;
        Vec3d normal; // of a disc
        Tag tag;
        bool is_thin = false; // what a ray meets almost along its plane, it may meet anywhere on the line through the ball
        bool is_flat() const { return !(tag == Tag{Tag::none}); }
        double above(const Vec3d& p) const { return dot(normal, p - centre); }
    };
    Solid solids[set_capacity];
    uint32_t count = 0;
    const Solid* ground = nullptr;

    Vec3d eye;
    double height = 0; // of the floor above the eye, along the floor's normal
    Matrix3 direction; // of the ray through a place on the picture, in pixels, from that (times a factor)
    double width = 0, tall = 0;

    struct Window {
        double left, right, top, bottom; // in pixels
    };
    static constexpr Window whole{-HUGE_VAL, HUGE_VAL, -HUGE_VAL, HUGE_VAL};
    static constexpr Window none{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

    template <class V>
    static Vec3d point(const V& v)
    {
        return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    }

    void view(const Camera<N>& c)
    {
        eye = point(c.eye);
        width = c.width;
        tall = c.height;
        // A sample's place is 2 n times a pixel's, less n times the picture's size.
        const double n = c.grid;
        const Vec3d right = point(c.right) * (2 * n), down = point(c.down) * (2 * n);
        const Vec3d corner = point(c.centre) - right * (width / 2) - down * (tall / 2);
        direction = transposed({right, down, corner});
    }

    void add_ball(const Point<N>& centre, typename N::Length radius, bool thin = false)
    {
        solids[count++] = {point(centre), static_cast<double>(radius) * (1 + relative) + slack, {}, {Tag::none}, thin};
    }
    void add_flat(const Point<N>& centre, typename N::Length radius, const Direction<N>& normal, Tag tag)
    {
        solids[count++] = {point(centre), static_cast<double>(radius), point(normal), tag};
    }

    // The largest disc, unless the eye lies in its plane.
    void find_floor()
    {
        double largest = 0;
        ground = nullptr;
        for (uint32_t i = 0; i < count; i++)
            if (solids[i].is_flat() && solids[i].radius > largest) {
                largest = solids[i].radius;
                ground = solids + i;
            }
        if (ground != nullptr) {
            height = ground->above(eye) * -1;
            if (fabs(height) < slack)
                ground = nullptr;
        }
        floor = ground != nullptr ? ground->tag : Tag{Tag::none};
    }

    // The box of the places p with p.C p >= 0, if they are an ellipse.
    Window box(const Matrix3& form) const
    {
        const Matrix3 c = transposed(direction) * form * direction;
        const auto minor = [](const Vec3d& a, const Vec3d& b) { return cross(a, b); };
        const Vec3d dual_x = minor(c.y, c.z), dual_y = minor(c.z, c.x), dual_z = minor(c.x, c.y); // of C's adjoint
        if (!(c.x.x < 0) || !(dual_z.z > 1e-9 * c.x.x * c.y.y))
            return whole;
        const double x = dual_x.z / dual_z.z, y = dual_y.z / dual_z.z;
        const double dx = x * x - dual_x.x / dual_z.z, dy = y * y - dual_y.y / dual_z.z;
        if (!(dx >= 0) || !(dy >= 0)) // of no places
            return {x, x, y, y};
        return {x - sqrt(dx), x + sqrt(dx), y - sqrt(dy), y + sqrt(dy)};
    }

    // Of the lines from a point, v away from a ball's centre: those that meet the ball.
    static Matrix3 lines(const Vec3d& v, double r)
    {
        return outer(v, v) + identity * (r * r - dot(v, v));
    }

    static void join(Window& a, const Window& b)
    {
        a = {fmin(a.left, b.left), fmax(a.right, b.right), fmin(a.top, b.top), fmax(a.bottom, b.bottom)};
    }

    // What may be before a light, and the sights of rays that leave a sphere's outside: of convex shapes, never that
    // sphere itself. Behind the floor the way goes straight on, to the images of shapes.
    void add_sphere(const Storage<N>& s, uint32_t sphere)
    {
        const Solid& from = solids[sphere];
        blockers[sphere] = 0;
        for (uint32_t i = 0; i < count; i++)
            if (i != sphere && shades(s, solids[i], from))
                blockers[sphere] |= set_of(i);
        for (uint32_t octant = 0; octant < 8; octant++) {
            uint32_t& sets = octants[sphere][octant] = unasked;
            for (uint32_t i = 0; i < count; i++) {
                const Solid& to = solids[i];
                if (i != sphere && faces(from, octant, to))
                    sets |= set_of(i);
                if (ground == nullptr || &to == ground)
                    continue;
                if (to.is_flat() || faces(from, octant, image(to)))
                    sets |= set_of(i + set_capacity);
                if (to.is_flat() || shades_floor(s, from, octant, to))
                    sets |= set_of(i + 2 * set_capacity);
            }
        }
    }

    // A ball, as the floor mirrors it.
    Solid image(const Solid& ball) const
    {
        Solid s = ball;
        s.centre = ball.centre - ground->normal * (2 * ground->above(ball.centre));
        return s;
    }

    struct Range {
        double low, high;
    };
    // May a ball shade the floor where rays from another reach it in an octant? In boxes around the shadow's ways.
    bool shades_floor(const Storage<N>& s, const Solid& from, uint32_t octant, const Solid& by) const
    {
        if (by.is_thin)
            return true;
        const double above = ground->above(by.centre);
        const auto reaches = [&](Range stretch, const Vec3d& start, const Vec3d& way, double radius) {
            const auto open = [&](double at, double start_at, double along, uint32_t bit) {
                const double ends[] = {stretch.low * (along - radius), stretch.low * (along + radius),
                                       stretch.high * (along - radius), stretch.high * (along + radius)};
                const double reach = from.radius + slack;
                return octant >> bit & 1 ? *std::min_element(ends, ends + 4) + start_at - at <= reach
                                         : *std::max_element(ends, ends + 4) + start_at - at >= -reach;
            };
            return open(from.centre.x, start.x, way.x, 0) && open(from.centre.y, start.y, way.y, 1)
                && open(from.centre.z, start.z, way.z, 2);
        };
        for (uint32_t i = 0; i < s.lights.count; i++) {
            // From the light through a point of the ball, to 1 / (1 - its height / the light's).
            const Vec3d light = point(s.lights.data[i].at);
            const double high = ground->above(light);
            const Range rest = high > 0 ? Range{high - above - by.radius, high - above + by.radius}
                                        : Range{above - high - by.radius, above - high + by.radius};
            if (!(rest.low > slack)
                || reaches({fabs(high) / rest.high, fabs(high) / rest.low}, light, by.centre - light, by.radius))
                return true;
        }
        for (uint32_t i = 0; i < s.suns.count; i++) {
            const Vec3d sun = point(s.suns.data[i].from);
            const double rise = dot(ground->normal, sun);
            if (!(fabs(rise) > slack))
                return true;
            // From a point of the ball along the light.
            const double a = -(above - by.radius) / rise, b = -(above + by.radius) / rise;
            Solid wide = from;
            wide.radius += by.radius;
            const Range stretch{fmin(a, b), fmax(a, b)};
            const auto open = [&](double gap, double along, uint32_t bit) {
                const double u = gap + stretch.low * along, v = gap + stretch.high * along;
                return octant >> bit & 1 ? fmin(u, v) <= wide.radius + slack : fmax(u, v) >= -wide.radius - slack;
            };
            const Vec3d gap = by.centre - from.centre;
            if (open(gap.x, sun.x, 0) && open(gap.y, sun.y, 1) && open(gap.z, sun.z, 2))
                return true;
        }
        return false;
    }

    // May a shape stand between something in a ball and a light? The rays from there to a light keep within a cone, whose
    // radius shrinks to 0; how far that is from another ball is convex along it.
    static bool shades(const Storage<N>& s, const Solid& in, const Solid& on)
    {
        if (in.is_thin)
            return true;
        for (uint32_t i = 0; i < s.lights.count; i++) {
            const Vec3d light = point(s.lights.data[i].at), way = light - on.centre;
            if (in.is_flat()) {
                if (!apart(in.above(on.centre), on.radius, in.above(light)))
                    return true;
                continue;
            }
            const auto gap = [&](double t) { return length(in.centre - on.centre - way * t) - on.radius * (1 - t); };
            double low = 0, high = 1;
            for (int step = 0; step < 200; step++) {
                const double a = low + (high - low) / 3, b = high - (high - low) / 3;
                if (gap(a) < gap(b))
                    high = b;
                else
                    low = a;
            }
            if (gap(low) <= in.radius + slack)
                return true;
        }
        for (uint32_t i = 0; i < s.suns.count; i++) {
            const Vec3d way = point(s.suns.data[i].from);
            if (in.is_flat()) {
                if (!apart(in.above(on.centre), on.radius, dot(in.normal, way)))
                    return true;
                continue;
            }
            const double t = fmax(0, dot(in.centre - on.centre, way));
            if (length(in.centre - on.centre - way * t) <= in.radius + on.radius + slack)
                return true;
        }
        return false;
    }
    // Does a ball lie on one side of a plane, and what it is seen from there, too?
    static bool apart(double above, double radius, double other)
    {
        return (above > radius + slack && other > slack) || (above < -radius - slack && other < -slack);
    }

    // May a way into that octant lead from something in one ball to a shape?
    static bool faces(const Solid& from, uint32_t octant, const Solid& to)
    {
        if (to.is_thin)
            return true;
        const auto sign = [octant](uint32_t bit) { return octant >> bit & 1 ? -1.0 : 1.0; };
        if (to.is_flat()) {
            const double above = to.above(from.centre);
            const auto back = [&](double n, uint32_t bit) { return n * sign(bit) * (above > 0 ? 1 : -1) >= slack * -1e-6; };
            const bool away = back(to.normal.x, 0) && back(to.normal.y, 1) && back(to.normal.z, 2);
            return !away || fabs(above) <= from.radius + slack;
        }
        const Vec3d way = to.centre - from.centre;
        const double reach = from.radius + to.radius;
        return way.x * sign(0) + reach >= 0 && way.y * sign(1) + reach >= 0 && way.z * sign(2) + reach >= 0;
    }

    // Where rays from the eye head for a plane.
    Window ahead(const Solid& flat) const
    {
        const double above = flat.above(eye);
        if (fabs(above) < slack)
            return whole;
        const Vec3d slope = transposed(direction) * flat.normal * (above > 0 ? -1 : 1); // n.d, in pixels
        const auto at = [&](double x, double y) { return slope.x * x + slope.y * y + slope.z; };
        Window w = none;
        const Vec3d corners[] = {{0, 0}, {width, 0}, {width, tall}, {0, tall}};
        for (int i = 0; i < 4; i++) {
            const Vec3d &a = corners[i], &b = corners[(i + 1) % 4];
            const double u = at(a.x, a.y), v = at(b.x, b.y);
            if (u >= 0)
                join(w, {a.x, a.x, a.y, a.y});
            if ((u < 0) != (v < 0)) {
                const double t = u / (u - v), x = a.x + (b.x - a.x) * t, y = a.y + (b.y - a.y) * t;
                join(w, {x, x, y, y});
            }
        }
        return w;
    }

    void add_windows(const Storage<N>& s, uint32_t bit)
    {
        const Solid& solid = solids[bit];
        mark(solid.is_flat() ? ahead(solid) : box(lines(solid.centre - eye, solid.radius)), bit);
        if (ground == nullptr || &solid == ground)
            return; // which no ray meets that leaves it
        mark(solid.is_flat() ? whole : box(lines(image(solid).centre - eye, solid.radius)), bit + set_capacity);
        mark(solid.is_flat() ? whole : shadow(s, solid), bit + 2 * set_capacity);
    }

    Window shadow(const Storage<N>& s, const Solid& ball) const
    {
        Window w = none;
        // A ray's direction d to its hit q on the floor, seen from p, times n.d: A d = (eye - p) n.d + h d.
        const Vec3d& n = ground->normal;
        const auto seen_from = [&](const Vec3d& p) { return outer(eye - p, n) + identity * height; };
        for (uint32_t i = 0; i < s.lights.count; i++) {
            const Vec3d at = point(s.lights.data[i].at);
            // What the form amounts to, near h^2 r^2, is the rest of terms as large as the fourth power of the distances.
            const double far = fmax(1, fmax(length(at - eye), length(at - ball.centre)));
            if (pow(far, 4) * 1e-12 > height * height * ball.radius * ball.radius)
                return whole;
            const Matrix3 a = seen_from(at);
            join(w, box(transposed(a) * lines(ball.centre - at, ball.radius) * a));
        }
        for (uint32_t i = 0; i < s.suns.count; i++) {
            const Matrix3 a = seen_from(ball.centre);
            const Vec3d sun = point(s.suns.data[i].from);
            const Matrix3 across = identity * -1 + outer(sun, sun);
            join(w, box(transposed(a) * across * a + outer(n, n) * (ball.radius * ball.radius)));
        }
        return w;
    }

    // Pixels are a little wider than they are, for the error of a hit on the floor.
    void mark(const Window& w, uint32_t bit)
    {
        const double left = fmax(0, floor_of(w.left) - 1), right = fmin(width, floor_of(w.right) + 2);
        const double top = fmax(0, floor_of(w.top) - 1), bottom = fmin(tall, floor_of(w.bottom) + 2);
        if (!(left < right) || !(top < bottom))
            return;
        mark(columns, left, right, width, bit);
        mark(rows, top, bottom, tall, bit);
    }
    static double floor_of(double v) { return ::floor(v); }
    static void mark(Edges& edges, double from, double to, double end, uint32_t bit)
    {
        edges.push() = {static_cast<uint32_t>(from), set_of(bit)};
        if (to < end)
            edges.push() = {static_cast<uint32_t>(to), set_of(bit)};
    }

    // In order, one for each place.
    static void finish(Edges& edges)
    {
        std::sort(edges.data, edges.data + edges.count, [](const Edge& a, const Edge& b) { return a.at < b.at; });
        uint32_t count = 0;
        for (uint32_t i = 0; i < edges.count; i++) {
            if (count > 0 && edges.data[count - 1].at == edges.data[i].at)
                edges.data[count - 1].changed ^= edges.data[i].changed;
            else
                edges.data[count++] = edges.data[i];
        }
        edges.count = count;
        edges.push() = {UINT32_MAX, 0};
    }
};

} // namespace qray::scene
