// A scene as the tracer reads it: pointers and counts into fixed arrays, a desktop's storage or a compiled scene's
// constant tables. Tables of effects that are not in E are empty types.
#pragma once

#include "../surface/material.hpp"
#include "camera.hpp"
#include "effects.hpp"
#include "eye_surface.hpp"
#include "flat_tree.hpp"
#include "light_surface.hpp"
#include "tree.hpp"

namespace qray {

template <class T, bool Present>
struct Table {
    const T* data;
    uint32_t count;
    constexpr const T& operator[](uint32_t i) const { return data[i]; }
    // The same, for a table that often has but one: if it is known to, that is known.
    constexpr const T& at(uint32_t i) const { return data[QRAY_KNOWN(count == 1) ? 0 : i]; }
};
template <class T>
struct Table<T, false> {};

// A table whose contents change: as it is at first, in flash, and a copy in RAM.
template <class T, uint32_t Count>
struct MovingTable {
    static constexpr uint32_t count = Count;
    T data[Count];
    constexpr T& operator[](uint32_t i) { return data[i]; }
    constexpr const T& operator[](uint32_t i) const { return data[i]; }
};

// A single value that only some scenes need.
template <class T, bool Present>
struct Maybe {
    T value;
};
template <class T>
struct Maybe<T, false> {};

// Which texture a material has, if any, and its index in the table of that kind.
struct TextureRef {
    TextureKind kind;
    uint16_t index;
};
template <class N>
using TextureOf = TextureRef;

template <class N, Effects E>
struct Scene {
    Either<E.moving, const Camera<N>&, Camera<N>> camera;
    [[no_unique_address]] Maybe<EyeSurface<N>, E.eye_surface> eye_surface{};
    Rgb<N> background;
    int32_t exposure; // colours are stored divided by 2^exposure
    [[no_unique_address]] Maybe<uint8_t, E.spawns()> max_depth{}; // at most E.depth
    [[no_unique_address]] Maybe<typename N::Unit, E.spawns()> cutoff{};
    [[no_unique_address]] Maybe<bool, E.shadow> shadows{};
    [[no_unique_address]] Maybe<uint8_t, E.adaptive> levels{};
    [[no_unique_address]] Maybe<typename N::Unit, E.adaptive> threshold{};
    [[no_unique_address]] Maybe<Tree<N>, E.tree> tree{};

#define QRAY_TABLE(Type, name, table) [[no_unique_address]] Table<Type<N>, E.name> table{};
    QRAY_TABLES(QRAY_TABLE)
#undef QRAY_TABLE
};

template <class N, Effects E>
QRAY_INLINE constexpr Corners<N> corners_of([[maybe_unused]] const Scene<N, E>& scene)
{
    if constexpr (E.smooth())
        return {scene.vertices.data, scene.normals.data};
    else if constexpr (E.corners())
        return {scene.vertices.data, nullptr};
    else
        return {};
}

} // namespace qray
