// A number system as the command sees it: it builds a scene into storage of its own, then draws rows.
#pragma once

#include <qray/picture/render.hpp>

#include "../scene/builder.hpp"
#include "../scene/emitter.hpp"
#include "memory.hpp"
#include "options.hpp"

namespace qray::cli {

struct RayCounts {
    uint64_t rays[4] = {};
    void operator()(RayKind kind) { rays[static_cast<int>(kind)]++; }
};

// What build() made of the scene.
struct Built {
    uint32_t width, height;
    Effects effects;
    uint32_t vanished; // objects smaller than the number system's resolution
    scene::Warning lost; // what the number system cannot draw right
    scene::Warning unmoved; // and what cannot move
    const char* kernel;
};

struct Renderer {
    // False, and a reason without a place, where the scene does not fit the number system.
    bool (*build)(const scene::Description&, const scene::Settings&, Built&, scene::Error&);
    // Of the scene that was built last, rows first to last - 1 into rgb, 3 width bytes a row; by any number of threads.
    void (*rows)(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts);
    // That scene as a C++ header; see Emitter::emit.
    void (*emit)(scene::Source& out, const char* title, const char* origin, const char* name);
};

#define QRAY_NUMBER(Type, name) extern const Renderer name##_renderer;
QRAY_NUMBERS(QRAY_NUMBER)
#undef QRAY_NUMBER
#define QRAY_NUMBER(Type, name) &name##_renderer,
inline const Renderer* const renderers[] = {QRAY_NUMBERS(QRAY_NUMBER)};
#undef QRAY_NUMBER

// The same pictures with vectors in registers (include/qray/number/lanes.hpp): null where they were not compiled.
extern const Renderer q32_lanes_renderer __attribute__((weak)), float_lanes_renderer __attribute__((weak));
// What draws the fastest on this processor. Its scene's tables are not those of a compiled scene.
const Renderer& fastest_renderer(Number number);

// Balls on a checkered floor, with mirrors.
constexpr Effects balls_effects()
{
    Effects e;
    e.sphere = e.disc = e.checker = e.light = e.shadow = e.highlight = e.mirror = e.tree = true;
    return e;
}

// Spheres, cylinders, polygons and patches with glass and mirrors, untextured: the entities of NFF.
constexpr Effects nff_effects()
{
    Effects e;
    e.sphere = e.cone = e.polygon = e.patch = e.light = e.shadow = e.see_through = true;
    e.highlight = e.fractional_shine = e.mirror = e.transmit = e.tree = true;
    e.depth = scene::Settings::max_depth;
    return e;
}

// The same without glass.
constexpr Effects opaque_effects()
{
    Effects e = nff_effects();
    e.see_through = e.transmit = false;
    return e;
}

static_assert(scene::Settings::max_levels <= max_adaptive_levels);

template <class N>
scene::Storage<N>& storage_of()
{
    static scene::Storage<N> storage;
    return storage;
}

template <class N, Effects E>
void rows_of(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
{
    const Scene<N, E> s = storage_of<N>().template view<E>();
    for (uint32_t j = first; j < last; j++)
        render_row<Rgb888>(s, j, rgb + size_t{j - first} * s.camera.width * 3, counts);
}

// With all that it calls in one function: for tracers that are small. With sanitizers that takes long to compile.
template <class N, Effects E>
#ifndef __SANITIZE_ADDRESS__
[[gnu::flatten]]
#endif
void flat_rows_of(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
{
    rows_of<N, E>(first, last, rgb, counts);
}

// Fills all of `built` but the kernel.
template <class N>
bool build_scene(const scene::Description& description, const scene::Settings& settings, Built& built,
                 scene::Error& error)
{
    scene::Storage<N>& storage = storage_of<N>();
    if (!make_room(storage.room, storage.lay_out(description, settings.compiled)))
        return error.say("not enough memory for the scene");
    if (!scene::Builder<N>(description, settings, storage).build(error))
        return false;
    built = {storage.camera.width, storage.camera.height, storage.effects, storage.vanished,
             storage.lost,         storage.unmoved,       nullptr};
    return true;
}

template <class N>
struct RendererOf {
    // The tracers that are built ahead, from the tightest to the one for everything: the first that can draw the scene
    // is taken. All give the same bytes. float's and q32's are built a second time with vectors in registers, and there
    // without glass, too, which is 2 to 8 % faster.
    struct Kernel {
        const char* name;
        Effects effects;
        void (*rows)(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts);
    };
    static const Kernel& kernel()
    {
        constexpr Effects balls = balls_effects(), nff = nff_effects(), opaque = QRAY_LANES ? opaque_effects() : nff,
                          all = scene::desktop_effects();
        static constexpr Kernel kernels[] = {
            {"balls", balls, flat_rows_of<N, balls>},
            {QRAY_LANES ? "opaque" : "nff", opaque, flat_rows_of<N, opaque>},
            {"nff", nff, flat_rows_of<N, nff>},
            {"everything", all, rows_of<N, all>},
        };
        const Kernel* k = kernels;
        while (k->effects != all && !k->effects.holds(storage_of<N>().effects))
            k++;
        return *k;
    }

    static bool build(const scene::Description& description, const scene::Settings& settings, Built& built,
                      scene::Error& error)
    {
        if (!build_scene<N>(description, settings, built, error))
            return false;
        built.kernel = kernel().name;
        return true;
    }
    static void rows(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
    {
        kernel().rows(first, last, rgb, counts);
    }
    static void emit(scene::Source& out, const char* title, const char* origin, const char* name)
    {
        scene::Emitter<N>(storage_of<N>(), out).emit(title, origin, name);
    }
    static constexpr Renderer renderer{build, rows, emit};
};

} // namespace qray::cli
