// What a ray meets, and the surface there.
#pragma once

#include "../scene/scene.hpp"

namespace qray {

template <class N>
struct Hit {
    typename N::Length t; // > 0
    Tag tag;
    Kind kind;
    uint32_t index; // into the scene's table of that kind
    Local<N> local; // curved surfaces only

    // Is it behind a hit at distance t2 on the surface named by tag2?
    QRAY_INLINE constexpr bool is_behind(typename N::Length t2, Tag tag2) const
    {
        return t2 < t || (t2 == t && tag2.place() < tag.place());
    }
};

// The surface at a hit. The geometric normal points outward; `normal` is the shading normal, turned to the viewer.
template <class N>
struct Surface {
    Point<N> point;
    Direction<N> geometric;
    Direction<N> normal;
    typename N::Unit n_d; // normal . d of the ray that sees it, <= 0
    bool turned;          // the normal was turned
};

// With the point where rays start that leave to the viewer's side, where a step takes long to find.
template <class N>
inline constexpr bool keeps_step = !N::is_fixed;
template <class N>
    requires keeps_step<N>
struct Surface<N> {
    Point<N> point;
    Direction<N> geometric;
    Direction<N> normal;
    typename N::Unit n_d;
    bool turned;
    Point<N> above;
};

} // namespace qray
