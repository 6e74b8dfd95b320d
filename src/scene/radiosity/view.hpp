// What light between surfaces asks of the tracer.
#pragma once

#include <qray/trace/trace.hpp>

#include "surfaces.hpp"

namespace qray::scene::radiosity {

constexpr Effects solver_effects()
{
    Effects e = desktop_effects(1);
    e.highlight = e.fractional_shine = e.mirror = e.transmit = e.grid = e.adaptive = e.eye_surface = false;
    return e;
}
using View = Scene<Double, solver_effects()>;

inline Vec3d vec(const Vec<double>& a) { return {a.x, a.y, a.z}; }
inline Vec<double> vec(const Vec3d& a) { return {a.x, a.y, a.z}; }

inline Ray<Double> leaving_ray(const FlatSurface& s, const Vec3d& at, uint32_t side, const Vec3d& along)
{
    return {step_off<Double>(vec(at), vec(s.n), side == 0), vec(along), make_tag(s.place, s.fill), side == 0};
}

} // namespace qray::scene::radiosity
