// Closed meshes, and rays aimed at their corners and edges.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "shapes.hpp"

namespace hostile {

struct Mesh {
    std::vector<Double3> corners;
    std::vector<std::vector<uint32_t>> faces; // planar; counter-clockwise from outside
    Double3 inside;                           // every corner can be seen from everywhere within `room` of it
    double room = 0;

    template <class F>
    void move(F f)
    {
        for (Double3& c : corners)
            c = f(c);
        inside = f(inside);
    }
};

// A body of revolution of a rough profile: trapezoids, one in three of them cut into two triangles, and triangles
// around the poles. Its `slices` by `stacks` corners: 3600 faces for 60 by 60.
inline Mesh turned_body(Random& random, uint32_t slices, uint32_t stacks, double roughness)
{
    Mesh m;
    m.corners.push_back({0, 1, 0});
    for (uint32_t i = 1; i < stacks; i++) {
        const double a = M_PI * i / stacks, r = 1 + random.in(-roughness, roughness) / stacks;
        for (uint32_t j = 0; j < slices; j++) {
            const double b = 2 * M_PI * j / slices;
            m.corners.push_back({r * std::sin(a) * std::cos(b), r * std::cos(a), -r * std::sin(a) * std::sin(b)});
        }
    }
    m.corners.push_back({0, -1, 0});
    const auto at = [&](uint32_t i, uint32_t j) { return 1 + (i - 1) * slices + j % slices; };
    const uint32_t last = static_cast<uint32_t>(m.corners.size() - 1);
    for (uint32_t j = 0; j < slices; j++) {
        m.faces.push_back({0, at(1, j), at(1, j + 1)});
        m.faces.push_back({last, at(stacks - 1, j + 1), at(stacks - 1, j)});
        for (uint32_t i = 1; i + 1 < stacks; i++) {
            const std::vector<uint32_t> q = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            if (random.chance(1.0 / 3)) {
                m.faces.push_back({q[0], q[1], q[2]});
                m.faces.push_back({q[0], q[2], q[3]});
            } else {
                m.faces.push_back(q);
            }
        }
    }
    m.room = 0.1;
    return m;
}

// A sphere whose corners are moved in and out at random: triangles only.
inline Mesh displaced_sphere(Random& random, uint32_t slices, uint32_t stacks, double roughness)
{
    Mesh m = turned_body(random, slices, stacks, 0);
    std::vector<std::vector<uint32_t>> triangles;
    for (const auto& f : m.faces)
        for (size_t i = 2; i < f.size(); i++)
            triangles.push_back({f[0], f[i - 1], f[i]});
    m.faces = triangles;
    for (Double3& c : m.corners)
        c = c * (1 + random.in(-roughness, roughness) / stacks);
    return m;
}

// A prism over a star of n points: two concave faces of 2 n corners, at radius 1 and `inner` in turn.
inline Mesh star_prism(uint32_t points, double depth, double inner = 0.7)
{
    Mesh m;
    const uint32_t n = 2 * points;
    for (int side = 0; side < 2; side++)
        for (uint32_t i = 0; i < n; i++) {
            const double a = 2 * M_PI * i / n, r = i % 2 != 0 ? 1 : inner;
            m.corners.push_back({r * std::cos(a), r * std::sin(a), side == 0 ? depth : -depth});
        }
    std::vector<uint32_t> front, back;
    for (uint32_t i = 0; i < n; i++) {
        front.push_back(i);
        back.push_back(n + (n - i) % n); // v1 is a tip: it gives the normal
        m.faces.push_back({i, n + i, n + (i + 1) % n, (i + 1) % n});
    }
    m.faces.push_back(front);
    m.faces.push_back(back);
    m.room = 0.1;
    return m;
}

// A random rotation.
struct Turn {
    Double3 x, y, z;
    explicit Turn(Random& random)
    {
        x = direction(random);
        y = across(random, x);
        z = qray::scene::cross(x, y);
    }
    Double3 operator()(const Double3& v) const { return x * v.x + y * v.y + z * v.z; }
};

struct MeshTally {
    uint64_t rays = 0, leaks = 0, odd = 0, pruned = 0, bounces = 0, escapes = 0;
};

template <class N>
class MeshBench {
public:
    // Every third triangle is a patch, the other faces are polygons.
    explicit MeshBench(const Mesh& mesh) : m(mesh)
    {
        auto& d = bench.from;
        d.object_count = d.vertex_count = 0;
        for (size_t i = 0; i < m.faces.size(); i++) {
            const auto& f = m.faces[i];
            const bool patch = f.size() == 3 && i % 3 == 0;
            auto o = Bench<N>::object(patch ? qray::Kind::patch : qray::Kind::polygon);
            o.vertex = d.vertex_count;
            o.count = static_cast<uint32_t>(f.size());
            for (const uint32_t c : f) {
                d.normals[d.vertex_count] = {0, 1, 0};
                d.vertices[d.vertex_count++] = m.corners[c];
            }
            d.objects[d.object_count++] = o;
        }
        qray::scene::Error error;
        qray::scene::Builder<N>(d, {}, bench.storage).build(error);
    }
    uint32_t faces() const { return bench.storage.polygons.count + bench.storage.patches.count; }
    uint32_t vanished() const { return bench.storage.vanished; }

