// What every shape says of itself and is asked. A shape is a structure with these constants, which are told and not guessed
//   has_corners   it is made of points in the scene's vertices
//   is_curved     what an intersection finds beside t is kept for the surface (Local)
//   is_smooth     it has shading normals of its own: shading_normal()
//   is_short      its test is so short that where code is cheap a loop over them is unrolled
// a Tag, and these functions, found by its type:
//   surely_missed(shape, reject)                                 may always say no; see reject.hpp
//   intersect<Near>(shape, corners, ray, limit, t, local)        the nearest t in (0, limit], or false
//   crossings<Near>(shape, corners, ray, distance)               how often the ray crosses it before a light at `distance`
//   surface_of(shape, corners, ray, t, local, point, normal)     the point of a hit, and the outward unit normal there
//   shading_normal(shape, corners, ray)                          of a smooth one: unit, not yet turned
// Near says that the ray is known not to be surely_missed(). The surface that a ray has just left is told by its tag.
#pragma once

#include "../vector/ray.hpp"

namespace qray {

// The scene's corners, and the shading normals there; null where no shape has such.
template <class N>
struct Corners {
    const Point<N>* points;
    const Direction<N>* normals;
};

} // namespace qray
