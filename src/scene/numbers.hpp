// The number systems, in the order in which they are named: each one's type, and its name for the command.
#pragma once

#include <qray/vector/ray.hpp>

#define QRAY_NUMBERS(DO) DO(q16, q16) DO(q24, q24) DO(q32, q32) DO(Float, float) DO(Double, double)

namespace qray::scene {

#define QRAY_NUMBER(Type, name) \
    if constexpr (Is<N, Type>) \
        return #Type;
template <class N>
constexpr const char* number_type()
{
    QRAY_NUMBERS(QRAY_NUMBER)
}
#undef QRAY_NUMBER
#define QRAY_NUMBER(Type, name) \
    if constexpr (Is<N, Type>) \
        return #name;
template <class N>
constexpr const char* number_name()
{
    QRAY_NUMBERS(QRAY_NUMBER)
}
#undef QRAY_NUMBER

} // namespace qray::scene
