#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Which paths through the library's quads the invocations of a wave take, light by light. The same bindings
// as shade.comp. A wave is 8 x 4 pixels, half of a workgroup: its pixel number i, row by row, gets in x the
// paths of light i as a bit mask, and in y whether it has a surface. For the first 32 convex quads without an
// image, and images of whole workgroups.

layout(local_size_x = 8, local_size_y = 8) in;

#include "bindings.glsl"
const bool HAS_SPECULAR_INPUT = true;
#define AREALIGHT_LIGHT_TEXTURES 1
#define AREALIGHT_TWO_SIDED 1
#define AREALIGHT_POLYGONS 1
#define AREALIGHT_MESHES 1
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "g_buffer.glsl"

layout(set = 0, binding = RADIANCE_BINDING, rgba32f) uniform writeonly image2D radiance_image;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count;
} constants;

const uint ROWS_PER_WAVE = 4u;
const uint LIGHTS_PER_WAVE = 32u;

// Bits of a mask: the same as in benches/src/model.rs. Those of a lobe are shifted by LOBE_SHIFT and, for
// each lobe before it, by LOBE_BITS.
const uint BEHIND = 1u; // or in the light's plane
const uint IN_FRONT = 2u;
const int LOBE_SHIFT = 2;
const int LOBE_BITS = 6;
const uint BELOW = 1u;
const uint ACUTE = 2u; // above the horizon, seen with acute edges
const uint NOT_ACUTE = 4u;
const uint CROSSING_1 = 8u; // with one vertex above; with two and three the next bits

shared uint wave_paths[8u / ROWS_PER_WAVE];

// The path of arealight_quad_vector.
uint quad_path(ArealightQuad quad) {
    if (arealight_lowest(quad) > 0.0) {
        vec4 cosine = vec4(dot(quad.a, quad.b), dot(quad.b, quad.c), dot(quad.c, quad.d),
                           dot(quad.d, quad.a));
        return all(greaterThan(cosine, vec4(0.0))) ? ACUTE : NOT_ACUTE;
    }
    if (!(arealight_highest(quad) > 0.0)) {
        return BELOW;
    }
    ArealightQuad turned = arealight_turned(quad);
    return CROSSING_1 << (turned.b.z > 0.0 ? (turned.c.z > 0.0 ? 2 : 1) : 0);
}

uint light_paths(ArealightPoint point, ArealightQuadLight light) {
    ArealightLocalQuad local;
    if (!arealight_to_local(point, light, local)) {
        return BEHIND;
    }
    uint diffuse = quad_path(arealight_transformed(point.lobes[AREALIGHT_LOBE_DIFFUSE].space, local.quad));
    uint specular = quad_path(arealight_transformed(point.lobes[AREALIGHT_LOBE_SPECULAR].space, local.quad));
    return IN_FRONT | diffuse << LOBE_SHIFT | specular << (LOBE_SHIFT + LOBE_BITS);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint wave = gl_LocalInvocationID.y / ROWS_PER_WAVE;
    uint place = gl_LocalInvocationIndex % LIGHTS_PER_WAVE;
    vec4 position = texelFetch(g_position, pixel, 0);
    bool hit = position.w != 0.0;
    ArealightPoint point = arealight_point(load_surface(pixel, position.xyz, constants.camera));
    uint own = 0u;
    for (uint index = 0u; index < min(constants.quad_count, LIGHTS_PER_WAVE); index++) {
        if (place == 0u) {
            wave_paths[wave] = 0u;
        }
        barrier();
        if (hit) {
            atomicOr(wave_paths[wave], light_paths(point, load_quad(lights[index])));
        }
        barrier();
        if (place == index) {
            own = wave_paths[wave];
        }
        barrier();
    }
    imageStore(radiance_image, pixel, vec4(float(own), hit ? 1.0 : 0.0, 0.0, 0.0));
}
