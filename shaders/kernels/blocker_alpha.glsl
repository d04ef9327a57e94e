#ifndef BLOCKER_ALPHA_GLSL
#define BLOCKER_ALPHA_GLSL

// Triangles that are cut out by a texture of the host's, with AREALIGHT_HOST_ALPHA 1.

#include "arealight/shadows/coverage.glsl"

// Of the host: what part of a triangle is there at a place, from 0 (light passes it) to 1. It is asked of
// triangles that have a number of their own (arealight::Blockers::with_alpha) or, in an acceleration
// structure, that are not opaque. It lies in host_alpha.glsl in an include folder of the host's compiler;
// what it reads is in descriptor set 1.
//
// `instance`: 0; in an acceleration structure the custom index of the instance, and the geometry's index
// within it is added. `triangle`: its number; in an acceleration structure that of the primitive.
// `barycentric`: weights of the second and the third vertex.
float arealight_bridge_alpha(uint instance, uint triangle, vec2 barycentric);
#include "host_alpha.glsl"

// Whether a triangle hides what is behind it along a ray of this unit direction.
bool blocker_hides(uint instance, uint triangle, vec2 barycentric, vec3 direction) {
    return arealight_hides(arealight_bridge_alpha(instance, triangle, barycentric), direction,
                           triangle ^ (instance << 16u));
}

#endif
