#ifndef SHADE_CONSTANTS_GLSL
#define SHADE_CONSTANTS_GLSL

// The constants of a frame, of the kernels shade and classify: arealight::gpu::ShadeConstants in Rust (a test
// compares them). They are push constants, or a uniform block at SHADE_CONSTANTS_BINDING where the including
// kernel defines that. Offsets are the same in both.
#ifdef SHADE_CONSTANTS_BINDING
layout(set = 0, binding = SHADE_CONSTANTS_BINDING, std140) uniform ShadeConstants {
#else
layout(push_constant, std430) uniform ShadeConstants {
#endif
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
    uint stencil; // view.glsl
} constants;

#endif
