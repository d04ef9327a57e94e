#ifndef SHADOW_RESOURCES_GLSL
#define SHADOW_RESOURCES_GLSL

// What the kernels of shadows, shadow_rays, shadow_history and shadow_filter, have in common: a descriptor
// set, push constants, specialisation constants.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 15) const int SHADOW_RAYS = 1;
layout(constant_id = 19) const uint VIEW = 0u;

#include "bindings.glsl"
#define G_BUFFER_LAYOUT LAYOUT

layout(push_constant, std430) uniform ShadowConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint seed;
    uvec2 size;
} constants;

#define AREALIGHT_FOOTPRINT 0
#include "effects.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "g_buffer.glsl"
#include "position.glsl"
#include "camera.glsl"

// How far the camera is from a position: an orthographic one as far as the direction to it is long.
float camera_distance(vec3 position) {
    return IS_ORTHOGRAPHIC ? length(constants.camera) : distance(constants.camera, position);
}

// Of a pixel with light: what arrives of its luminance in r, from 0 to 1; the penumbra's width in g, over the
// distance to the camera, times the part that is hidden; 1 in b, and more by a bit for each ray that is
// hidden; and in a how many rays it has. Else zero.
layout(set = 0, binding = SHADOW_BINDING, rgba16f) uniform image2D shadow_image;

#endif
