#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Makes a level of the light textures from the one before: half the texels a side, blurred by a separable kernel
// whose taps stop at the margin's edge. arealight::PyramidSize::kernel gives its weights; sums are in float32.

layout(local_size_x = 8, local_size_y = 8) in;

#include "half.glsl"

layout(set = 0, binding = 0) uniform texture2DArray finer_level;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

const int MAX_RADIUS = 6; // LevelKernel::MAX_RADIUS

layout(push_constant, std430) uniform TextureBlurConstants {
    float weights[MAX_RADIUS]; // half of the kernel, from the middle
    uint radius;
    uint first_layer;
} constants;

// Of the finer level, what a group reads a side: two texels for each of its own, and the kernel's ends.
const int GROUP = 8;
const int MAX_TILE = 2 * GROUP + 2 * (MAX_RADIUS - 1);

shared vec3 tile[MAX_TILE * MAX_TILE];
shared vec3 rows[MAX_TILE * GROUP];

void main() {
    int layer = int(constants.first_layer + gl_WorkGroupID.z);
    int radius = int(constants.radius);
    int side = 2 * GROUP + 2 * (radius - 1);
    int item = int(gl_LocalInvocationIndex);

    // Read the finer texels
    ivec2 corner = ivec2(gl_WorkGroupID.xy) * 2 * GROUP - (radius - 1);
    ivec2 last = textureSize(finer_level, 0).xy - 1;
    for (int i = item; i < side * side; i += GROUP * GROUP) {
        ivec2 texel = clamp(corner + ivec2(i % side, i / side), ivec2(0), last);
        tile[i] = texelFetch(finer_level, ivec3(texel, layer), 0).rgb;
    }
    barrier();

    // Blur along rows: the middle of our texel is between two of the finer ones
    for (int i = item; i < side * GROUP; i += GROUP * GROUP) {
        int right = (i / GROUP) * side + 2 * (i % GROUP) + radius;
        vec3 sum = vec3(0.0);
        for (int tap = 0; tap < radius; tap++) {
            sum += constants.weights[tap] * (tile[right - 1 - tap] + tile[right + tap]);
        }
        rows[i] = sum;
    }
    barrier();

    // Blur along columns
    ivec2 local = ivec2(gl_LocalInvocationID.xy);
    int below = (2 * local.y + radius) * GROUP + local.x;
    vec3 color = vec3(0.0);
    for (int tap = 0; tap < radius; tap++) {
        color += constants.weights[tap] * (rows[below - (1 + tap) * GROUP] + rows[below + tap * GROUP]);
    }
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(out_level).xy))) {
        color = round_to_half(min(color, LARGEST_HALF));
        imageStore(out_level, ivec3(texel, layer), vec4(color, 1.0));
    }
}
