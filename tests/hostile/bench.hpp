// Where a random shape stands, and rays that are thrown at it.
#pragma once

#include <cstdlib>
#include <memory>

#include <qray/qray.hpp>

#include "../roomy.hpp"
#include "numbers.hpp"
#include "scene/builder.hpp"

namespace hostile {

using qray::Effects;

// A scene of one object, made by the builder. The view holds its box: the frame is the number system's own world,
// unscaled, as long as the object lies within +-reach.
inline constexpr double reach = 35;

template <class N>
struct Bench {
    qray::test::Roomy<qray::scene::Description> description;
    qray::test::Roomy<qray::scene::Storage<N>> stored;
    qray::scene::Description& from = description.at;
    qray::scene::Storage<N>& storage = stored.at;

    Bench()
    {
        from.view = {{-reach, -reach, -reach}, {reach, reach, reach}, {0, 1, 0}, 45, 1, 1};
        from.far = world - 0.25; // of itself it would halve the scale
        from.ambient = {0.2, 0.2, 0.2};
        from.lay_out(1 << 16, 1 << 18);
        storage.lay_out(from, false); // the only shape's table lies at the room's beginning, now and after build()
        from.fill_count = from.object_count = 1;
        from.fills[0] = {};
    }
    void build(const qray::scene::Object& object)
    {
        from.objects[0] = object;
        from.vertex_count = object.count;
        qray::scene::Error error;
        const qray::scene::Settings settings;
        qray::scene::Builder<N>(from, settings, storage).build(error);
    }
    static qray::scene::Object object(qray::Kind kind)
    {
        qray::scene::Object o;
        o.kind = kind;
        return o;
    }
};

// A ray towards `target` from a random place, far away in regime small_far.
template <class N>
qray::Ray<N> ray_at(Random& random, Regime regime, const Double3& target)
{
    using namespace qray::scene;
    for (;;) {
        const Double3 from = in_ball(random, world);
        const double distance = length(target - from);
        if (distance > (regime == Regime::small_far ? 40 : 1e-3))
            return free_ray<N>(random, from, target - from);
    }
}
// A ray through `near` that heads along the unit vector d.
template <class N>
qray::Ray<N> ray_along(Random& random, const Double3& near, const Double3& d)
{
    using namespace qray::scene;
    double back = random.in(0.5, 100);
    while (length(near - d * back) > world)
        back /= 2; // ends: `near` lies in the world
    return free_ray<N>(random, near - d * back, d);
}

inline double random_size(Random& random, Regime regime)
{
    switch (regime) {
    case Regime::ordinary: return random.logarithmic(0.5, 16);
    case Regime::small_far: return random.logarithmic(0.005, 0.05);
    default: return random.logarithmic(0.1, 16);
    }
}
inline Double3 random_place(Random& random, Regime, double size)
{
    const double r = reach - size;
    return {random.in(-r, r), random.in(-r, r), random.in(-r, r)};
}

} // namespace hostile
