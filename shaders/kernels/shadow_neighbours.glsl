#ifndef SHADOW_NEIGHBOURS_GLSL
#define SHADOW_NEIGHBOURS_GLSL

// What the kernels that take means of shadows over pixels have in common.

// Neighbours count as of the same surface by this part of the camera's distance out of its plane, and by a
// power of their normals' cosine.
const float PLANE_PART = 0.004;

// What likeness takes an offset out of the plane times, for a surface at a position.
float plane_scale(vec3 position) {
    return 1.0 / (PLANE_PART * camera_distance(position));
}

// How much a neighbour at an offset, with its normal, counts as of the surface of this normal and
// plane_scale, over e to the power of `exponent`.
float likeness(vec3 offset, vec3 neighbour, vec3 normal, float plane_scale, float exponent) {
    // The cosine to the power of 32
    float alike = max(dot(normal, neighbour), 0.0);
    alike *= alike;
    alike *= alike;
    alike *= alike;
    alike *= alike;
    return exp(-abs(dot(normal, offset)) * plane_scale - exponent) * alike * alike;
}

// A unit normal in a word, which is not 0; and out of it.
uint pack_normal(vec3 normal) {
    return packUnorm4x8(vec4(0.5 * normal + 0.5, 1.0));
}
vec3 unpack_normal(uint word) {
    return normalize(2.0 * unpackUnorm4x8(word).xyz - 1.0);
}

// The shading normal of a pixel at a position, unit.
vec3 load_normal(ivec2 pixel, vec3 position) {
    return arealight_normalize_or(load_surface(pixel, position, constants.camera).normal,
                                  vec3(0.0, 0.0, 1.0));
}

#endif
