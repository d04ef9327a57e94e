#ifndef LIGHT_RECORDS_GLSL
#define LIGHT_RECORDS_GLSL

// The records of lights, which the CPU writes: crates/arealight/src/gpu.rs has the same, and a test compares
// the offsets. The including kernel defines LIGHTS_BINDING, SHAPES_BINDING or both.

struct ArealightGpuLight {
    vec3 radiance;
    uint first_vertex;
    vec3 center;
    float radius;
    vec3 normal;
    float area; // over the radius squared
    uint vertex_count;
    uint flags;
    uint texture_layer;
    uint shaping; // the first row of its opening, with LIGHT_OPENING, and of its profile, with LIGHT_PROFILE
};

#ifdef LIGHTS_BINDING
layout(set = 0, binding = LIGHTS_BINDING, std430) readonly buffer Lights {
    ArealightGpuLight lights[];
};
#endif

const uint LIGHT_TWO_SIDED = 1u;
const uint LIGHT_FLAT = 2u; // its vertices lie in a plane, to 1e-4 of its size
const uint LIGHT_MESH = 4u; // several faces
const uint LIGHT_QUAD = 8u; // convex, of at most four vertices
const uint LIGHT_PROFILE = 16u; // the upper half of the flags is the cosine where it ends, of 65535
const uint LIGHT_OPENING = 32u; // it is seen through an opening
const uint LIGHT_SHAPED = 48u; // one or the other, or both
const uint NO_LIGHT_TEXTURE = 0xffffffffu;

struct ArealightGpuShape {
    vec3 radiance;
    uint kind;
    vec3 center;
    float radius;
    vec3 axis_u;
    uint detail; // of a tube its ends; of a disk the layer of its image
    vec3 axis_v;
    uint flags;
};

#ifdef SHAPES_BINDING
layout(set = 0, binding = SHAPES_BINDING, std430) readonly buffer Shapes {
    ArealightGpuShape shapes[];
};
#endif

const uint SHAPE_DISK = 0u;
const uint SHAPE_SPHERE = 1u;
const uint SHAPE_TUBE = 2u;

const uint SHAPE_TWO_SIDED = 1u;

// From here on, of either record's flags: the groups of surfaces that the light shines on, 0 for all.
const uint LIGHT_LINKS_SHIFT = 8u;

uint light_links(uint flags) {
    return (flags >> LIGHT_LINKS_SHIFT) & 0xffu;
}

// Whether a light shines on surfaces of these groups.
bool is_linked(uint flags, uint groups) {
    uint links = light_links(flags);
    return links == 0u || (links & groups) != 0u;
}

#endif
