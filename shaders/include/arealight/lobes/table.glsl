#ifndef AREALIGHT_TABLE_GLSL
#define AREALIGHT_TABLE_GLSL

#include "arealight/surface.glsl"

// The host's bridge to the fitted table: texel `texel` (x roughness, y view angle) of layer 0 (matrix of the
// lobe without Fresnel term), layer 1 (magnitudes; their third channel says how much of
// arealight_ggx_grazing_dip is in the first two), layer 2 (matrix of the lobe of Schlick's weight; layer 0
// again in a table of one matrix), or, with AREALIGHT_TWO_SPECULAR_LOBES alone, layers 3 and 4 (matrices of
// the first and the second lobe) and 5 (the second one's shares); all four channels, unfiltered, in float32
// or float16. Texels outside are never asked for.
vec4 arealight_bridge_table(int layer, ivec2 texel);
// Nodes a side of the table, from 2 on.
int arealight_bridge_table_size();

// What the table holds for a roughness and a view.
struct ArealightTableSample {
    vec4 matrix;         // of f cos, or of the first of two lobes; see arealight_table_space
    vec4 schlick_matrix; // of f cos (1 - cos theta_vh)^5, or of the second of two lobes
    // Of two lobes the second one's share of the energy, at reflectances of 1 and AREALIGHT_DIELECTRIC_F0
    vec2 second_shares;
    float albedo;        // integral of f cos over the hemisphere, without Fresnel term, in [0, 1]
    float schlick;       // integral of f cos (1 - cos theta_vh)^5, in [0, 1]
    float alpha;         // roughness^2, at least AREALIGHT_MIN_ALPHA
};

// The reflectance at normal incidence, with F90 = 1, of the second of the shares in layer 5.
const float AREALIGHT_DIELECTRIC_F0 = 0.02;

// The bilinear mean of four texels around `coordinate`, which is in nodes: 0 to size - 1.
vec4 arealight_table_bilinear(int layer, vec2 coordinate, int size) {
    vec2 node = clamp(floor(coordinate), vec2(0.0), vec2(float(size - 2)));
    ivec2 texel = ivec2(node);
    vec2 upper = coordinate - node;
    vec2 lower = 1.0 - upper;
    return lower.x * lower.y * arealight_bridge_table(layer, texel)
         + upper.x * lower.y * arealight_bridge_table(layer, texel + ivec2(1, 0))
         + lower.x * upper.y * arealight_bridge_table(layer, texel + ivec2(0, 1))
         + upper.x * upper.y * arealight_bridge_table(layer, texel + ivec2(1, 1));
}

// What fills the dips of GGX's two albedos (albedo, schlick) at grazing views, so that a table can
// interpolate them: its magnitudes hold it at each node, and the lookup takes that of its own place away. For
// a roughness in [0.01, 1] and the cosine of a view in [0, 1]: within [0, 0.21] and [-0.53, 0.02]. Error
// against the float64 twin, ggx_grazing_dip: 4e-7. Source: docs/fit.md.
vec2 arealight_ggx_grazing_dip(float roughness, float cos_view) {
    float alpha = roughness * roughness;
    float x = cos_view / alpha;
    float below = 1.0 / (1.0 + x * (0.7153 + x * (0.0637 + x * 0.3232)));
    float dip = 0.2272 * x;
    // How much of its weight a lobe that lies on the surface has lost to its width
    float width = alpha / (alpha + 0.2316 * roughness + 0.01454);
    float halted = width * (0.5502 + x * (0.1084 * x - 0.1966));
    float from_normal = 1.0 - cos_view;
    float schlick_weight = from_normal * (from_normal * from_normal) * (from_normal * from_normal);
    return vec2(dip * below + 0.0866 * alpha * (cos_view / (cos_view + 0.01997)),
                ((dip + halted) * below - 0.5365) * schlick_weight);
}

