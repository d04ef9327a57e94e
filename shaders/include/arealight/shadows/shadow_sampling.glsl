#ifndef AREALIGHT_SHADOW_SAMPLING_GLSL
#define AREALIGHT_SHADOW_SAMPLING_GLSL

#include "arealight/form_factor/quad.glsl"
#include "arealight/shadows/polygon_sampling.glsl"

// Shadow rays for quads and triangles, drawn from the lobes of a surface (../material.glsl). The unshadowed
// light is exact; a shadow is the mean visibility under the lobes. With N rays for all lights and lobes:
//
//     choose a light and a lobe with arealight_choose, by the luminance u of radiance x albedo x form factor
//     drawn = arealight_draw_quad(arealight_transformed(lobe.space, quad), random)
//     direction = arealight_from_cosine_space(point.to_frame, lobe.space, drawn)
//     V = 0 where something blocks the ray from arealight_ray_origin on to the light, else 1
//     c = radiance x albedo / luminance(radiance x albedo)
//     radiance = the unshadowed sum x (mean of c V) / (mean of c)
//
// Of one ray on that is right on average; where nothing or everything is hidden it is without noise.

// A quad in cosine space as far as it is above the horizon, to draw from.
ArealightSamplingPolygon arealight_sampling_polygon(ArealightQuad quad) {
    ArealightSamplingPolygon polygon;
    if (arealight_lowest(quad) >= 0.0) {
        polygon.vertices = vec3[](quad.a, quad.b, quad.c, quad.d, quad.d);
    } else if (arealight_highest(quad) <= 0.0) {
        polygon.vertices = vec3[](vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    } else {
        ArealightCutQuad cut = arealight_cut_at_horizon(quad);
        polygon.vertices = vec3[](cut.entry, cut.a, cut.b, cut.c, cut.exit);
    }
    return polygon;
}

// Quads smaller than this part of their distance are drawn from by area: the areas of two circles would
// cancel.
const float AREALIGHT_SMALL_QUAD = 0.1;

bool arealight_is_small(ArealightQuad quad) {
    vec3 diagonals = vec3(distance(quad.a, quad.c), distance(quad.b, quad.d), distance(quad.a, quad.b));
    float size = max(diagonals.x, max(diagonals.y, diagonals.z));
    float nearest = min(min(dot(quad.a, quad.a), dot(quad.b, quad.b)),
                        min(dot(quad.c, quad.c), dot(quad.d, quad.d)));
    return size * size < AREALIGHT_SMALL_QUAD * AREALIGHT_SMALL_QUAD * nearest;
}

// The density of the clamped cosine over the sides' parameters at a vertex between two others, up to the
// quad's distance from the origin.
float arealight_vertex_density(vec3 vertex, vec3 before, vec3 after) {
    float square = dot(vertex, vertex);
    return max(vertex.z, 0.0) * length(cross(after - vertex, before - vertex)) / (square * square);
}

// A point of a small quad, with a density of the sides' parameters that is bilinear between those of the
// vertices. The shadow of one as large as a tenth of its distance has an error of 2e-4 rms.
vec3 arealight_draw_small_quad(ArealightQuad quad, vec2 random) {
    // Of sizes that do not leave float32
    float scale = 1.0 / max(arealight_max_component(quad.a), 1e-37);
    vec3 a = scale * quad.a, b = scale * quad.b, c = scale * quad.c, d = scale * quad.d;
    vec4 density = vec4(arealight_vertex_density(a, d, b), arealight_vertex_density(b, a, c),
                        arealight_vertex_density(c, b, d),
                        arealight_vertex_density(d, c, a));
    float v = arealight_linear_quantile(density.x + density.y, density.w + density.z, random.y);
    float u = arealight_linear_quantile(mix(density.x, density.w, v), mix(density.y, density.z, v), random.x);
    return mix(mix(a, b, u), mix(d, c, u), v);
}

// A direction, of any length, from the clamped cosine over a quad in cosine space. `random` in [0, 1)^2,
// uniform.
vec3 arealight_draw_quad(ArealightQuad quad, vec2 random) {
    if (arealight_is_small(quad)) {
        return arealight_draw_small_quad(quad, random);
    }
    return arealight_draw(arealight_sampling_polygon(quad), random).direction;
}

// A direction from cosine space back to where `space` and before it `to_frame` come from, unit. `space` has a
// positive determinant and `to_frame` is a rotation.
vec3 arealight_from_cosine_space(mat3 to_frame, mat3 space, vec3 direction) {
    // The rows of the inverse, times the determinant, are the cross products of the columns
    vec3 in_frame = vec3(dot(cross(space[1], space[2]), direction), dot(cross(space[2], space[0]), direction),
                         dot(cross(space[0], space[1]), direction));
    return arealight_normalize_or(in_frame, vec3(0.0, 0.0, 1.0)) * to_frame;
}

#endif
