#ifndef SHADE_MAIN_GLSL
#define SHADE_MAIN_GLSL

// Shades a G-buffer with every light of two buffers: polygons, and shapes.

#include "shade_resources.glsl"

// Some polygon light is a convex quad without an image
layout(constant_id = 11) const bool HAS_QUADS = true;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count; // of the first lights: convex quads without an image
} constants;

const bool HAS_LIGHTS = true;
const bool HAS_OTHERS = (EFFECTS & BEYOND_QUADS) != 0u;
const bool HAS_SHAPES = (EFFECTS & ANY_SHAPE) != 0u;

// The lights of the buffer.
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
};
uint light_at(LightList list, uint place) {
    return place;
}
uint shape_at(LightList list, uint place) {
    return place;
}

#include "shade_pixel.glsl"

void main() {
    uint quad_count = HAS_OTHERS ? constants.quad_count : constants.light_count;
    LightList list = LightList(quad_count, constants.light_count, constants.shape_count);
    shade_pixel(ivec2(gl_GlobalInvocationID.xy), imageSize(radiance_image), list);
}

#endif
