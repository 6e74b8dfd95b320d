// The tables of light maps: what radiosity.hpp found, in a number system's steps.
#pragma once

#include <algorithm>

#include "frame.hpp"
#include "settings.hpp"
#include "storage.hpp"

namespace qray::scene {

template <class N>
class LightMapBuilder {
public:
    LightMapBuilder(const Description& from, const Settings& with, const Frame& in, Storage<N>& into)
        : d(from), s(into), settings(with), frame(in)
    {
    }

    // What surfaces send one another: on what takes no part the ambient light, and on the others nothing
    // before it is solved.
    void build()
    {
        const LightGrid* grid = d.grids;
        for (uint32_t i = 0; i < d.object_count; i++) {
            const Object& o = d.objects[i];
            bool takes_part = false;
            with_host(o.kind, [&](auto host) { host.outline(d, o, [&](const Vec3d&) { takes_part = true; }); });
            const bool solved = takes_part && d.grid_count != 0;
            const Vec3d ambient = takes_part ? Vec3d{} : d.ambient * d.fills[o.fill].ambient;
            const uint32_t even = solved ? 0 : even_light(ambient);
            for (uint32_t k = surfaces_of(o); k-- > 0;)
                s.lights_of.push() = {even, even};
            if (!solved)
                continue;
            const uint32_t outside = light_map(grid[0]), inside = light_map(grid[1]);
            s.lights_of.data[s.lights_of.count - 1] = {outside, inside};
            grid += 2;
        }
    }

private:
    const Description& d;
    Storage<N>& s;
    const Settings& settings;
    const Frame& frame;

    uint32_t even_light(const Vec3d& light)
    {
        const Rgb<N> c = s.colour(light);
        uint32_t i = s.even_lights.count;
        while (i > 0 && !(s.even_lights.data[i - 1].light == c))
            i--;
        if (i == 0) {
            s.even_lights.push() = {c};
            i = s.even_lights.count;
        }
        return LightOf<N>::even + i - 1;
    }

    uint32_t light_map(const LightGrid& grid)
    {
        const Vec3d *const first = d.light + grid.first, *const end = first + grid.lights();
        Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{}, sum;
        for (const Vec3d* c = first; c != end; c++) {
            low = {fmin(low.x, c->x), fmin(low.y, c->y), fmin(low.z, c->z)};
            high = {fmax(high.x, c->x), fmax(high.y, c->y), fmax(high.z, c->z)};
            sum = sum + *c;
        }
        const double steps_in_1 = fmax(scene::length(grid.x.along), scene::length(grid.y.along)) / frame.scale;
        if (largest(high - low) <= 1.0 / 512 || steps_in_1 > LightSteps<N>::most)
            return even_light(sum * (1.0 / grid.lights()));
        constexpr double white = 4, steps = 255, least = 0x1p-20;
        const auto top = [](double v) { return fmin(fmax(v, least), white) / steps; };
        const Vec3d step{top(high.x), top(high.y), top(high.z)};
        const LightAxis<N> x = light_axis(grid, grid.x), y = light_axis(grid, grid.y);
        s.light_maps.push() = {x, y, s.colour(step * (N::is_fixed ? 256 : 0x1p-16)),
                               static_cast<uint16_t>(grid.x.count), static_cast<uint16_t>(grid.y.count), light_values,
                               grid.cuts != 0 ? s.light_knots.count : LightMap<N>::whole, s.light_cuts.count};
        for (uint32_t i = 0; grid.cuts != 0 && i < (grid.x.count - 1) * (grid.y.count - 1); i++)
            s.light_knots.push() = {static_cast<uint16_t>(d.roots[grid.first_root + i])};
        for (uint32_t i = grid.first_cut; i < grid.first_cut + grid.cuts; i++) {
            const WallCut& cut = d.cuts[i];
            s.light_cuts.push() = {light_plane(cut), static_cast<uint16_t>(cut.above),
                                   static_cast<uint16_t>(cut.below)};
        }
        const uint32_t most = (1u << settings.light_bits) - 1;
        for (const Vec3d* c = first; c != end; c++)
            for (double Vec3d::*part : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
                light_value(static_cast<uint32_t>(fmin(floor(c->*part / (step.*part * (255 / most)) + 0.5), most)),
                            most);
        return s.light_maps.count - 1;
    }
    // Only compiled scenes have several in a byte.
    void light_value(uint32_t level, uint32_t most)
    {
        const uint32_t bits = settings.compiled ? settings.light_bits : 8, shift = light_values++ * bits % 8;
        if (shift == 0)
            s.light_cells.push() = {};
        s.light_cells.data[s.light_cells.count - 1].value |=
            static_cast<uint8_t>(settings.compiled ? level << shift : level * (255 / most));
    }
    uint32_t light_values = 0;

    // Of row . q + offset of a point q in the moved and scaled scene.
    static LightSteps<N> light_steps(const Vec3d& row, double offset)
    {
        const auto whole = [](double v) { return static_cast<int32_t>(llrint(v)); };
        if constexpr (NarrowFixed<N>) {
            int exponent = 0;
            frexp((scene::length(row) * world + fabs(offset)) * 1.01, &exponent);
            const int shift = std::min(30 - exponent, 24);
            const double k = ldexp(1, shift - N::Length::frac + N::dropped);
            return {whole(row.x * k), whole(row.y * k), whole(row.z * k), whole(ldexp(offset, shift)), shift};
        } else if constexpr (N::is_fixed) {
            const Vec3d r = row * ldexp(1, 32 - N::Length::frac);
            return {{{whole(r.x)}, {whole(r.y)}, {whole(r.z)}}, whole(offset)};
        } else {
            return {Convert<N>::point(row), whole(offset)};
        }
    }

    uint16_t light_plane(const WallCut& cut)
    {
        const LightPlane<N> plane{Convert<N>::direction(cut.normal),
                                  Convert<N>::length((cut.height - dot(cut.normal, frame.origin)) * frame.scale)};
        uint32_t i = 0;
        while (i < s.light_planes.count
               && !(s.light_planes.data[i].normal == plane.normal && s.light_planes.data[i].height == plane.height))
            i++;
        if (i == s.light_planes.count)
            s.light_planes.push() = plane;
        return static_cast<uint16_t>(i);
    }

    LightAxis<N> light_axis(const LightGrid& grid, const NodeAxis& from)
    {
        const uint16_t* const node = d.nodes + from.first;
        const int between = node[1] - node[0];
        bool even = true;
        for (uint32_t i = 2; i < from.count; i++)
            even = even && node[i] - node[i - 1u] == between;
        const double step = even ? 1.0 / between : 1;
        const Vec3d row = from.along * step;
        const double offset = dot(row, frame.origin - grid.origin) - (even ? node[0] * step : 0);
        const LightSteps<N> axis = light_steps(row * (256 / frame.scale), 256 * offset);
        const int most = static_cast<int>(256 * (from.count - 1)) - 1;
        if (even)
            return {axis, most, LightAxis<N>::even};
        const uint32_t first = s.light_knots.count;
        for (uint32_t k = 0, i = 0; k <= from.steps; k++) {
            while (i + 2 < from.count && node[i + 1] <= k)
                i++;
            const double at = 256 * (i + (static_cast<double>(k) - node[i]) / (node[i + 1] - node[i]));
            s.light_knots.push() = {static_cast<uint16_t>(std::clamp(static_cast<int>(at + 0.5), 0, most))};
        }
        return {axis, static_cast<int32_t>(256 * from.steps - 1), first};
    }
};

} // namespace qray::scene
