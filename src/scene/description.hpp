// What a scene text says, in double precision and in the file's own units and order: the parser's
// result and the builder's input. Arrays lie in memory that the caller hands in.
//
// What parse() promises of all lengths, so that neither their fourth powers nor quotients of two squares
// leave double's range: every coordinate is at most 1e15 in size; of each direction, normal and axis, of
// at - from and of a cone's b - a the largest component is at least 1e-60 (a smaller one is zero: an error),
// and so is each radius that is not 0 (an object of none is dropped), each texture size and `far`.
// A polygon has a plane: (v1 - v0) x (v2 - v1) or, where these are in line, its Newell vector is not zero.
#pragma once

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <qray/scene/lists.hpp>

#include "files.hpp"
#include "lexer.hpp"
#include "room.hpp"
#include "vec3d.hpp"

namespace qray::scene {

struct Limits {
    static constexpr uint32_t objects = 1'048'576;  // entities after parsing (a patch is one)
    static constexpr uint32_t vertices = 3'145'728; // corners of all polygons and patches
    static constexpr uint32_t surfaces = 1'048'576; // after building: a patch of n corners has n - 2; see Tag
    static constexpr uint32_t materials = 4'096;    // distinct fills
    static constexpr uint32_t lights = 64;
    static constexpr uint32_t places = 16;          // of a panel, along an edge
    static constexpr uint32_t light_surfaces = 1'024; // that a light lies on, on average
    static constexpr uint32_t cells = 32'768;         // of light, on both sides of all flat surfaces
    static constexpr uint32_t resolution = 32'768;  // pixels along either edge
    static constexpr uint32_t text = 256u << 20;    // bytes of scene text, and of a mesh's file
    static constexpr uint32_t images = 64;          // different files
    static constexpr uint32_t image_size = 16'384;  // texels along either edge
    static constexpr uint32_t image_bytes = 64u << 20; // of all of them
    static constexpr double narrow_radius = 256;      // of a scene, least, in steps of q16 or q24
    static constexpr double narrow_cell = 1.0 / 4096; // of a texture, likewise
};

struct View {
    Vec3d from, at, up;
    double angle = 0; // degrees, full vertical field, in (0, 180)
    uint32_t width = 0, height = 0;
};

struct Texture {
    TextureKind kind = TextureKind::none;
    Vec3d colour;    // N, the texture's own colour
    double size = HUGE_VAL; // > 0; of a globe, and of none, without end
    Vec3d axis;      // as given, not normalised, of those that have one; else zero
    Vec3d at;        // an image's corner, a globe's centre
    Vec3d u, v;      // edges of an image; its size is the shorter
    uint32_t image = 0; // index into images
    friend bool operator==(const Texture&, const Texture&) = default;
};

struct Fill {
    Vec3d colour{1, 1, 1};
    double ambient = 1, diffuse = 1, highlight = 0, shine = 1, mirror = 0, transmit = 0, emission = 0;
    double ior = 1; // <= 0 in the text reads as 1
    Texture texture;
    friend bool operator==(const Fill&, const Fill&) = default;
};

struct LightSource {
    bool sun = false;
    uint32_t places = 0; // of a panel, along an edge; else 0
    Vec3d at;     // position, of a panel its middle; or for a sun the direction it shines from (not normalised)
    Vec3d u, v;   // half edges of a panel
    Vec3d colour; // resolved: 1/sqrt(n) where the text gave none
    uint32_t line = 0; // of the text
};

struct ImageSource {
    size_t first; // of its bytes among all: red, green and blue, row by row from the bottom
    uint32_t width, height;
};

struct Object {
    Kind kind{};
    uint8_t entity = 0;             // by which of its Host's entities the text says it
    uint32_t fill = 0;              // index into fills
    Vec3d a, b;                     // as the shape's header in src/scene/shape has them: centre, base, normal ...
    double ra = 0, rb = 0;          // radii
    uint32_t vertex = 0, count = 0; // corners: the first, and how many
    uint32_t line = 0;              // of the text
};

// What is not drawn as the text has it: how often, where first, and what is said of that.
struct Warning {
    uint32_t count, line, column; // of an object its line alone: the column is 0
    char text[224];

    [[gnu::format(printf, 3, 4)]] void note(Position place, const char* format, ...)
    {
        if (count++ != 0 && line <= place.line)
            return;
        line = place.line;
        column = place.column;
        va_list values;
        va_start(values, format);
        vsnprintf(text, sizeof text, format, values);
        va_end(values);
    }
};

// Where light is known on a side of a flat surface: at nodes, each so many steps from an edge of its rectangle.
struct NodeAxis {
    Vec3d along; // along.(p - origin) counts steps
    uint32_t steps, first, count; // of the whole rectangle; its nodes
};
// Walls cut what is between four nodes in parts, which have a light at each of the four by themselves.
struct WallCut {
    Vec3d normal;
    double height;         // of the wall's plane: normal.p
    uint32_t above, below; // links: 2 k + 1 to cut k of the grid, 2 k + 2 to its part k
};
struct LightGrid {
    uint32_t place; // of the surface in the scene file
    Vec3d origin;
    NodeAxis x, y;
    uint32_t first;               // of its lights, row by row, and four of each part behind them
    uint32_t cuts, parts;         // how many
    uint32_t first_cut, first_root; // what is between four nodes has a link, or 0; row by row
    uint32_t lights() const { return x.count * y.count + 4 * parts; }
};

// One line for people: file:line:column: text. What is wrong with a whole scene may have a place of its own.
struct Error {
    char text[512] = {};
    Position at{0, 0};

