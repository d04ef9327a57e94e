// What part of each light arrives in an engine that has shadows of its own: here a mask of each polygon light
// in a layer of an array, as engines keep what their shadow maps say. shaders/kernels/shade.comp includes it
// with AREALIGHT_HOST_VISIBILITY 1.

layout(set = 1, binding = 0) uniform texture2DArray shadow_masks;

vec3 arealight_bridge_visibility(ivec2 pixel, vec3 position, uint light, bool is_shape) {
    return is_shape ? vec3(1.0) : texelFetch(shadow_masks, ivec3(pixel, int(light)), 0).rrr;
}
