#ifndef AREALIGHT_ANISOTROPY_GLSL
#define AREALIGHT_ANISOTROPY_GLSL

#include "arealight/lobes/specular.glsl"

// The lobes of an anisotropic GGX distribution, from the same table as isotropic ones, or from the formula in
// its place.
//
// Microsurfaces are stretches of one another, so that the visible normals of an anisotropic lobe at a view
// are those of an isotropic one at a stretched view (Heitz 2018, Sampling the GGX Distribution of Visible
// Normals). The matrix of the isotropic lobe, taken there, is brought over by the linear map that takes the
// directions which nine of these normals reflect in the one to those of the other, by least squares. Error:
// docs/materials.md.

// How much of the larger roughness the smaller one has at least: an aspect of alphas of 400. Narrower lobes
// are crescents, which no matrix is near to, and the matrices' condition is beyond float32.
const float AREALIGHT_LEAST_ROUGHNESS_RATIO = 0.05;

// The squared sine of a view at which Schlick's albedo has half of its alpha from the view's azimuth, and
// half from both alphas: at the normal there is no azimuth.
const float AREALIGHT_AZIMUTH_START = 0.02;

// Where the nine visible normals are on the unit disk that they are seen on: across the plane of incidence,
// and within it. They are symmetric about that plane, which keeps determinants above 0; and as nearly round
// as nine can be, so that hardly anything changes where they turn with the view's azimuth about the normal.
const vec2 AREALIGHT_VISIBLE_NORMALS[9] = vec2[9](
    vec2(0.0), vec2(0.75, 0.0), vec2(0.53033, 0.53033), vec2(0.0, 0.75), vec2(-0.53033, 0.53033),
        vec2(-0.75, 0.0),
    vec2(-0.53033, -0.53033), vec2(0.0, -0.75), vec2(0.53033, -0.53033));

// A direction to the viewer in the axes of the distribution: (sin_view azimuth, cos_view).
struct ArealightAxisView {
    vec2 azimuth; // unit, also at the normal
    float sin_view;
    float cos_view;
};

// The view of a surface whose axes are longer by `by`, above 0.
ArealightAxisView arealight_stretched_view(ArealightAxisView view, vec2 by) {
    vec2 azimuth = view.azimuth * by;
    float square = dot(azimuth, azimuth);
    azimuth *= inversesqrt(square);
    float sin_view = view.sin_view * sqrt(square);
    float scale = inversesqrt(sin_view * sin_view + view.cos_view * view.cos_view);
    return ArealightAxisView(azimuth, sin_view * scale, view.cos_view * scale);
}

// The slopes of a visible normal of alpha 1, seen from `view`; `place` is one of AREALIGHT_VISIBLE_NORMALS.
vec2 arealight_visible_slopes(ArealightAxisView view, vec2 place) {
    float root = sqrt(1.0 - place.x * place.x);
    float along = mix(root, place.y, 0.5 + 0.5 * view.cos_view);
    float away = sqrt(max(1.0 - place.x * place.x - along * along, 0.0));
    vec2 flat_part = (away * view.sin_view - along * view.cos_view) * view.azimuth
                   + place.x * vec2(-view.azimuth.y, view.azimuth.x);
    return flat_part / max(along * view.sin_view + away * view.cos_view, 1e-4);
}

// The direction that a surface of these slopes reflects, in the frame of the view's mirror direction: within
// the plane of incidence and perpendicular to it, both times `scale`; and along the mirror direction.
vec3 arealight_reflected_by_slopes(ArealightAxisView view, vec2 slopes, float scale) {
    float along = dot(view.azimuth, slopes);
    float across = view.azimuth.x * slopes.y - view.azimuth.y * slopes.x;
    float weight = 2.0 / (1.0 + dot(slopes, slopes));
    return vec3(scale * weight * (along - view.cos_view * view.sin_view * across * across),
                scale * weight * (view.cos_view + view.sin_view * along) * across,
                1.0 - weight * (along * along + view.cos_view * view.cos_view * across * across));
}

// a b^T: WGSL has no outerProduct.
mat3 arealight_outer_product(vec3 a, vec3 b) {
    return mat3(a * b.x, a * b.y, a * b.z);
}

