#ifndef SHADOW_PICKS_GLSL
#define SHADOW_PICKS_GLSL

// For which light and which lobe each shadow ray of a pixel is: chosen while the lights are summed, by the
// luminance of what each adds. The including kernel defines PICKS_BINDING, PICKS_ACCESS and the constant
// SHADOW_RAYS.

const bool HAS_SHADOWS = SHADOW_RAYS > 0;
// The most rays of a pixel: ShadowOptions::MOST_RAYS in Rust (a test compares them).
const int MOST_SHADOW_RAYS = 4;

// Of each pixel SHADOW_RAYS words: the light's index in its buffer, and these bits.
layout(set = 0, binding = PICKS_BINDING, std430) PICKS_ACCESS buffer ShadowPicks {
    uint shadow_picks[];
};

const uint PICK_SPECULAR = 0x80000000u; // of the specular lobes, else of the diffuse one
const uint PICK_SHAPE = 0x40000000u;    // a disk, sphere or tube, else a polygon or mesh
const uint PICK_INDEX = 0x3fffffffu;
const uint NO_PICK = 0xffffffffu;

// Where the picks of a pixel begin.
uint first_pick(ivec2 pixel, ivec2 size) {
    return uint(SHADOW_RAYS) * uint(pixel.y * size.x + pixel.x);
}

#endif
