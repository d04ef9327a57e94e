#ifndef AREALIGHT_SPECULAR_GLSL
#define AREALIGHT_SPECULAR_GLSL

#include "arealight/lobes/formula.glsl"
#include "arealight/lobes/lobe.glsl"
#include "arealight/lobes/table.glsl"

// What the table holds for a view and a perceptual roughness, or what the formula gives in its place: one
// lobe, or two.
ArealightTableSample arealight_specular_sample(ArealightFrame frame, float roughness, bool has_two_lobes) {
    if (AREALIGHT_USES_FORMULA) {
        return arealight_formula_sample(frame, roughness);
    }
    return arealight_table_lookup(frame, roughness, has_two_lobes);
}

ArealightLobe arealight_table_lobe(ArealightFrame frame, vec4 texel, float alpha, vec3 albedo) {
    return arealight_lobe(arealight_table_space(frame, texel, alpha), albedo);
}

// What GGX with Schlick's Fresnel term reflects of light from everywhere, per channel.
vec3 arealight_specular_albedo(ArealightTableSample table, vec3 f0, float f90) {
    return f0 * table.albedo + (vec3(f90) - f0) * table.schlick;
}

// GGX with Schlick's Fresnel term F = f0 + (f90 - f0) (1 - cos)^5, by one lobe between the table's two. A
// colour counts by the mean of its channels; the albedo is exact in each.
ArealightLobe arealight_specular_lobe(ArealightFrame frame, ArealightTableSample table, vec3 f0, float f90) {
    vec4 texel = mix(table.matrix, table.schlick_matrix, arealight_schlick_share(table, f0, f90));
    return arealight_table_lobe(frame, texel, table.alpha, arealight_specular_albedo(table, f0, f90));
}

#endif
