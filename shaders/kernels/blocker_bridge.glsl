#ifndef BLOCKER_BRIDGE_GLSL
#define BLOCKER_BRIDGE_GLSL

// What blocks a ray: the host's own shader, its acceleration structure, or arealight::Blockers.

// 1: the host's own shader says what blocks a ray.
#ifndef AREALIGHT_HOST_BLOCKER
#define AREALIGHT_HOST_BLOCKER 0
#endif
// 1: an acceleration structure of the host's does.
#ifndef AREALIGHT_RAY_QUERY
#define AREALIGHT_RAY_QUERY 0
#endif

#if AREALIGHT_HOST_BLOCKER
// Of the host: the distance of something that blocks a ray from `origin` (relative to what positions are
// relative to) along `direction`, unit, before `distance`; else `distance` or more. A host that knows only
// whether there is something returns 0 then. It lies in an include folder of the host's compiler; what it
// reads is in descriptor set 1.
float arealight_bridge_blocker(vec3 origin, vec3 direction, float distance);
#include "host_blocker.glsl"
#elif AREALIGHT_RAY_QUERY
#include "blockers_ray_query.glsl"
#else
#include "blockers.glsl"
#endif

#endif
