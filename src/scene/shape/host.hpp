// What the desktop knows of a shape, beside its header in include/qray/shape: how the text says it, how far it
// reaches, what the tracer's structure is made of. Host<Shape> stands in the header of the shape's name in this folder:
//   entities        the words that say one in a scene, each with a function that reads what follows
//   fields          what a compiled scene says of its table's columns
//   example         an object of about unit size at the origin, and a place on it, for tests
//   extent          adds an object to a box
//   lies_on         is a point no farther than `off` from an object (of several surfaces, the part-th), on which side?
//                   With HUGE_VAL of what is flat: from its plane
//   convert         pushes the tracer's structures of an object, by a Builder
//   box             the extent of the tracer's structure in the moved and scaled scene, for trees
//   random          a random object as text, for tests
//   widest          the greatest radius of what is curved; HUGE_VAL of what is not
//   apart           how far apart two are, at most, of what is curved: for those that fall together
//   covers          does a flat one hold a point of its plane, whose normal is n?
// and, where it differs from HostOfShape's, surfaces_of, range, middle, is_ball, is_endless and outline. HostOfFlat is
// for what is one flat surface.
#pragma once

#include "../convert.hpp"
#include "../reader.hpp"

namespace qray::scene {

template <template <class> class Shape>
struct Host;

struct Entity {
    const char* word;
    const char* name;   // in messages: a NAME
    const char* plural; // in statistics
    // Reads and checks; false where it has written the error. What has no extent is `empty`, and left out.
    bool (*read)(Reader&, Description&, Object&, bool& empty);
};

struct HostOfShape {
    // Is it one flat surface, or the ball of radius ra around a?
    static constexpr bool is_flat = false, is_ball = false;
    // How many surfaces an object has, each with a place of its own.
    static uint32_t surfaces_of(const Object&) { return 1; }
    // How large the structure is, in units of what it may be in the moved and scaled scene; where coordinates say, 0.
    template <class N>
    static double range(const Object&) { return 0; }
    static Vec3d middle(const Description&, const Object& o) { return o.a; }
    static bool covers(const Description&, const Object&, const Vec3d&, const Vec3d&) { return false; }
    // Does it reach as far as the scene allows?
    static bool is_endless(const Object&) { return false; }
    // Calls f(corner) for those of what is flat and ends: of what takes part in radiosity.
    template <class F>
    static void outline(const Description&, const Object&, F)
    {
    }
};
struct HostOfFlat : HostOfShape {
    static constexpr bool is_flat = true;
    static double widest(const Object&) { return HUGE_VAL; }
    static double apart(const Object&, const Object&) { return HUGE_VAL; } // by their planes instead
    static bool covers() = delete;                                         // each has its own
};

// What the tracer's numbers are.
template <class L>
double value(L v)
{
    if constexpr (requires { v.raw; })
        return v.raw / static_cast<double>(int64_t{1} << L::frac);
    else
        return static_cast<double>(v);
}
template <class L>
Vec3d value(const Vec<L>& v) { return {value(v.x), value(v.y), value(v.z)}; }

inline Extent ball_extent(const Vec3d& centre, double radius)
{
    Extent box;
    box.add(centre, {radius, radius, radius});
    return box;
}

} // namespace qray::scene
