#ifndef AREALIGHT_RAY_ORIGIN_GLSL
#define AREALIGHT_RAY_ORIGIN_GLSL

// Where a shadow ray starts, so that it does not meet the surface that it leaves: a number of units in the
// last place of each coordinate away along the surface's geometric normal. Source: Waechter and Binder, A
// Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems 2019, chapter 6.

// Coordinates smaller than this move by a length, as their last place says nothing of the rounding that they
// went through.
const float AREALIGHT_ORIGIN_NEAR = 0.03125;
// That length, per unit of the normal.
const float AREALIGHT_ORIGIN_LENGTH = 1.52587890625e-5;
// Units in the last place, per unit of the normal.
const float AREALIGHT_ORIGIN_PLACES = 256.0;

// Where a shadow ray ends, as a part of the way to the light: 1 - 2^-12, before the light's own geometry,
// which may be there.
const float AREALIGHT_RAY_PART = 0.999755859375;

// The origin of a ray that leaves the surface at `position` on the side of `normal`, the unit normal of its
// geometry (not of its shading). `step`: by how much the position may be wrong along any axis beyond its own
// rounding, in its unit: 0 for positions in float32 and for reversed float depth; for other depth the
// distance between the positions of two neighbouring values, along the view.
//
// It is away from the position by up to 256 x 2^-23 = 3.1e-5 of each coordinate, or 1.5e-5 where that is
// larger, and 2 steps.
vec3 arealight_ray_origin(vec3 position, vec3 normal, float step) {
    ivec3 places = ivec3(AREALIGHT_ORIGIN_PLACES * normal);
    ivec3 bits = floatBitsToInt(position);
    // Away from zero are more bits, of either sign
    vec3 by_places = intBitsToFloat(bits + mix(places, -places, lessThan(position, vec3(0.0))));
    vec3 by_length = position + AREALIGHT_ORIGIN_LENGTH * normal;
    vec3 origin = mix(by_places, by_length, lessThan(abs(position), vec3(AREALIGHT_ORIGIN_NEAR)));
    return origin + 2.0 * step * normal;
}

#endif
