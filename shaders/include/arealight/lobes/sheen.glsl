#ifndef AREALIGHT_SHEEN_GLSL
#define AREALIGHT_SHEEN_GLSL

#include "arealight/lobes/formula.glsl"
#include "arealight/lobes/lobe.glsl"

// At levels with more than one specular lobe it is two lobes, and the second takes light away: Charlie has a
// hole about the mirror direction.

// The smallest sheen roughness; a smaller one counts as this. Below it the lobe is seen at grazing angles
// alone.
const float AREALIGHT_SHEEN_MIN_ROUGHNESS = 0.07;

// Entries (q00 - 1) / sin^2, q02 / sin, q20 / sin, q22 of the one lobe, sin being that of the view: the cubic
// of arealight_formula_cubic in AREALIGHT_SHEEN_MIN_ROUGHNESS / roughness and the view's cosine.
const vec4 AREALIGHT_SHEEN_LOBE[10] = vec4[10](
    vec4(-0.0267666, 0.293183, 0.0270966, 1.45411),
    vec4(0.0837258, -1.53275, -0.521527, -1.00096),
    vec4(-1.93149, 2.76252, 2.16498, 1.33838),
    vec4(2.69006, -1.52679, -2.40386, -0.692998),
    vec4(2.40305, -6.30596, 0.584988, 3.75839),
    vec4(7.7175, 20.6398, 3.45546, -12.1357),
    vec4(-1.80104, -22.1208, 0.380597, 14.7094),
    vec4(-2.85413, -8.55474, -3.64936, 24.8031),
    vec4(0.275537, -118.524, -2.21212, -12.7155),
    vec4(1.08156, 6.405, 2.79909, -15.2336));

// Likewise of the first of two lobes, and of the second, which takes this part of the albedo away from it.
const vec4 AREALIGHT_SHEEN_FIRST_LOBE[10] = vec4[10](
    vec4(-0.13149, 0.361569, 0.0752426, 1.31949),
    vec4(0.0795685, -0.750933, -0.507509, -1.0286),
    vec4(-0.797448, 1.23546, 1.07581, 1.66252),
    vec4(0.822861, -0.777411, -1.23096, -0.977043),
    vec4(1.15234, -2.78307, -0.922504, 3.82266),
    vec4(3.37522, 4.03748, 3.75964, -8.12919),
    vec4(-0.434047, -3.39555, 2.05407, 9.60216),
    vec4(-1.44889, -3.17878, 0.119249, 19.0531),
    vec4(0.757793, -67.8161, -2.09296, -12.5886),
    vec4(0.51529, 2.82687, 0.574435, -12.1523));
const vec4 AREALIGHT_SHEEN_HOLE[10] = vec4[10](
    vec4(0.278544, 1.59541, 0.20479, 1.31666),
    vec4(-1.72316, -3.21944, -1.83265, -1.42049),
    vec4(1.86359, 3.12397, 4.81223, 2.68942),
    vec4(-1.25023, -0.213376, -3.4335, -1.23521),
    vec4(-2.70468, -4.03953, -2.25019, -3.96172),
    vec4(2.36349, 7.43148, 9.86338, -1.06574),
    vec4(2.96525, 1.01746, -12.8099, -5.95062),
    vec4(3.645, 11.4033, 2.76699, 15.824),
    vec4(1.70914, -48.2181, -5.23448, 29.5173),
    vec4(-1.60811, -5.13065, -1.12835, -9.8566));
const float AREALIGHT_SHEEN_HOLE_SHARE = 0.25;

// L(x) = a / (1 + b x^c) + d x + e of the masking of Charlie, for p = (1 - alpha)^2 = 0 and 1: (a, b, c, d),
// e.
const vec4 AREALIGHT_SHEEN_MASKING[2] = vec4[2](
    vec4(21.5473, 3.82987, 0.19823, -1.9776),
    vec4(25.3245, 3.32435, 0.16801, -1.27393));
const vec2 AREALIGHT_SHEEN_MASKING_OFFSET = vec2(-4.32054, -4.85967);

// Lambda of a cosine in (0, 1] and a sheen roughness in (0, 1]. Source: KHR_materials_sheen.
float arealight_sheen_masking(float cosine, float roughness) {
    float from_one = 1.0 - roughness * roughness;
    float p = from_one * from_one;
    vec4 c = mix(AREALIGHT_SHEEN_MASKING[0], AREALIGHT_SHEEN_MASKING[1], p);
    float offset = mix(AREALIGHT_SHEEN_MASKING_OFFSET.x, AREALIGHT_SHEEN_MASKING_OFFSET.y, p);
    float x = min(cosine, 1.0 - cosine);
    float exponent = c.x / (1.0 + c.y * pow(x, c.z)) + c.w * x + offset;
    float half_exponent = c.x / (1.0 + c.y * pow(0.5, c.z)) + c.w * 0.5 + offset;
    return exp(cosine < 0.5 ? exponent : 2.0 * half_exponent - exponent);
}

