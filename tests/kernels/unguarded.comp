#version 450
#extension GL_GOOGLE_include_directive : require

// What the library's guard is there for: the same arcs, with a clamp where the guard was, and without either.

layout(local_size_x = 64) in;

#include "arealight/form_factor/arc.glsl"

layout(set = 0, binding = 0, std430) readonly buffer Vertices {
    vec4 vertices[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Results {
    vec4 results[];
};

layout(push_constant, std430) uniform UnguardedConstants {
    uint count;
} constants;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    vec3 from = arealight_unit(vertices[4u * index + 3u].xyz);
    vec3 arcs = vec3(0.0);
    for (uint i = 0u; i < 4u; i++) {
        vec3 to = arealight_unit(vertices[4u * index + i].xyz);
        arcs += arealight_arc(from, to);
        from = to;
    }
    float form_factor = AREALIGHT_PER_ARC * arcs.z;
    results[index] = vec4(form_factor, clamp(form_factor, 0.0, 1.0), 0.0, 0.0);
}
