#ifndef AREALIGHT_PROFILE_GLSL
#define AREALIGHT_PROFILE_GLSL

#include "arealight/form_factor/arc.glsl"

// A profile: a factor of a light's radiance, in [0, 1], by the angle from its front. Angles are measured by
// x = sine^2 * scale: 0 on the axis, 1 where the profile ends.

// The host's bridge to the rows of profiles. The first one is (scale, count of levels, piece scale, 0). Of
// each level follows (x, factor, sum, squared tangent), sum being the factor's integral over x from 0; then
// of 64 pieces the beginning of each, as wide as each other in sqrt((1 - cosine) * piece scale), (x, factor,
// sum, slope of the factor); at last the end, (1, 0, sum, 0).
vec4 arealight_bridge_profile(uint row);

const uint AREALIGHT_PROFILE_PIECES = 64u;

// x, factor and sum of a profile at a point at the squared distance `side` from the foot of a perpendicular
// of the squared length `height`; without cancellation.
vec3 arealight_profile_place(uint profile, float side, float height) {
    vec4 head = arealight_bridge_profile(profile);
    float square = max(side + height, AREALIGHT_LEAST_SQUARE);
    float x = head.x * side / square;
    float part = sqrt(min(head.z * side / (square + sqrt(square * height)), 1.0));
    uint piece = x < 1.0 ? min(uint(part * float(AREALIGHT_PROFILE_PIECES)), AREALIGHT_PROFILE_PIECES - 1u)
        : AREALIGHT_PROFILE_PIECES;
    vec4 row = arealight_bridge_profile(profile + 1u + uint(head.y) + piece);
    float step = x - row.x;
    float factor = row.y + row.w * step;
    return vec3(x, factor, row.z + 0.5 * (row.y + factor) * step);
}

// The factor of a profile of a light's point at an offset from the shading point: of the light's own normal,
// from either side.
float arealight_profile_factor(uint profile, vec3 normal, vec3 offset) {
    float height = dot(normal, offset);
    vec3 side = offset - height * normal;
    return arealight_profile_place(profile, dot(side, side), height * height).y;
}

#endif
