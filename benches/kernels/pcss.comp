#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The yardstick of shadow maps: percentage-closer soft shadows (Fernando 2005) of one quad light. A map holds
// how deep below the light's centre, along its normal, the first blocker is. Of the map's texels that
// blockers between a point and the light can be in, some are looked up; the mean depth of those that are
// nearer than the point's own plane says how wide the penumbra is, and so over which texels the plane is
// compared. The radiance, which is there without shadows, is multiplied by the share of texels that do not
// hide it.
//
// The same blockers, random numbers and G-buffer as the product's passes. An engine rasterises the map; here
// rays find it.

layout(local_size_x = 8, local_size_y = 8) in;

// 1: make the map. 0: shade by it.
layout(constant_id = 0) const uint MAKES_MAP = 0u;
// Texels looked up for the blockers' depth, and for the share.
layout(constant_id = 1) const uint SEARCH_TAPS = 16u;
layout(constant_id = 2) const uint FILTER_TAPS = 32u;

// Texels of the map to a side. It is a paraboloid map of the half space that the light shines into.
const int MAP_SIZE = 512;
const float NO_BLOCKER = 3e38;
// Of depths: what is nearer to a plane is of it.
const float BIAS = 0.002;
// Texels of the map by which a point is lifted above its plane.
const float LIFT = 1.5;

#define LIGHTS_BINDING 0
#define G_BUFFER_BINDING 2
#define BLOCKER_NODES_BINDING 7
#define BLOCKER_TRIANGLES_BINDING 8
const bool HAS_SPECULAR_INPUT = false;
#include "light_records.glsl"
#include "quad_point.glsl"
#include "g_buffer.glsl"
#include "blockers.glsl"
#include "arealight/shadows/sequence.glsl"

layout(set = 0, binding = 6, rgba32f) uniform image2D radiance_image;
layout(set = 0, binding = 9, std430) buffer ShadowMap {
    float depths[];
};

#include "shade_constants.glsl"

// To the light's frame: x and y along it, z along its normal.
mat3 light_frame(vec3 normal) {
    vec3 other = abs(normal.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 tangent = normalize(cross(other, normal));
    return transpose(mat3(tangent, cross(normal, tangent), normal));
}

// The direction of a place in the map, both coordinates from -1 to 1.
vec3 map_direction(vec2 place) {
    float square = dot(place, place);
    return vec3(2.0 * place, 1.0 - square) / (1.0 + square);
}

float map_depth(vec3 direction) {
    vec2 place = direction.xy / (length(direction) + direction.z);
    ivec2 texel = clamp(ivec2((0.5 + 0.5 * place) * float(MAP_SIZE)), ivec2(0), ivec2(MAP_SIZE - 1));
    return depths[texel.y * MAP_SIZE + texel.x];
}

void make_map(ivec2 texel) {
    ArealightGpuLight light = lights[0];
    vec3 direction = map_direction((vec2(texel) + 0.5) / float(MAP_SIZE) * 2.0 - 1.0);
    float depth = NO_BLOCKER;
    if (direction.z > 0.0) {
        vec3 in_world = transpose(light_frame(light.normal)) * direction;
        BvhHit hit = bvh_trace(light.center, in_world, NO_BLOCKER, false);
        depth = hit.triangle == BVH_NO_TRIANGLE ? NO_BLOCKER : hit.distance * direction.z;
    }
    depths[texel.y * MAP_SIZE + texel.x] = depth;
}

// The depth of the point's plane in a direction from the light, at most the point's own.
float plane_depth(vec3 point, vec3 normal, vec3 direction) {
    float along = dot(normal, point) / dot(normal, direction) * direction.z;
    return (along > 0.0 ? min(along, point.z) : point.z) * (1.0 - BIAS);
}

// The part of the light that arrives at a point with a normal, both in the light's frame.
float visibility(ArealightGpuLight light, mat3 to_light, vec3 point, vec3 normal, uvec2 pixel) {
    float near = min(light.radius, 0.5 * point.z);
    float sum = 0.0;
    float count = 0.0;
    for (uint tap = 0u; tap < SEARCH_TAPS; tap++) {
        float area;
        vec3 corner = to_light * point_of(light,
                                          arealight_sequence_2d(pixel, constants.seed * SEARCH_TAPS + tap),
            area);
        vec3 direction = mix(corner, point, near / point.z);
        float depth = map_depth(direction);
        if (depth < plane_depth(point, normal, direction)) {
            sum += depth;
            count += 1.0;
        }
    }
    if (count == 0.0) {
        return 1.0;
    }
    float blocker = min(sum / count, point.z);
    float hidden = 0.0;
    for (uint tap = 0u; tap < FILTER_TAPS; tap++) {
        float area;
        vec3 corner = to_light * point_of(light,
                                          arealight_sequence_2d(pixel, constants.seed * FILTER_TAPS + tap),
            area);
        vec3 direction = mix(corner, point, blocker / point.z);
        hidden += map_depth(direction) < plane_depth(point, normal, direction) ? 1.0 : 0.0;
    }
    return 1.0 - hidden / float(FILTER_TAPS);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (MAKES_MAP != 0u) {
        if (all(lessThan(pixel, ivec2(MAP_SIZE)))) {
            make_map(pixel);
        }
        return;
    }
    if (any(greaterThanEqual(pixel, imageSize(radiance_image)))) {
        return;
    }
    vec4 position = texelFetch(g_position, pixel, 0);
    ArealightGpuLight light = lights[0];
    mat3 to_light = light_frame(light.normal);
    vec3 point = to_light * (position.xyz - light.center);
    if (position.w == 0.0 || point.z <= 0.0) {
        return;
    }
    vec3 normal = to_light * load_surface(pixel, position.xyz, constants.camera).normal;
    normal = dot(normal, point) > 0.0 ? -normal : normal;
    float texel = (length(point) + point.z) * (2.0 / float(MAP_SIZE));
    point += LIFT * texel * normal;
    vec4 before = imageLoad(radiance_image, pixel);
    float part = visibility(light, to_light, point, normal, uvec2(pixel));
    imageStore(radiance_image, pixel, vec4(before.rgb * part, before.a));
}
