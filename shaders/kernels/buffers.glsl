#ifndef BUFFERS_GLSL
#define BUFFERS_GLSL

// Structures that the CPU writes: crates/arealight/src/gpu.rs has the same, and a test compares the offsets.

struct ArealightGpuLight {
    vec3 radiance;
    uint first_vertex;
    vec3 center;
    float radius;
    vec3 area;
    uint vertex_count;
    uint flags;
    uint reserved0;
    uint reserved1;
    uint reserved2;
};

const uint LIGHT_TWO_SIDED = 1u;

#endif
