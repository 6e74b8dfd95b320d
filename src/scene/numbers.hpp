// The number systems, in the order in which they are named: each one's type, and its name for the command.
#pragma once

#include <qray/vector/ray.hpp>

#define QRAY_NUMBERS(DO) DO(q16, q16) DO(q24, q24) DO(q32, q32) DO(Float, float) DO(Double, double)
#define QRAY_NUMBERS_SAID "q16, q24, q32, float or double"

namespace qray::scene {

struct NumberNames {
    const char *type, *name;
};
#define QRAY_NUMBER(Type, name) \
    if constexpr (Is<N, Type>) \
        return NumberNames{#Type, #name};
template <class N>
constexpr NumberNames number_names_of()
{
    QRAY_NUMBERS(QRAY_NUMBER)
}
#undef QRAY_NUMBER

} // namespace qray::scene
