// Triangles in little room. The text has none: they are made of what is a `p` or `pp` of three corners there.
#pragma once

#include <array>

#include "patch.hpp"
#include "polygon.hpp"

namespace qray::scene {

template <template <class> class Shape>
struct HostOfMesh : Host<Shape> {
    static constexpr std::array<Entity, 0> entities{};
    static constexpr const char* fields = "corners; place; what its normal has beyond theirs; material";
    static constexpr const char* example[] = {nullptr, nullptr};
    template <class N, bool Smooth>
    static Extent box(const MeshTriangle<N, Smooth>& s, const Corners<N>& corners)
    {
        Extent box;
        for (uint32_t i = 0; i < 3; i++)
            box.add(value(s.figure(corners.points)[i]));
        return box;
    }
};

template <>
struct Host<Triangle> : HostOfMesh<Polygon> {};
template <>
struct Host<SmoothTriangle> : HostOfMesh<Patch> {};

} // namespace qray::scene
