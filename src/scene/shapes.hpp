// The desktop's side of the list of shapes in include/qray/scene/lists.hpp.
#pragma once

#include "shape/cone.hpp"
#include "shape/disc.hpp"
#include "shape/patch.hpp"
#include "shape/polygon.hpp"
#include "shape/sphere.hpp"
#include "shape/triangle.hpp"

namespace qray::scene {

// f(Host<Shape>{}) for the shape of that kind.
template <class F>
decltype(auto) with_host(Kind kind, F f)
{
    switch (kind) {
#define QRAY_CASE(Type, name, table) case Kind::name: return f(Host<Type>{});
        QRAY_SHAPES(QRAY_CASE)
#undef QRAY_CASE
    }
    __builtin_unreachable();
}

// f<Shape<N>>(Host<Shape>{}) for the shape of that kind.
template <class N, class F>
void with_shape_of(Kind kind, F f)
{
    switch (kind) {
#define QRAY_CASE(Type, name, table) case Kind::name: return f.template operator()<Type<N>>(Host<Type>{});
        QRAY_SHAPES(QRAY_CASE)
#undef QRAY_CASE
    }
}

// f(Host<Shape>{}, Kind) for each.
template <class F>
void for_each_host(F f)
{
#define QRAY_CALL(Type, name, table) f(Host<Type>{}, Kind::name);
    QRAY_SHAPES(QRAY_CALL)
#undef QRAY_CALL
}

inline const char* name_of(const Object& o)
{
    return with_host(o.kind, [&o](auto host) { return host.entities[o.entity].name; });
}
inline uint32_t surfaces_of(const Object& o)
{
    return with_host(o.kind, [&o](auto host) { return host.surfaces_of(o); });
}
inline double widest(const Object& o) { return with_host(o.kind, [&o](auto host) { return host.widest(o); }); }
inline bool is_ball(Kind kind) { return with_host(kind, [](auto host) { return host.is_ball; }); }
inline bool is_flat(const Object& o) { return with_host(o.kind, [](auto host) { return host.is_flat; }); }
inline bool is_endless(const Object& o)
{
    return with_host(o.kind, [&o](auto host) { return host.is_endless(o); });
}
inline Vec3d middle(const Description& d, const Object& o)
{
    return with_host(o.kind, [&](auto host) { return host.middle(d, o); });
}
inline bool covers(const Description& d, const Object& o, const Vec3d& n, const Vec3d& p)
{
    return with_host(o.kind, [&](auto host) { return host.covers(d, o, n, p); });
}
inline void add_object(Extent& box, const Description& d, const Object& o)
{
    with_host(o.kind, [&](auto host) { host.extent(box, d, o); });
}
inline Above lies_on(const Description& d, const Object& o, uint32_t part, const Vec3d& p, double off)
{
    return with_host(o.kind, [&](auto host) { return host.lies_on(d, o, part, p, off); });
}

} // namespace qray::scene
