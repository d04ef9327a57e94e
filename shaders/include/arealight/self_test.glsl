#ifndef AREALIGHT_SELF_TEST_GLSL
#define AREALIGHT_SELF_TEST_GLSL

// Ten shading points with the answers of float64, for a host's own shader to run with its own bridges:
// whether the table is loaded as it should be. A table with missing layers, whose axes are swapped, or which
// is read as sRGB makes a picture that is only darker. examples/self_test.comp runs it. It is of the specular
// lobe alone, as one lobe and, with AREALIGHT_TWO_SPECULAR_LOBES, as two; other options don't matter.

#include "arealight/form_factor/quad.glsl"
#include "arealight/lobes/specular.glsl"

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

// What two lobes reflect.
const vec3 AREALIGHT_SELF_TEST_ANSWERS_OF_TWO[10] = vec3[10](
    vec3(0.213402287, 0.142266219, 0.071130150), vec3(0.687013929, 0.458169684, 0.229325438),
    vec3(0.009024164, 0.009024164, 0.009024164), vec3(0.206087665, 0.206087665, 0.206087665),
    vec3(0.106664457, 0.106664457, 0.119099592), vec3(0.941257651, 0.891717799, 0.792638096),
    vec3(0.024182386, 0.024182386, 0.024182386), vec3(0.010693282, 0.010693282, 0.010693282),
    vec3(0.417355754, 0.184235769, 0.067675776), vec3(0.200455986, 0.200455986, 0.200455986));

// What the lobe of a texel of the table reflects of a quad in the shading frame.
float arealight_self_test_lobe(ArealightFrame frame, ArealightTableSample table, vec4 texel,
                               ArealightQuad quad) {
    mat3 space = arealight_table_space(frame, texel, table.alpha);
    return arealight_form_factor(arealight_quad_vector(arealight_transformed(space, quad), 1.0));
}

// What the table makes of a point, by one lobe or by two.
vec3 arealight_self_test_radiance(int index, bool has_two) {
    vec4 view = AREALIGHT_SELF_TEST_VIEWS[index];
    vec3 f0 = AREALIGHT_SELF_TEST_F0[index];
    ArealightFrame frame = arealight_surface_frame(vec3(0.0, 0.0, 1.0), view.xyz);
    mat3 to_frame = arealight_frame_matrix(frame);
    vec3 center = to_frame * AREALIGHT_SELF_TEST_CENTERS[index];
    vec3 u = to_frame * AREALIGHT_SELF_TEST_HALVES_U[index];
    vec3 v = to_frame * AREALIGHT_SELF_TEST_HALVES_V[index];
    ArealightQuad quad = ArealightQuad(center - u - v, center + u - v, center + u + v, center + v - u);
    ArealightTableSample table = arealight_table_lookup(frame, view.w, has_two);
    vec3 albedo = arealight_specular_albedo(table, f0, 1.0);
    vec4 texel = mix(table.matrix, table.schlick_matrix, arealight_schlick_share(table, f0, 1.0));
    if (has_two) {
        vec3 second = arealight_second_albedo(table, f0, 1.0, albedo);
        return (albedo - second) * arealight_self_test_lobe(frame, table, table.matrix, quad)
             + second * arealight_self_test_lobe(frame, table, table.schlick_matrix, quad);
    }
    return albedo * arealight_self_test_lobe(frame, table, texel, quad);
}

// Whether an answer is right. NaN is wrong, too.
bool arealight_self_test_agrees(vec3 radiance, vec3 answer) {
    return arealight_max_component(radiance - answer)
        <= AREALIGHT_SELF_TEST_TOLERANCE * arealight_max_component(answer);
}

// A bit for each point whose radiance is wrong, the first in the lowest: 0 where all are right.
uint arealight_self_test() {
    uint wrong = 0u;
    for (int index = 0; index < AREALIGHT_SELF_TEST_POINTS; index++) {
        bool is_right = arealight_self_test_agrees(arealight_self_test_radiance(index, false),
                                                   AREALIGHT_SELF_TEST_ANSWERS[index]);
        if (AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
            is_right = is_right && arealight_self_test_agrees(arealight_self_test_radiance(index, true),
                                                              AREALIGHT_SELF_TEST_ANSWERS_OF_TWO[index]);
        }
        wrong |= is_right ? 0u : 1u << uint(index);
    }
    return wrong;
}

#endif
