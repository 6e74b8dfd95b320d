// What drawing a scene asks of a tracer, counted in double precision: the rays, and the cases of each shape's
// test, of shading and of textures that cost differently. A board's cost of each makes a prediction of its
// instructions.
#pragma once

#include "../scene/description.hpp"
#include "../scene/settings.hpp"

namespace qray::cli {

// A `veiled` ray is one to a light in a scene where surfaces may let light through; a `nearest_test`, one of
// a ray that is not to a light. Of a shape kind: `test`, a ray and a shape; `single`, `several` and `many`,
// those of a list of one, of up to eight and of more, and `opaque`, those in a scene that has no veiled
// rays, of which compilers make different code; `ahead`, the shape's bounding ball is not all behind the
// ray; `line`, the ray's whole line enters that ball; `near`, both; `met`, so is its plane or its endless
// cone; `inward`, the ray starts on that cone, into it; `corner` and `edge`, the corners of those whose
// plane is met, and the edges that have an end on either side of the ray, across its dominant axis; `inside`
// and `found`, those that are met themselves, and their corners; `seen`, the hit that is shaded.
// `lamp_several` is a lamp of more than one.
enum class Operation : uint8_t {
    pixel, sample, ray, shadow_ray, veiled_ray, test, nearest_test, veiled_test, found,
    sphere_test, sphere_single, sphere_several, sphere_many, sphere_ahead, sphere_line, sphere_met,
    sphere_seen,
    disc_test, disc_single, disc_several, disc_many, disc_ahead, disc_met, disc_seen,
    cone_test, cone_single, cone_several, cone_many, cone_opaque, cone_ahead, cone_line, cone_near, cone_met,
    cone_inward, cone_seen,
    polygon_test, polygon_single, polygon_several, polygon_many, polygon_opaque, polygon_ahead, polygon_line,
    polygon_near, polygon_met, polygon_corner, polygon_edge, polygon_inside, polygon_found, polygon_seen,
    patch_test, patch_single, patch_several, patch_many, patch_opaque, patch_ahead, patch_line, patch_near,
    patch_met, patch_found, patch_seen,
    hit, lamp, lamp_several, sun_lamp, lit, shine, shine_square, shine_fraction, mirrored, refracted, glass,
    checker, stripes, gradient, rings, noise, marble, wood, brick,
};
constexpr const char* operation_names[] = {
    "pixel", "sample", "ray", "shadow_ray", "veiled_ray", "test", "nearest_test", "veiled_test", "found",
    "sphere_test", "sphere_single", "sphere_several", "sphere_many", "sphere_ahead", "sphere_line",
    "sphere_met", "sphere_seen",
    "disc_test", "disc_single", "disc_several", "disc_many", "disc_ahead", "disc_met", "disc_seen",
    "cone_test", "cone_single", "cone_several", "cone_many", "cone_opaque", "cone_ahead", "cone_line",
    "cone_near", "cone_met", "cone_inward", "cone_seen",
    "polygon_test", "polygon_single", "polygon_several", "polygon_many", "polygon_opaque", "polygon_ahead",
    "polygon_line", "polygon_near", "polygon_met", "polygon_corner", "polygon_edge", "polygon_inside",
    "polygon_found", "polygon_seen",
    "patch_test", "patch_single", "patch_several", "patch_many", "patch_opaque", "patch_ahead", "patch_line",
    "patch_near", "patch_met", "patch_found", "patch_seen",
    "hit", "lamp", "lamp_several", "sun_lamp", "lit", "shine", "shine_square", "shine_fraction", "mirrored",
    "refracted", "glass",
    "checker", "stripes", "gradient", "rings", "noise", "marble", "wood", "brick",
};
constexpr int operation_count = sizeof operation_names / sizeof *operation_names;
static_assert(operation_count == static_cast<int>(Operation::brick) + 1);

struct OperationCounts {
    double of[operation_count] = {};
    double& operator[](Operation o) { return of[static_cast<int>(o)]; }
};

// Of every stride-th row of the picture, times what is left out; with windows, where compiled scenes of this number
// system have them. Not to be called by two threads at once.
OperationCounts count_operations(const scene::Description& description, const scene::Settings& settings,
                                 uint32_t stride, bool windows);

} // namespace qray::cli
