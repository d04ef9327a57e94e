#ifndef AREALIGHT_SPLIT_GLSL
#define AREALIGHT_SPLIT_GLSL

#include "arealight/form_factor/quad.glsl"
#include "arealight/textures/footprint.glsl"

// Lookups of a light's image by parts of the light, each with a form factor and a footprint of its own.

#if AREALIGHT_LIGHT_TEXTURES

// Parts to a side of the whole light.
const float AREALIGHT_PARTS = 4.0;

// A convex part of a light, and where on its image its vertices are.
struct ArealightPart {
    ArealightQuad quad; // from the light's center
    vec4 u;
    vec4 v;
};

// The part of a light whose vertices are these offsets from its center.
ArealightPart arealight_part(ArealightImage image, ArealightQuad quad) {
    vec2 a = arealight_image_coordinate(image, quad.a);
    vec2 b = arealight_image_coordinate(image, quad.b);
    vec2 c = arealight_image_coordinate(image, quad.c);
    vec2 d = arealight_image_coordinate(image, quad.d);
    return ArealightPart(quad, vec4(a.x, b.x, c.x, d.x), vec4(a.y, b.y, c.y, d.y));
}

// The part in a column and row of `count` by `count` that a part is split into.
ArealightPart arealight_split_part(ArealightPart whole, vec2 cell, float count) {
    vec4 s = vec4(cell.x, cell.x + 1.0, cell.x + 1.0, cell.x) / count;
    vec4 t = vec4(cell.y, cell.y, cell.y + 1.0, cell.y + 1.0) / count;
    ArealightQuad quad = whole.quad;
    ArealightPart part;
    part.quad = ArealightQuad(mix(mix(quad.a, quad.b, s.x), mix(quad.d, quad.c, s.x), t.x),
                              mix(mix(quad.a, quad.b, s.y), mix(quad.d, quad.c, s.y), t.y),
                              mix(mix(quad.a, quad.b, s.z), mix(quad.d, quad.c, s.z), t.z),
                              mix(mix(quad.a, quad.b, s.w), mix(quad.d, quad.c, s.w), t.w));
    part.u = mix(mix(whole.u.xxxx, whole.u.yyyy, s), mix(whole.u.wwww, whole.u.zzzz, s), t);
    part.v = mix(mix(whole.v.xxxx, whole.v.yyyy, s), mix(whole.v.wwww, whole.v.zzzz, s), t);
    return part;
}

// As arealight_footprint, of one of `parts` by `parts` parts of the light, which is within the box from `low`
// to `high`: two taps.
vec3 arealight_footprint_of_part(ArealightLobeImage image, vec3 toward, vec2 low, vec2 high, float parts) {
    ArealightPlaneHit hit = arealight_plane_hit(image, toward);
    vec2 box = arealight_clamp_coordinate(hit.box, low, high);
    // Near to the light a part sees no more than itself. From afar all see all of it, and their blurs must
    // add up to an even one: those of half a part's width do
    float distance = hit.square / (sqrt(dot(image.normal, image.normal)) + AREALIGHT_TINY);
    float end = 4.0 + 6.0 / (1.0 + 0.0625 * distance * distance);
    ArealightFootprintEllipse ellipse = arealight_footprint_ellipse(image, hit.square, 2.0, end * parts
                                                                    * parts);
    float variance = min(ellipse.major, max(ellipse.minor, 0.5625 * ellipse.major));
    vec2 step = sqrt(ellipse.major - variance) * ellipse.axis;
    vec3 color = arealight_image_blurred(image, arealight_mirror_coordinate(box + step, low, high), variance)
               + arealight_image_blurred(image, arealight_mirror_coordinate(box - step, low, high), variance);
    return 0.5 * color;
}

// The mean colour that a lobe sees of a part, whose vector form factor is `vector`.
vec3 arealight_part_color(ArealightLobeImage image, ArealightPart part, vec3 vector) {
    vec2 low = vec2(min(min(part.u.x, part.u.y), min(part.u.z, part.u.w)),
                    min(min(part.v.x, part.v.y), min(part.v.z, part.v.w)));
    vec2 high = vec2(max(max(part.u.x, part.u.y), max(part.u.z, part.u.w)),
                     max(max(part.v.x, part.v.y), max(part.v.z, part.v.w)));
    return arealight_footprint_of_part(image, vector, low, high, AREALIGHT_PARTS);
}

#endif
#endif
