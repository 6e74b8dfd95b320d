// The members of a structure, one by one: what a compiled scene holds is written by them, so that none is forgotten.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include <bit>
#include <type_traits>

namespace qray::scene {

struct AnyMember {
    template <class T>
    operator T() const;
};

// How many members has an aggregate? As many as it can be initialised from.
template <class T, class... Members>
consteval size_t member_count()
{
    if constexpr (requires { T{Members{}..., AnyMember{}}; })
        return member_count<T, Members..., AnyMember>();
    else
        return sizeof...(Members);
}

// f(member, member, ...), in their order.
template <class T, class F>
void with_members(const T& v, F f)
{
    constexpr size_t count = member_count<T>();
    static_assert(count <= 12, "a structure of more members than this function takes apart");
#define QRAY_MEMBERS(n, ...) \
    if constexpr (count == n) { \
        const auto& [__VA_ARGS__] = v; \
        f(__VA_ARGS__); \
    }
    if constexpr (count == 0)
        f();
    QRAY_MEMBERS(1, a)
    QRAY_MEMBERS(2, a, b)
    QRAY_MEMBERS(3, a, b, c)
    QRAY_MEMBERS(4, a, b, c, d)
    QRAY_MEMBERS(5, a, b, c, d, e)
    QRAY_MEMBERS(6, a, b, c, d, e, g)
    QRAY_MEMBERS(7, a, b, c, d, e, g, h)
    QRAY_MEMBERS(8, a, b, c, d, e, g, h, i)
    QRAY_MEMBERS(9, a, b, c, d, e, g, h, i, j)
    QRAY_MEMBERS(10, a, b, c, d, e, g, h, i, j, k)
    QRAY_MEMBERS(11, a, b, c, d, e, g, h, i, j, k, l)
    QRAY_MEMBERS(12, a, b, c, d, e, g, h, i, j, k, l, m)
#undef QRAY_MEMBERS
}

// Of a structure of numbers, member by member.
template <class T>
void add_to_hash(uint64_t& hash, const T& v)
{
    if constexpr (std::is_class_v<T>) {
        with_members(v, [&hash](const auto&... members) { (add_to_hash(hash, members), ...); });
    } else {
        hash = (hash ^ std::bit_cast<uint64_t>(static_cast<double>(v))) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    }
}

} // namespace qray::scene
