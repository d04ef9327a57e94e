#ifndef SRGB_GLSL
#define SRGB_GLSL

// Linear light from the encoding of IEC 61966-2-1.
vec3 linear_from_srgb(vec3 encoded) {
    vec3 high = pow((encoded + 0.055) / 1.055, vec3(2.4));
    return mix(high, encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

#endif
