// The list of the steps at which the tracer rounds.
#pragma once

namespace qray::study {

// The steps: name, of which quantity of a number system its result is, and what it is. Quotients and rows have their
// bits not behind the point, but from the first that is set. Lengths are scene units after the builder's scale. With
// coordinates go radii, with v.d what cones find in their own frame, with hit points how far off these new rays start,
// with curved normals what they are found from (offset / radius of a sphere, weights of a patch's corners), with
// cosines the shares of light that are made of them, with weights the coefficients of materials.
#define QRAY_STEPS(X) \
    X(camera, Unit, "camera direction") \
    X(coordinate, Length, "coordinates") \
    X(projection, Length, "v·d") \
    X(perpendicular, Length, "perpendicular") \
    X(root, Length, "root") \
    X(quotient, Quotient, "quotient") \
    X(t, Length, "t") \
    X(point, Length, "hit point") \
    X(normal, Unit, "normal") \
    X(curved, Curved, "curved normals") \
    X(mirrored, Unit, "mirrored direction") \
    X(refracted, Unit, "refracted direction") \
    X(eta, Eta, "ratios of indices") \
    X(light, Unit, "light's direction") \
    X(cosine, Unit, "cosines") \
    X(power, Share, "power") \
    X(row, Row, "texture rows") \
    X(texture, Cell, "texture coordinates") \
    X(colour, Colour, "colours") \
    X(share, Share, "shares of colours") \
    X(map, Colour, "light maps") \
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
