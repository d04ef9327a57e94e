#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// A yardstick: light textures as in the article (Heitz et al. 2016, section 5, and its published code), with
// the library's form factors and pyramid. The eval kernel else: same bindings, same cases.
//
// The texture is looked up at the foot of the perpendicular from the shading point onto the light's plane, in
// cosine space, blurred by the distance r to it: the lobe's image of eq. 35, of variance r^2 / 2, which is
// exact for a plane parallel to the receiver.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;

#define LIGHTS_BINDING 1
#define LIGHT_TEXTURES_BINDING 5
#define CASES_BINDING 3
#include "effects.glsl"
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "../../tools/kernels/shaders/cases.glsl"

vec3 article_color(mat3 space, ArealightLocalPolygon local) {
    ArealightLobeImage image = arealight_lobe_image(local.image, space * local.center, space
                                                    * local.to_frame);
    // The foot of the perpendicular: the plane met along its normal
    ArealightPlaneHit foot = arealight_plane_hit(image, image.normal);
    vec2 box = arealight_clamp_coordinate(foot.box, vec2(0.0), vec2(1.0));
    float area = sqrt(dot(image.normal, image.normal));
    return arealight_image_blurred(image, box, foot.square / (2.0 * area));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightPolygonLight light = load_polygon(lights[cases[index].light]);
    ArealightPoint point = arealight_point(case_surface(cases[index]));
    vec3 reflected = vec3(0.0);
    ArealightLocalPolygon local;
    if (arealight_to_local(point, light, local)) {
        for (int i = 0; i < AREALIGHT_LOBES; i++) {
            if (arealight_has_lobe(i)) {
                ArealightLobe lobe = arealight_lobe_at(point, i);
                float form_factor = arealight_form_factor(arealight_vector_form_factor(lobe.space, local));
                reflected += lobe.albedo * form_factor * article_color(lobe.space, local);
            }
        }
    }
    results[index] = vec4(light.radiance * reflected, 0.0);
}
