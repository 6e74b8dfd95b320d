// The effects by name, in the order of Effects.
#pragma once

#include <qray/scene/effects.hpp>

namespace qray::scene {

struct EffectName {
    const char* name;
    bool Effects::*effect;
};

constexpr EffectName effect_names[] = {
    {"sphere", &Effects::sphere},
    {"disc", &Effects::disc},
    {"cone", &Effects::cone},
    {"polygon", &Effects::polygon},
    {"patch", &Effects::patch},
    {"checker", &Effects::checker},
    {"stripes", &Effects::stripes},
    {"gradient", &Effects::gradient},
    {"rings", &Effects::rings},
    {"noise", &Effects::noise},
    {"marble", &Effects::marble},
    {"wood", &Effects::wood},
    {"brick", &Effects::brick},
    {"light", &Effects::light},
    {"sun", &Effects::sun},
    {"shadow", &Effects::shadow},
    {"see_through", &Effects::see_through},
    {"highlight", &Effects::highlight},
    {"fractional_shine", &Effects::fractional_shine},
    {"mirror", &Effects::mirror},
    {"transmit", &Effects::transmit},
    {"eye_surface", &Effects::eye_surface},
    {"grid", &Effects::grid},
    {"adaptive", &Effects::adaptive},
    {"windows", &Effects::windows},
    {"tree", &Effects::tree},
};
// Every effect is there: they are all of Effects but its depth.
static_assert(sizeof effect_names / sizeof *effect_names == sizeof(Effects) - sizeof(Effects::depth));

} // namespace qray::scene
