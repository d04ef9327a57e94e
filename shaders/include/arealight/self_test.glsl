#ifndef AREALIGHT_SELF_TEST_GLSL
#define AREALIGHT_SELF_TEST_GLSL

// Ten shading points with the answers of float64, for a host's own shader to run with its own bridges:
// whether the table is loaded as it should be. A table with missing layers, whose axes are swapped, or which
// is read as sRGB makes a picture that is only darker. examples/self_test.comp runs it. It is for the default
// options: of the specular lobe alone, from the table, as one lobe.

#include "arealight/lights/quad.glsl"
#include "arealight/material.glsl"

const int AREALIGHT_SELF_TEST_POINTS = 10;
// What an answer may be off by, relative to the largest channel: half floats are off by 4e-4, a table of 32
// nodes a side by 4e-3.
const float AREALIGHT_SELF_TEST_TOLERANCE = 1e-2;

// Direction to the viewer; perceptual roughness.
const vec4 AREALIGHT_SELF_TEST_VIEWS[10] = vec4[10](
    vec4(0.0, 0.0, 1.0, 0.5), vec4(0.6, 0.0, 0.8, 0.3), vec4(0.8, 0.0, 0.6, 0.7),
    vec4(0.96, 0.0, 0.28, 0.2), vec4(0.96, 0.0, 0.28, 0.9), vec4(0.28, 0.0, 0.96, 0.1),
    vec4(0.28, 0.0, 0.96, 1.0), vec4(0.0, 0.6, 0.8, 0.6), vec4(-0.8, 0.0, 0.6, 0.4),
    vec4(0.995, 0.0, 0.0999, 0.5));
// Reflectance at normal incidence.
const vec3 AREALIGHT_SELF_TEST_F0[10] = vec3[10](
    vec3(0.9, 0.6, 0.3), vec3(0.9, 0.6, 0.3), vec3(0.04, 0.04, 0.04), vec3(0.04, 0.04, 0.04),
        vec3(0.8, 0.8, 0.9),
    vec3(0.95, 0.9, 0.8), vec3(0.5, 0.5, 0.5), vec3(0.04, 0.04, 0.04), vec3(0.7, 0.3, 0.1),
        vec3(0.2, 0.2, 0.2));
// Rectangles of unit radiance: centers, and half of each side.
const vec3 AREALIGHT_SELF_TEST_CENTERS[10] = vec3[10](
    vec3(0.0, 0.0, 2.0), vec3(-1.5, 0.0, 1.8), vec3(-1.5, 0.5, 1.0), vec3(-2.0, 0.1, 0.6),
        vec3(-1.0, 0.3, 0.8),
    vec3(-0.55, 0.0, 2.0), vec3(0.4, 1.0, 1.2), vec3(0.3, -1.2, 1.1), vec3(1.6, -0.2, 1.0),
        vec3(-1.4, -0.4, 0.5));
const vec3 AREALIGHT_SELF_TEST_HALVES_U[10] = vec3[10](
    vec3(0.5, 0.0, 0.0), vec3(0.0, 0.6, 0.0), vec3(0.0, 0.8, 0.0), vec3(0.0, 0.9, 0.0), vec3(0.0, 0.7, 0.0),
    vec3(0.4, 0.0, 0.0), vec3(0.9, 0.0, 0.0), vec3(-0.8, 0.0, 0.0), vec3(0.0, -0.7, 0.0),
        vec3(0.0, 0.8, 0.0));
const vec3 AREALIGHT_SELF_TEST_HALVES_V[10] = vec3[10](
    vec3(0.0, -0.5, 0.0), vec3(0.5, 0.0, 0.5), vec3(0.3, 0.0, 0.6), vec3(0.1, 0.0, 0.5), vec3(0.4, 0.0, 0.5),
    vec3(0.0, -0.4, 0.0), vec3(0.0, -0.5, 0.4), vec3(0.0, 0.3, 0.5), vec3(-0.2, 0.0, 0.6),
        vec3(0.0, 0.0, 0.8));
// What is reflected, in float64.
const vec3 AREALIGHT_SELF_TEST_ANSWERS[10] = vec3[10](
    vec3(0.204311820, 0.136210142, 0.068108463), vec3(0.687826604, 0.458758969, 0.229691334),
        vec3(0.009917959, 0.009917959, 0.009917959),
    vec3(0.206355886, 0.206355886, 0.206355886), vec3(0.106919034, 0.106919034, 0.119933446),
        vec3(0.941347369, 0.891802796, 0.792713649),
    vec3(0.024654984, 0.024654984, 0.024654984), vec3(0.011057375, 0.011057375, 0.011057375),
        vec3(0.418419854, 0.183879639, 0.066609532),
    vec3(0.201004664, 0.201004664, 0.201004664));

// What the library makes of a point: black, but for its specular lobe.
vec3 arealight_self_test_radiance(int index) {
    ArealightSurface surface;
    surface.position = vec3(0.0);
    surface.normal = vec3(0.0, 0.0, 1.0);
    surface.view = AREALIGHT_SELF_TEST_VIEWS[index].xyz;
    surface.roughness = AREALIGHT_SELF_TEST_VIEWS[index].w;
    surface.diffuse_albedo = vec3(0.0);
    surface.f0 = AREALIGHT_SELF_TEST_F0[index];
    surface.f90 = 1.0;
    surface.interface_f0 = 0.0;
    surface.interface_f90 = 0.0;
    surface.diffuse_roughness = 0.0;
    surface.coat = ArealightCoat(vec3(0.0), 0.0, 0.0);
    surface.anisotropy = ArealightAnisotropy(vec3(0.0), surface.roughness);
    surface.sheen = ArealightSheen(vec3(0.0), 0.0);
    vec3 u = AREALIGHT_SELF_TEST_HALVES_U[index];
    vec3 v = AREALIGHT_SELF_TEST_HALVES_V[index];
    ArealightQuadLight light;
    light.radiance = vec3(1.0);
    light.center = AREALIGHT_SELF_TEST_CENTERS[index];
    light.normal = normalize(cross(u, v));
    light.quad = ArealightQuad(-u - v, u - v, u + v, v - u);
    light.two_sided = false;
    return arealight_radiance(arealight_point(surface), light);
}

// A bit for each point whose radiance is wrong, the first in the lowest: 0 where all are right.
uint arealight_self_test() {
    uint wrong = 0u;
    for (int index = 0; index < AREALIGHT_SELF_TEST_POINTS; index++) {
        vec3 answer = AREALIGHT_SELF_TEST_ANSWERS[index];
        vec3 off = abs(arealight_self_test_radiance(index) - answer);
        float largest = max(answer.r, max(answer.g, answer.b));
        // NaN is wrong, too
        bool is_right = max(off.r, max(off.g, off.b)) <= AREALIGHT_SELF_TEST_TOLERANCE * largest;
        wrong |= is_right ? 0u : 1u << uint(index);
    }
    return wrong;
}

#endif
