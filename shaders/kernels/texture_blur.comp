#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Makes a level of the light textures from the one before: half the texels a side, blurred by a separable
// kernel with the image mirrored beyond its edge. arealight::PyramidSize::kernel gives its weights; sums are
// in float32.
//
// Each invocation makes a block of texels out of registers: of what it reads, neighbours share the most.
// Shared memory would read less, and take twice the time in software. Wide groups read long rows.

layout(local_size_x = 32, local_size_y = 2) in;

#include "half.glsl"

layout(set = 0, binding = 0) uniform texture2DArray finer_level;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray out_level;

const int MAX_RADIUS = 6; // arealight::pyramid::MOST_TAPS

layout(push_constant, std430) uniform TextureBlurConstants {
    float weights[MAX_RADIUS]; // half of the kernel, from the middle; zero beyond its radius
    uint first_layer;
} constants;

// Taps to a side: the kernel's radius or more.
layout(constant_id = 8) const int RADIUS = 6;

// Texels that an invocation makes, and the finer ones that it reads: plan::texture_blur knows the first.
const int BLOCK_WIDTH = 4;
const int BLOCK_HEIGHT = 4;
const int READ_WIDTH = 2 * BLOCK_WIDTH + 2 * (RADIUS - 1);
const int READ_HEIGHT = 2 * BLOCK_HEIGHT + 2 * (RADIUS - 1);

// The weight of a tap of the whole kernel, from its first; zero outside.
float kernel_weight(int tap) {
    int from_middle = tap < RADIUS ? RADIUS - 1 - tap : tap - RADIUS;
    return from_middle < RADIUS ? constants.weights[min(from_middle, MAX_RADIUS - 1)] : 0.0;
}

void main() {
    int layer = int(constants.first_layer + gl_GlobalInvocationID.z);
    ivec2 extent = imageSize(out_level).xy;
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(BLOCK_WIDTH, BLOCK_HEIGHT);
    if (any(greaterThanEqual(first, extent))) {
        return;
    }
    ivec2 corner = 2 * first - (RADIUS - 1);
    ivec2 last = textureSize(finer_level, 0).xy - 1;
    vec3 sums[BLOCK_HEIGHT][BLOCK_WIDTH];
    for (int y = 0; y < BLOCK_HEIGHT; y++) {
        for (int x = 0; x < BLOCK_WIDTH; x++) {
            sums[y][x] = vec3(0.0);
        }
    }

    for (int row = 0; row < READ_HEIGHT; row++) {
        // Read a row of the finer level
        vec3 texels[READ_WIDTH];
        for (int x = 0; x < READ_WIDTH; x++) {
            // Mirrored once: no tap is farther out than the finer level is wide, but those of texels that are
            // not there
            ivec2 texel = corner + ivec2(x, row);
            texel = max(texel, -1 - texel);
            texel = max(min(texel, 2 * last + 1 - texel), ivec2(0));
            texels[x] = texelFetch(finer_level, ivec3(texel, layer), 0).rgb;
        }
        for (int x = 0; x < BLOCK_WIDTH; x++) {
            // Blur it along itself: the middle of our texel is between two of the finer ones
            vec3 sum = vec3(0.0);
            for (int tap = 0; tap < RADIUS; tap++) {
                int right = 2 * x + RADIUS;
                sum += constants.weights[tap] * (texels[right - 1 - tap] + texels[right + tap]);
            }
            // Add it to the texels of ours that it is a part of
            for (int y = 0; y < BLOCK_HEIGHT; y++) {
                sums[y][x] += kernel_weight(row - 2 * y) * sum;
            }
        }
    }

    for (int y = 0; y < BLOCK_HEIGHT; y++) {
        for (int x = 0; x < BLOCK_WIDTH; x++) {
            ivec2 texel = first + ivec2(x, y);
            if (all(lessThan(texel, extent))) {
                vec3 color = round_to_half(min(sums[y][x], LARGEST_HALF));
                imageStore(out_level, ivec3(texel, layer), vec4(color, 1.0));
            }
        }
    }
}
