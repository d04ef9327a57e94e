#version 450
#extension GL_GOOGLE_include_directive : require
#include "arealight/arealight.glsl"

// The pixel of shaders/examples/deferred.comp with the form factors of others: the same bindings, surface,
// table and lobes, and quads.

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2DArray table;
// Position; normal, roughness; base colour, metalness
layout(set = 0, binding = 1) uniform sampler2D g_buffer[3];
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D radiance_image;
struct Lamp { vec3 radiance; float reserved0; vec3 center; float reserved1; vec3 normal; float reserved2;
    vec4 vertices[4]; vec4 padding; };
layout(set = 0, binding = 3, std430) readonly buffer Lamps { Lamp lamps[]; };
layout(push_constant) uniform Frame { vec3 camera; uint lamp_count; } frame;

vec4 arealight_bridge_table(int layer, ivec2 texel) { return texelFetch(table, ivec3(texel, layer), 0); }
int arealight_bridge_table_size() { return textureSize(table, 0).x; }

#include "yardsticks.glsl"

// A lobe's form factor of the quad, which is relative to the shading point and seen from the front.
float form_factor(mat3 space, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    return yardstick_quad(YARDSTICK_CLIPLESS, space * v0, space * v1, space * v2, space * v3);
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
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04),
                                     1.0);

    ArealightPoint point = arealight_point(surface);
    ArealightLobe diffuse = point.lobes[AREALIGHT_LOBE_DIFFUSE];
    ArealightLobe specular = point.lobes[AREALIGHT_LOBE_SPECULAR];
    mat3 specular_space = specular.space * point.to_frame;
    vec3 radiance = vec3(0.0);
    for (uint i = 0u; i < frame.lamp_count; i++) {
        vec3 center = lamps[i].center - surface.position;
        if (dot(lamps[i].normal, center) < 0.0) {
            vec3 v0 = center + lamps[i].vertices[0].xyz;
            vec3 v1 = center + lamps[i].vertices[1].xyz;
            vec3 v2 = center + lamps[i].vertices[2].xyz;
            vec3 v3 = center + lamps[i].vertices[3].xyz;
            radiance += lamps[i].radiance * (specular.albedo * form_factor(specular_space, v0, v1, v2, v3)
                                             + diffuse.albedo * form_factor(point.to_frame, v0, v1, v2, v3));
        }
    }
    imageStore(radiance_image, pixel, vec4(radiance, 1.0));
}
