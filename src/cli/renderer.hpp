// A number system as the command sees it: it builds a scene into storage of its own, then draws rows.
#pragma once

#include "../scene/emitter.hpp"
#include "kernel.hpp"
#include "memory.hpp"
#include "options.hpp"

namespace qray::cli {

// What build() made of the scene.
struct Built {
    uint32_t width, height;
    Effects effects;
    uint32_t vanished; // objects smaller than the number system's resolution
    scene::Warning lost; // what the number system cannot draw right
    const char* kernel;
};

struct Renderer {
    // False, and a reason without a place, where the scene does not fit the number system.
    bool (*build)(const scene::Description&, const scene::Settings&, Built&, scene::Error&);
    // As Kernel::rows, of the scene that was built last; by any number of threads.
    void (*rows)(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts);
    // That scene as a C++ header; see Emitter::emit.
    void (*emit)(scene::Source& out, const char* title, const char* origin, const char* name);
};

extern const Renderer q16_renderer, q32_renderer, float_renderer, double_renderer;
inline const Renderer* const renderers[] = {&q16_renderer, &q32_renderer, &float_renderer, &double_renderer};

// The same pictures with vectors in registers (include/qray/number/lanes.hpp): null where they were not compiled.
extern const Renderer q32_lanes_renderer __attribute__((weak)), float_lanes_renderer __attribute__((weak));
// What draws the fastest on this processor. Its scene's tables are not those of a compiled scene.
const Renderer& fastest_renderer(Number number);

template <class N>
scene::Storage<N>& storage_of()
{
    static scene::Storage<N> storage;
    return storage;
}

template <class N>
struct RendererOf {
    static bool build(const scene::Description& description, const scene::Settings& settings, Built& built,
                      scene::Error& error)
    {
        scene::Storage<N>& storage = storage_of<N>();
        if (!make_room(storage.room, storage.lay_out(description))) {
            snprintf(error.text, sizeof error.text, "not enough memory for the scene");
            return false;
        }
        if (!scene::Builder<N>(description, settings, storage).build(error))
            return false;
        built = {storage.camera.width, storage.camera.height, storage.effects, storage.vanished,
                 storage.lost, Kernel<N>::name(storage)};
        return true;
    }
    static void rows(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
    {
        Kernel<N>::rows(storage_of<N>(), first, last, rgb, counts);
    }
    static void emit(scene::Source& out, const char* title, const char* origin, const char* name)
    {
        scene::Emitter<N>(storage_of<N>(), out).emit(title, origin, name);
    }
    static constexpr Renderer renderer{build, rows, emit};
};

} // namespace qray::cli
