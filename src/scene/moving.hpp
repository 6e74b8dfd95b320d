// Which tables of a compiled scene move: a bit for each, in the order of QRAY_TABLES.
#pragma once

#include <stdint.h>

#include <string_view>

#include <qray/scene/effects.hpp>

namespace qray::scene {

#define QRAY_NAME(Type, name, table) table,
enum class TableId : uint8_t { QRAY_TABLES(QRAY_NAME) };
#undef QRAY_NAME
#define QRAY_NAME(Type, name, table) #table,
inline constexpr std::string_view table_names[] = {QRAY_TABLES(QRAY_NAME)};
#undef QRAY_NAME

constexpr uint64_t bit_of(TableId table) { return uint64_t{1} << static_cast<int>(table); }
constexpr uint64_t bit_of(Kind kind) { return uint64_t{1} << static_cast<int>(kind); } // shapes are the first
static_assert(static_cast<int>(Kind::patch) == static_cast<int>(TableId::patches));
inline constexpr uint64_t camera_moves = uint64_t{1} << 63; // in every scene that moves
// How surfaces light one another is known of one place alone.
constexpr bool moves_tables(uint64_t moving) { return (moving & ~camera_moves) != 0; }
static_assert(sizeof table_names / sizeof *table_names < 64);

// What can be named: of the rest, some move along. Triangles in little room keep of their normal what rounded corners
// do not say, and stand still; figures that move are made none.
inline constexpr uint64_t lean_tables = bit_of(TableId::triangles) | bit_of(TableId::smooth_triangles);
#define QRAY_BIT(Type, name, table) | bit_of(TableId::table)
inline constexpr uint64_t movable_tables =
    (0 QRAY_SHAPES(QRAY_BIT) QRAY_LIGHTS(QRAY_BIT) | bit_of(TableId::mattes)) & ~lean_tables;
#undef QRAY_BIT

constexpr bool moves_all(uint64_t moving) { return (moving & movable_tables) == movable_tables; }

// With what follows the tables that are named.
constexpr uint64_t with_followers(uint64_t moving)
{
    Effects e;
#define QRAY_MOVES(Type, name, table) e.name = (moving & bit_of(TableId::table)) != 0;
    QRAY_SHAPES(QRAY_MOVES)
#undef QRAY_MOVES
    return moving | camera_moves | (e.shapes() != 0 ? bit_of(TableId::entries) : 0)
        | (e.corners() ? bit_of(TableId::vertices) : 0) | (e.smooth() ? bit_of(TableId::normals) : 0);
}

// A text, and behind it what can be named.
template <size_t Size>
struct MovableSaid {
    char text[Size + 200] = {};

    constexpr explicit MovableSaid(const char (&before)[Size], std::string_view gap = " ")
    {
        size_t at = 0;
        const auto put = [&](std::string_view part) {
            for (const char c : part)
                text[at++] = c;
        };
        put(before);
        std::string_view between;
        for (size_t i = 0; i < sizeof table_names / sizeof *table_names; i++)
            if ((movable_tables >> i & 1) != 0) {
                put(between);
                put(table_names[i]);
                between = ", ";
            }
        put(gap);
        put("(planes are discs, cylinders cones, mattes colours)");
    }
};

// "spheres,lights", "camera", "all"; false where something else is named.
constexpr bool read_moving(std::string_view text, uint64_t& moving)
{
    moving = camera_moves;
    while (true) {
        const size_t comma = text.find(',');
        const std::string_view name = text.substr(0, comma);
        uint64_t found = name == "camera" ? camera_moves : name == "all" ? movable_tables : 0;
        for (size_t i = 0; i < sizeof table_names / sizeof *table_names; i++)
            if (name == table_names[i])
                found = movable_tables & uint64_t{1} << i;
        if (found == 0)
            return false;
        moving |= found;
        if (comma == std::string_view::npos)
            break;
        text.remove_prefix(comma + 1);
    }
    moving = with_followers(moving);
    return true;
}

} // namespace qray::scene
