// What drawing a scene asks of a tracer, counted in double precision: the rays, and the cases of each shape's
// test, of shading and of textures that cost differently. A board's cost of each makes a prediction of its
// instructions.
#pragma once

#include "../scene/description.hpp"
#include "../scene/settings.hpp"

namespace qray::cli {

enum class Operation : uint8_t {
    pixel, sample, ray, shadow_ray, test,
    sphere_test, sphere_ahead, sphere_met, sphere_seen,
    disc_test, disc_ahead, disc_seen,
    cone_test, cone_near, cone_met, cone_seen,
    polygon_test, polygon_ahead, polygon_corner, polygon_seen,
    patch_test, patch_ahead, patch_met, patch_seen,
    hit, lit, shine, shine_square, shine_fraction, mirrored, refracted,
    checker, stripes, gradient, rings, noise, marble, wood, brick,
};
constexpr const char* operation_names[] = {
    "pixel", "sample", "ray", "shadow_ray", "test",
    "sphere_test", "sphere_ahead", "sphere_met", "sphere_seen",
    "disc_test", "disc_ahead", "disc_seen",
    "cone_test", "cone_near", "cone_met", "cone_seen",
    "polygon_test", "polygon_ahead", "polygon_corner", "polygon_seen",
    "patch_test", "patch_ahead", "patch_met", "patch_seen",
    "hit", "lit", "shine", "shine_square", "shine_fraction", "mirrored", "refracted",
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
