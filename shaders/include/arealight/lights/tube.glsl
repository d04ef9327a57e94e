#ifndef AREALIGHT_TUBE_LIGHT_GLSL
#define AREALIGHT_TUBE_LIGHT_GLSL

#include "arealight/form_factor/tube_horizons.glsl"
#include "arealight/options.glsl"
#if AREALIGHT_SOLID_ANGLES
#include "arealight/form_factor/tube_solid_angle.glsl"
#endif
#include "arealight/light_kind.glsl"

// A cylinder or capsule of constant radiance, which shines outwards.
struct ArealightTubeLight {
    vec3 radiance;  // W/(m^2 sr)
    vec3 center;    // relative to the origin of ArealightSurface.position
    vec3 half_axis; // from the center to one end
    float radius;
    int ends;       // one of AREALIGHT_TUBE_*
};

bool arealight_to_local(ArealightPoint point, ArealightTubeLight light, out ArealightTube local) {
    vec3 center = point.to_frame * (light.center - point.position);
    local = arealight_tube(center, point.to_frame * light.half_axis, light.radius, light.ends);
    return local.seen;
}

// z alone.
vec3 arealight_vector_form_factor(mat3 space, ArealightTube local) {
    float horizon = arealight_horizon_width(space);
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        return vec3(0.0, 0.0, arealight_tube_both_horizons(local, vec3(0.0, 0.0, 1.0), space, horizon));
    }
    return vec3(0.0, 0.0, arealight_tube_form_factor(local, space, horizon));
}

vec3 arealight_image_average(mat3 space, ArealightTube local, vec3 vector) {
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
float arealight_solid_angle(ArealightTube local) {
    return arealight_tube_solid_angle(local);
}
#endif

AREALIGHT_WITHOUT_HALF_VECTORS(ArealightTube)
AREALIGHT_LIGHT_KIND(ArealightTubeLight, ArealightTube, AREALIGHT_UNROLLED_LOBES)

#endif
