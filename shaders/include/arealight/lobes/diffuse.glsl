#ifndef AREALIGHT_DIFFUSE_GLSL
#define AREALIGHT_DIFFUSE_GLSL

#include "arealight/lobes/lobe.glsl"

// Lambert's lobe: the clamped cosine itself. `albedo` per channel, in [0, 1].
ArealightLobe arealight_diffuse_lobe(vec3 albedo) {
    return ArealightLobe(mat3(1.0), albedo, 1.0);
}

#endif
