#ifndef AREALIGHT_FORMULA_GLSL
#define AREALIGHT_FORMULA_GLSL

#include "arealight/lobes/table.glsl"

// GGX without a table: what arealight_table_lookup answers, by polynomials and two ratios of them.

// The smallest cosine of a view for which entries and albedos are asked: exactly at the horizon a lobe
// degenerates.
const float AREALIGHT_FORMULA_MIN_COS_VIEW = 1e-3;

// Coefficients, as `arealight fit --formula` prints them; what they mean is told at
// arealight::table::Formula.
const vec4 AREALIGHT_FORMULA_LOBE[10] = vec4[10](
    vec4(0.000106325, -0.000173203, 0.798099, 0.000232858),
    vec4(0.888402, 0.222552, -0.393555, 1.87183),
    vec4(0.220809, -0.397026, 1.45862, 0.185503),
    vec4(-0.103141, 0.163481, -1.9671, -0.0510923),
    vec4(1.09508, -3.4479, 2.86341, 1.2254),
    vec4(-0.733183, 2.53892, -3.27869, -0.885117),
    vec4(-0.576453, 1.27706, 1.01414, -0.134502),
    vec4(-0.337482, 1.59226, -1.65787, -2.2709),
    vec4(1.13581, -3.18903, 1.80408, 0.0346131),
    vec4(-0.881539, 1.05982, -0.469445, 1.09021));
const vec4 AREALIGHT_FORMULA_SCHLICK_LOBE[10] = vec4[10](
    vec4(-0.000282478, 0.000141569, 0.467144, -0.000226082),
    vec4(1.04274, -0.0829637, -1.34949, 1.93784),
    vec4(-1.06173, 1.99868, 2.24879, -1.23212),
    vec4(0.492686, -2.4267, -1.84783, 0.938178),
    vec4(0.884266, -2.44054, -0.974075, 1.39883),
    vec4(-0.897777, 7.21233, 0.0692134, -4.4182),
    vec4(-2.02054, 0.36344, -2.2511, 1.74401),
    vec4(4.58582, 1.83591, 3.41195, -1.20383),
    vec4(1.97124, -7.14248, 3.25115, 2.74964),
    vec4(-4.64039, 0.445416, -2.83275, 0.110711));
const float AREALIGHT_FORMULA_DIP[4] = float[4](
    0.221252, 0.616968, 0.113125, 0.307204);
const float AREALIGHT_FORMULA_ALBEDO[10] = float[10](
    1.00702, 0.796598, -0.91299, -0.0582205, -2.09435, 1.09497, 0.552113, 1.85779, -1.29729, -0.188006);
const float AREALIGHT_FORMULA_ALBEDO_DENOMINATOR[6] = float[6](
    1.0, 0.825253, -0.988757, -1.97244, 1.39829, 1.56562);
const float AREALIGHT_FORMULA_SCHLICK[6] = float[6](
    0.952818, -0.163929, 2.15186, -1.16622, -1.24023, 0.645299);
const float AREALIGHT_FORMULA_SCHLICK_DENOMINATOR[6] = float[6](
    1.0, -0.356565, 8.81801, -0.653119, -11.4369, 8.4293);

// Ten monomials 1, y, y^2, y^3, x, x y, x y^2, x^2, x^2 y, x^3, by Horner's rule in y, then in x.
vec4 arealight_formula_cubic(vec4 c[10], float x, float y) {
    vec4 row0 = c[0] + y * (c[1] + y * (c[2] + y * c[3]));
    vec4 row1 = c[4] + y * (c[5] + y * c[6]);
    vec4 row2 = c[7] + y * c[8];
    return row0 + x * (row1 + x * (row2 + x * c[9]));
}

float arealight_formula_cubic(float c[10], float x, float y) {
    float row0 = c[0] + y * (c[1] + y * (c[2] + y * c[3]));
    float row1 = c[4] + y * (c[5] + y * c[6]);
    float row2 = c[7] + y * c[8];
    return row0 + x * (row1 + x * (row2 + x * c[9]));
}

// 1, y, y^2, x, x y, x^2.
float arealight_formula_quadratic(float c[6], float x, float y) {
    return c[0] + y * (c[1] + y * c[2]) + x * (c[3] + y * c[4] + x * c[5]);
}

// GGX's lobes at a surface frame and a perceptual roughness (clamped to [0.01, 1]; NaN counts as 0.01).
// Entries and albedos of a view below AREALIGHT_FORMULA_MIN_COS_VIEW are those at it; the mirror frame in
// which arealight_table_space takes them stays the view's own, as it does with a table.
//
// Mean error of the reflected radiance over the fit's 3,000 quads, in thousandths: .66 at F0 = 0.04 and 2.85
// at 1; with a table of 64 x 64 nodes .54 and 2.13. The albedo is within 0.015 of the truth, 0.0023 on
// average, Schlick's within 0.05. Against the float64 twin, arealight::table::Formula::lookup: entries 9e-7
// of the largest, albedos 7e-7. Determinants are above 0 at every roughness, view and reflectance. Cost,
// counted in optimised SPIR-V: 99 multiply-adds, 7 more multiplications, 4 divisions; no sampler, no memory.
// Source: a least squares on the table, weighted by the curvature of the loss of the table's own fit:
// docs/fit.md.
ArealightTableSample arealight_formula_sample(ArealightFrame frame, float roughness) {
    roughness = arealight_clamped_roughness(roughness, sqrt(AREALIGHT_MIN_ALPHA));
    float alpha = roughness * roughness;
    float cosine = clamp(frame.cos_view, AREALIGHT_FORMULA_MIN_COS_VIEW, 1.0);

    // Matrices; the second entry vanishes with alpha
    ArealightTableSample result;
    result.matrix = arealight_formula_cubic(AREALIGHT_FORMULA_LOBE, alpha, cosine);
    result.schlick_matrix = arealight_formula_cubic(AREALIGHT_FORMULA_SCHLICK_LOBE, alpha, cosine);
    result.matrix.y *= alpha;
    result.schlick_matrix.y *= alpha;
    result.second_shares = vec2(0.0);

    // Albedo: smooth, less a dip where the cosine of the view is about alpha
    float x = cosine / alpha;
    float dip = AREALIGHT_FORMULA_DIP[0] * x /
                (1.0 + x * (AREALIGHT_FORMULA_DIP[1] + x
                            * (AREALIGHT_FORMULA_DIP[2] + x * AREALIGHT_FORMULA_DIP[3])));
    float smooth_part = arealight_formula_cubic(AREALIGHT_FORMULA_ALBEDO, alpha, cosine) /
                        arealight_formula_quadratic(AREALIGHT_FORMULA_ALBEDO_DENOMINATOR, alpha, cosine);
    result.albedo = clamp(smooth_part - dip, 0.0, 1.0);

    // Its Schlick part, which falls with the fourth power towards the normal
    float from_normal = (1.0 - cosine) * (1.0 - cosine);
    float ratio = arealight_formula_quadratic(AREALIGHT_FORMULA_SCHLICK, roughness, cosine) /
                  arealight_formula_quadratic(AREALIGHT_FORMULA_SCHLICK_DENOMINATOR, roughness, cosine);
    result.schlick = clamp(from_normal * from_normal * ratio, 0.0, result.albedo);
    result.alpha = alpha;
    return result;
}

#endif
