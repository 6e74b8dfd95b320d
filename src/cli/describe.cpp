#include "describe.hpp"

#include "../scene/effect_names.hpp"
#include "../scene/shapes.hpp"
#include "options.hpp"

#include <stdio.h>

namespace qray::cli {

int describe()
{
    const char* before = "{\"numbers\": [";
    for (const char* name : number_names) {
        printf("%s\"%s\"", before, name);
        before = ", ";
    }
    before = "],\n\"effects\": [";
    for (const scene::EffectName& e : scene::effect_names) {
        printf("%s\"%s\"", before, e.name);
        before = ", ";
    }
    // An object of each shape, and a place on it; each texture, and whether it has an axis.
    before = "],\n\"shapes\": {";
#define QRAY_SHAPE(Type, name, table) \
    printf("%s\"" #name "\": [\"%s\", \"%s\"]", before, scene::Host<Type>::example[0], scene::Host<Type>::example[1]); \
    before = ",\n    ";
    QRAY_SHAPES(QRAY_SHAPE)
#undef QRAY_SHAPE
    before = "},\n\"textures\": {";
#define QRAY_TEXTURE(Type, name, table) \
    printf("%s\"" #name "\": %s", before, Type<Double>::has_axis ? "true" : "false"); \
    before = ", ";
    QRAY_TEXTURES(QRAY_TEXTURE)
#undef QRAY_TEXTURE
    puts("}}");
    return 0;
}

} // namespace qray::cli
