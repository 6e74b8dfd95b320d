// Builders and tracers for all that a scene can call for: what takes long to compile, once for all tests: the desktop's
// in tracer.cpp, the boards' in tracer_flat.cpp.
#pragma once

#include <qray/picture/render.hpp>

#include "../src/scene/builder.hpp"
#include "roomy.hpp"

#ifndef QRAY_ONCE
#define QRAY_ONCE extern
#endif
#ifndef QRAY_FLAT
#define QRAY_FLAT extern
#endif

namespace qray {

namespace test {
struct RayCount {
    uint64_t rays[4] = {};
    void operator()(RayKind kind) { rays[static_cast<int>(kind)]++; }
    uint64_t operator[](RayKind kind) const { return rays[static_cast<int>(kind)]; }
};
// As boards draw a compiled scene: with their tree.
constexpr Effects flat()
{
    Effects e = everything(5);
    e.tree = false;
    return e;
}
} // namespace test

#define QRAY_FOR(N) \
    QRAY_ONCE template class scene::Builder<N>; \
    QRAY_ONCE template Rgb<N> trace(const Scene<N, scene::desktop_effects()>&, Ray<N>, test::RayCount&, EyeSample); \
    QRAY_FLAT template Rgb<N> trace(const Scene<N, test::flat()>&, Ray<N>, test::RayCount&, EyeSample)
QRAY_FOR(q32);
QRAY_FOR(Float);
#ifndef QRAY_LANES_ALONE // for tests of lanes, which these have not
QRAY_FOR(q16);
QRAY_FOR(q24);
QRAY_FOR(Double);
#endif
#undef QRAY_FOR

} // namespace qray
