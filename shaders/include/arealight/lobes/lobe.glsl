#ifndef AREALIGHT_LOBE_GLSL
#define AREALIGHT_LOBE_GLSL

#include "arealight/options.glsl"
#include "arealight/surface.glsl"

// A lobe of a surface's reflection: a clamped cosine, linearly transformed and weighted.
struct ArealightLobe {
    // From the shading frame (x to the viewer's side, z the normal) to the lobe's cosine space; determinant >
    // 0
    mat3 space;
    vec3 albedo; // what it reflects of light from everywhere, per channel
    float gain;  // of what is left by clipping at the surface's horizon, to keep the albedo; 1 without that
};

// A lobe that lies above others.
struct ArealightLayer {
    ArealightLobe lobe;
    float base; // of the light that the lobes below get, in [0, 1]
};

// The gain of a lobe with this space, from 1 on: the inverse of its part above the surface, which is a lune
// of the cosine (share_above_surface in Rust).
float arealight_gain_above_surface(mat3 space) {
    if (!AREALIGHT_CLIPS_AT_SURFACE) {
        return 1.0;
    }
    // The normal of the surface's horizon in the lobe's space
    vec3 horizon = cross(space[0], space[1]);
    float share = 0.5 + 0.5 * horizon.z * inversesqrt(dot(horizon, horizon) + AREALIGHT_TINY);
    return 1.0 / max(share, 1e-6);
}

// A lobe of this space and albedo.
ArealightLobe arealight_lobe(mat3 space, vec3 albedo) {
    return ArealightLobe(space, albedo, arealight_gain_above_surface(space));
}

#endif
