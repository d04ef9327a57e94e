#ifndef SHADOW_HISTORY_GLSL
#define SHADOW_HISTORY_GLSL

// What is kept of shadows from frame to frame. The including kernel has shadow_resources.glsl
// and shadow_colors.glsl.

#include "shadow_neighbours.glsl"

// Words of the head, and of a pixel.
const uint HISTORY_HEAD = 40u;
const uint HISTORY_PIXEL = 10u;

// First for frames of even and of odd seeds each a head of 20 words: the matrix from positions to clip space,
// by columns, and what is added to positions of that frame so that they are relative to the origin of the one
// before; then for even and for odd ones each a record of every pixel:
//
//     what arrives and the penumbra's width, as halves; of how many frames, 0 for none; position; normal;
//     pack_colors
layout(set = 0, binding = HISTORY_BINDING, std430) buffer ShadowHistory {
    uint shadow_history[];
};

struct HistoryPixel {
    vec2 shadow;  // what arrives of the light, and the penumbra's width times the part that is hidden
    float frames; // that these are the mean of
    vec3 position;
    vec3 normal;  // unit
    ShadowColors colors;
};

// Where the record of a pixel is, of this frame (0) or of the one before (1).
uint history_record(ivec2 pixel, ivec2 size, uint before) {
    uint parity = (constants.seed ^ before) & 1u;
    uint pixels = uint(size.x) * uint(size.y);
    return HISTORY_HEAD + HISTORY_PIXEL * (parity * pixels + uint(pixel.y * size.x + pixel.x));
}

HistoryPixel load_history(ivec2 pixel, ivec2 size, uint before) {
    uint at = history_record(pixel, size, before);
    vec3 position = uintBitsToFloat(uvec3(shadow_history[at + 2u], shadow_history[at + 3u],
                                          shadow_history[at + 4u]));
    vec3 normal = 2.0 * unpackUnorm4x8(shadow_history[at + 5u]).xyz - 1.0;
    uvec4 colors = uvec4(shadow_history[at + 6u], shadow_history[at + 7u], shadow_history[at + 8u],
                         shadow_history[at + 9u]);
    return HistoryPixel(unpackHalf2x16(shadow_history[at]), uintBitsToFloat(shadow_history[at + 1u]),
                        position,
                        arealight_normalize_or(normal, vec3(0.0, 0.0, 1.0)), unpack_colors(colors));
}

void store_history(ivec2 pixel, ivec2 size, HistoryPixel history) {
    uint at = history_record(pixel, size, 0u);
    uvec3 position = floatBitsToUint(history.position);
    shadow_history[at] = packHalf2x16(history.shadow);
    shadow_history[at + 1u] = floatBitsToUint(history.frames);
    shadow_history[at + 2u] = position.x;
    shadow_history[at + 3u] = position.y;
    shadow_history[at + 4u] = position.z;
    shadow_history[at + 5u] = pack_normal(history.normal);
    // Up or down by chance, else a mean over many frames stays where a step is less than half of one
    float turned = 0.61803399 * float(constants.seed & 1023u);
    float dither = fract(turned + dot(vec2(pixel), vec2(0.75487767, 0.56984029)));
    uvec4 colors = pack_colors(history.colors, dither);
    for (uint i = 0u; i < 4u; i++) {
        shadow_history[at + 6u + i] = colors[i];
    }
}

// The vector at a word of the head of this frame (0) or of the one before (1).
vec4 history_head(uint word, uint before) {
    uint at = 20u * ((constants.seed ^ before) & 1u) + word;
    return uintBitsToFloat(uvec4(shadow_history[at], shadow_history[at + 1u], shadow_history[at + 2u],
                                 shadow_history[at + 3u]));
}

#endif
