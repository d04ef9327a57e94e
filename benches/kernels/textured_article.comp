#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// A yardstick: light textures as in the article (Heitz et al. 2016, section 5, and its published code), with the library's
// form factors and pyramid. The eval kernel else: same bindings, same cases.
//
// The texture is looked up at the foot of the perpendicular from the shading point onto the light's plane, in cosine
// space, blurred by the distance r to it: the lobe's image of eq. 35, of variance r^2 / 2, which is exact for a plane
// parallel to the receiver.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;

#define LIGHTS_BINDING 1
#define LIGHT_TEXTURES_BINDING 5
#include "table_image.glsl"
#include "lights.glsl"
#define CASES_BINDING 3
#include "cases.glsl"

vec3 article_lobe(ArealightLobe lobe, ArealightLobeView view, ArealightPolygonLight light, ArealightArcs walked,
                  ArealightQuad quad, ArealightQuality quality) {
    ArealightArcs arcs = arealight_lobe_arcs(view, walked, quad, EFFECTS, quality);
    ArealightSeenImage image = arealight_see_image(light.image, view.center, view.transform);
    // The foot of the perpendicular: the plane met along its normal
    ArealightSeenPoint foot = arealight_seen_point(image, image.normal);
    vec2 box = arealight_clamp_coordinate(foot.box, vec2(0.0), vec2(1.0));
    float area = sqrt(dot(image.normal, image.normal));
    vec3 color = arealight_image_blurred(image, box, foot.square / (2.0 * area));
    return lobe.albedo * arealight_form_factor(arcs, light.two_sided) * color;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightGpuCase given = cases[index];
    ArealightPolygonLight light = load_light(given.light);
    ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(case_surface(given), EFFECTS, quality);
    ArealightSeenLight seen = arealight_see(point.position, light);
    ArealightQuad quad = arealight_light_quad(light);
    ArealightLobeViews views = arealight_lobe_views(point, seen, quality.form_factor);
    ArealightLobeArcs walked = arealight_walk_light(views, light, EFFECTS, quality);
    vec3 reflected = article_lobe(point.glossy, views.glossy, light, walked.glossy, quad, quality)
                   + article_lobe(point.diffuse, views.diffuse, light, walked.diffuse, quad, quality);
    if (FRESNEL == AREALIGHT_FRESNEL_SPLIT) {
        reflected += article_lobe(point.schlick, views.schlick, light, walked.schlick, quad, quality);
    }
    results[index] = vec4(light.radiance * reflected, 0.0);
}