// The map, in mirror frames, of directions that a surface of these alphas reflects to those of an isotropic
// one of alpha `reference`, at the view stretched by their ratio. The identity exactly where that is what
// they are. `mean` is the geometric mean of the alphas.
mat3 arealight_isotropic_map(ArealightAxisView view, ArealightAxisView reference_view, vec2 alpha,
                             float reference, float mean) {
    ArealightAxisView seen = arealight_stretched_view(view, alpha);
    float scale = 1.0 / mean;
    mat3 both = mat3(0.0);
    mat3 rest = mat3(0.0);
    for (int i = 0; i < 9; i++) {
        vec2 slopes = arealight_visible_slopes(seen, AREALIGHT_VISIBLE_NORMALS[i]);
        vec3 given = arealight_reflected_by_slopes(view, alpha * slopes, scale);
        vec3 isotropic = arealight_reflected_by_slopes(reference_view, reference * slopes, scale);
        both += arealight_outer_product(given, isotropic);
        rest += arealight_outer_product(isotropic - given, isotropic);
    }
    // 1 + rest / both, by cofactors
    vec3 x = cross(both[1], both[2]);
    vec3 y = cross(both[2], both[0]);
    vec3 z = cross(both[0], both[1]);
    mat3 map = mat3(1.0) + rest * transpose(mat3(x, y, z)) * (1.0 / max(dot(both[0], x), AREALIGHT_TINY));
    // Unscaled
    map[0].z *= scale;
    map[1].z *= scale;
    map[2].xy *= mean;
    return map;
}

// Perceptual roughness along the tangent and across it as it is looked up: both from 0.01 to 1 (NaN counts as
// 0.01), and no farther apart than AREALIGHT_LEAST_ROUGHNESS_RATIO.
vec2 arealight_axis_roughness(ArealightSurface surface) {
    float smallest = sqrt(AREALIGHT_MIN_ALPHA);
    vec2 roughness = vec2(arealight_clamped_roughness(surface.anisotropy.roughness, smallest),
                          arealight_clamped_roughness(surface.roughness, smallest));
    return max(roughness, AREALIGHT_LEAST_ROUGHNESS_RATIO * max(roughness.x, roughness.y));
}

