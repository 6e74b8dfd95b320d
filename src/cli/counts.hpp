// What drawing a scene asks of a tracer, counted in double precision: the rays, and the cases of each shape's
// test, of shading and of textures that cost differently. A board's cost of each makes a prediction of its
// instructions.
#pragma once

#include "../scene/description.hpp"
#include "../scene/settings.hpp"

namespace qray::cli {

// A `veiled` ray is one to a light in a scene where surfaces may let light through. Of a shape kind: `test`,
// a ray and a shape; `several` and `many`, those of a list of more than one and of more than eight, which
// compilers unroll or not; `ahead`, the shape's bounding ball is not all behind the ray; `line`, the ray's
// whole line enters that ball; `near`, both; `met`, so is its plane or its endless cone; `corner` and
// `found`, the corners of those whose plane is met, and of those that are; `seen`, the hit that is shaded.
enum class Operation : uint8_t {
    pixel, sample, ray, shadow_ray, veiled_ray, test, veiled_test, found,
    sphere_test, sphere_several, sphere_many, sphere_ahead, sphere_line, sphere_met, sphere_seen,
    disc_test, disc_several, disc_many, disc_ahead, disc_met, disc_seen,
    cone_test, cone_several, cone_many, cone_ahead, cone_line, cone_near, cone_met, cone_seen,
    polygon_test, polygon_several, polygon_many, polygon_ahead, polygon_line, polygon_near, polygon_corner,
    polygon_found, polygon_seen,
    patch_test, patch_several, patch_many, patch_ahead, patch_line, patch_near, patch_met, patch_found,
    patch_seen,
    hit, lamp, sun_lamp, lit, shine, shine_square, shine_fraction, mirrored, refracted, glass,
    checker, stripes, gradient, rings, noise, marble, wood, brick,
};
constexpr const char* operation_names[] = {
    "pixel", "sample", "ray", "shadow_ray", "veiled_ray", "test", "veiled_test", "found",
    "sphere_test", "sphere_several", "sphere_many", "sphere_ahead", "sphere_line", "sphere_met",
    "sphere_seen",
    "disc_test", "disc_several", "disc_many", "disc_ahead", "disc_met", "disc_seen",
    "cone_test", "cone_several", "cone_many", "cone_ahead", "cone_line", "cone_near", "cone_met",
    "cone_seen",
    "polygon_test", "polygon_several", "polygon_many", "polygon_ahead", "polygon_line", "polygon_near",
    "polygon_corner", "polygon_found", "polygon_seen",
    "patch_test", "patch_several", "patch_many", "patch_ahead", "patch_line", "patch_near", "patch_met",
    "patch_found", "patch_seen",
    "hit", "lamp", "sun_lamp", "lit", "shine", "shine_square", "shine_fraction", "mirrored", "refracted",
    "glass",
    "checker", "stripes", "gradient", "rings", "noise", "marble", "wood", "brick",
};
constexpr int operation_count = sizeof operation_names / sizeof *operation_names;
static_assert(operation_count == static_cast<int>(Operation::brick) + 1);

struct OperationCounts {
    double of[operation_count] = {};
    double& operator[](Operation o) { return of[static_cast<int>(o)]; }
};

// Of every stride-th row of the picture, times what is left out. Not to be called by two threads at once.
OperationCounts count_operations(const scene::Description& description, const scene::Settings& settings,
                                 uint32_t stride);

} // namespace qray::cli
