#ifndef AREALIGHT_SPHERE_LIGHT_GLSL
#define AREALIGHT_SPHERE_LIGHT_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/sphere.glsl"
#include "arealight/light_kind.glsl"

// A sphere of constant radiance.
struct ArealightSphereLight {
    vec3 radiance;  // of the outside, W/(m^2 sr)
    vec3 center;    // relative to the origin of ArealightSurface.position
    float radius;
    bool two_sided; // the inside emits too (with AREALIGHT_TWO_SIDED)
};

// A sphere in the shading frame, and the disk that covers the same directions.
struct ArealightLocalSphere {
    vec3 center; // from the shading point
    float radius;
    ArealightSilhouette silhouette;
};

// A point inside of a sphere sees it everywhere.
bool arealight_to_local(ArealightPoint point, ArealightSphereLight light, out ArealightLocalSphere local) {
    local.center = point.to_frame * (light.center - point.position);
    local.radius = light.radius;
    local.silhouette = arealight_sphere_silhouette(local.center, local.radius);
    return !local.silhouette.inside || (AREALIGHT_HAS_TWO_SIDED && light.two_sided);
}

// z alone: by the disk, in any space. In the shading frame itself a sphere has a closed form of its own,
// which compilers choose for a lobe whose space is a literal unit matrix.
vec3 arealight_vector_form_factor(mat3 space, ArealightLocalSphere local) {
    if (local.silhouette.inside) {
        return vec3(0.0, 0.0, 1.0);
    }
    if (space == mat3(1.0)) {
        return vec3(0.0, 0.0, arealight_sphere_form_factor(local.center, local.radius, false));
    }
    vec3 center = space * local.silhouette.center;
    vec3 axis_u = space * local.silhouette.axis_u;
    vec3 axis_v = space * local.silhouette.axis_v;
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        vec3 heights = vec3(local.silhouette.center.z, local.silhouette.axis_u.z, local.silhouette.axis_v.z);
        return vec3(0.0, 0.0, arealight_ellipse_both_horizons(center, axis_u, axis_v, heights, true,
                                                              arealight_horizon_width(space)));
    }
    return vec3(0.0, 0.0, arealight_ellipse_form_factor(center, axis_u, axis_v, true));
}

vec3 arealight_image_average(mat3 space, ArealightLocalSphere local, vec3 vector) {
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
float arealight_solid_angle(ArealightLocalSphere local) {
    return local.silhouette.inside ? 4.0 * AREALIGHT_PI
        : arealight_sphere_solid_angle(local.center, local.radius);
}
#endif

AREALIGHT_WITHOUT_HALF_VECTORS(ArealightLocalSphere)
AREALIGHT_LIGHT_KIND(ArealightSphereLight, ArealightLocalSphere, AREALIGHT_UNROLLED_LOBES)

#endif
