// Where light is known: at the middles of cells, and between them where that of what glows changes within one.
#pragma once

#include "cells.hpp"
#include "steps.hpp"

namespace qray::scene::radiosity {

// A place where the light of a surface is known.
struct LightNode {
    uint32_t surface, cell; // whose middle it is, or none
    Point2 at;
    uint8_t side;
    bool seen, filled; // it lies on the surface; it has light, at least of its neighbours
};

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

class Nodes {
public:
    Nodes(Description& of, const Frame& in, Surfaces& on, Cells& with, const Glowing& apart)
        : d(of), frame(in), surfaces(on), cells(with), glowing(apart), steps(on, apart)
    {
    }

    Vec3d* glows = nullptr; // by node, of what is taken apart alone

    const LightNode* begin() const { return nodes; }
    const LightNode* end() const { return nodes + d.light_size; }
    bool lay(const Solving& with, Error& error)
    {
        uint32_t axes = 0, most_steps = 0, lights = 4 * cells.most, walled = 0;
        for (const FlatSurface& s : surfaces) {
            axes += 2 * (fine * (s.columns + s.rows) + 8);
            lights += 2 * most_lights(s);
            for (uint32_t side = 0; side < 2; side++)
                walled += surfaces.has_walls(s, side) ? most_lights(s) : 0;
            most_steps = std::max(most_steps, steps_of(s));
        }
        const auto cut_arrays = [&](Layout& layout) {
            d.grids = layout.array<LightGrid>(2 * surfaces.size());
            d.nodes = layout.array<uint16_t>(axes);
            d.cuts = layout.array<WallCut>(cells.most);
            d.roots = layout.array<uint32_t>(walled);
            part_cells = layout.array<uint32_t>(2 * surfaces.size());
            d.light = layout.array<Vec3d>(lights);
            nodes = layout.array<LightNode>(lights);
            glows = layout.array<Vec3d>(lights);
            steps.lay_out(layout, most_steps);
        };
        if (!lay_out(d.light_room, with, error, cut_arrays))
            return false;
        d.grid_count = d.node_count = d.cut_count = d.root_count = d.light_size = 0;
        for (const FlatSurface& s : surfaces)
            for (uint32_t side = 0; side < 2; side++)
                lay(s, side);
        return true;
    }

    // Finds out the light of all that lie on a surface by light(node), and of others from those around them.
    template <class F>
    void find_light(const Solving& with, F light)
    {
        run(with, d.light_size, [&](uint32_t i) {
            if (const LightNode& node = nodes[i]; node.seen)
                d.light[i] = light(node) * surfaces.fill(surfaces[node.surface]).diffuse;
        });
        for (uint32_t i = 0; i < d.grid_count; i++)
            fill_unseen(d.grids[i]);
    }

