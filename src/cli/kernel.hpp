// The tracers that are built ahead. Of those of a number system that can draw the scene, the first is taken: they stand
// from the tightest to the one for everything. All give the same bytes. float's and q32's are built a second time with
// vectors in registers (lanes_*.cpp), for processors that have such.
#pragma once

#include <qray/picture/render.hpp>

#include "../scene/builder.hpp"

namespace qray::cli {

struct RayCounts {
    uint64_t rays[4] = {};
    void operator()(RayKind kind) { rays[static_cast<int>(kind)]++; }
};

// A scene of one number system, ready to draw.
template <class N>
struct Kernel {
    // Rows first to last - 1 into rgb, 3 width bytes a row.
    static void rows(const scene::Storage<N>& storage, uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts);
    static const char* name(const scene::Storage<N>& storage);
};

// Balls on a checkered floor, with mirrors.
constexpr Effects balls_effects()
{
    Effects e;
    e.sphere = e.disc = e.checker = e.light = e.shadow = e.highlight = e.mirror = e.tree = true;
    return e;
}

// Spheres, cylinders and polygons with glass and mirrors, untextured: the entities of NFF but for patches.
constexpr Effects nff_effects()
{
    Effects e;
    e.sphere = e.cone = e.polygon = e.light = e.shadow = e.see_through = e.highlight = e.fractional_shine = true;
    e.mirror = e.transmit = e.tree = true;
    e.depth = scene::Settings::max_depth;
    return e;
}

static_assert(scene::Settings::max_levels <= max_adaptive_levels);

template <class N, Effects E>
void rows_of(const scene::Storage<N>& storage, uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
{
    const Scene<N, E> s = storage.template view<E>();
    for (uint32_t j = first; j < last; j++)
        render_row<Rgb888>(s, j, rgb + size_t{j - first} * s.camera.width * 3, counts);
}

// With all that it calls in one function: for kernels that are small.
template <class N, Effects E>
[[gnu::flatten]] void flat_rows_of(const scene::Storage<N>& storage, uint32_t first, uint32_t last, uint8_t* rgb,
                                   RayCounts& counts)
{
    rows_of<N, E>(storage, first, last, rgb, counts);
}

template <class N>
void Kernel<N>::rows(const scene::Storage<N>& storage, uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
{
    if (balls_effects().holds(storage.effects))
        flat_rows_of<N, balls_effects()>(storage, first, last, rgb, counts);
    else if (nff_effects().holds(storage.effects))
        rows_of<N, nff_effects()>(storage, first, last, rgb, counts);
    else
        rows_of<N, everything(scene::Settings::max_depth)>(storage, first, last, rgb, counts);
}

template <class N>
const char* Kernel<N>::name(const scene::Storage<N>& storage)
{
    return balls_effects().holds(storage.effects) ? "balls"
        : nff_effects().holds(storage.effects)    ? "nff"
                                                  : "everything";
}

} // namespace qray::cli
