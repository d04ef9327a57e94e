#version 450
#extension GL_GOOGLE_include_directive : require

// How far lights of records are of any matter: the radius and the box of each, polygons and then shapes.

layout(local_size_x = 8) in;

#define LIGHTS_BINDING 0
#define SHAPES_BINDING 1
#include "light_reach.glsl"

struct Asked {
    uint light_count;
    uint shape_count;
    float threshold;
    float density;
};

layout(set = 0, binding = 2, std430) readonly buffer AskedOf {
    Asked asked[];
};
layout(set = 0, binding = 3, std430) writeonly buffer Results {
    float results[];
};
layout(push_constant, std430) uniform Constants {
    uint count;
} constants;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    Asked of = asked[0];
    LightReach reach;
    if (index < of.light_count) {
        reach = reach_of(lights[index], of.threshold, of.density);
    } else {
        reach = reach_of(shapes[index - of.light_count], of.threshold, of.density);
    }
    results[7u * index] = reach.radius;
    for (int axis = 0; axis < 3; axis++) {
        results[7u * index + 1u + uint(axis)] = reach.low[axis];
        results[7u * index + 4u + uint(axis)] = reach.high[axis];
    }
}
