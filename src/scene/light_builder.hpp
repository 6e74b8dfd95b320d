// The tables of lamps, suns and panels, and the surfaces that they lie on.
#pragma once

#include <stdio.h>

#include "moving.hpp"
#include "resolution.hpp"
#include "settings.hpp"
#include "storage.hpp"

namespace qray::scene {

template <class N>
class LightBuilder {
public:
    LightBuilder(const Description& from, const Settings& with, const Frame& in, const Resolution<N>& of,
                 Storage<N>& into)
        : d(from), s(into), settings(with), frame(in), resolution(of)
    {
    }

    // Colours are divided by 2^exposure so that no sum of lights leaves the range of Colour.
    bool build(Error& error)
    {
        double emission = 0;
        for (uint32_t i = 0; i < d.fill_count; i++)
            emission = fmax(emission, d.fills[i].emission);
        Vec3d sum = d.ambient + grey(emission);
        for (uint32_t i = 0; i < d.light_count; i++)
            sum = sum + d.lights[i].colour * 2;
        double arrives = 0;
        for (uint32_t i = 0; d.grid_count != 0 && i < d.light_size; i++)
            arrives = fmax(arrives, largest(d.light[i]));
        sum = sum + grey(arrives);
        s.exposure = 0;
        if constexpr (N::is_fixed)
            while (ldexp(fmax(largest(sum), largest(d.background)), -s.exposure) > range)
                s.exposure++;
        s.background = s.colour(d.background);
        s.far_lights = 0;
        uint32_t panels = 0;
        for (uint32_t i = 0; i < d.light_count; i++) {
            const LightSource& l = d.lights[i];
            if (l.places != 0 && !panel(l, panels++, error))
                return false;
            if (l.places != 0)
                continue;
            if (l.sun) {
                s.suns.push() = {Convert<N>::direction(unit(l.at)), s.colour(l.colour)};
                continue;
            }
            auto [at, shift] = far_point<N>(frame.point(l.at));
            // So far away that it is a sun; in float, its square would be infinite.
            if (shift > 30 || (SingleFloat<N> && largest(at) > 0x1p60)) {
                s.far_lights |= uint64_t{1} << i;
                s.suns.push() = {Convert<N>::direction(unit(at)), s.colour(l.colour)};
                continue;
            }
            if constexpr (SingleFloat<N>) // what is not 0 from there to a surface has a square that float holds
                at = {off_zero(at.x), off_zero(at.y), off_zero(at.z)};
            if (shift == 0)
                resolution.light_surfaces(l.at, keep_light_surface(l, TableId::lights, s.lights.count));
            else if (moves(TableId::lights))
                s.unmoved.note({l.line, 0}, "a lamp far outside of the scene: place() moves it, move() does not");
            s.lights.push() = {Convert<N>::point(at), shift, s.colour(l.colour)};
        }
        return s.light_surfaces.count <= most_light_surfaces()
            || error.say("lights lie on more than %u surfaces (limit 'light_surfaces', times lights)",
                         most_light_surfaces());
    }

private:
    const Description& d;
    Storage<N>& s;
    const Settings& settings;
    const Frame& frame;
    const Resolution<N>& resolution;

    uint32_t most_light_surfaces() const { return d.light_count * Limits::light_surfaces; }
    bool moves(TableId table) const { return (settings.moving & bit_of(table)) != 0; }
    // Counts one more than there may be, too. `light` is as LightSurface has it. Of what moves nothing is kept.
    auto keep_light_surface(const LightSource& l, TableId table, uint32_t light)
    {
        return [this, &l, table, light](const Object& o, uint32_t place, const Vec3d& outward, int32_t side) {
            if (moves(table) || (settings.moving & bit_of(o.kind)) != 0)
                s.unmoved.note({l.line, 0},
                               "a light on a %s, or within rounding of it, of which one moves: rounding decides which "
                               "side is lit; expected a light %.3g off",
                               name_of(o), Steps<N>::off * resolution.step());
            else if (s.light_surfaces.count < most_light_surfaces())
                s.light_surfaces.push() = {light, make_tag(place, o.fill), Convert<N>::direction(outward), side};
            else
                s.light_surfaces.count = most_light_surfaces() + 1;
        };
    }

    bool panel(const LightSource& l, uint32_t number, Error& error)
    {
        const Vec3d at = frame.point(l.at), u = l.u * frame.scale, v = l.v * frame.scale;
        const Vec3d reach{fabs(u.x) + fabs(v.x), fabs(u.y) + fabs(v.y), fabs(u.z) + fabs(v.z)};
        const auto [far, shift] = far_point<N>({fabs(at.x) + reach.x, fabs(at.y) + reach.y, fabs(at.z) + reach.z});
        if (shift > 30 || (SingleFloat<N> && largest(far) > 0x1p60)) {
            if (largest(reach) > 0x1p-20 * largest(at))
                return error.say("a panel that is too far away for its size, %.3g by %.3g: as far as 1e9 times the "
                                 "scene's size",
                                 2 * scene::length(l.u), 2 * scene::length(l.v));
            s.far_lights |= uint64_t{1} << (&l - d.lights);
            s.suns.push() = {Convert<N>::direction(unit(at)), s.colour(l.colour)};
            return true;
        }
        if (shift == 0)
            resolution.panel_surfaces(l, keep_light_surface(l, TableId::panels, ~number));
        else if (moves(TableId::panels))
            s.unmoved.note({l.line, 0}, "a panel far outside of the scene, which stands still");
        const auto fine = [shift = shift](const Vec3d& p) {
            return Convert<N>::point(p * ldexp(1, Panel<N>::fine - shift));
        };
        s.panels.push() = {fine(at - u - v), fine(u * (2.0 / l.places)), fine(v * (2.0 / l.places)), shift,
                           s.colour(l.colour), static_cast<uint8_t>(l.places), static_cast<uint8_t>(number)};
        return true;
    }
    static double off_zero(double v) { return copysign(fmax(fabs(v), 0x1p-38), v); }
    static constexpr double range = 7.99;
};

} // namespace qray::scene
