// What is there of a scene's triangles that have a number: for shadow_rays.comp, from the scene's buffers.
#define SCENE_SET 1
#define SCENE_BINDING 0
#include "scene.glsl"

float arealight_bridge_alpha(uint instance, uint triangle, vec2 barycentric) {
    return surface_alpha(triangles[triangle - 1u], barycentric);
}
