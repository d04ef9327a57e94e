#ifndef AREALIGHT_DISK_LIGHT_GLSL
#define AREALIGHT_DISK_LIGHT_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/light_kind.glsl"
#include "arealight/textures/footprint.glsl"

// A flat disk or ellipse, center + cos(t) axis_u + sin(t) axis_v, of constant radiance or with an image that
// multiplies it. The image's rows run along axis_u, its top row is where axis_v points to, seen from the
// front, and the parallelogram of both axes touches its edges.
struct ArealightDiskLight {
    vec3 radiance;  // of the front, W/(m^2 sr)
    vec3 center;    // relative to the origin of ArealightSurface.position
    vec3 axis_u;    // a half axis
    vec3 axis_v;    // the conjugate half axis; axis_u x axis_v points to where the front shines
    bool two_sided; // the back emits too (with AREALIGHT_TWO_SIDED)
#if AREALIGHT_LIGHT_TEXTURES
    uint image;     // a layer of the light textures, or AREALIGHT_NO_IMAGE
#endif
};

#if AREALIGHT_LIGHT_TEXTURES
// Where the image of a disk with these half axes is.
ArealightImage arealight_disk_image(uint layer, vec3 axis_u, vec3 axis_v) {
    float u = dot(axis_u, axis_u);
    float v = dot(axis_v, axis_v);
    float longer = sqrt(sqrt(max(u, v) / max(min(u, v), AREALIGHT_TINY)));
    return ArealightImage(layer, axis_v - axis_u, 2.0 * axis_u, -2.0 * axis_v, vec2(0.0), vec2(1.0), longer);
}
#endif

// A disk in the shading frame.
struct ArealightLocalDisk {
    vec3 center; // from the shading point
    vec3 axis_u;
    vec3 axis_v;
#if AREALIGHT_LIGHT_TEXTURES
    uint image;
#endif
};

bool arealight_to_local(ArealightPoint point, ArealightDiskLight light, out ArealightLocalDisk local) {
    vec3 offset = light.center - point.position;
    vec3 normal = arealight_normalize_or(cross(light.axis_u, light.axis_v), vec3(0.0));
    local.center = point.to_frame * offset;
    local.axis_u = point.to_frame * light.axis_u;
    local.axis_v = point.to_frame * light.axis_v;
#if AREALIGHT_LIGHT_TEXTURES
    local.image = light.image;
#endif
    return arealight_lit_side(offset, normal, AREALIGHT_HAS_TWO_SIDED && light.two_sided,
                              arealight_position_error(point.position)) != 0.0;
}

// z alone: what it is where the point is on a bright side.
vec3 arealight_vector_form_factor(mat3 space, ArealightLocalDisk local) {
    vec3 center = space * local.center;
    vec3 axis_u = space * local.axis_u;
    vec3 axis_v = space * local.axis_v;
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        vec3 heights = vec3(local.center.z, local.axis_u.z, local.axis_v.z);
        return vec3(0.0, 0.0, arealight_ellipse_both_horizons(center, axis_u, axis_v, heights, true,
                                                              arealight_horizon_width(space)));
    }
    return vec3(0.0, 0.0, arealight_ellipse_form_factor(center, axis_u, axis_v, true));
}

vec3 arealight_image_average(mat3 space, ArealightLocalDisk local, vec3 vector) {
#if AREALIGHT_LIGHT_TEXTURES
    if (AREALIGHT_HAS_TEXTURED_DISKS && local.image != AREALIGHT_NO_IMAGE) {
        ArealightImage image = arealight_disk_image(local.image, local.axis_u, local.axis_v);
        vec3 center = space * local.center;
        ArealightLobeImage seen = arealight_lobe_image(image, center, space);
        // Towards the middle of what is above the horizon, to .01 of a radius
        mat2x3 axes = space * mat2x3(local.axis_u, local.axis_v);
        vec2 rise = vec2(axes[0].z, axes[1].z);
        float most = max(length(rise), AREALIGHT_TINY);
        float above = clamp(center.z / most, -1.0, 1.0);
        center += (1.0 - above) * (0.424 - 0.076 * above) / most * (axes * rise);
        vector = center * (vector.z / max(center.z, AREALIGHT_TINY));
        return arealight_footprint(seen, vector);
    }
#endif
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
float arealight_solid_angle(ArealightLocalDisk local) {
    return arealight_ellipse_solid_angle(local.center, local.axis_u, local.axis_v);
}
#endif

AREALIGHT_WITHOUT_HALF_VECTORS(ArealightLocalDisk)
AREALIGHT_LIGHT_KIND(ArealightDiskLight, ArealightLocalDisk, AREALIGHT_UNROLLED_LOBES)

#endif
