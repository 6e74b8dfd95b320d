// The list of the steps at which the tracer rounds.
#pragma once

namespace qray::study {

// The steps: name, of which quantity of a number system its result is, and what it is. Significant: its bits are not
// those behind the point, but all from the first that is set. Lengths are scene units after the builder's scale. With
// coordinates go radii, with v.d what cones find in their own frame, with cosines the shares of light that are made of
// them, with weights the coefficients of materials.
#define QRAY_STEPS(X) \
    X(camera, Unit, "camera direction") \
    X(coordinate, Length, "coordinates") \
    X(projection, Length, "v·d") \
    X(perpendicular, Length, "perpendicular") \
    X(root, Length, "root") \
    X(quotient, Significant, "quotient") \
    X(t, Length, "t") \
    X(point, Length, "hit point") \
    X(normal, Unit, "normal") \
    X(mirrored, Unit, "mirrored direction") \
    X(refracted, Unit, "refracted direction") \
    X(light, Unit, "light's direction") \
    X(cosine, Unit, "cosines") \
    X(power, Unit, "power") \
    X(row, Significant, "texture rows") \
    X(texture, Cell, "texture coordinates") \
    X(colour, Colour, "colours") \
    X(weight, Unit, "weights")

enum class Step {
#define QRAY_STEP(name, quantity, what) name,
    QRAY_STEPS(QRAY_STEP)
#undef QRAY_STEP
};
#define QRAY_ONE(name, quantity, what) +1
inline constexpr int steps = QRAY_STEPS(QRAY_ONE);
#undef QRAY_ONE

} // namespace qray::study