    // A half of the rays are aimed at corners, the others at edges; a half start inside.
    MeshTally shoot(uint64_t seed, uint64_t rays)
    {
        Random random(seed);
        for (; tally.rays < rays; tally.rays++)
            shoot(random);
        return tally;
    }

    // Rays that bounce about inside, in random directions: none gets out.
    MeshTally bounce(uint64_t seed, uint64_t count)
    {
        Random random(seed);
        const auto scene = bench.storage.template view<effects(true)>();
        qray::Ray<N> ray{};
        bool lost = true;
        for (; tally.bounces < count; tally.bounces++) {
            if (lost)
                ray = free_ray<N>(random, m.inside + in_ball(random, m.room), direction(random));
            qray::Hit<N> hit{};
            lost = !qray::nearest(scene, ray, hit);
            if (lost) {
                tally.escapes++;
                continue;
            }
            const qray::Surface<N> s = surface_at(scene, ray, hit);
            qray::Direction<N> d = made_direction<N>(random, direction(random));
            if (qray::dot<N>(s.geometric, d) > typename N::Cosine{})
                d = -d;
            const bool above = qray::dot<N>(s.normal, d) > typename N::Cosine{};
            const auto n_d = N::unit(qray::dot<N>(s.normal, d));
            ray = tally.bounces % 2 == 0
                ? qray::going_on<N, effects(true)>(s, hit.kind, hit.tag, d, above, above ? n_d : -n_d)
                : qray::leaving<N, effects(true)>(s, hit.kind, hit.tag, d, above);
        }
        return tally;
    }

private:
    const Mesh& m;
    Bench<N> bench;
    MeshTally tally;

    static constexpr Effects effects(bool tree)
    {
        Effects e;
        e.polygon = e.patch = true;
        e.tree = tree;
        return e;
    }

    void shoot(Random& random)
    {
        using namespace qray::scene;
        const auto& face = m.faces[random.below(static_cast<uint32_t>(m.faces.size()))];
        const uint32_t i = random.below(static_cast<uint32_t>(face.size()));
        const Double3 a = m.corners[face[i]], b = m.corners[face[(i + 1) % face.size()]];
        const Double3 target = random.chance(0.5) ? a : a + (b - a) * random.unit();
        const Double3 centre = m.inside + in_ball(random, m.room);
        const bool from_inside = random.chance(0.5);
        Double3 from = centre;
        if (!from_inside) {
            double away = random.in(0.5, 3);
            while (length(target + (target - centre) * away) > world)
                away /= 2;
            from = target + (target - centre) * away;
        }
        const qray::Ray<N> ray = free_ray<N>(random, from, target - from);
        const auto scene = bench.storage.template view<effects(false)>();
        int crossings = 0;
        typename N::Length least = N::length_max;
        qray::for_each_shape(scene, [&](const auto& shape, qray::Kind, uint32_t) {
            typename N::Length t{};
            qray::Local<N> local{};
            if (qray::intersect(shape, corners_of(scene), ray, N::length_max, t, local)) {
                crossings++;
                least = t < least ? t : least;
            }
            return false;
        });
        if (crossings == 0)
            tally.leaks++;
        if ((crossings % 2 != 0) != from_inside)
            tally.odd++;
        qray::Hit<N> hit{};
        if (!qray::nearest(scene, ray, hit) || !(hit.t == least))
            tally.leaks++;
        const auto with_tree = bench.storage.template view<effects(true)>();
        if (!qray::nearest(with_tree, ray, hit) || !(hit.t == least))
            tally.pruned++;
    }
};

} // namespace hostile
