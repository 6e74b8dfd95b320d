// Builders and tracers for all that a desktop's scene can call for: what takes long to compile, once for all tests, in
// tracer.cpp.
#pragma once

#include <qray/picture/render.hpp>

#include "../src/scene/builder.hpp"
#include "roomy.hpp"

#ifndef QRAY_ONCE
#define QRAY_ONCE extern
#endif

namespace qray {

namespace test {
struct RayCount {
    uint64_t rays[4] = {};
    void operator()(RayKind kind) { rays[static_cast<int>(kind)]++; }
    uint64_t operator[](RayKind kind) const { return rays[static_cast<int>(kind)]; }
};
} // namespace test

#define QRAY_FOR(N) \
    QRAY_ONCE template class scene::Builder<N>; \
    QRAY_ONCE template Rgb<N> trace(const Scene<N, scene::desktop_effects()>&, Ray<N>, test::RayCount&, EyeSample)
QRAY_FOR(q32);
QRAY_FOR(Float);
#ifndef QRAY_LANES_ALONE // for tests of lanes, which these have not
QRAY_FOR(q16);
QRAY_FOR(Double);
#endif
#undef QRAY_FOR

} // namespace qray
