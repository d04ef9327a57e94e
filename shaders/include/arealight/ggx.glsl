#ifndef AREALIGHT_GGX_GLSL
#define AREALIGHT_GGX_GLSL

#include "arealight/common.glsl"

// GGX with height-correlated Smith masking-shadowing, in the surface frame (z is the normal): the truth that
// the fitted lobes stand for. Twin of arealight_oracle::ggx. Sources: Walter et al. 2007 (D), Heitz 2014
// (G2), Heitz 2018 (visible normals). Directions are unit vectors.

//
// Where the distribution has two alphas, along x and along y of a frame whose z is the normal, `alpha` is
// both: the isotropic one is that with both alike, in any frame.

// The distribution of normals, 1/sr. Relative error 1e-5 down to alpha 1e-3, 1e-3 at 1e-4 (from the rounding
// of `half_vector`).
float arealight_ggx_distribution(vec3 half_vector, vec2 alpha) {
    vec2 stretched = half_vector.xy / alpha;
    float slope = dot(stretched, stretched) + half_vector.z * half_vector.z;
    return AREALIGHT_INVERSE_PI / (alpha.x * alpha.y * slope * slope);
}

// G2 / (4 cos_view cos_light), finite at grazing angles.
float arealight_ggx_visibility(vec3 view, vec3 light, vec2 alpha) {
    float by_view = light.z * length(vec3(alpha * view.xy, view.z));
    float by_light = view.z * length(vec3(alpha * light.xy, light.z));
    return 0.5 / max(by_view + by_light, 1e-30);
}

// (1 - cos theta_vh)^5: Schlick's Fresnel term is f0 + (f90 - f0) times this.
float arealight_schlick_weight(vec3 view, vec3 half_vector) {
    float weight = 1.0 - clamp(dot(view, half_vector), 0.0, 1.0);
    float weight2 = weight * weight;
    return weight2 * weight2 * weight;
}

// f cos(theta_light) with Schlick's Fresnel term, a channel, 1/sr; zero for directions below the surface.
vec3 arealight_ggx_evaluate(vec3 view, vec3 light, vec2 alpha, vec3 f0, float f90) {
    if (light.z <= 0.0 || view.z < 0.0) {
        return vec3(0.0);
    }
    vec3 half_vector = arealight_normalize_or(view + light, vec3(0.0, 0.0, 1.0));
    vec3 fresnel = f0 + (vec3(f90) - f0) * arealight_schlick_weight(view, half_vector);
    return fresnel * (arealight_ggx_distribution(half_vector, alpha)
                      * arealight_ggx_visibility(view, light, alpha) * light.z);
}

// A light direction drawn from the visible normals; `u` in [0, 1)^2. It may lie below the surface.
vec3 arealight_ggx_sample(vec3 view, vec2 alpha, vec2 u) {
    // Stretch the view so that the surface has alpha 1
    vec3 stretched = arealight_normalize_or(vec3(alpha * view.xy, view.z), vec3(0.0, 0.0, 1.0));
    vec3 t1 = arealight_normalize_or(vec3(-stretched.y, stretched.x, 0.0), vec3(1.0, 0.0, 0.0));
    vec3 t2 = cross(stretched, t1);
    // Sample the projected area of the hemisphere
    float r = sqrt(u.x);
    float phi = 2.0 * AREALIGHT_PI * u.y;
    float p1 = r * cos(phi);
    float s = 0.5 * (1.0 + stretched.z);
    float p2 = mix(sqrt(max(0.0, 1.0 - p1 * p1)), r * sin(phi), s);
    vec3 normal = t1 * p1 + t2 * p2 + stretched * sqrt(max(0.0, 1.0 - p1 * p1 - p2 * p2));
    // Take the stretch back, and mirror the view
    vec3 half_vector = arealight_normalize_or(vec3(alpha * normal.xy, max(0.0, normal.z)),
                                              vec3(0.0, 0.0, 1.0));
    return half_vector * (2.0 * dot(view, half_vector)) - view;
}

// The density of arealight_ggx_sample in solid angle, 1/sr; zero below the surface.
float arealight_ggx_density(vec3 view, vec3 light, vec2 alpha) {
    if (light.z <= 0.0) {
        return 0.0;
    }
    vec3 half_vector = arealight_normalize_or(view + light, vec3(0.0, 0.0, 1.0));
    float root = length(vec3(alpha * view.xy, view.z));
    // D G1 <v, h> / cos_v / (4 <v, h>), with G1 / cos_v = 2 / (cos_v + root)
    return arealight_ggx_distribution(half_vector, alpha) * 0.5 / max(view.z + root, 1e-30);
}

#endif
