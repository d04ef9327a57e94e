#ifndef SHADE_CONSTANTS_GLSL
#define SHADE_CONSTANTS_GLSL

// The push constants of a frame, of the kernels shade and classify: arealight::gpu::ShadeConstants in Rust (a test compares them).
layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera; // or the direction to it
    uint light_count;
    uint shape_count;
    uint quad_count; // of the first lights: convex quads without an image
    uint seed;       // of shadow rays
    uint capacity;   // of a tile's list
    uvec2 size;
    uint horizon_cells;   // of tiles alone, as the next
    float cull_threshold;
    uvec2 offset; // of the frame's rectangle in the radiance image
} constants;

#endif
