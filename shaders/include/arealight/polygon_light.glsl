#ifndef AREALIGHT_POLYGON_LIGHT_GLSL
#define AREALIGHT_POLYGON_LIGHT_GLSL

#include "arealight/effects.glsl"
#include "arealight/form_factor.glsl"
#include "arealight/surface.glsl"
#include "arealight/table.glsl"

// The host's bridge to the lights' vertices: the position of vertex `index`, relative to the same origin as
// ArealightSurface.position.
vec3 arealight_bridge_vertex(uint index);

// A flat polygon of constant radiance, convex or concave.
struct ArealightPolygonLight {
    vec3 radiance;     // of the front, W/(m^2 sr)
    uint first_vertex; // for arealight_bridge_vertex
    uint vertex_count; // from 3 on
    vec3 center;       // of a sphere that holds every vertex, relative to the origin
    float radius;      // of that sphere; may be generous
    bool two_sided;    // the back emits too
};

// A surface made ready for any number of lights: what does not depend on the light.
struct ArealightShadingPoint {
    vec3 position;
    mat3 to_surface;       // offsets into the shading frame: the cosine space of the Lambert lobe
    mat3 to_cosine;        // offsets into the GGX lobe's cosine space
    vec3 diffuse_albedo;
    vec3 specular_albedo;  // the GGX lobe's directional albedo, Fresnel term included
};

// Prepares a surface: its frame, and one lookup in the table where `effects` has the glossy lobe.
ArealightShadingPoint arealight_shading_point(ArealightSurface surface, uint effects) {
    ArealightShadingPoint point;
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    point.position = surface.position;
    point.to_surface = arealight_frame_matrix(frame);
    point.to_cosine = point.to_surface;
    point.diffuse_albedo = surface.diffuse_albedo;
    point.specular_albedo = vec3(0.0);
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        ArealightLobe lobe = arealight_table_lookup(frame, surface.roughness);
        point.to_cosine = lobe.to_cosine;
        // F = f0 + (f90 - f0) (1 - cos)^5, integrated over the lobe
        point.specular_albedo = surface.f0 * lobe.albedo + (vec3(surface.f90) - surface.f0) * lobe.schlick;
    }
    return point;
}

// The form factor of a polygon light in the space that `to_cosine` leads to, in [0, 1]; error: see
// form_factor.glsl. `to_cosine` is linear and keeps handedness.
float arealight_polygon_form_factor(vec3 position, mat3 to_cosine, ArealightPolygonLight light, int rung) {
    // Scale by a power of two, so that squares neither overflow nor vanish; it changes no rounding
    float extent = arealight_max_component(light.center - position) + light.radius;
    mat3 transform = to_cosine * arealight_power_of_two_scale(extent);

    uint end = light.first_vertex + light.vertex_count;
    ArealightWalk walk = arealight_walk_begin(transform * (arealight_bridge_vertex(end - 1u) - position));
    for (uint index = light.first_vertex; index < end; index++) {
        arealight_walk_to(walk, transform * (arealight_bridge_vertex(index) - position), rung);
    }
    return arealight_walk_form_factor(walk, light.two_sided, rung);
}

// Outgoing radiance towards the viewer from one polygon light, W/(m^2 sr), without visibility.
//
// The Lambert lobe is exact to the form factor's error; the GGX lobe is the fitted one: exact for the table's
// lobe, and as close to GGX as the table's fit. Source: Heitz et al. 2016, eq. 11.
vec3 arealight_polygon_radiance(ArealightShadingPoint point, ArealightPolygonLight light, uint effects,
                                int rung) {
    light.two_sided = light.two_sided && (effects & AREALIGHT_EFFECT_TWO_SIDED) != 0u;
    vec3 reflected = vec3(0.0);
    if ((effects & AREALIGHT_EFFECT_DIFFUSE) != 0u) {
        reflected += point.diffuse_albedo
                   * arealight_polygon_form_factor(point.position, point.to_surface, light, rung);
    }
    if ((effects & AREALIGHT_EFFECT_GLOSSY) != 0u) {
        reflected += point.specular_albedo
                   * arealight_polygon_form_factor(point.position, point.to_cosine, light, rung);
    }
    return light.radiance * reflected;
}

#endif
