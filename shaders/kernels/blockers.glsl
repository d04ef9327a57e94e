#ifndef BLOCKERS_GLSL
#define BLOCKERS_GLSL

// What blocks light, from buffers of arealight::Blockers: a bridge for shadow rays where the host has no
// acceleration structure of its own. The including kernel defines BLOCKER_NODES_BINDING and
// BLOCKER_TRIANGLES_BINDING.

#define BVH_NODES_BINDING BLOCKER_NODES_BINDING
#include "bvh.glsl"
// 1: the host's own shader says what is there of triangles that are cut out; else all of them is.
#ifndef AREALIGHT_HOST_ALPHA
#define AREALIGHT_HOST_ALPHA 0
#endif
#if AREALIGHT_HOST_ALPHA
#include "blocker_alpha.glsl"
#endif

// In w of the first vertex are the bits of the number that arealight_bridge_alpha is asked by; 0 for none.
struct ArealightGpuBlockerTriangle {
    vec4 vertices[3];
};

layout(set = 0, binding = BLOCKER_TRIANGLES_BINDING, std430) readonly buffer BlockerTriangles {
    ArealightGpuBlockerTriangle blocker_triangles[];
};

void bvh_meet_triangle(uint index, vec3 origin, vec3 direction, inout BvhHit hit) {
    ArealightGpuBlockerTriangle triangle = blocker_triangles[index];
    BvhHit met;
    if (bvh_intersect(triangle.vertices[0].xyz, triangle.vertices[1].xyz, triangle.vertices[2].xyz, index,
                      origin, direction,
                      hit.distance, met)) {
#if AREALIGHT_HOST_ALPHA
        uint number = floatBitsToUint(triangle.vertices[0].w);
        if (number != 0u && !blocker_hides(0u, number, met.barycentric, direction)) {
            return;
        }
#endif
        hit = met;
    }
}

// The distance of a blocker, not always the nearest, on the way from `origin`, relative to the lights'
// origin, along a unit direction; `distance` if there is none before it. Either face of a triangle blocks.
float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance) {
    return bvh_trace(origin, direction, distance, true).distance;
}

#endif
