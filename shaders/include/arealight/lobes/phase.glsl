#ifndef AREALIGHT_PHASE_GLSL
#define AREALIGHT_PHASE_GLSL

#include "arealight/common.glsl"

// What stands for Henyey and Greenstein's phase function: a uniform part, one clamped cosine forwards or from
// |g| = AREALIGHT_PHASE_KNEE on two, and one backwards of negative weight, all about one axis and stretched
// across it.
//
// The integral over the sphere of the error is .0008 at |g| = .1, .006 at .3, .009 at .5, .006 at .7, .005 at
// .8, .01 at .9, .03 at .95; half of that is the most that a light's share of 1 is off. 0 is exact, and a
// light all around gives 1. Source: arealight_fit::phase in Rust, `arealight fit --phase`; there and here the
// same.

// The largest |g| that is shaded; larger ones count as this.
const float AREALIGHT_MAX_ANISOTROPY = 0.95;

// Powers of |g|, above the knee of |g| - knee: of the first lobe forwards, the narrower one, the one
// backwards.
const float AREALIGHT_PHASE_KNEE = 0.6;
const vec3 AREALIGHT_PHASE_STRETCH_LOW[4] = vec3[4](
    vec3(0.998048, 0.3, 1.00083),
    vec3(-0.375246, 0.0, 0.410717),
    vec3(-0.716996, 0.0, -0.664347),
    vec3(0.105049, 0.0, 0.440699));
const vec3 AREALIGHT_PHASE_WEIGHT_LOW[5] = vec3[5](
    vec3(0.0, 0.0, 0.0),
    vec3(0.732296, 0.0, -0.767405),
    vec3(1.6591, 0.0, 1.64278),
    vec3(-1.72435, 0.0, -0.750854),
    vec3(0.156885, 0.0, -0.285696));
const vec3 AREALIGHT_PHASE_STRETCH_HIGH[4] = vec3[4](
    vec3(0.537472, 0.358721, 1.10329),
    vec3(-0.811065, 0.00573923, 0.13935),
    vec3(3.63719, -3.96415, -1.54567),
    vec3(-10.3322, 4.43207, 5.53119));
const vec3 AREALIGHT_PHASE_WEIGHT_HIGH[5] = vec3[5](
    vec3(0.684526, 0.0, -0.0682529),
    vec3(0.378191, 0.697644, 0.206883),
    vec3(-30.9886, 30.2938, 0.0260293),
    vec3(138.699, -139.395, -0.791751),
    vec3(-183.978, 185.452, 1.15065));

struct ArealightPhaseLobes {
    float even;   // the uniform part's weight; with the others' the sum is 1
    vec3 stretch; // of each lobe across its axis
    vec3 weight;  // of each lobe
};

// The lobes of a phase function's g, the mean cosine of the angle by which light is turned: of either sign,
// of which the axis is to take care. NaN counts as 0.
ArealightPhaseLobes arealight_phase_lobes(float g) {
    float size = abs(g) > 0.0 ? min(abs(g), AREALIGHT_MAX_ANISOTROPY) : 0.0;
    bool high = size > AREALIGHT_PHASE_KNEE;
    float x = high ? size - AREALIGHT_PHASE_KNEE : size;
    ArealightPhaseLobes lobes = ArealightPhaseLobes(0.0, vec3(0.0), vec3(0.0));
    for (int i = 3; i >= 0; i--) {
        lobes.stretch = lobes.stretch * x + (high ? AREALIGHT_PHASE_STRETCH_HIGH[i]
                                                  : AREALIGHT_PHASE_STRETCH_LOW[i]);
    }
    for (int i = 4; i >= 0; i--) {
        lobes.weight = lobes.weight * x + (high ? AREALIGHT_PHASE_WEIGHT_HIGH[i]
                                                : AREALIGHT_PHASE_WEIGHT_LOW[i]);
    }
    lobes.even = 1.0 - (lobes.weight.x + lobes.weight.y + lobes.weight.z);
    return lobes;
}

// Henyey and Greenstein's phase function itself, 1/sr, of the cosine between the directions before and after;
// g in (-1, 1).
float arealight_henyey_greenstein(float g, float cosine) {
    float square = max(1.0 + g * (g - 2.0 * cosine), 1e-12);
    return (1.0 - g * g) * 0.25 * AREALIGHT_INVERSE_PI / (square * sqrt(square));
}

#endif
