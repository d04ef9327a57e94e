#version 450
#extension GL_GOOGLE_include_directive : require

// Directions drawn over polygons: an invocation per draw, by the R2 sequence.

layout(local_size_x = 64) in;

#include "arealight/shadows/polygon_sampling.glsl"

// Draws of a polygon.
layout(constant_id = 0) const uint DRAWS = 1u;

struct SamplingArguments {
    vec4 vertices[AREALIGHT_SAMPLING_VERTICES];
};

layout(set = 0, binding = 0, std430) readonly buffer Arguments {
    SamplingArguments arguments[];
};
layout(set = 0, binding = 1, std430) writeonly buffer Results {
    vec4 results[]; // direction and area
};

layout(push_constant, std430) uniform SamplingConstants {
    uint count;
} constants;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    SamplingArguments given = arguments[index / DRAWS];
    ArealightSamplingPolygon polygon;
    for (int i = 0; i < AREALIGHT_SAMPLING_VERTICES; i++) {
        polygon.vertices[i] = given.vertices[i].xyz;
    }
    vec2 random = fract(0.5 + float(index % DRAWS) * vec2(0.7548776662, 0.5698402910));
    ArealightDraw draw = arealight_draw(polygon, random);
    results[index] = vec4(draw.direction, draw.area);
}
