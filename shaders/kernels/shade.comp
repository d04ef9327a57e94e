#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shades a G-buffer with every light of two buffers: polygons and meshes; disks, spheres and tubes.

#include "shade_resources.glsl"

// Some polygon light is a convex quad without an image
layout(constant_id = 11) const bool HAS_QUADS = true;

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count; // of the first lights: convex quads without an image
    uint seed;       // of shadow rays
} constants;

const bool HAS_LIGHTS = true;
const bool HAS_POLYGONS = (EFFECTS & EFFECTS_OF_POLYGONS) != 0u;
const bool HAS_SHAPES = (EFFECTS & EFFECTS_OF_SHAPES) != 0u;

// The lights of the buffer.
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
};
uint light_at(LightList list, uint index) {
    return index;
}
uint shape_at(LightList list, uint index) {
    return index;
}

#include "shade_pixel.glsl"

void main() {
    uint quad_count = HAS_POLYGONS ? constants.quad_count : constants.light_count;
    LightList list = LightList(quad_count, constants.light_count, constants.shape_count);
    shade_pixel(ivec2(gl_GlobalInvocationID.xy), imageSize(radiance_image), list);
}