// The table at a surface frame and a perceptual roughness (clamped to [0.01, 1]; NaN counts as 0.01), of one
// lobe or of two. Source: Heitz et al. 2016, section 4. Error against the float64 twin, LightTable::lookup:
// 4e-7 of the largest entry, and what moving both axes by 3 x 2^-24 changes; together 1.3e-6 for the
// matrices. Albedos follow the view's cosine within alpha of the horizon, where an error of it counts 0.3 /
// alpha times. Against the truth, GGX's albedo is within 1.0e-3 to 89.9 degrees, 1.4e-3 beyond, and that of
// Schlick's weight within 1.6e-3, with 64 nodes a side, at every roughness.
ArealightTableSample arealight_table_lookup(ArealightFrame frame, float roughness, bool has_two_lobes) {
    roughness = arealight_clamped_roughness(roughness, sqrt(AREALIGHT_MIN_ALPHA));

    // Axes: roughness and sqrt(1 - cos), the latter without cancellation near the normal
    int size = arealight_bridge_table_size();
    vec2 axes = vec2(roughness, frame.sin_view * inversesqrt(1.0 + frame.cos_view));
    vec2 coordinate = axes * float(size - 1);
    vec4 magnitude = arealight_table_bilinear(1, coordinate, size);
    magnitude.xy -= magnitude.z * arealight_ggx_grazing_dip(roughness, frame.cos_view);

    ArealightTableSample result;
    result.matrix = arealight_table_bilinear(has_two_lobes ? 3 : 0, coordinate, size);
    result.schlick_matrix = arealight_table_bilinear(has_two_lobes ? 4 : 2, coordinate, size);
    result.second_shares = has_two_lobes ? arealight_table_bilinear(5, coordinate, size).xy : vec2(0.0);
    result.albedo = clamp(magnitude.x, 0.0, 1.0);
    result.schlick = clamp(magnitude.y, 0.0, result.albedo);
    result.alpha = roughness * roughness;
    return result;
}

// The part that Schlick's weight has in the specular albedo, in [0, 1]: TableSample::schlick_share. Colours
// count by the mean of their channels.
float arealight_schlick_share(ArealightTableSample table, vec3 f0, float f90) {
    float mean = dot(f0, vec3(1.0 / 3.0));
    float lobe = mean * table.albedo;
    float schlick = (f90 - mean) * table.schlick;
    return schlick > 0.0 && lobe >= 0.0 ? schlick / (lobe + schlick) : 0.0;
}

// What the second of two lobes reflects of light from everywhere, per channel, within [0, `albedo`], which is
// that of both: so much of a reflectance of 1 and so much of AREALIGHT_DIELECTRIC_F0 as f0 and f90 are made
// of. TableSample::lobes.
vec3 arealight_second_albedo(ArealightTableSample table, vec3 f0, float f90, vec3 albedo) {
    vec3 dielectric = (vec3(f90) - f0) * (1.0 / (1.0 - AREALIGHT_DIELECTRIC_F0));
    vec3 metal = f0 - AREALIGHT_DIELECTRIC_F0 * dielectric;
    float dielectric_albedo = mix(table.schlick, table.albedo, AREALIGHT_DIELECTRIC_F0);
    vec3 second = metal * (table.albedo * table.second_shares.x) + dielectric
        * (dielectric_albedo * table.second_shares.y);
    return clamp(second, vec3(0.0), albedo);
}

// The space of a lobe of the table, from the shading frame.
//
// A texel (q00, q02, q20, q22) holds the transform in the mirror frame, divided by its middle entry, with the
// last row divided by alpha: there it is smooth down to a mirror. The mirror frame's axes are across = (cos,
// 0, sin) and mirror = (-sin, 0, cos). Zeros and the one are literals: they cost nothing.
mat3 arealight_table_space(ArealightFrame frame, vec4 texel, float alpha) {
    mat2 to_mirror = mat2(frame.cos_view, frame.sin_view, -frame.sin_view, frame.cos_view);
    vec2 first = to_mirror * texel.xy;
    vec2 last = to_mirror * texel.zw * alpha;
    return mat3(first.x, 0.0, last.x, 0.0, 1.0, 0.0, first.y, 0.0, last.y);
}

#endif
