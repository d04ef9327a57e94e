#ifndef AREALIGHT_MEDIUM_GLSL
#define AREALIGHT_MEDIUM_GLSL

#include "arealight/lobes/phase.glsl"
#include "arealight/material.glsl"
#include "arealight/ray_points.glsl"

// A point in a medium (AREALIGHT_MEDIA): a surface without a horizon, whose lobes are its phase function.
//
//     ArealightMediumPoint medium = arealight_medium_point(position, view, g);
//     radiance += scattering * arealight_in_scattered(medium, quad); // for each light, of any kind
//
// What comes of it is for a scattering coefficient of 1, and for lights that nothing dims on their way:
// W/(m^2 sr) per unit of length. Two-lobe phase functions are the sum of two points.
// AREALIGHT_SURFACE_HORIZON counts as 0.

// A point made ready for any number of lights.
struct ArealightMediumPoint {
    // Of it the position and the frame: z is the lobes' axis, where light goes on to, or for g < 0 comes from
    ArealightPoint point;
    ArealightPhaseLobes lobes;
};

// `position` is relative to the host's origin, `view` the direction to the viewer, of any length, `g` the
// mean cosine of the phase function: positive where light goes on forwards.
ArealightMediumPoint arealight_medium_point(vec3 position, vec3 view, float g) {
    vec3 axis = g < 0.0 ? view : -view;
    ArealightMediumPoint medium;
    medium.point.position = position;
    medium.point.to_frame = arealight_frame_matrix(arealight_surface_frame(axis, axis));
    medium.lobes = arealight_phase_lobes(g);
    return medium;
}

// The space of one of the three lobes; the last looks backwards, turned and not mirrored.
mat3 arealight_phase_space(ArealightMediumPoint medium, int lobe) {
    vec3 stretch = medium.lobes.stretch;
    float across = 1.0 / (lobe == 0 ? stretch.x : lobe == 1 ? stretch.y : stretch.z);
    float along = lobe == 2 ? -1.0 : 1.0;
    return mat3(across, 0.0, 0.0, 0.0, along * across, 0.0, 0.0, 0.0, along);
}

// Whether some light shows an image.
const bool AREALIGHT_SHOWS_IMAGES = !bool(AREALIGHT_LIGHT_TEXTURES) ? false
    : AREALIGHT_HAS_TEXTURED_POLYGONS ? true : AREALIGHT_HAS_TEXTURED_DISKS;

// For light_kind.glsl. arealight_phase_integral: the phase function over a light of unit radiance, a channel,
// in [0, 1]; 0 where it does not shine to the point. Error: that of phase.glsl's lobes, and 2e-6. Of an image
// the uniform part sees what the lobes see of it, by their form factors.
#define AREALIGHT_IN_MEDIA(Light, Local)                                                            \
    vec3 arealight_phase_integral(ArealightMediumPoint medium, Light light) {                       \
        Local local;                                                                                \
        if (!arealight_to_local(medium.point, light, local)) {                                      \
            return vec3(0.0);                                                                       \
        }                                                                                           \
        vec3 sum = vec3(0.0);                                                                       \
        vec4 seen = vec4(0.0);                                                                      \
        /* An even phase function needs the solid angle alone */                                    \
        if (AREALIGHT_SHOWS_IMAGES || medium.lobes.even != 1.0) {                                   \
            for (int i = 0; i < 3; i++) {                                                           \
                vec3 weights = medium.lobes.weight;                                                 \
                float weight = i == 0 ? weights.x : i == 1 ? weights.y : weights.z;                 \
                if (i == 1 && weight == 0.0) {                                                      \
                    continue;                                                                       \
                }                                                                                   \
                mat3 space = arealight_phase_space(medium, i);                                      \
                vec3 vector = arealight_vector_form_factor(space, local);                           \
                float part = arealight_form_factor(vector);                                         \
                vec3 color = vec3(1.0);                                                             \
                if (AREALIGHT_SHOWS_IMAGES) {                                                       \
                    color = arealight_image_average(space, local, vector);                          \
                    seen += part * vec4(color, 1.0);                                                \
                }                                                                                   \
                sum += weight * part * color;                                                       \
            }                                                                                       \
        }                                                                                           \
        float even = medium.lobes.even * (0.25 * AREALIGHT_INVERSE_PI) * arealight_solid_angle(local); \
        vec3 color = AREALIGHT_SHOWS_IMAGES ? seen.rgb / max(seen.a, 1e-30) : vec3(1.0);            \
        return clamp(sum + even * color, vec3(0.0), vec3(1e30));                                    \
    }                                                                                               \
    vec3 arealight_in_scattered(ArealightMediumPoint medium, Light light) {                         \
        return light.radiance * arealight_phase_integral(medium, light);                            \
    }

#endif
