#ifndef AREALIGHT_COAT_GLSL
#define AREALIGHT_COAT_GLSL

#include "arealight/lobes/specular.glsl"

// A coat above other lobes: KHR_materials_clearcoat. What it reflects, and what it keeps from the lobes
// below, depends on the view alone, so that the layers conserve energy with a factor each: radiance = (1 -
// share) base + share coat, the coat being GGX without Fresnel term. With AREALIGHT_COAT_BY_ALBEDO as OpenPBR
// has it: radiance = (1 - weight albedo) base + weight coat, the coat being GGX with Schlick's Fresnel term,
// and the albedo its own at the view.

// The frame of a coat, in the shading frame's coordinates, where the view is `view`; the shading frame itself
// without AREALIGHT_COAT_NORMAL and for a normal of zero.
ArealightFrame arealight_coat_frame(ArealightFrame frame, ArealightCoat coat, vec3 view) {
    if (AREALIGHT_HAS_COAT_NORMAL) {
        return arealight_surface_frame(arealight_frame_matrix(frame) * coat.normal, view);
    }
    return ArealightFrame(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0), frame.cos_view,
                          frame.sin_view);
}

// A GGX lobe about the coat's own normal: one more lookup in the table (or the formula). A view below that
// normal counts as grazing. With AREALIGHT_SURFACE_HORIZON it is clipped at the surface's horizon, as every
// lobe is, and gains no more than its part above either horizon asks for.
ArealightLayer arealight_coat_layer(ArealightFrame frame, ArealightCoat coat) {
    vec3 view = vec3(frame.sin_view, 0.0, frame.cos_view);
    ArealightFrame own = arealight_coat_frame(frame, coat, view);
    ArealightTableSample table = arealight_specular_sample(own, coat.roughness, false);
    ArealightLobe lobe;
    float share;
    if (AREALIGHT_COATS_BY_ALBEDO) {
        lobe = arealight_specular_lobe(own, table, vec3(AREALIGHT_COAT_F0), 1.0);
        lobe.albedo *= coat.weight;
        share = lobe.albedo.x;
    } else {
        share = arealight_coat_share(coat, dot(own.normal, view));
        lobe = arealight_table_lobe(own, table.matrix, table.alpha, vec3(share * table.albedo));
    }
    if (AREALIGHT_HAS_COAT_NORMAL) {
        lobe.space = lobe.space * arealight_frame_matrix(own);
        lobe.gain = min(lobe.gain, arealight_gain_above_surface(lobe.space));
    }
    return ArealightLayer(lobe, 1.0 - share);
}

#endif
