#ifndef AREALIGHT_SPECULAR_GLSL
#define AREALIGHT_SPECULAR_GLSL

#include "arealight/lobes/formula.glsl"
#include "arealight/lobes/lobe.glsl"
#include "arealight/lobes/table.glsl"

// What the table holds for a view and a perceptual roughness, or what the formula gives in its place.
ArealightTableSample arealight_specular_sample(ArealightFrame frame, float roughness) {
    if (AREALIGHT_USES_FORMULA) {
        return arealight_formula_sample(frame, roughness);
    }
    return arealight_table_lookup(frame, roughness);
}

ArealightLobe arealight_table_lobe(ArealightFrame frame, vec4 texel, float alpha, vec3 albedo) {
    return arealight_lobe(arealight_table_space(frame, texel, alpha), albedo);
}

// What GGX with Schlick's Fresnel term reflects of light from everywhere, per channel.
vec3 arealight_specular_albedo(ArealightTableSample table, vec3 f0, float f90) {
    return f0 * table.albedo + (vec3(f90) - f0) * table.schlick;
}

// GGX with Schlick's Fresnel term F = f0 + (f90 - f0) (1 - cos)^5, by one lobe between the table's two. A colour counts by
// the mean of its channels; the albedo is exact in each.
ArealightLobe arealight_specular_lobe(ArealightFrame frame, ArealightTableSample table, vec3 f0, float f90) {
    vec4 texel = mix(table.matrix, table.schlick_matrix, arealight_schlick_share(table, f0, f90));
    return arealight_table_lobe(frame, texel, table.alpha, arealight_specular_albedo(table, f0, f90));
}

// The same in two lobes, each exact in the reflectance: of f0, and of what grows with (1 - cos)^5. Where f90 is less than f0
// the second one's albedo is negative; the sum of what both reflect is not.
ArealightLobe arealight_specular_f0_lobe(ArealightFrame frame, ArealightTableSample table, vec3 f0) {
    return arealight_table_lobe(frame, table.matrix, table.alpha, f0 * table.albedo);
}

ArealightLobe arealight_specular_schlick_lobe(ArealightFrame frame, ArealightTableSample table, vec3 f0, float f90) {
    return arealight_table_lobe(frame, table.schlick_matrix, table.alpha, (vec3(f90) - f0) * table.schlick);
}

#endif
