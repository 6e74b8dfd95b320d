// Cells of surfaces, on both sides: what they are, where they lie, and what light they send.
#pragma once

#include "surfaces.hpp"

namespace qray::scene::radiosity {

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

// Those of all rectangles, and behind them those of parts that walls cut.
struct Cells {
    SurfaceCell* all;
    uint32_t count, most;

    SurfaceCell& operator[](uint32_t number) const { return all[number]; }
    // Cuts their array; find() fills it.
    void lay_out(Layout& layout, uint32_t of_rectangles)
    {
        count = of_rectangles;
        most = 2 * of_rectangles + 1024;
        all = layout.array<SurfaceCell>(most);
    }
    void find(Surfaces& surfaces)
    {
        for (const FlatSurface& s : surfaces)
            for (uint32_t k = 0; k < s.cells(); k++) {
                SurfaceCell cell{};
                cell.surface = surfaces.number(s);
                Point2 p{(k % s.columns + 0.5) * s.width, (k / s.columns + 0.5) * s.height};
                cell.seen = surfaces.holds(s, p)
                    || surfaces.cut_out(s, s.part(s.columns, s.rows, k), nullptr, p) > 0;
                cell.at = s.at(p);
                all[s.cell + k] = cell;
                cell.side = 1;
                all[s.cell + s.cells() + k] = cell;
            }
    }
};

} // namespace qray::scene::radiosity
