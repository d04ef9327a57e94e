#ifndef LIGHT_COUNTS_GLSL
#define LIGHT_COUNTS_GLSL

// How many lights a frame has: those of its constants, or no more than that and what a buffer says that the
// GPU wrote. The including kernel has effects.glsl, shade_constants.glsl and the specialisation constant
// LIGHT_COUNTS, and defines LIGHT_COUNTS_BINDING.

// arealight::gpu::LightCounts in Rust.
struct ArealightGpuLightCounts {
    uint light_count;
    uint shape_count;
    uint quad_count;
};

layout(set = 0, binding = LIGHT_COUNTS_BINDING, std430) readonly buffer LightCounts {
    ArealightGpuLightCounts light_counts;
};

// Polygons and meshes.
uint light_count() {
    return LIGHT_COUNTS ? min(light_counts.light_count, constants.light_count) : constants.light_count;
}

// Disks, spheres and tubes.
uint shape_count() {
    return LIGHT_COUNTS ? min(light_counts.shape_count, constants.shape_count) : constants.shape_count;
}

// Of the first polygons: convex quads without an image. Where the frame has no others, all are.
uint quad_count() {
    if (LIGHT_COUNTS) {
        return HAS_POLYGONS ? min(min(light_counts.quad_count, constants.quad_count), light_count())
            : light_count();
    }
    return constants.quad_count;
}

#endif
