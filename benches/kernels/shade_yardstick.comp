#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The shade kernel with the form factors that others ship: see yardsticks.glsl. The same bindings, table
// lookup, lobes, light reads and loop over the lights as shade.comp, so that only the form factor differs,
// and the table where another is bound. Lights that are seen from the back are left by a branch, as three.js
// does.
//
// For lights of one colour. Outlines other than convex quads are shaded by the two schools that clip nothing;
// clipping by cases is for quads alone.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int METHOD = 0;

#include "bindings.glsl"
const uint EFFECT_TWO_SIDED = 4u;
const uint EFFECT_SPECULAR_INPUT = 8u;
const uint EFFECT_POLYGON = 16u;
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#define AREALIGHT_LIGHT_TEXTURES 1
#define AREALIGHT_POLYGONS 1
#define AREALIGHT_MESHES 1
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "g_buffer.glsl"

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform image2D radiance_image;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count;
} constants;

#include "yardsticks.glsl"

// What the library gives: a shading point's position, and its two lobes.
struct YardstickPoint {
    vec3 position;
    mat3 diffuse_space; // into the lobe's cosine space
    mat3 glossy_space;
    vec3 diffuse_albedo;
    vec3 glossy_albedo;
};

YardstickPoint yardstick_point(ivec2 pixel, vec3 position) {
    ArealightPoint point = arealight_point(load_surface(pixel, position, constants.camera));
    ArealightLobe diffuse = point.lobes[AREALIGHT_LOBE_DIFFUSE];
    ArealightLobe specular = point.lobes[AREALIGHT_LOBE_SPECULAR];
    return YardstickPoint(point.position, point.to_frame, specular.space * point.to_frame, diffuse.albedo,
                          specular.albedo);
}

const bool HAS_OTHERS = (EFFECTS & EFFECT_POLYGON) != 0u && METHOD != YARDSTICK_CLIP_BY_CASES;
const bool HAS_TWO_SIDED = (EFFECTS & EFFECT_TWO_SIDED) != 0u;

// A lobe's form factor of a quad around the shading point.
float quad_form_factor(mat3 space, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    return yardstick_quad(METHOD, space * v0, space * v1, space * v2, space * v3);
}

vec3 reflected_quad(YardstickPoint point, ArealightQuad quad, vec3 center, bool front) {
    // Seen from the back, the outline runs the other way
    vec3 v0 = center + quad.a;
    vec3 v1 = center + (front ? quad.b : quad.d);
    vec3 v2 = center + quad.c;
    vec3 v3 = center + (front ? quad.d : quad.b);
    return point.diffuse_albedo * quad_form_factor(point.diffuse_space, v0, v1, v2, v3)
         + point.glossy_albedo * quad_form_factor(point.glossy_space, v0, v1, v2, v3);
}

// Any outline, by one loop over its vertices for both lobes.
vec3 reflected_outline(YardstickPoint point, ArealightGpuLight light, vec3 center, bool front) {
    uint end = light.first_vertex + light.vertex_count;
    vec3 last = center + arealight_bridge_vertex(end - 1u);
    vec3 diffuse_from = normalize(point.diffuse_space * last);
    vec3 glossy_from = normalize(point.glossy_space * last);
    vec3 diffuse = vec3(0.0);
    vec3 glossy = vec3(0.0);
    for (uint index = light.first_vertex; index < end; index++) {
        vec3 vertex = center + arealight_bridge_vertex(index);
        vec3 diffuse_to = normalize(point.diffuse_space * vertex);
        vec3 glossy_to = normalize(point.glossy_space * vertex);
        diffuse += yardstick_edge(diffuse_from, diffuse_to);
        glossy += yardstick_edge(glossy_from, glossy_to);
        diffuse_from = diffuse_to;
        glossy_from = glossy_to;
    }
    float side = front ? 1.0 : -1.0;
    return point.diffuse_albedo * yardstick_unclipped(METHOD, side * diffuse)
         + point.glossy_albedo * yardstick_unclipped(METHOD, side * glossy);
}

// What a light adds.
vec3 radiance_of(YardstickPoint point, uint index, bool is_quad) {
    ArealightGpuLight light = lights[index];
    vec3 center = light.center - point.position;
    bool front = dot(light.normal, center) < 0.0;
    if (!front && !(HAS_TWO_SIDED && (light.flags & LIGHT_TWO_SIDED) != 0u)) {
        return vec3(0.0);
    }
    return light.radiance * (is_quad ? reflected_quad(point, load_quad(light).quad, center, front)
                                     : reflected_outline(point, light, center, front));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 position = texelFetch(g_position, pixel, 0);
    vec3 radiance = vec3(0.0);
    if (position.w != 0.0) {
        YardstickPoint point = yardstick_point(pixel, position.xyz);
        uint quad_count = HAS_OTHERS ? constants.quad_count : constants.light_count;
        for (uint index = 0u; index < quad_count; index++) {
            radiance += radiance_of(point, index, true);
        }
        if (HAS_OTHERS) {
            for (uint index = quad_count; index < constants.light_count; index++) {
                radiance += radiance_of(point, index, false);
            }
        }
    }
    imageStore(radiance_image, pixel, vec4(radiance, position.w != 0.0 ? 1.0 : 0.0));
}