    // Of side `number`: two a surface.
    Near find(uint32_t number, const Vec3d& at) const
    {
        const LightGrid& grid = d.grids[number];
        const FlatSurface& s = surfaces[number / 2];
        const auto place = [this](const NodeAxis& axis, double at_step, double& part) {
            const uint16_t* const node = d.nodes + axis.first;
            if (axis.count == 1)
                return 0u;
            const auto i = static_cast<uint32_t>(std::upper_bound(node + 1, node + axis.count - 1, at_step) - node - 1);
            part = fmin(fmax((at_step - node[i]) / (node[i + 1] - node[i]), 0), 1);
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

private:
    Description& d;
    const Frame& frame;
    Surfaces& surfaces;
    Cells& cells;
    const Glowing& glowing;
    Steps steps;
    LightNode* nodes = nullptr;
    uint32_t* part_cells = nullptr; // of a side, the cell of its first part

    void lay(const FlatSurface& s, uint32_t side)
    {
        LightGrid& grid = d.grids[d.grid_count++];
        const double scale = frame.scale;
        const auto start = [&](NodeAxis& axis, const Vec3d& along, double size, uint32_t cells_along) {
            axis = {along * (fine * scale / size), fine * cells_along, d.node_count, cells_along};
            for (uint32_t i = 0; i < cells_along; i++)
                d.nodes[d.node_count++] = static_cast<uint16_t>(fine * i + fine / 2);
            d.node_count += (fine - 1) * cells_along + 4;
        };
        grid.place = s.place;
        grid.origin = s.origin * (1 / scale) + frame.origin;
        start(grid.x, s.u, s.width, s.columns);
        start(grid.y, s.v, s.height, s.rows);
        if (s.cells() > 1 && glowing.parts() != 0 && s.columns < 128 && s.rows < 128)
            steps.refine(s, side, d.nodes, grid.x, grid.y);
        grid.first = d.light_size;
        const uint32_t surface = surfaces.number(s);
        for (uint32_t y = 0; y < grid.y.count; y++)
            for (uint32_t x = 0; x < grid.x.count; x++) {
                const uint32_t kx = d.nodes[grid.x.first + x], ky = d.nodes[grid.y.first + y];
                const bool middle = kx % fine == fine / 2 && ky % fine == fine / 2;
                const Point2 p = step_place(s, kx, ky);
                const uint32_t cell = s.cell + side * s.cells() + ky / fine * s.columns + kx / fine;
                push({surface, middle ? cell : none, middle ? s.place_of(cells[cell].at) : p,
                      static_cast<uint8_t>(side), middle ? cells[cell].seen : surfaces.holds(s, p), false});
            }
        cut_by_walls(s, side, grid);
    }
    void push(const LightNode& node)
    {
        d.light[d.light_size] = {};
        nodes[d.light_size++] = node;
    }

    // Where walls stand between nodes.
    void cut_by_walls(const FlatSurface& s, uint32_t side, LightGrid& grid)
    {
        grid.cuts = grid.parts = 0;
        grid.first_cut = d.cut_count;
        grid.first_root = d.root_count;
        part_cells[d.grid_count - 1] = cells.count;
        if (!surfaces.has_walls(s, side) || grid.x.count < 2)
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
        for (const Wall& wall : surfaces.walls)
            for (uint32_t i = 0, now = count; i < now; i++) {
                QuadPart& part = parts[i];
                if (part.count == QuadPart::most || count == most || cells.count + count >= cells.most
                    || !(part.holds(wall, quad) > 1e-6 * (s.width + s.height)))
                    continue;
                QuadPart above = part, below = part;
                above.walls[part.count] = below.walls[part.count] = &wall;
                above.above[above.count++] = true;
                below.above[below.count++] = false;
                Point2 middle{};
                if (surfaces.cut_out(s, quad, &above, middle) == 0 || surfaces.cut_out(s, quad, &below, middle) == 0)
                    continue;
                const FlatSurface& w = surfaces[wall.surface];
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
        const auto middle_along = [](double at, double size) { return (floor(at / size) + 0.5) * size; };
        const Point2 of_cell{middle_along(between.x, s.width), middle_along(between.y, s.height)};
        if (count == 1 && (cells.count >= cells.most || !surfaces.walls.part(between, of_cell)))
            return 0;
        for (uint32_t i = 0; i < count; i++) {
            const QuadPart& part = parts[i];
            SurfaceCell cell{};
            Point2 middle{};
            surfaces.cut_out(s, quad, &part, middle);
            cell.at = s.at(middle);
            cell.surface = surfaces.number(s);
            cell.side = static_cast<uint8_t>(side);
            cell.seen = true;
            cells[cells.count++] = cell;
            set(part.link, 2 * ++grid.parts);
            for (uint32_t c = 0; c < 4; c++) {
                const Point2 at = part.near(corners[c], middle);
                push({cell.surface, none, surfaces.holds(s, at) ? at : middle, cell.side, true, true});
            }
        }
        return root;
    }

    // Nodes beside the surface are as those around them.
    void fill_unseen(const LightGrid& grid)
    {
        const uint32_t end = grid.first + grid.x.count * grid.y.count;
        for (uint32_t i = grid.first; i < end; i++)
            nodes[i].filled = nodes[i].seen;
        for (bool more = true; more;) {
            more = false;
            for (uint32_t i = grid.first; i < end; i++) {
                const uint32_t x = (i - grid.first) % grid.x.count, y = (i - grid.first) / grid.x.count;
                Vec3d sum;
                uint32_t count = 0;
                for (uint32_t b = y - (y > 0); b <= y + 1 && b < grid.y.count && !nodes[i].filled; b++)
                    for (uint32_t a = x - (x > 0); a <= x + 1 && a < grid.x.count; a++)
                        if (const uint32_t from = grid.first + b * grid.x.count + a; nodes[from].filled) {
                            sum = sum + d.light[from];
                            count++;
                        }
                if (count != 0) {
                    d.light[i] = sum * (1.0 / count);
                    nodes[i].filled = more = true;
                }
            }
        }
    }
};

} // namespace qray::scene::radiosity
