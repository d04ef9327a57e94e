#version 460
#extension GL_GOOGLE_include_directive : require

// The kernel shadow_rays of scenes with triangles that are cut out or blended: what is there of them is in
// the scene's buffers, in set 1.
#define AREALIGHT_HOST_ALPHA 1
#include "shadow_rays.comp"
