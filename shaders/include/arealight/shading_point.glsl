#ifndef AREALIGHT_SHADING_POINT_GLSL
#define AREALIGHT_SHADING_POINT_GLSL

#include "arealight/effects.glsl"
#include "arealight/surface.glsl"
#include "arealight/table.glsl"

// A lobe's cosine space: where it is the clamped cosine.
struct ArealightCosineSpace {
    mat3 to_cosine;    // offsets from the shading point into it; keeps handedness
    float determinant; // of to_cosine
    float stretch;     // no offset becomes longer than this many times its length
};

// A surface made ready for any number of lights: what does not depend on the light.
struct ArealightShadingPoint {
    vec3 position;
    vec3 normal;                  // unit
    ArealightCosineSpace diffuse; // of the Lambert lobe: the shading frame
    ArealightCosineSpace glossy;  // of the fitted GGX lobe
    vec3 diffuse_albedo;
    vec3 specular_albedo;         // the GGX lobe's directional albedo, Fresnel term included
};

ArealightCosineSpace arealight_cosine_space(mat3 to_cosine) {
    float square = dot(to_cosine[0], to_cosine[0]) + dot(to_cosine[1], to_cosine[1])
                 + dot(to_cosine[2], to_cosine[2]);
    return ArealightCosineSpace(to_cosine, determinant(to_cosine), sqrt(square));
}

// Prepares a surface: its frame, and one lookup in the table where `effects` has the glossy lobe.
ArealightShadingPoint arealight_shading_point(ArealightSurface surface, uint effects) {
    ArealightShadingPoint point;
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    point.position = surface.position;
    point.normal = frame.normal;
    point.diffuse = ArealightCosineSpace(arealight_frame_matrix(frame), 1.0, 1.0);
    point.glossy = point.diffuse;
    point.diffuse_albedo = surface.diffuse_albedo;
    point.specular_albedo = vec3(0.0);
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        ArealightLobe lobe = arealight_table_lookup(frame, surface.roughness);
        point.glossy = arealight_cosine_space(lobe.to_cosine);
        // F = f0 + (f90 - f0) (1 - cos)^5, integrated over the lobe
        point.specular_albedo = surface.f0 * lobe.albedo + (vec3(surface.f90) - surface.f0) * lobe.schlick;
    }
    return point;
}

#endif
