// Triangles in little room, and corners that are stored once.
#pragma once

#include <string.h>

#include "members.hpp"
#include "storage.hpp"

namespace qray::scene {

template <class N>
struct LeanBuilder {
    Storage<N>& s;

    void start(uint32_t slots)
    {
        s.corner_slots.count = slots;
        memset(s.corner_slots.data, 0, slots * sizeof *s.corner_slots.data);
    }

    // False where its numbers do not fit. `normals` are null where it is flat.
    template <class T>
    bool push(Array<T>& table, const Point<N>* corners, const Direction<N>* normals, const Direction<N>& g,
              uint32_t place, uint32_t fill)
    {
        if (place > UINT16_MAX || fill > UINT8_MAX || s.vertices.count + 3 > UINT16_MAX)
            return false;
        T t{{}, static_cast<uint16_t>(place), {}, static_cast<uint8_t>(fill)};
        if constexpr (N::is_fixed) {
            Direction<N> across{};
            if (!normal_across<N>(corners[0], corners[1], corners[2], across))
                return false;
            const auto rest = [](auto whole, auto part, int8_t& to) {
                const int32_t difference = whole.raw - part.raw;
                to = static_cast<int8_t>(difference);
                return to == difference;
            };
            if (!rest(g.x, across.x, t.normal.x) || !rest(g.y, across.y, t.normal.y)
                || !rest(g.z, across.z, t.normal.z))
                return false;
        } else {
            t.normal = {g.x, g.y, g.z};
        }
        const auto number = [&](int i) {
            return static_cast<uint16_t>(shared_corner(corners[i], normals == nullptr ? nullptr : normals + i));
        };
        t.corners = {number(0), number(1), number(2)};
        table.push() = t;
        return true;
    }

private:
    // The number of a corner, which the scene's vertices may have already.
    uint32_t shared_corner(const Point<N>& p, const Direction<N>* normal)
    {
        uint64_t at = 0;
        add_to_hash(at, Vec3d{value(p.x), value(p.y), value(p.z)});
        for (;; at++) {
            uint32_t& slot = s.corner_slots.data[at %= s.corner_slots.count];
            if (slot == 0) {
                s.vertices.push() = p;
                if (normal != nullptr)
                    s.normals.push() = *normal;
                slot = s.vertices.count;
            }
            if (s.vertices.data[slot - 1] == p && (normal == nullptr || s.normals.data[slot - 1] == *normal))
                return slot - 1;
        }
    }
};

} // namespace qray::scene
