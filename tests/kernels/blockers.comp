#version 450
#extension GL_GOOGLE_include_directive : require

// Distances of blockers along rays: an invocation per ray.

layout(local_size_x = 64) in;

#define BLOCKER_NODES_BINDING 0
#define BLOCKER_TRIANGLES_BINDING 1
#include "blockers.glsl"

struct Ray {
    vec4 origin;
    vec4 direction; // and in w the distance up to which something may block
};

layout(set = 0, binding = 2, std430) readonly buffer Rays {
    Ray rays[];
};
layout(set = 0, binding = 3, std430) writeonly buffer Distances {
    float distances[];
};

layout(push_constant, std430) uniform BlockerConstants {
    uint count;
} constants;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    Ray ray = rays[index];
    distances[index] = arealight_bridge_blocker(ray.origin.xyz, ray.direction.xyz, ray.direction.w);
}
