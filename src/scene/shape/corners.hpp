// What figures with corners share: polygons and patches.
#pragma once

#include "host.hpp"

namespace qray::scene {

// The corners behind those that the scene has already, each with a normal or without.
inline bool read_corners(Reader& r, Description& d, Object& o, bool with_normals)
{
    o.vertex = d.vertex_count;
    if (!r.count(with_normals ? "the number of vertices of a patch" : "the number of vertices of a polygon", 3,
                 UINT32_MAX, "", o.count))
        return false;
    if (o.count > Limits::vertices - d.vertex_count)
        return r.fail(r.token.at,
                      "%s vertices are too many after the %u so far; expected at most %u (limit 'vertices')",
                      Shown(r.token.text).text, d.vertex_count, Limits::vertices);
    for (uint32_t i = o.vertex; i != o.vertex + o.count; i++)
        if (!r.point(with_normals ? "a vertex of a patch" : "a vertex of a polygon", d.vertices[i])
            || (with_normals && !r.direction("a normal of a patch", d.normals[i])))
            return false;
    return true;
}

// Whether n >= 3 corners enclose something. What rounding each coordinate to a double could make of an area
// of 0 (up to 2^-50 times the largest coordinate times the extent, in each product) is none.
inline bool has_area(const Vec3d* corners, uint32_t n, bool fan)
{
    double coordinate = largest(corners[0]), extent = 0;
    for (uint32_t i = 1; i < n; i++) {
        coordinate = fmax(coordinate, largest(corners[i]));
        extent = fmax(extent, largest(corners[i] - corners[0]));
    }
    if (extent < smallest_length)
        return false;
    const double noise = 0x1p-50 * extent * coordinate;
    Vec3d sum;
    for (uint32_t i = 1; i + 1 < n; i++) {
        const Vec3d area = cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
        // A polygon whose lobes cancel in the sum still has the plane of its first corner, and is drawn.
        if ((fan || i == 1) && largest(area) > noise)
            return true;
        sum = sum + area;
    }
    return !fan && largest(sum) > noise;
}

inline void add_corners(Extent& box, const Vec3d* corners, uint32_t count, double off = 0)
{
    for (uint32_t i = 0; i < count; i++)
        box.add(corners[i], {off, off, off});
}

// Is a corner off the plane of the first three by more than a hundredth of the polygon's size?
inline void warn_of_nonplanar(Description& d, const Object& o)
{
    if (o.count == 3)
        return;
    const Vec3d* corners = d.vertices + o.vertex;
    const Vec3d normal = unit(across(corners, o.count));
    Extent box;
    add_corners(box, corners, o.count);
    double off = 0;
    for (uint32_t i = 0; i < o.count; i++)
        off = fmax(off, fabs(dot(corners[i] - corners[0], normal)));
    const double size = length(box.high - box.low);
    if (off > 0.01 * size)
        d.nonplanar.note({o.line, 0}, "a polygon with a corner %.3g off its plane, %.3g %% of its size", off,
                         100 * off / size);
}

struct HostOfCorners : HostOfFlat {
    static void extent(Extent& box, const Description& d, const Object& o)
    {
        add_corners(box, d.vertices + o.vertex, o.count);
    }
    static Vec3d middle(const Description& d, const Object& o)
    {
        Vec3d sum;
        for (uint32_t i = 0; i < o.count; i++)
            sum = sum + d.vertices[o.vertex + i];
        return sum * (1.0 / o.count);
    }
    static bool covers(const Description& d, const Object& o, const Vec3d& n, const Vec3d& p)
    {
        const Vec3d u = unit_across(n), w = cross(n, u);
        bool inside = false;
        for (uint32_t i = 0, before = o.count - 1; i < o.count; before = i++) {
            const Vec3d a = d.vertices[o.vertex + i] - p, b = d.vertices[o.vertex + before] - p;
            const double ay = dot(a, w), by = dot(b, w);
            if ((ay > 0) != (by > 0) && dot(a, u) + (dot(b, u) - dot(a, u)) * ay / (ay - by) > 0)
                inside = !inside;
        }
        return inside;
    }
};

// A figure is taken for what its extent holds of its plane: a ray from there meets nothing of it. HUGE_VAL
// asks for its plane alone.
inline Above lies_in_figure(const Vec3d* corners, uint32_t count, const Vec3d& p, double off)
{
    if (Extent box; off < HUGE_VAL) {
        add_corners(box, corners, count, off);
        if (!box.holds(p)) // of a large mesh, nearly all
            return {};
    }
    const Vec3d g = across(corners, count);
    return length(g) > 0 ? above_plane(corners[0], unit(g), p, off) : Above{};
}

// How far beside its corners a ray may meet a figure because they are not in one plane. A ray whose cosine with the
// normal is c meets it as far as height / c from where its line passes through their hull; what is flatter than 1/64 is
// not told more. What rounding makes of corners in a plane counts as none, as does what is little beside the figure and
// beside hit_slack.
template <class N>
double reach_beside(const Point<N>* corners, uint32_t count, const Direction<N>& normal)
{
    double height = 0, size = 0;
    for (uint32_t i = 1; count > 3 && i < count; i++) {
        const Vec3d v = value(corners[i]) - value(corners[0]);
        height = fmax(height, fabs(dot(v, value(normal))));
        size = fmax(size, length(v));
    }
    double rounding;
    if constexpr (N::is_fixed)
        rounding = ldexp(16, -N::Length::frac);
    else
        rounding = 512 * static_cast<double>(N::epsilon);
    return height > rounding && height > fmin(size / 128, 0x1p-10) ? 64 * height : 0;
}

// The ball around the middle of the extent.
template <class N>
struct CornerBall {
    Point<N> middle;
    typename N::Length radius;
};
template <class B>
CornerBall<typename B::Number> corner_ball(const B& b, const Vec3d* corners, uint32_t count)
{
    Extent box;
    add_corners(box, corners, count);
    const Vec3d centre = box.middle();
    double far = 0;
    for (uint32_t i = 0; i < count; i++)
        far = fmax(far, length(corners[i] - centre));
    return {b.point(centre), b.bound(far)};
}

// Do rounded corners not all fall on one point?
template <class P>
bool spans(const P* corners, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++)
        if (!(corners[i] == corners[0]))
            return true;
    return false;
}

} // namespace qray::scene
