// Steps, of which a cell has eight along an edge: nodes stand at those where the light of what glows bends.
#pragma once

#include "glowing.hpp"

namespace qray::scene::radiosity {

inline constexpr uint32_t fine = 8;
inline uint32_t steps_of(const FlatSurface& s) { return (fine * s.columns + 1) * (fine * s.rows + 1); }
inline Point2 step_place(const FlatSurface& s, uint32_t x, uint32_t y)
{
    const auto at = [](uint32_t k, uint32_t parts, double size) {
        return fmin(fmax(k, 0.25), fine * parts - 0.25) * (size / fine);
    };
    return {at(x, s.columns, s.width), at(y, s.rows, s.height)};
}
// How many lights a side has at most, beside those of parts.
inline uint32_t most_lights(const FlatSurface& s) { return s.cells() > 1 ? 4 * s.cells() + 600 : 1; }

class Steps {
public:
    Steps(const Surfaces& of, const Glowing& in) : surfaces(of), glowing(in) {}

    // Cuts an array for the steps of one side.
    void lay_out(Layout& layout, uint32_t most) { glows = layout.array<Glow>(most); }
    // Adds nodes to the axes of a side, into `in`.
    void refine(const FlatSurface& of, uint32_t on, uint16_t* in, NodeAxis& x, NodeAxis& y)
    {
        s = &of;
        side = on;
        nodes = in;
        memset(static_cast<void*>(glows), 0, steps_of(of) * sizeof *glows);
        for (uint32_t gap = fine; gap > 1; gap /= 2) {
            refine(x, y, gap, false);
            refine(y, x, gap, true);
        }
    }

private:
    struct Glow {
        Vec3d light;
        bool known, seen;
    };
    const Surfaces& surfaces;
    const Glowing& glowing;
    Glow* glows = nullptr;
    const FlatSurface* s = nullptr;
    uint32_t side = 0;
    uint16_t* nodes = nullptr;

    const Glow& glow_of(uint32_t x, uint32_t y)
    {
        Glow& g = glows[y * (fine * s->columns + 1) + x];
        if (!g.known) {
            const Point2 p = step_place(*s, x, y);
            g.known = true;
            g.seen = surfaces.holds(*s, p);
            g.light = g.seen ? glowing.arriving(*s, s->at(p), side) * surfaces.fill(*s).diffuse : Vec3d{};
        }
        return g;
    }

    // Halves gaps between nodes along an axis where the light between them, at a node across, is not the mean; and adds
    // nodes at the edges where it is not as at the outermost.
    void refine(NodeAxis& axis, const NodeAxis& other, uint32_t gap, bool across)
    {
        uint16_t* const node = nodes + axis.first;
        const uint16_t* const others = nodes + other.first;
        const auto glow = [&](uint32_t along, uint32_t k) -> const Glow& {
            return across ? glow_of(others[k], along) : glow_of(along, others[k]);
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
        if (count > 255 || count * other.count > most_lights(*s))
            return;
        memcpy(node, made, count * sizeof *node);
        axis.count = count;
    }
    static constexpr double bend = 1.0 / 64, white = 4;
    static Vec3d seen_light(const Glow& g)
    {
        return {fmin(g.light.x, white), fmin(g.light.y, white), fmin(g.light.z, white)};
    }
};

} // namespace qray::scene::radiosity
