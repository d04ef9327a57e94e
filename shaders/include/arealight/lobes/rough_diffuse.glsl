#ifndef AREALIGHT_ROUGH_DIFFUSE_GLSL
#define AREALIGHT_ROUGH_DIFFUSE_GLSL

#include "arealight/lobes/lobe.glsl"

// EON, the energy-preserving Oren-Nayar lobe of OpenPBR: light that facets reflect once, and what bounces
// between them. Source: Portsmouth, Kutz and Hill 2025; the space is fitted (docs/materials.md).

// The part of white light that EON reflects after one bounce: E-hat, of a view's cosine and a roughness in
// [0, 1]. Error 4e-4.
float arealight_rough_diffuse_single_albedo(float cos_view, float roughness) {
    float x = 1.0 - cos_view;
    float grazing = x * (0.0571085 + x * (0.4918819 + x * (0.0714430 * x - 0.3321814)));
    return (1.0 + roughness * grazing) / (1.0 + 0.2877934 * roughness);
}

// `albedo` per channel and `roughness` in [0, 1]: Lambert's lobe where the roughness is 0, to the bit. The
// lobe of one bounce is a cosine that leans towards the viewer; what bounces again is a wider one. They are
// one lobe between the two by the mean of the channels; the albedo is exact in each, to 4e-4. Against the
// true integral over quads of unit radiance: mean error 0.8e-3 for an albedo of 0.8, 0.15e-3 for 0.18;
// Lambert's lobe has 9.4e-3 and 2.7e-3.
ArealightLobe arealight_rough_diffuse_lobe(ArealightFrame frame, vec3 albedo, float roughness) {
    roughness = arealight_clamped_roughness(roughness, 0.0);
    float m = frame.cos_view;
    float s = frame.sin_view;

    // What one bounce and what more reflect
    float single = arealight_rough_diffuse_single_albedo(m, roughness);
    float mean_single = (1.0 + 0.0726637 * roughness) / (1.0 + 0.2877934 * roughness);
    vec3 more = albedo * albedo * (mean_single * (1.0 - single)) / max(vec3(1.0) - albedo
                                                                       * (1.0 - mean_single), vec3(1e-3));
    vec3 reflected = albedo * single + more;
    float part = dot(more, vec3(1.0)) / max(dot(reflected, vec3(1.0)), 1e-6);

    // The space of one bounce; that of more is diag(1, 1, 0.79), unused at roughness 0
    float x = 1.0 + roughness * s * s * (-0.2409 + m * (0.3583 - 0.1340 * m) + 0.0999 * roughness);
    float x_of_z = roughness * s * (-0.7191 + m * (0.3185 - 0.0357 * m) - 0.0046 * roughness);
    float z_of_x = roughness * s * (0.4851 + m * (0.2321 * m - 0.5456) - 0.0134 * roughness);
    float z = 1.0 + roughness * s * s * (0.1475 + m * (0.0799 * m - 0.1680) - 0.1455 * roughness);
    mat3 space = mat3(mix(x, 1.0, part), 0.0, z_of_x * (1.0 - part), 0.0, 1.0, 0.0, x_of_z * (1.0 - part),
                      0.0, mix(z, 0.79, part));
    return arealight_lobe(space, reflected);
}

#endif
