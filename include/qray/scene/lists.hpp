// What exists, one list of each kind. Everything else is derived from these: the sets of effects, a scene's tables, the
// loops over them, what a desktop stores and what a compiled scene holds. What is forgotten does not compile.
//
// X(Type, name, table): the structure, one template over the number system; the effect that it is; the
// scene's table of it.
#pragma once

#include <stdint.h>

#include "../light/light.hpp"
#include "../light/panel.hpp"
#include "../light/sun.hpp"
#include "../shape/cone.hpp"
#include "../shape/disc.hpp"
#include "../shape/patch.hpp"
#include "../shape/polygon.hpp"
#include "../shape/smooth_triangle.hpp"
#include "../shape/sphere.hpp"
#include "../shape/triangle.hpp"
#include "../surface/highlight.hpp"
#include "../surface/mirror.hpp"
#include "../surface/transmit.hpp"
#include "../texture/brick.hpp"
#include "../texture/checker.hpp"
#include "../texture/globe.hpp"
#include "../texture/gradient.hpp"
#include "../texture/image.hpp"
#include "../texture/light_map.hpp"
#include "../texture/marble.hpp"
#include "../texture/noise.hpp"
#include "../texture/rings.hpp"
#include "../texture/stripes.hpp"
#include "../texture/wood.hpp"

// A ray asks shapes in this order.
#define QRAY_SHAPES(X) \
    X(Sphere, sphere, spheres) \
    X(Disc, disc, discs) /* a plane is one */ \
    X(Cone, cone, cones) /* so is a cylinder */ \
    X(Polygon, polygon, polygons) \
    X(Patch, patch, patches) \
    X(Triangle, triangle, triangles) /* of polygons and patches in compiled scenes, in little room */ \
    X(SmoothTriangle, smooth_triangle, smooth_triangles)

#define QRAY_TEXTURES(X) \
    X(Checker, checker, checkers) \
    X(Stripes, stripes, stripes) \
    X(Gradient, gradient, gradients) \
    X(Rings, rings, rings) \
    X(Noise, noise, noises) \
    X(Marble, marble, marbles) \
    X(Wood, wood, woods) \
    X(Brick, brick, bricks) \
    X(Image, image, images) \
    X(Globe, globe, globes)

#define QRAY_LIGHTS(X) \
    X(Light, light, lights) \
    X(Sun, sun, suns) \
    X(Panel, panel, panels)

// Parts of a material that only some scenes have; each table has an entry for every material.
#define QRAY_SURFACES(X) \
    X(Highlight, highlight, highlights) \
    X(Mirror, mirror, mirrors) \
    X(Transmit, transmits(), transmits)

// All effects: those above, and those that are no structure with a table.
#define QRAY_EFFECTS(X) \
    QRAY_SHAPES(X) \
    QRAY_TEXTURES(X) \
    QRAY_LIGHTS(X) \
    X(, shadow, )      /* light can be blocked, */ \
    X(, see_through, ) /* and a surface in its way may let some of it through */ \
    X(, highlight, ) \
    X(, fractional_shine, ) \
    X(, mirror, )      /* rays of higher depth */ \
    X(, transmit, ) \
    X(, eye_surface, ) /* the eye lies on a surface */ \
    X(, light_surface, ) /* so does a light */ \
    X(, light_map, )   /* flat surfaces light one another */ \
    X(, grid, )        /* several samples a pixel, */ \
    X(, adaptive, )    /* or as many as it takes */ \
    X(, tree, )        /* of a desktop, over the shapes */ \
    X(, flat_tree, )   /* of a compiled scene */

// All tables of a scene, in its order.
#define QRAY_TABLES(X) \
    QRAY_SHAPES(X) \
    X(Point, corners(), vertices) \
    X(Direction, smooth(), normals) /* shading normals, as many as vertices */ \
    X(Matte, always(), mattes) \
    QRAY_SURFACES(X) \
    X(TextureOf, texture(), textures) /* by material */ \
    X(Texel, texels(), texels) \
    QRAY_TEXTURES(X) \
    QRAY_LIGHTS(X) \
    X(LightSurface, light_surface, light_surfaces) \
    X(LightOf, light_map, lights_of) /* by place in the scene file */ \
    X(EvenLight, light_map, even_lights) \
    X(LightMap, light_map, light_maps) \
    X(LightKnot, light_map, light_knots) \
    X(LightCut, light_map, light_cuts) \
    X(LightPlane, light_map, light_planes) \
    X(LightCell, light_map, light_cells) \
    X(TreeEntry, flat_tree, entries)

namespace qray {

#define QRAY_NAME(Type, name, table) name,
enum class Kind : uint8_t { QRAY_SHAPES(QRAY_NAME) };
enum class TextureKind : uint8_t { none, QRAY_TEXTURES(QRAY_NAME) };
#undef QRAY_NAME

} // namespace qray