// What sheen of colour 1 reflects of light from everywhere, from 0 on; at grazing views of low roughness
// Charlie gains energy, up to 2.9. For a roughness in [AREALIGHT_SHEEN_MIN_ROUGHNESS, 1] and a view's cosine
// in [AREALIGHT_FORMULA_MIN_COS_VIEW, 1].
//
// 1 / (4 cos (1 + Lambda)), which is what makes Charlie's albedo steep at grazing views, times the
// exponential of a polynomial of degree 5 in AREALIGHT_SHEEN_MIN_ROUGHNESS / roughness and the square root of
// the view's cosine. Error: 1.5e-3 on average over roughnesses and view angles, 6.5e-3 at most.
float arealight_sheen_albedo(float roughness, float cos_view) {
    float u = AREALIGHT_SHEEN_MIN_ROUGHNESS / roughness;
    float y = sqrt(cos_view);
    float row0 = 0.474986 + y * (-0.81853 + y * (3.2161 + y * (-8.37422 + y * (9.68834 - 3.20163 * y))));
    float row1 = 7.47217 + y * (2.63793 + y * (-47.5624 + y * (74.5765 - 55.2354 * y)));
    float row2 = -10.4407 + y * (-6.65814 + y * (31.3788 - 39.6479 * y));
    float row3 = 7.45288 + y * (4.95557 - 6.39439 * y);
    float row4 = -0.7258 - 1.88308 * y;
    float exponent = row0 + u * (row1 + u * (row2 + u * (row3 + u * (row4 - 1.06969 * u))));
    return exp(exponent) / (4.0 * cos_view * (1.0 + arealight_sheen_masking(cos_view, roughness)));
}

// The space of a lobe of these coefficients, from the shading frame: its own surface's, since Charlie does
// not lean towards the mirror direction. At the normal it is symmetric about it. For the ranges of
// arealight_sheen_albedo; determinants are above 0 at every one.
mat3 arealight_sheen_space(vec4 coefficients[10], ArealightFrame frame, float roughness, float cos_view) {
    vec4 entries = arealight_formula_cubic(coefficients, AREALIGHT_SHEEN_MIN_ROUGHNESS / roughness, cos_view);
    float s = frame.sin_view;
    return mat3(1.0 + s * s * entries.x, 0.0, s * entries.z, 0.0, 1.0, 0.0, s * entries.y, 0.0, entries.w);
}

// Sheen's lobes.
struct ArealightSheenLayer {
    ArealightLobe lobe; // the one, or the first of two
    ArealightLobe hole; // the second, with AREALIGHT_HAS_TWO_SHEEN_LOBES alone: its albedo is 0 or below
    float base;         // of the light that the lobes below get, in [0, 1]
};

// Sheen's lobes, and what they keep from the lobes below: radiance = sheen + base * those. The part of the
// light that the base gets is a scalar of the view alone, the same for each channel: 1 - the largest channel
// of the colour times the albedo, from 0 on.
//
// Mean error of the reflected radiance, for a colour of 1 and random quads of unit radiance, roughness 0.1 to
// 1: .6e-3 by two lobes, 1.8e-3 by one. No sampler, no memory. Source: docs/decisions/0019-sheen.md.
ArealightSheenLayer arealight_sheen_layer(ArealightFrame frame, ArealightSheen sheen) {
    float roughness = arealight_clamped_roughness(sheen.roughness, AREALIGHT_SHEEN_MIN_ROUGHNESS);
    float cos_view = max(frame.cos_view, AREALIGHT_FORMULA_MIN_COS_VIEW);
    float albedo = arealight_sheen_albedo(roughness, cos_view);
    float base = max(1.0 - arealight_max_component(sheen.color) * albedo, 0.0);
    vec3 color = sheen.color * albedo;
    if (!AREALIGHT_HAS_TWO_SHEEN_LOBES) {
        ArealightLobe lobe = arealight_lobe(arealight_sheen_space(AREALIGHT_SHEEN_LOBE, frame, roughness,
                                                                  cos_view), color);
        return ArealightSheenLayer(lobe, lobe, base);
    }
    mat3 first = arealight_sheen_space(AREALIGHT_SHEEN_FIRST_LOBE, frame, roughness, cos_view);
    mat3 hole = arealight_sheen_space(AREALIGHT_SHEEN_HOLE, frame, roughness, cos_view);
    return ArealightSheenLayer(arealight_lobe(first, (1.0 + AREALIGHT_SHEEN_HOLE_SHARE) * color),
                               arealight_lobe(hole, -AREALIGHT_SHEEN_HOLE_SHARE * color), base);
}

#endif
