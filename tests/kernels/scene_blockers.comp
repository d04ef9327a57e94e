#version 450
#extension GL_GOOGLE_include_directive : require

// Distances of blockers along rays through a scene: an invocation per ray.

layout(local_size_x = 64) in;

#define SCENE_BINDING 0
#include "../../tools/kernels/shaders/scene_blocker.glsl"

struct Ray {
    vec4 origin;
    vec4 direction; // and in w the distance of the light
};

layout(set = 0, binding = 5, std430) readonly buffer Rays {
    Ray rays[];
};
layout(set = 0, binding = 6, std430) writeonly buffer Distances {
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
