#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The shade kernel as others write it: the same bindings, table and lobes, but the form factors of yardsticks.glsl. For
// lights of one colour; outlines other than convex quads, and the backs of lights, are the practice's alone.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int METHOD = 0;

const int METHOD_PRACTICE = 0;
const int METHOD_TEXTBOOK = 1;

#define LIGHTS_BINDING 1
#define G_BUFFER_BINDING 3
#define LIGHT_TEXTURES_BINDING 8
#include "table_image.glsl"
#include "lights.glsl"
#include "g_buffer.glsl"

layout(set = 0, binding = 7, rgba32f) uniform image2D radiance_image;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count;
} constants;

ArealightQuad yardstick;

vec3 yardstick_vertex(uint index) {
    return index == 0u ? yardstick.v0 : index == 1u ? yardstick.v1 : index == 2u ? yardstick.v2 : yardstick.v3;
}

#include "yardsticks.glsl"

// A lobe's form factor of the quad, which is relative to the shading point and seen from the front.
float seen_by(ArealightLobe lobe, ArealightQuad quad) {
    mat3 to_cosine = lobe.space.to_cosine;
    quad = ArealightQuad(to_cosine * quad.v0, to_cosine * quad.v1, to_cosine * quad.v2, to_cosine * quad.v3);
    if (METHOD == METHOD_PRACTICE) {
        return yardstick_practice_quad(quad.v0, quad.v1, quad.v2, quad.v3);
    }
    yardstick = quad;
    return yardstick_textbook(4u);
}

// As yardstick_practice_quad, of any outline, seen from the front or from the back.
float practice_outline(ArealightLobe lobe, ArealightPolygonLight light, vec3 center, bool front) {
    uint index = light.first_vertex;
    uint end = index + light.vertex_count;
    vec3 a = normalize(lobe.space.to_cosine * (center + arealight_bridge_vertex(end - 1u)));
    vec3 sum = vec3(0.0);
    do {
        vec3 b = normalize(lobe.space.to_cosine * (center + arealight_bridge_vertex(index)));
        sum += yardstick_practice_edge(a, b);
        a = b;
    } while (++index < end);
    float l = length(sum);
    return max((l * l + (front ? -sum.z : sum.z)) / (l + 1.0), 0.0);
}

const bool HAS_OTHERS = (EFFECTS & AREALIGHT_EFFECT_POLYGON) != 0u;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 position = texelFetch(g_position, pixel, 0);
    vec3 radiance = vec3(0.0);
    if (position.w != 0.0) {
        ArealightSurface surface = load_surface(pixel, position.xyz, constants.camera, EFFECTS);
        ArealightQuality quality = ArealightQuality(AREALIGHT_FORM_FACTOR_EXACT, AREALIGHT_HORIZON_COSINE,
                                                    AREALIGHT_FRESNEL_BY_F0, AREALIGHT_LOBES_TABLE,
                                                    AREALIGHT_FOOTPRINT_ROUND);
        ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);
        uint quad_count = HAS_OTHERS ? constants.quad_count : constants.light_count;
        uint index = 0u;
        if (quad_count != 0u) {
            do {
                ArealightPolygonLight light = load_light(index);
                vec3 center = light.center - point.position;
                bool front = dot(light.area, center) < 0.0;
                if (front || ((EFFECTS & AREALIGHT_EFFECT_TWO_SIDED) != 0u && light.two_sided)) {
                    // Seen from the back, the outline runs the other way
                    ArealightQuad quad = arealight_light_quad(light);
                    quad = ArealightQuad(center + quad.v0, center + (front ? quad.v1 : quad.v3), center + quad.v2,
                                         center + (front ? quad.v3 : quad.v1));
                    radiance += light.radiance * (point.glossy.albedo * seen_by(point.glossy, quad)
                                                  + point.diffuse.albedo * seen_by(point.diffuse, quad));
                }
                index++;
            } while (index < quad_count);
        }
        if (HAS_OTHERS && index < constants.light_count) {
            do {
                ArealightPolygonLight light = load_light(index);
                vec3 center = light.center - point.position;
                bool front = dot(light.area, center) < 0.0;
                if (front || light.two_sided) {
                    radiance += light.radiance * (point.glossy.albedo * practice_outline(point.glossy, light, center, front)
                                                  + point.diffuse.albedo * practice_outline(point.diffuse, light, center, front));
                }
                index++;
            } while (index < constants.light_count);
        }
    }
    imageStore(radiance_image, pixel, vec4(radiance, position.w != 0.0 ? 1.0 : 0.0));
}
