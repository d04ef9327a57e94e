#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The yardstick of shadow rays: plain area sampling. For each ray a light is chosen by its power over its
// distance squared, and a point of it by area; what the true BRDF (Lambert + GGX) reflects of it, if it
// arrives, over the density of both choices, is added to the radiance. Nothing is known of the unshadowed
// radiance, so that there is noise where nothing is hidden too.
//
// The same blockers, random numbers and G-buffer as the product's passes. For convex quads of one colour.

layout(local_size_x = 8, local_size_y = 8) in;

// Of a pixel, 1 to MOST_RAYS.
layout(constant_id = 0) const int RAYS = 1;
const int MOST_RAYS = 16;

#define LIGHTS_BINDING 0
#define G_BUFFER_BINDING 2
#define BLOCKER_NODES_BINDING 7
#define BLOCKER_TRIANGLES_BINDING 8
const bool HAS_SPECULAR_INPUT = true;
#include "light_records.glsl"
#include "quad_point.glsl"
#include "g_buffer.glsl"
#include "blockers.glsl"
#include "arealight/ggx.glsl"
#include "arealight/shadows/choose.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "arealight/shadows/sequence.glsl"

layout(set = 0, binding = 6, rgba32f) uniform image2D radiance_image;

#include "shade_constants.glsl"

const uint NO_LIGHT = 0xffffffffu;

// The light of each ray, with the probability of its choice.
struct Choice {
    uint light;
    float probability;
};

float importance(ArealightGpuLight light, vec3 position) {
    vec3 offset = light.center - position;
    float area = light.area * light.radius * light.radius;
    return arealight_luminance(light.radiance) * area / max(dot(offset, offset), AREALIGHT_TINY);
}

void choose_lights(ivec2 pixel, vec3 position, out Choice choices[MOST_RAYS]) {
    float random[MOST_RAYS];
    for (int ray = 0; ray < RAYS; ray++) {
        random[ray] = arealight_sequence(uvec2(pixel), constants.seed * uint(RAYS) + uint(ray));
        choices[ray] = Choice(NO_LIGHT, 0.0);
    }
    float sum = 0.0;
    for (uint index = 0u; index < constants.light_count; index++) {
        float weight = importance(lights[index], position);
        if (weight > 0.0) {
            for (int ray = 0; ray < RAYS; ray++) {
                float before = sum;
                if (arealight_choose(random[ray], before, weight)) {
                    choices[ray] = Choice(index, weight);
                }
            }
            sum += weight;
        }
    }
    for (int ray = 0; ray < RAYS; ray++) {
        choices[ray].probability /= max(sum, AREALIGHT_TINY);
    }
}

// f cos of both lobes, for directions in the shading frame.
vec3 reflected(ArealightSurface surface, vec3 view, vec3 light) {
    float alpha = max(surface.roughness * surface.roughness, AREALIGHT_MIN_ALPHA);
    vec3 diffuse = surface.diffuse_albedo * (AREALIGHT_INVERSE_PI * max(light.z, 0.0));
    return diffuse + arealight_ggx_evaluate(view, light, vec2(alpha), surface.f0, surface.f90);
}

vec3 estimate(ArealightSurface surface, ArealightFrame frame, vec3 origin, Choice choice, vec2 random) {
    if (choice.light == NO_LIGHT) {
        return vec3(0.0);
    }
    ArealightGpuLight light = lights[choice.light];
    float area;
    vec3 offset = point_of(light, random, area) + (light.center - surface.position);
    float square = max(dot(offset, offset), AREALIGHT_TINY);
    vec3 direction = offset * inversesqrt(square);
    float cosine = -dot(light.normal, direction);
    cosine = (light.flags & LIGHT_TWO_SIDED) != 0u ? abs(cosine) : cosine;
    vec3 view = vec3(frame.sin_view, 0.0, frame.cos_view);
    vec3 part = reflected(surface, view, arealight_frame_matrix(frame) * direction);
    float end = sqrt(square) * AREALIGHT_RAY_PART;
    if (cosine <= 0.0 || part == vec3(0.0) || arealight_bridge_blocker(origin, direction, end) < end) {
        return vec3(0.0);
    }
    return light.radiance * part * (cosine * area / (square * choice.probability));
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
    ArealightSurface surface = load_surface(pixel, position.xyz, constants.camera);
    ArealightFrame frame = arealight_surface_frame(surface.normal, surface.view);
    vec3 side = dot(frame.normal, surface.view) < 0.0 ? -frame.normal : frame.normal;
    vec3 origin = arealight_ray_origin(surface.position, side, 0.0);
    Choice choices[MOST_RAYS];
    choose_lights(pixel, surface.position, choices);
    vec3 sum = vec3(0.0);
    for (int ray = 0; ray < RAYS; ray++) {
        vec2 random = arealight_sequence_2d(uvec2(pixel), constants.seed * uint(RAYS) + uint(ray));
        sum += estimate(surface, frame, origin, choices[ray], random);
    }
    vec4 before = imageLoad(radiance_image, pixel);
    imageStore(radiance_image, pixel, vec4(before.rgb + sum / float(RAYS), before.a));
}