// The tangent's direction within the surface, in the shading frame. One of zero length, or along the normal,
// counts as the first axis that is far from the normal, whatever the view.
vec2 arealight_surface_axis(ArealightFrame frame, vec3 tangent) {
    vec3 unit = arealight_normalize_or(tangent, frame.normal);
    vec3 along = unit - frame.normal * dot(frame.normal, unit);
    if (!(dot(along, along) >= 1e-10)) {
        vec3 axis = abs(frame.normal.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
        along = axis - frame.normal * dot(frame.normal, axis);
    }
    vec2 local = vec2(dot(frame.tangent, along), dot(frame.bitangent, along));
    return local * inversesqrt(max(dot(local, local), AREALIGHT_TINY));
}

// The lobes of a distribution that is stretched along a tangent, as ArealightTableSample is of isotropic
// ones.
struct ArealightStretchedSample {
    mat3 space;                 // of f cos, from the shading frame, or of the first of two lobes
    // Of f cos (1 - cos theta_vh)^5, which may be mixed with the first, or of the second of two lobes
    mat3 schlick_space;
    ArealightTableSample table; // its albedos and the second lobe's shares
};

// What the table or the formula holds for a roughness at a view.
ArealightTableSample arealight_axis_sample(ArealightFrame frame, ArealightAxisView view, float roughness,
                                           bool has_two_lobes) {
    frame.sin_view = view.sin_view;
    frame.cos_view = view.cos_view;
    return arealight_specular_sample(frame, roughness, has_two_lobes);
}

// The space of a lobe, from the shading frame: `texel` and `alpha` are of the isotropic lobe
// (arealight_table_space), `map` is from the mirror frame of the view to the isotropic lobe's.
mat3 arealight_anisotropic_space(ArealightFrame frame, vec4 texel, float alpha, mat3 map, float scale) {
    mat3 isotropic = mat3(texel.x, 0.0, alpha * texel.z, 0.0, 1.0, 0.0, texel.y, 0.0, alpha * texel.w);
    mat3 to_mirror = mat3(frame.cos_view, 0.0, -frame.sin_view, 0.0, 1.0, 0.0, frame.sin_view, 0.0,
                          frame.cos_view);
    return scale * (isotropic * map * to_mirror);
}

// The two lobes of a distribution that is stretched along a tangent, in the place of
// arealight_specular_sample's. Continuous in view, tangent and roughness; of equal roughnesses what isotropic
// lobes are, to 1e-6. Cost a point: two least squares of nine directions and four lookups of a layer each;
// nothing a light.
ArealightStretchedSample arealight_stretched_sample(ArealightFrame frame, ArealightSurface surface,
                                                    bool has_two_lobes) {
    vec2 roughness = arealight_axis_roughness(surface);
    vec2 alpha = roughness * roughness;
    vec2 axis = arealight_surface_axis(frame, surface.anisotropy.tangent);
    ArealightAxisView view = ArealightAxisView(vec2(axis.x, -axis.y), frame.sin_view, frame.cos_view);

    // Matrices, from isotropic lobes between the two alphas
    float most = max(roughness.x, roughness.y);
    float ratio = min(roughness.x, roughness.y) / most;
    float mean_roughness = most * sqrt(ratio);
    float mean = mean_roughness * mean_roughness;
    float lobe_roughness = most * sqrt(sqrt(ratio));
    float lobe_alpha = lobe_roughness * lobe_roughness;
    ArealightAxisView lobe_view = arealight_stretched_view(view, alpha / lobe_alpha);
    mat3 lobe_map = arealight_isotropic_map(view, lobe_view, alpha, lobe_alpha, mean);
    ArealightTableSample lobe = arealight_axis_sample(frame, lobe_view, lobe_roughness, has_two_lobes);

    // Albedos, from the lobe of the mean square at the view that it sees, and from that of the view's azimuth
    vec2 weights = view.azimuth * view.azimuth * (view.sin_view * view.sin_view)
        + vec2(0.5 * AREALIGHT_AZIMUTH_START);
    vec2 squares = (alpha / (most * most)) * (alpha / (most * most));
    float root_roughness = most * sqrt(sqrt(0.5 * (squares.x + squares.y)));
    float azimuth_roughness = most * sqrt(sqrt(dot(weights, squares) / (weights.x + weights.y)));
    ArealightAxisView root_view = arealight_stretched_view(view, alpha / (root_roughness * root_roughness));

    ArealightStretchedSample result;
    result.table = arealight_axis_sample(frame, root_view, root_roughness, false);
    result.table.schlick = min(arealight_axis_sample(frame, view, azimuth_roughness, false).schlick,
                               result.table.albedo);
    float scale = mean / lobe_alpha;
    result.space = arealight_anisotropic_space(frame, lobe.matrix, lobe.alpha, lobe_map, scale);
    if (AREALIGHT_HAS_TWO_SPECULAR_LOBES) {
        if (has_two_lobes) {
            result.schlick_space = arealight_anisotropic_space(frame, lobe.schlick_matrix, lobe.alpha,
                                                               lobe_map, scale);
            result.table.second_shares = lobe.second_shares;
            return result;
        }
    }
    ArealightAxisView schlick_view = arealight_stretched_view(view, alpha / mean);
    mat3 schlick_map = arealight_isotropic_map(view, schlick_view, alpha, mean, mean);
    ArealightTableSample schlick_lobe = arealight_axis_sample(frame, schlick_view, mean_roughness, false);
    result.schlick_space = arealight_anisotropic_space(frame, schlick_lobe.schlick_matrix, schlick_lobe.alpha,
                                                       schlick_map, 1.0);
    return result;
}

// As arealight_specular_lobe.
ArealightLobe arealight_anisotropic_lobe(ArealightStretchedSample stretched, vec3 f0, float f90) {
    float share = arealight_schlick_share(stretched.table, f0, f90);
    mat3 space = stretched.space + share * (stretched.schlick_space - stretched.space);
    return arealight_lobe(space, arealight_specular_albedo(stretched.table, f0, f90));
}

#endif
