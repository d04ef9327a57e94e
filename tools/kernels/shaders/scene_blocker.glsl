#ifndef SCENE_BLOCKER_GLSL
#define SCENE_BLOCKER_GLSL

// What blocks light in a scene: a bridge for shadow rays over the scene's own buffers. The including kernel
// defines SCENE_BINDING, as scene.glsl has it.

#include "scene.glsl"
#include "arealight/shadows/coverage.glsl"
#include "arealight/shadows/ray_origin.glsl"

// Both faces of a triangle block, by its alpha.
void bvh_meet_triangle(uint index, vec3 origin, vec3 direction, inout BvhHit hit) {
    ArealightGpuTriangle triangle = triangles[index];
    BvhHit met;
    if (bvh_intersect(triangle.p0, triangle.p1, triangle.p2, index, origin, direction, hit.distance, met)
        && arealight_hides(surface_alpha(triangle, met.barycentric), direction, index + 1u)) {
        hit = met;
    }
}

// The distance of a blocker, not always the nearest, on the way from `origin`, relative to the lights'
// origin, along a unit direction to a light at `distance`; `distance` if there is none.
float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance) {
    BvhHit hit = bvh_trace(origin, direction, distance * AREALIGHT_RAY_PART, true);
    return hit.triangle == BVH_NO_TRIANGLE ? distance : hit.distance;
}

#endif
