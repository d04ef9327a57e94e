#ifndef AREALIGHT_PROFILE_GLSL
#define AREALIGHT_PROFILE_GLSL

#include "arealight/form_factor/arc.glsl"
#include "arealight/options.glsl"

// A profile: a factor of a light's radiance, in [0, 1], by the angle from its front. Angles are measured by
// x = sine^2 * scale: 0 on the axis, 1 where the profile ends.

// The host's bridge to the rows of profiles. The first one is (scale, count of levels, piece scale, crowding,
// negative where it is not round). Of each level follows (x, factor, sum, squared tangent), sum being the
// factor's integral over x from 0; then of 64 pieces the beginning of each, (x, factor, sum, slope of the
// factor); then the end, (1, 0, sum, 0). With p = sqrt((1 - cosine) * piece scale) pieces are even in
// p * crowding / (1 + (crowding - 1) * p): narrower on the axis, for narrow beams.
//
// Where it is not round there follow the direction of azimuth 0, and of 33 places, even in p, what the factor
// is in parts of its mean about the normal: 1 and six harmonics of the azimuth, the cosine's and the sine's
// coefficients of two in a row.
vec4 arealight_bridge_profile(uint row);

const uint AREALIGHT_PROFILE_PIECES = 64u;
const uint AREALIGHT_AZIMUTH_PLACES = 32u;
const uint AREALIGHT_AZIMUTH_ROWS = 3u;

// x, factor and sum of a profile at a point at the squared distance `side` from the foot of a perpendicular
// of the squared length `height`; without cancellation.
vec3 arealight_profile_place(uint profile, float side, float height) {
    vec4 head = arealight_bridge_profile(profile);
    float square = max(side + height, AREALIGHT_LEAST_SQUARE);
    float x = head.x * side / square;
    float part = sqrt(min(head.z * side / (square + sqrt(square) * sqrt(height)), 1.0));
    part *= abs(head.w) / (1.0 + (abs(head.w) - 1.0) * part);
    uint piece = x < 1.0 ? min(uint(part * float(AREALIGHT_PROFILE_PIECES)), AREALIGHT_PROFILE_PIECES - 1u)
        : AREALIGHT_PROFILE_PIECES;
    vec4 row = arealight_bridge_profile(profile + 1u + uint(head.y) + piece);
    float step = x - row.x;
    float factor = row.y + row.w * step;
    return vec3(x, factor, row.z + 0.5 * (row.y + factor) * step);
}

// The row of the direction of azimuth 0 of a profile that is not round.
uint arealight_azimuth_row(uint profile, float levels) {
    return profile + uint(levels) + AREALIGHT_PROFILE_PIECES + 2u;
}

// Where a half angle's tangent is among a profile's pieces, in [0, 1].
float arealight_profile_part(float tangent, float piece_scale) {
    return tangent * sqrt(2.0 * piece_scale / (1.0 + tangent * tangent));
}

// What a profile that is not round is in the direction `side`, along the light's plane from the light, in
// parts of its mean about the normal. `row` is that of azimuth 0, `to_space` from the world to the space of
// `normal` and `side`; `part` is sqrt((1 - cosine) * piece scale). `gathered`: 1 at one azimuth, 0 all about
// the normal. Error: what more than six harmonics have, of a street lamp's two lobes 1 %, RMS over mean.
float arealight_profile_azimuth(uint row, mat3 to_space, vec3 normal, vec3 side, float part, float gathered) {
    vec3 azimuth = to_space * arealight_bridge_profile(row).xyz;
    // Counter-clockwise seen from behind
    vec3 right_angle = cross(azimuth, normal);
    vec2 turn = vec2(dot(azimuth, side), dot(right_angle, side));
    turn *= inversesqrt(max(dot(turn, turn), AREALIGHT_LEAST_SQUARE));
    float place = min(part, 1.0) * float(AREALIGHT_AZIMUTH_PLACES);
    uint low = min(uint(place), AREALIGHT_AZIMUTH_PLACES - 1u);
    uint first = row + 1u + AREALIGHT_AZIMUTH_ROWS * low;
    vec2 power = turn;
    float damped = 1.0;
    float next = gathered;
    float sum = 1.0;
    for (uint index = first; index < first + AREALIGHT_AZIMUTH_ROWS; index++) {
        vec4 harmonics = mix(arealight_bridge_profile(index),
                             arealight_bridge_profile(index + AREALIGHT_AZIMUTH_ROWS), place - float(low));
        // The harmonic m of a spread that leaves `gathered` of the first: that to the power m^2
        for (int half_row = 0; half_row < 2; half_row++) {
            damped *= next;
            next *= gathered * gathered;
            sum += damped * dot(half_row == 0 ? harmonics.xy : harmonics.zw, power);
            power = vec2(power.x * turn.x - power.y * turn.y, power.x * turn.y + power.y * turn.x);
        }
    }
    return max(sum, 0.0);
}

// The factor of a profile of a light's point at an offset from the shading point: of the light's own normal,
// from either side.
float arealight_profile_factor(uint profile, vec3 normal, vec3 offset) {
    float height = dot(normal, offset);
    vec3 side = offset - height * normal;
    float square = dot(side, side);
    float factor = arealight_profile_place(profile, square, height * height).y;
    vec4 head = arealight_bridge_profile(profile);
    if (AREALIGHT_HAS_AZIMUTHS && head.w < 0.0) {
        float whole = square + height * height;
        float part = sqrt(head.z * square / max(whole + sqrt(whole) * abs(height), AREALIGHT_LEAST_SQUARE));
        factor *= arealight_profile_azimuth(arealight_azimuth_row(profile, head.y), mat3(1.0), normal, -side,
                                            part, 1.0);
    }
    return factor;
}

#endif
