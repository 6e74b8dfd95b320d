// The effects by name, in the order of Effects.
#pragma once

#include <qray/scene/effects.hpp>

namespace qray::scene {

struct EffectName {
    const char* name;
    bool Effects::*effect;
};

#define QRAY_NAMED(Type, name, table) {#name, &Effects::name},
constexpr EffectName effect_names[] = {QRAY_EFFECTS(QRAY_NAMED)};
#undef QRAY_NAMED

} // namespace qray::scene
