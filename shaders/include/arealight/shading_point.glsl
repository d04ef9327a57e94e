#ifndef AREALIGHT_SHADING_POINT_GLSL
#define AREALIGHT_SHADING_POINT_GLSL

#include "arealight/effects.glsl"
#include "arealight/formula.glsl"
#include "arealight/surface.glsl"
#include "arealight/table.glsl"

// A lobe's cosine space: where it is the clamped cosine.
struct ArealightCosineSpace {
    mat3 to_cosine;    // offsets from the shading point into it; keeps handedness
    float determinant; // of to_cosine
    float stretch;     // no offset becomes longer than this many times its length
    float flatness;    // how much lower than long offsets become at most, in (0, 1]: of the height's row, over stretch
};

// A lobe of a surface's reflection: a cosine, transformed and weighed.
struct ArealightLobe {
    ArealightCosineSpace space;
    vec3 albedo; // what it reflects of light from everywhere, a channel
    float gain;  // of what is clipped at the surface's horizon, to keep the albedo
};

// A surface made ready for any number of lights: what does not depend on the light.
struct ArealightShadingPoint {
    vec3 position;
    vec3 normal;           // unit
    ArealightLobe diffuse; // Lambert's
    ArealightLobe glossy;  // fitted to GGX; with AREALIGHT_FRESNEL_SPLIT its F0 part
    ArealightLobe schlick; // with AREALIGHT_FRESNEL_SPLIT alone: the part that grows with (1 - cos)^5
};

// What a surface reflects of a light of unit radiance, a channel, lobe by lobe.
struct ArealightReflected {
    vec3 diffuse;
    vec3 glossy;
};

ArealightCosineSpace arealight_cosine_space(mat3 to_cosine) {
    float square = dot(to_cosine[0], to_cosine[0]) + dot(to_cosine[1], to_cosine[1])
                 + dot(to_cosine[2], to_cosine[2]);
    vec3 height = vec3(to_cosine[0].z, to_cosine[1].z, to_cosine[2].z);
    float flatness = sqrt(dot(height, height) / (square + AREALIGHT_TINY));
    return ArealightCosineSpace(to_cosine, determinant(to_cosine), sqrt(square), flatness);
}

// A lobe of the table, from a texel of one of its matrices.
ArealightLobe arealight_table_lobe(ArealightFrame frame, vec4 texel, float alpha, vec3 albedo,
                                   ArealightQuality quality) {
    ArealightLobe lobe;
    lobe.space = arealight_cosine_space(arealight_table_transform(frame, texel, alpha));
    lobe.albedo = albedo;
    lobe.gain = 1.0;
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        // The part of the lobe above the surface: a lune of the cosine, share_above_surface in Rust
        vec3 across = lobe.space.to_cosine * frame.tangent;
        float share = 0.5 + 0.5 * across.x * inversesqrt(across.x * across.x + across.z * across.z + AREALIGHT_TINY);
        lobe.gain = 1.0 / max(share, 1e-6);
    }
    return lobe;
}

// Prepares a surface: its frame, and where `effects` has the glossy lobe one lookup in the table, or the formula.
ArealightShadingPoint arealight_shading_point(ArealightSurface surface, uint effects, ArealightQuality quality) {
    ArealightShadingPoint point;
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    point.position = surface.position;
    point.normal = frame.normal;
    ArealightCosineSpace cosine = ArealightCosineSpace(arealight_frame_matrix(frame), 1.0, 1.0, 1.0);
    point.diffuse = ArealightLobe(cosine, surface.diffuse_albedo, 1.0);
    point.glossy = ArealightLobe(cosine, vec3(0.0), 1.0);
    point.schlick = point.glossy;
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        // F = f0 + (f90 - f0) (1 - cos)^5, integrated over the lobe
        ArealightTableSample table;
        if (quality.lobes == AREALIGHT_LOBES_FORMULA) {
            table = arealight_formula_sample(frame, surface.roughness);
        } else {
            table = arealight_table_lookup(frame, surface.roughness);
        }
        vec3 f0_part = surface.f0 * table.albedo;
        vec3 schlick_part = (vec3(surface.f90) - surface.f0) * table.schlick;
        if (quality.fresnel == AREALIGHT_FRESNEL_SPLIT) {
            point.glossy = arealight_table_lobe(frame, table.matrix, table.alpha, f0_part, quality);
            point.schlick = arealight_table_lobe(frame, table.schlick_matrix, table.alpha, schlick_part, quality);
        } else {
            vec4 texel = mix(table.matrix, table.schlick_matrix, arealight_schlick_share(table, surface.f0, surface.f90));
            point.glossy = arealight_table_lobe(frame, texel, table.alpha, f0_part + schlick_part, quality);
        }
    }
    return point;
}

#endif
