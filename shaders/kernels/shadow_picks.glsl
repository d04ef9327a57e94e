#ifndef SHADOW_PICKS_GLSL
#define SHADOW_PICKS_GLSL

// For which light and which lobe each shadow ray of a pixel is: chosen while the lights are summed, by the
// size of what each adds. The including kernel defines PICKS_BINDING, PICKS_ACCESS and the constant
// SHADOW_RAYS.

const bool HAS_SHADOWS = SHADOW_RAYS > 0;
// The most rays of a pixel: ShadowOptions::MOST_RAYS in Rust (a test compares them).
const int MOST_SHADOW_RAYS = 4;

// Of each pixel first a word, the part of the specular lobes in each channel of the radiance, from 0 to 1,
// as unorms of 10 bits. Then of each ray two: the light's index in its buffer with these bits, and
// pack_color of the picked light's colour over that of all that the lobe reflects, both of size 1.
layout(set = 0, binding = PICKS_BINDING, std430) PICKS_ACCESS buffer ShadowPicks {
    uint shadow_picks[];
};

#include "pick_bits.glsl"

// Where the word of a pixel is.
uint pixel_picks(ivec2 pixel, ivec2 size) {
    return uint(1 + 2 * SHADOW_RAYS) * uint(pixel.y * size.x + pixel.x);
}

// Where the words of a ray of the pixel are, whose word is at `pixel_picks`.
uint ray_pick(uint pixel_picks, int ray) {
    return pixel_picks + 1u + 2u * uint(ray);
}

// The size of a radiance that lights are picked by: all channels count alike, so that no ratio of a pick is
// large but in a channel that has next to no light.
float pick_size(vec3 radiance) {
    return dot(radiance, vec3(1.0 / 3.0));
}

// Integers to 1023, rounded up from `rounded` of their step on.
uint pack_tens(vec3 numbers, float rounded) {
    uvec3 bits = uvec3(clamp(numbers + rounded, 0.0, 1023.5));
    return bits.x | bits.y << 10u | bits.z << 20u;
}
vec3 unpack_tens(uint word) {
    return vec3(word & 1023u, word >> 10u & 1023u, word >> 20u & 1023u);
}

// Three numbers from 0 to 63 in a word, by their roots: within .004 + .8 %, 0 and 1 exactly.
uint pack_color(vec3 color, float rounded) {
    return pack_tens(128.0 * sqrt(color), rounded);
}
vec3 unpack_color(uint word) {
    vec3 root = unpack_tens(word) * 0.0078125;
    return root * root;
}

#endif
