#ifndef FROXELS_GLSL
#define FROXELS_GLSL

// A grid of froxels over a view: columns over its picture, slices by the distance from the camera. What the
// kernels of a medium have in common: an image, push constants.

#include "bindings.glsl"

// arealight::gpu::MediumConstants in Rust (a test compares them).
layout(push_constant, std430) uniform MediumConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    vec3 scattering; // per unit of length; not read where an image has it, as the next
    float extinction;
    uint shape_count;
    uint quad_count;
    uint seed;
    float anisotropy;
    uint columns_rows; // 16 bits each
    uint slices_cull; // 16 bits; the upper ones of the radiance that a pixel may lose
    float nearest;  // about where slices begin to grow
    float farthest; // where they end
} constants;

// By the kernel medium_scatter what a froxel scatters towards the camera per unit of length (rgb), and its
// extinction (a). By medium_integrate what arrives of all from the camera to the froxel's far side, and the
// part that is let through.
layout(set = 0, binding = FROXELS_BINDING, rgba16f) uniform image3D froxels;

uint slice_count() {
    return constants.slices_cull & 0xffffu;
}

ivec3 froxel_counts() {
    return ivec3(constants.columns_rows & 0xffffu, constants.columns_rows >> 16, slice_count());
}

// The distance at which a slice begins; slices are even to about `nearest`, then each is longer by a factor.
float slice_distance(float slice) {
    float growth = log2(1.0 + constants.farthest / constants.nearest);
    return constants.nearest * (exp2(growth * slice / float(slice_count())) - 1.0);
}

// Its inverse.
float distance_slice(float distance) {
    float growth = log2(1.0 + constants.farthest / constants.nearest);
    return float(slice_count()) * log2(1.0 + distance / constants.nearest) / growth;
}

#endif
