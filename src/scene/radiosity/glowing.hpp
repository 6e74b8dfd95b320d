// What glows by itself: its light comes exactly, where nothing is between, and the rest by rays; in a room that glows
// all over, rays know it as well.
#pragma once

#include "view.hpp"

namespace qray::scene::radiosity {

class Glowing {
public:
    Glowing(Surfaces& of, const View& in) : surfaces(of), view(in) {}

    // How many parts are taken apart: none where rays know all.
    uint32_t parts() const { return count; }
    bool find(Room& room, const Solving& with, Error& error)
    {
        uint32_t glow = 0, most = 0, corners = 0;
        for (const FlatSurface& s : surfaces)
            if (surfaces.fill(s).emission > 0) {
                const uint32_t own = pieces_of(s.columns) * pieces_of(s.rows);
                glow++;
                most += own;
                corners += own * 4 + s.corners * 6 + 8;
            }
        if (glow == surfaces.size() || most > 2048)
            return true;
        const auto cut_arrays = [&](Layout& layout) {
            pieces = layout.array<Piece>(most);
            piece_corners = layout.array<Vec3d>(corners);
        };
        if (!lay_out(room, with, error, cut_arrays))
            return false;
        uint32_t corner = 0;
        for (const FlatSurface& s : surfaces) {
            const double emission = surfaces.fill(s).emission;
            const uint32_t columns = pieces_of(s.columns), rows = pieces_of(s.rows);
            for (uint32_t k = 0; emission > 0 && k < columns * rows; k++) {
                Point2 middle{};
                if (surfaces.cut_out(s, s.part(columns, rows, k), nullptr, middle) == 0)
                    continue;
                const Vec3d at = s.at(middle);
                const Ring& figure = surfaces.cut;
                pieces[count++] = {at, vec(colour_at(view, s.fill, vec(at))) * emission, corner, figure.count, s.place};
                for (uint32_t c = 0; c < figure.count; c++)
                    piece_corners[corner++] = s.at(figure.at[c]);
            }
        }
        return true;
    }

    // What arrives at a place from there.
    Vec3d arriving(const FlatSurface& s, const Vec3d& at, uint32_t side) const
    {
        Vec3d sum;
        const Vec3d n = s.normal(side);
        for (const Piece* p = pieces; p != pieces + count; p++) {
            const double share =
                form_factor(p->corners, [&](uint32_t i) { return piece_corners[p->corner + i] - at; }, n);
            if (!(share > 1e-12) || p->place == s.place)
                continue;
            const Vec3d way = p->at - at;
            const double distance = length(way);
            const Ray<Double> ray = leaving_ray(s, at, side, way * (1 / distance));
            sum = sum + p->light * (share * light_through(view, ray, distance * (1 - 1e-9)));
        }
        return sum;
    }

private:
    struct Piece {
        Vec3d at, light;
        uint32_t corner, corners, place; // of its surface
    };
    static uint32_t pieces_of(uint32_t cells) { return std::max(cells, 4u); }

    Surfaces& surfaces;
    const View& view;
    Piece* pieces = nullptr;
    uint32_t count = 0;
    Vec3d* piece_corners = nullptr;
};

} // namespace qray::scene::radiosity
