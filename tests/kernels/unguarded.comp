#version 450
#extension GL_GOOGLE_include_directive : require

// What the library's guard is there for: the same arcs, with a clamp where the guard was, and without either.

layout(local_size_x = 64) in;

#include "arealight/arc.glsl"

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
    ArealightAnchor nowhere = arealight_anchor(vec3(0.0), 0.0, AREALIGHT_FORM_FACTOR_EXACT);
    ArealightVertex from = arealight_vertex(nowhere, vertices[4u * index + 3u].xyz, AREALIGHT_FORM_FACTOR_EXACT);
    float sum = 0.0;
    for (uint i = 0u; i < 4u; i++) {
        ArealightVertex to = arealight_vertex(nowhere, vertices[4u * index + i].xyz, AREALIGHT_FORM_FACTOR_EXACT);
        sum += arealight_arc(from, to, AREALIGHT_FORM_FACTOR_EXACT).z;
        from = to;
    }
    float form_factor = -sum * AREALIGHT_INVERSE_TWO_PI;
    results[index] = vec4(form_factor, clamp(form_factor, 0.0, 1.0), 0.0, 0.0);
}
