#ifndef VISIBILITY_BRIDGE_GLSL
#define VISIBILITY_BRIDGE_GLSL

// 1: the host's own shader says what part of each light arrives: from shadow maps, or from anything that it
// knows.
#ifndef AREALIGHT_HOST_VISIBILITY
#define AREALIGHT_HOST_VISIBILITY 0
#endif

#if AREALIGHT_HOST_VISIBILITY
// Of the host: what part of a light arrives at a pixel's position (relative to what positions are relative
// to), per channel, from 0 to 1. `light` is the index of its record, of the polygons and meshes or, with
// `is_shape`, of the disks, spheres and tubes: PackedLights::order and shape_order have its place in the
// host's list. It lies in an include folder of the host's compiler; what it reads is in descriptor set 1.
vec3 arealight_bridge_visibility(ivec2 pixel, vec3 position, uint light, bool is_shape);
#include "host_visibility.glsl"
#endif

#endif
