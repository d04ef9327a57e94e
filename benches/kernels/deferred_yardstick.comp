#version 450
#extension GL_GOOGLE_include_directive : require
#include "arealight/arealight.glsl"

// The pixel of shaders/examples/deferred.comp with the form factors of others: the same bindings, surface, table and lobes, and
// quads whose vertices are read in turn.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DArray table;
layout(set = 0, binding = 1) uniform sampler2D g_buffer[3]; // position; normal, roughness; base colour, metalness
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D radiance_image;
struct Lamp { vec3 radiance; uint first_vertex; vec3 center; float radius; vec3 area; uint vertex_count; };
layout(set = 0, binding = 3, std430) readonly buffer Lamps { Lamp lamps[]; };
layout(set = 0, binding = 4, std430) readonly buffer Vertices { vec4 vertices[]; };
layout(push_constant) uniform Frame { vec3 camera; uint lamp_count; } frame;

vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }
vec3 arealight_bridge_vertex(uint index) { return vertices[index].xyz; } // from its light's center

vec3 yardstick_vertex(uint index) { return arealight_bridge_vertex(index); }
#include "yardsticks.glsl"

// A lobe's form factor of the quad, which is relative to the shading point and seen from the front.
float seen_by(ArealightLobe lobe, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    mat3 to_cosine = lobe.space.to_cosine;
    return yardstick_practice_quad(to_cosine * v0, to_cosine * v1, to_cosine * v2, to_cosine * v3);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 normal_roughness = texelFetch(g_buffer[1], pixel, 0);
    vec4 base_color_metalness = texelFetch(g_buffer[2], pixel, 0);
    ArealightSurface surface;
    surface.position = texelFetch(g_buffer[0], pixel, 0).xyz;
    surface.normal = normal_roughness.xyz;
    surface.view = frame.camera - surface.position;
    surface.roughness = normal_roughness.w;
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04), 1.0);

    const uint EFFECTS = AREALIGHT_EFFECT_DIFFUSE | AREALIGHT_EFFECT_GLOSSY;
    const ArealightQuality QUALITY = ArealightQuality(AREALIGHT_FORM_FACTOR_EXACT, AREALIGHT_HORIZON_COSINE,
        AREALIGHT_FRESNEL_BY_F0, AREALIGHT_LOBES_TABLE, AREALIGHT_FOOTPRINT_ROUND);
    ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, QUALITY);
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.lamp_count; i++) {
        vec3 center = lamps[i].center - surface.position;
        uint first = lamps[i].first_vertex;
        if (dot(lamps[i].area, center) < 0.0) {
            vec3 v0 = center + arealight_bridge_vertex(first);
            vec3 v1 = center + arealight_bridge_vertex(first + 1u);
            vec3 v2 = center + arealight_bridge_vertex(first + 2u);
            vec3 v3 = center + arealight_bridge_vertex(first + 3u);
            radiance += lamps[i].radiance * (point.glossy.albedo * seen_by(point.glossy, v0, v1, v2, v3)
                                             + point.diffuse.albedo * seen_by(point.diffuse, v0, v1, v2, v3));
        }
    }
    imageStore(radiance_image, pixel, vec4(radiance, 1.0));
}
