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
    uint texture_layer;
    uint reserved0;
    uint reserved1;
    vec3 texture_corner;
    uint reserved2;
    vec3 texture_axis_u;
    uint reserved3;
    vec3 texture_axis_v;
    uint reserved4;
    vec2 texture_low;
    vec2 texture_size;
};

const uint LIGHT_TWO_SIDED = 1u;
const uint LIGHT_FLAT = 2u; // its vertices lie in a plane, to 1e-4 of its size
const uint NO_LIGHT_TEXTURE = 0xffffffffu;

#endif
