#include "radiosity.hpp"

#include "radiosity/nodes.hpp"

namespace qray::scene {

namespace radiosity {

namespace {

// Where a ray of a cell ends, and how much of the cell's light comes along it.
struct Link {
    uint32_t cell;
    float weight;
};

class Solver {
public:
    struct Rooms {
        Storage<Double> storage;
        Room surfaces, cells, glowing;
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
        if (!builder.build(error) || !surfaces.find(rooms.surfaces, with, error) || !lay_cells(error))
            return false;
        view = rooms.storage.view<solver_effects()>();
        if (!glowing.find(rooms.glowing, with, error) || !nodes.lay(with, error))
            return false;
        run_cells([this](SurfaceCell& cell) { prepare(cell); });
        nodes.find_light(with, [this](const LightNode& node) {
            const FlatSurface& s = surfaces[node.surface];
            return glowing.arriving(s, s.at(node.at), node.side);
        });
        std::copy_n(d.light, d.light_size, nodes.glows);
        run_cells([this](SurfaceCell& cell) { gather_links(cell); });
        if (!settle(error))
            return false;
        nodes.find_light(with, [this](const LightNode& node) { return light_by_others(node); });
        for (uint32_t i = 0; i < d.light_size; i++)
            d.light[i] = d.light[i] + nodes.glows[i];
        count_rays();
        const Frame& f = builder.frame;
        for (uint32_t i = 0; i < d.cut_count; i++) // back to where the text has it
            d.cuts[i].height = d.cuts[i].height / f.scale + dot(d.cuts[i].normal, f.origin);
        return true;
    }

private:
    static constexpr uint32_t most_through = 8;
    static constexpr uint32_t most_rounds = 1000;

    Description& d;
    const Solving& with;
    Rooms& rooms;
    const Settings settings;
    Builder<Double> builder;
    View view{};
    Surfaces surfaces{d, builder.frame};
    Cells cells{};
    Glowing glowing{surfaces, view};
    Nodes nodes{d, builder.frame, surfaces, cells, glowing};
    Link* links = nullptr;
    uint32_t most_links = 0; // of a cell
    Vec3d* rays = nullptr;

    bool lay_cells(Error& error)
    {
        bool clear = false;
        for (uint32_t i = 0; i < d.fill_count; i++)
            clear = clear || d.fills[i].transmit > 0;
        most_links = with.rays * (clear ? most_through : 1);
        const auto cut_arrays = [&](Layout& layout) {
            cells.lay_out(layout, d.cell_count);
            rays = layout.array<Vec3d>(with.rays);
            links = layout.array<Link>(size_t{cells.most} * most_links);
        };
        if (!lay_out(rooms.cells, with, error, cut_arrays))
            return false;
        cells.find(surfaces);
        find_directions();
        return true;
    }
    template <class F>
    void run_cells(F part)
    {
        run(with, cells.count, [&](uint32_t i) {
            if (cells[i].seen)
                part(cells[i]);
        });
    }

    // From places, and to parts of what glows; not those that go on behind glass.
    void count_rays()
    {
        d.light_rays = 0;
        for (uint32_t i = 0; i < cells.count; i++)
            d.light_rays += cells[i].seen ? with.rays : 0;
        for (const LightNode& n : nodes)
            d.light_rays += n.seen ? glowing.parts() + (n.cell == none ? with.rays : 0) : 0;
    }

    // Of the half sphere, more where the cosine is more: points of a circle, lifted.
    void find_directions()
    {
        uint32_t found = 0;
        double x = 0.5, y = 0.5;
        while (found < with.rays) {
            x += 0.75487766624669276; // Roberts' sequence R2
            y += 0.56984029099805327;
            x -= floor(x);
            y -= floor(y);
            const double a = 2 * x - 1, b = 2 * y - 1, rest = 1 - a * a - b * b;
            if (rest > 0)
                rays[found++] = {a, b, sqrt(rest)};
        }
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
                    surfaces.holds(s, p) && &cells[nodes.find(2 * cell.surface + cell.side, s.at(p)).cell] == &cell)
                    add(s.at(p));
        if (places == 0)
            add(cell.at);
        cell.own = cell.own * (1.0 / places);
        cell.colour = cell.colour * (1.0 / places);
        if (glowing.parts() != 0)
            cell.own = cell.own - cell.colour * surfaces.fill(s).emission;
        cell.sent = cell.own;
    }

    // Of the rays of a place: calls met(cell, weight) where they meet what takes part; the sum of the light that others
    // send.
    template <class Met>
    Vec3d gather(const FlatSurface& s, const Vec3d& at, uint32_t side, Met met) const
    {
        Vec3d sum;
        const Vec3d n = s.normal(side);
        NoCount count;
        for (uint32_t i = 0; i < with.rays; i++) {
            double weight = 1.0 / with.rays;
            Ray<Double> ray = leaving_ray(s, at, side, s.u * rays[i].x + s.v * rays[i].y + n * rays[i].z);
            for (uint32_t through = 0; through < most_through && weight > 0; through++) {
                Hit<Double> hit;
                if (!nearest(view, ray, hit)) {
                    sum = sum + d.background * weight;
                    break;
                }
                const Surface<Double> surface = surface_at(view, ray, hit);
                const uint32_t material = hit.tag.material(), number = surfaces.of(hit.tag.place());
                if (number != none) {
                    const Near near = nodes.find(2 * number + surface.turned, vec(surface.point));
                    met(near.cell, weight);
                    sum = sum + times(cells[near.cell].colour, near.light(nodes.glows)) * weight;
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
        Link* const own = links + static_cast<size_t>(&cell - cells.all) * most_links;
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
            for (uint32_t i = 0; i < cells.count; i++) {
                SurfaceCell& cell = cells[i];
                if (!cell.seen)
                    continue;
                Vec3d sum = cell.base;
                const Link* const own = links + size_t{i} * most_links;
                for (const Link* l = own; l != own + cell.links; l++)
                    sum = sum + cells[l->cell].sent * static_cast<double>(l->weight);
                cell.arrives = sum;
                const Vec3d sent = cell.own + times(cell.colour, sum) * surfaces.fill(surfaces[cell.surface]).diffuse;
                d.light_change = fmax(d.light_change, largest(sent - cell.sent));
                most = fmax(most, largest(sent));
                cell.sent = sent;
            }
            if (d.light_change <= 1e-6 * most)
                return true;
        }
        error.at = d.radiosity_at;
        return error.say(
            "the light of surfaces still changes by %.3g after %u rounds; a room that loses none has no picture",
            d.light_change, most_rounds);
    }

    Vec3d light_by_others(const LightNode& node) const
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
};

} // namespace

} // namespace radiosity

bool solve_radiosity(Description& d, const Solving& with, Error& error)
{
    static radiosity::Solver::Rooms rooms;
    return d.radiosity == 0 || radiosity::Solver(d, with, rooms).solve(error);
}

} // namespace qray::scene
