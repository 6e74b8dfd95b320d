// A number system as the command sees it: it builds a scene into static storage of its own, then draws rows.
#pragma once

#include "../scene/emitter.hpp"
#include "kernel.hpp"
#include "options.hpp"

namespace qray::cli {

// What build() made of the scene.
struct Built {
    uint32_t width, height;
    Effects effects;
    uint32_t vanished; // objects smaller than the number system's resolution
    uint32_t balls;
    uint32_t table_bytes; // of the scene when it is compiled
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

template <class N>
uint32_t table_bytes(const scene::Storage<N>& s)
{
    size_t sum = 0;
    scene::for_each_table(s, s.effects, [&sum](const auto& array, const char*, const char*, const char*) {
        sum += array.count * sizeof *array.data;
    });
    return static_cast<uint32_t>(sum);
}

template <class N>
struct RendererOf {
    static inline scene::Storage<N> storage;

    static bool build(const scene::Description& description, const scene::Settings& settings, Built& built,
                      scene::Error& error)
    {
        if (!scene::Builder<N>(description, settings, storage).build(error))
            return false;
        built = {storage.camera.width, storage.camera.height, storage.effects, storage.vanished,
                 storage.spheres.count, table_bytes(storage), Kernel<N>::name(storage)};
        return true;
    }
    static void rows(uint32_t first, uint32_t last, uint8_t* rgb, RayCounts& counts)
    {
        Kernel<N>::rows(storage, first, last, rgb, counts);
    }
    static void emit(scene::Source& out, const char* title, const char* origin, const char* name)
    {
        scene::Emitter<N>(storage, out).emit(title, origin, name);
    }
    static constexpr Renderer renderer{build, rows, emit};
};

} // namespace qray::cli
