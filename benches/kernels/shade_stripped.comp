#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The shade kernel, stripped by hand to what a scene of one-sided quads without images needs on the first rungs: no
// effect, no rung and no field of a light that is for anything else. For the time that absent effects take: none, where
// the shade kernel without them takes as long as this.

layout(local_size_x = 8, local_size_y = 8) in;

// Instead of the diffuse lobe and the glossy one: the diffuse one alone
layout(constant_id = 0) const bool DIFFUSE_ONLY = false;

#include "arealight/form_factor.glsl"
#include "arealight/surface.glsl"
#include "table_image.glsl"

struct StrippedLight {
    vec3 radiance;
    uint first_vertex;
    vec3 center;
    float radius;
    vec3 area;
    uint vertex_count;
    // What the shade kernel has for images
    uvec4 unread[6];
};

layout(set = 0, binding = 1, std430) readonly buffer Lights {
    StrippedLight lights[];
};
layout(set = 0, binding = 2, std430) readonly buffer LightVertices {
    vec4 light_vertices[];
};
layout(set = 0, binding = 3) uniform texture2D g_position;
layout(set = 0, binding = 4) uniform texture2D g_normal;
layout(set = 0, binding = 5) uniform texture2D g_base_color;
layout(set = 0, binding = 7, rgba32f) uniform image2D radiance_image;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
} constants;

// A lobe, made ready for any light.
struct StrippedLobe {
    mat3 to_cosine;
    float stretch;
    float flatness;
    vec3 albedo;
};

StrippedLobe stripped_lobe(mat3 to_cosine, vec3 albedo) {
    float square = dot(to_cosine[0], to_cosine[0]) + dot(to_cosine[1], to_cosine[1]) + dot(to_cosine[2], to_cosine[2]);
    vec3 height = vec3(to_cosine[0].z, to_cosine[1].z, to_cosine[2].z);
    return StrippedLobe(to_cosine, sqrt(square), sqrt(dot(height, height) / (square + AREALIGHT_TINY)), albedo);
}

vec3 stripped_reflected(StrippedLobe lobe, vec3 center, float scale, ArealightQuad quad) {
    mat3 transform = lobe.to_cosine * scale;
    ArealightAnchor anchor =
        ArealightAnchor(lobe.to_cosine * center, 0.0, 0.0, false, AREALIGHT_HORIZON_WIDTH * lobe.flatness);
    ArealightQuad cosine =
        ArealightQuad(transform * quad.v0, transform * quad.v1, transform * quad.v2, transform * quad.v3);
    ArealightArcs arcs = arealight_quad_clipped(anchor, cosine, AREALIGHT_FORM_FACTOR_EXACT);
    return lobe.albedo * min(arealight_form_factor(arcs, false), 1.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 position = texelFetch(g_position, pixel, 0);
    if (position.w == 0.0) {
        return;
    }

    // Prepare the lobes
    vec4 normal = texelFetch(g_normal, pixel, 0);
    vec4 base_color = texelFetch(g_base_color, pixel, 0);
    ArealightFrame frame = arealight_surface_frame(normal.xyz, constants.camera - position.xyz);
    StrippedLobe diffuse =
        StrippedLobe(arealight_frame_matrix(frame), 1.0, 1.0, base_color.rgb * (1.0 - base_color.a));
    StrippedLobe glossy;
    if (!DIFFUSE_ONLY) {
        vec3 f0 = mix(vec3(0.04), base_color.rgb, base_color.a);
        ArealightTableSample table = arealight_table_lookup(frame, normal.w);
        vec4 texel = mix(table.matrix, table.schlick_matrix, arealight_schlick_share(table, f0, 1.0));
        glossy = stripped_lobe(arealight_table_transform(frame, texel, table.alpha),
                               f0 * table.albedo + (vec3(1.0) - f0) * table.schlick);
    }

    // Sum the lights
    vec3 radiance = vec3(0.0);
    for (uint index = 0u; index < constants.light_count; index++) {
        vec3 center = lights[index].center - position.xyz;
        float scale = arealight_power_of_two_scale(arealight_max_component(center) + lights[index].radius);
        center *= scale;
        uint first = lights[index].first_vertex;
        uint last = clamp(lights[index].vertex_count, 1u, 4u) - 1u;
        ArealightQuad quad = ArealightQuad(light_vertices[first].xyz, light_vertices[first + 1u].xyz,
                                           light_vertices[first + min(2u, last)].xyz, light_vertices[first + last].xyz);
        vec3 reflected = vec3(0.0);
        if (!DIFFUSE_ONLY) {
            reflected = stripped_reflected(glossy, center, scale, quad);
        }
        reflected += stripped_reflected(diffuse, center, scale, quad);
        radiance += lights[index].radiance * reflected;
    }
    vec4 before = imageLoad(radiance_image, pixel);
    imageStore(radiance_image, pixel, vec4(before.rgb + radiance, 1.0));
}
