#ifndef AREALIGHT_SHADOW_SAMPLING_GLSL
#define AREALIGHT_SHADOW_SAMPLING_GLSL

#include "arealight/form_factor/quad.glsl"
#include "arealight/shadows/polygon_sampling.glsl"

// Shadow rays for quads and triangles, drawn from the lobes of a surface (../material.glsl). The unshadowed light is exact; a shadow is the mean
// visibility under the lobes. With N rays for all lights and lobes:
//
//     choose a light and a lobe with arealight_choose, by the luminance u of radiance x albedo x form factor
//     draw = arealight_draw(arealight_sampling_polygon(arealight_transformed(lobe.space, quad)), random)
//     direction = arealight_from_cosine_space(point.to_frame, lobe.space, draw.direction)
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

// A direction from cosine space back to where `space` and before it `to_frame` come from, unit. `space` has a positive determinant and
// `to_frame` is a rotation.
vec3 arealight_from_cosine_space(mat3 to_frame, mat3 space, vec3 direction) {
    // The rows of the inverse, times the determinant, are the cross products of the columns
    vec3 in_frame = vec3(dot(cross(space[1], space[2]), direction), dot(cross(space[2], space[0]), direction),
                         dot(cross(space[0], space[1]), direction));
    return arealight_normalize_or(in_frame, vec3(0.0, 0.0, 1.0)) * to_frame;
}

#endif
