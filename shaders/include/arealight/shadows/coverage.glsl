#ifndef AREALIGHT_COVERAGE_GLSL
#define AREALIGHT_COVERAGE_GLSL

// Surfaces that are cut out, or thin as a veil, before a light.

#include "arealight/shadows/sequence.glsl"

// Whether a surface with a coverage of `alpha`, 0 to 1, hides what is behind it along a ray of this
// unit direction: always or never at 1 and 0, else by a hash of the direction and of the surface's number
// (pcg3d, Jarzynski and Olano 2020). Over rays the part `alpha` is hidden, and of two surfaces one behind the
// other each by a chance of its own, so that on average light arrives by the product of what they let
// through. NaN hides nothing.
bool arealight_hides(float alpha, vec3 direction, uint surface) {
    if (alpha <= 0.0 || alpha >= 1.0) {
        return alpha > 0.0;
    }
    uvec3 hash = (floatBitsToUint(direction) + surface * 2654435769u) * 1664525u + 1013904223u;
    hash.x += hash.y * hash.z;
    hash.y += hash.z * hash.x;
    hash.z += hash.x * hash.y;
    hash ^= hash >> 16u;
    hash.x += hash.y * hash.z;
    return arealight_fraction(hash.x) < alpha;
}

#endif
