// Why a pixel has its colour: the tree of rays that the tracer followed, as it was told (the concept Explains in
// include/qray/trace/local_light.hpp), and as text.
#pragma once

#include <qray/picture/render.hpp>

#include "../scene/description.hpp"
#include "../scene/source.hpp"
#include "memory.hpp"
#include "options.hpp"

namespace qray::cli {

// All in the text's units, and light as the text has it.
struct Explanation {
    enum class Verdict : uint8_t { at_light, behind, nothing, adds };
    // What one light gives to a hit; a panel by all of its places.
    struct LightShare {
        uint32_t light; // of the description
        uint32_t places, lit, behind, blocked;
        Verdict verdict;
        double cosine, distance; // of a panel, of its last place
        double through;          // what crossed surfaces let pass, in [0, 1]
        uint32_t crossed;        // surfaces that were crossed (by shadow rays of a panel: in all),
        uint32_t first_crossed;  // and the first of them by its place in the text
        scene::Vec3d matte, highlight; // before weight; matte times the surface's colour
    };
    // One ray of the tree, and the hit where it ends. Rays stand in the order in which they were traced: each before
    // those that it sends on, the mirrored one and all that comes of it before the refracted one.
    struct TracedRay {
        RayKind kind;
        uint8_t depth;
        double weight;
        scene::Vec3d origin, direction;
        bool hit, turned, totally_reflected, touched_edge, deepest;
        uint32_t place, material;
        double t, cosine;            // cosine: normal . direction
        scene::Vec3d point, normal;  // the shading normal, turned to the viewer
        scene::Vec3d arrives, colour; // ambient (or of other surfaces) and emission; what they are multiplied by
        scene::Vec3d light;          // of this surface, or the background: before weight
        double cut_mirrored, cut_refracted; // weights of rays that were not traced, or less than 0
        uint32_t first_light, light_count;
    };
    struct Sample {
        double x, y; // in pixels from the picture's corner
        uint32_t first_ray, ray_count;
        scene::Vec3d light; // not yet clamped
    };
    // An array that grows.
    template <class T>
    struct List {
        scene::Room room;
        uint32_t count = 0;
        T* begin() const { return reinterpret_cast<T*>(room.at); }
        T* end() const { return begin() + count; }
        T& operator[](uint32_t i) const { return begin()[i]; }
        T& last() const { return end()[-1]; }
        bool push(const T& value)
        {
            if ((count + size_t{1}) * sizeof(T) > room.size && !grow_room(room, 2 * room.size + 64 * sizeof(T)))
                return false;
            begin()[count++] = value;
            return true;
        }
    };
    List<Sample> samples;
    List<TracedRay> rays;
    List<LightShare> lights;
    Pixel pixel;
    bool whole = true; // or there was not enough memory
};

// Explains pixel (x, y) of the scene that this number system's renderer built last from the description.
void explain_pixel(Number number, const scene::Description& from, uint32_t x, uint32_t y, Explanation& into);

// As text of at most 120 columns. Where there is another drawing's beside it, in another number system or by other
// settings, what differs by more than is said in the first lines is marked by '!'.
struct Explained {
    const char *name, *number; // name: what tells the two apart
    const scene::Settings& settings;
    const Explanation& of;
};
struct Place {
    const char* scene;
    uint32_t width, height, x, y;
};
void write_explanation(scene::Source& out, const scene::Description& description, const Place& place,
                       const Explained& first, const Explained* beside);

} // namespace qray::cli