    // Always false.
    [[gnu::format(printf, 2, 3)]] bool say(const char* format, ...)
    {
        va_list values;
        va_start(values, format);
        vsnprintf(text, sizeof text, format, values);
        va_end(values);
        return false;
    }
};

// An object by what it is sorted by.
struct SortedObject {
    uint32_t group, index;
    double x, y, z;
};

struct Description {
    View view;
    Vec3d background;
    Vec3d ambient{0.2, 0.2, 0.2};
    bool shadows = true;
    double far = 0; // 0: the default, 16 scene radii
    uint32_t object_count = 0, vertex_count = 0, fill_count = 0, light_count = 0;
    uint32_t dropped = 0; // objects and triangles of patches without extent, left out
    Warning empty{};      // of these, what has a radius of 0
    Warning nonplanar{};  // polygons of which a corner is off the plane by more than 1 % of their size
    Warning passed_over{}; // meshes of which files say more than their faces
    Warning clamped{};    // numbers of `f` outside of their ranges
    char comment[256] = {}; // the first comment that says something, without its '#'; else empty
    Bytes files; // that the scene names, while they are read; the room is the caller's
    Room room;   // the caller's, for what follows
    Object* objects = nullptr;
    Vec3d* vertices = nullptr;
    Vec3d* normals = nullptr; // patches only, at the corner's index, as given
    Fill* fills = nullptr;
    LightSource lights[Limits::lights];
    uint32_t most_objects = 0, most_vertices = 0; // as many as the arrays hold
    uint32_t image_count = 0;
    ImageSource images[Limits::images + 1]; // the last while it is read
    Bytes image_bytes; // in a room of its own
    double radiosity = 0; // the longest edge of a cell; 0: none
    Position radiosity_at{};
    Room light_room; // the caller's, for what solve_radiosity() finds:
    LightGrid* grids = nullptr; // two a surface that takes part: outside, inside
    uint16_t* nodes = nullptr;
    WallCut* cuts = nullptr;
    uint32_t* roots = nullptr;
    Vec3d* light = nullptr; // what arrives at each two nodes, times diffuse
    uint32_t grid_count = 0, node_count = 0, cut_count = 0, root_count = 0, light_size = 0;
    uint32_t cell_count = 0, light_rounds = 0;
    double light_change = 0; // the largest in the last round
    uint64_t light_rays = 0;

    // Cuts arrays for so many, and as many fills as objects, from the room where it is large enough; returns how many
    // bytes it must have.
    size_t lay_out(uint32_t of_objects, uint32_t of_vertices)
    {
        most_objects = of_objects;
        most_vertices = of_vertices;
        return lay_out_in(room, [&](Layout& layout) {
            objects = layout.array<Object>(most_objects);
            vertices = layout.array<Vec3d>(most_vertices);
            normals = layout.array<Vec3d>(most_vertices);
            fills = layout.array<Fill>(most_objects < Limits::materials ? most_objects : Limits::materials);
        });
    }
    // As many as a text of that size can hold: "s 0 0 0 1 " takes 10 bytes, "0 0 0 " of a corner 6.
    size_t lay_out(size_t text)
    {
        const auto most = [](size_t n, uint32_t limit) { return n < limit ? static_cast<uint32_t>(n) : limit; };
        return lay_out(most(text / 10 + 1, Limits::objects), most(text / 6 + 1, Limits::vertices));
    }
    // Makes room for so many in all, up to the limits; what is there moves. False where there is no more memory.
    bool grow(uint64_t least_objects, uint64_t least_vertices, bool (*grow_room)(Room&, size_t))
    {
        if (least_objects <= most_objects && least_vertices <= most_vertices)
            return true;
        const auto more = [](uint64_t least, uint32_t now, uint32_t limit) {
            return static_cast<uint32_t>(fmin(limit, fmax(static_cast<double>(least), 1.5 * now)));
        };
        const uint32_t of_objects = more(least_objects, most_objects, Limits::objects);
        const uint32_t of_vertices = more(least_vertices, most_vertices, Limits::vertices);
        Description larger{};
        if (!grow_room(room, larger.lay_out(of_objects, of_vertices)))
            return false;
        lay_out(most_objects, most_vertices);
        larger.room = room;
        larger.lay_out(of_objects, of_vertices);
        // From the last to the first, each to a higher place.
        memmove(larger.fills, fills, fill_count * sizeof *fills);
        memmove(larger.normals, normals, vertex_count * sizeof *normals);
        memmove(larger.vertices, vertices, vertex_count * sizeof *vertices);
        lay_out(of_objects, of_vertices);
        return true;
    }
};

// Reads the scene text of `size` bytes into `out` (reset first), whose room has out.lay_out(size) bytes. `name` stands
// in messages; files that the scene names are read by `files`. Returns false, fills `error` and leaves `out`
// unspecified where the text is no scene of scenes/README.md. Every rule of the language that does not depend on a
// number system is checked here. Threads may parse into different Descriptions.
bool parse(const char* name, const char* text, size_t size, Description& out, Error& error,
           const Files* files = nullptr);

} // namespace qray::scene
