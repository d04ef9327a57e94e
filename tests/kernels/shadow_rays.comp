#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shadow rays for shading points under a light of triangles: an invocation per ray.

layout(local_size_x = 64) in;

// Rays of a point.
layout(constant_id = 0) const uint RAYS = 1u;

#include "table_image.glsl"
#include "arealight/material.glsl"
#include "arealight/shadows/shadow_sampling.glsl"

struct ShadowPoint {
    vec3 normal;
    float roughness;
    vec3 view;
    float f90;
    vec3 diffuse_albedo;
    uint first_triangle;
    vec3 f0;
    uint triangle_count;
    vec3 radiance;
    float reserved;
};

layout(set = 0, binding = 1, std430) readonly buffer Points {
    ShadowPoint points[];
};
// Three a triangle, from the shading point.
layout(set = 0, binding = 2, std430) readonly buffer Corners {
    vec4 corners[];
};
struct ShadowRay {
    vec4 direction; // and in w the sum of the weights: the luminance without shadows
    vec4 color;     // of the lobe that it is drawn for, of luminance 1
};
layout(set = 0, binding = 3, std430) writeonly buffer Rays {
    ShadowRay rays[];
};

layout(push_constant, std430) uniform ShadowConstants {
    uint count;
} constants;

float luminance(vec3 color) {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    ShadowPoint given = points[index / RAYS];
    ArealightCoat no_coat = ArealightCoat(vec3(0.0), 0.0, 0.0);
    ArealightSheen no_sheen = ArealightSheen(vec3(0.0), 0.0);
    ArealightPoint point = arealight_point(ArealightSurface(vec3(0.0), given.normal, given.view,
                                                            given.diffuse_albedo, given.f0,
                                                            given.f90, given.roughness, 0.0, 0.0, 0.0,
                                                                no_coat,
                                                            ArealightAnisotropy(vec3(0.0), given.roughness),
                                                                no_sheen,
                                                            AREALIGHT_NO_FILM));
    // The R3 sequence, for the choice and for the direction
    vec3 random = fract(0.5 + float(index % RAYS) * vec3(0.8191725134, 0.6710436067, 0.5497004779));

    // Choose a triangle and a lobe
    float sum = 0.0;
    int chosen_lobe = 0;
    ArealightQuad chosen;
    for (uint i = 0u; i < given.triangle_count; i++) {
        uint first = 3u * (given.first_triangle + i);
        vec3 last = point.to_frame * corners[first + 2u].xyz;
        ArealightQuad triangle = ArealightQuad(point.to_frame * corners[first].xyz, point.to_frame
                                               * corners[first + 1u].xyz, last, last);
        for (int lobe = AREALIGHT_LOBE_DIFFUSE; lobe <= AREALIGHT_LOBE_SPECULAR; lobe++) {
            vec3 vector = arealight_quad_vector(arealight_transformed(point.lobes[lobe].space, triangle));
            float weight = luminance(given.radiance * point.lobes[lobe].albedo) * abs(vector.z);
            if (weight > 0.0 && arealight_choose(random.x, sum, weight)) {
                chosen_lobe = lobe;
                chosen = triangle;
            }
        }
    }

    // Draw a direction from it
    ShadowRay ray = ShadowRay(vec4(0.0), vec4(0.0));
    if (sum > 0.0) {
        ArealightLobe lobe = point.lobes[chosen_lobe];
        ArealightQuad in_space = arealight_transformed(lobe.space, chosen);
        ArealightDraw draw = arealight_draw(arealight_sampling_polygon(in_space), random.yz);
        vec3 color = given.radiance * lobe.albedo;
        ray.direction = vec4(arealight_from_cosine_space(point.to_frame, lobe.space, draw.direction), sum);
        ray.color = vec4(color / luminance(color), 0.0);
    }
    rays[index] = ray;
}
