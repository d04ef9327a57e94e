#version 450
#extension GL_GOOGLE_include_directive : require

// Form factors of disks, spheres and tubes over a list of arguments, so that tests and benchmarks can hold
// them to what their comments say; and the published disk.

layout(local_size_x = 64) in;

layout(constant_id = 0) const int FUNCTION = 0;
// 1 where tubes are cut by the surface whose normal is z too; or a lobe's horizon
layout(constant_id = 1) const int CHOICE = 0;

const int FUNCTION_ELLIPSE = 0;
const int FUNCTION_SPHERE = 1;
const int FUNCTION_SILHOUETTE = 2;
const int FUNCTION_ARCTANGENT = 3;
const int FUNCTION_PUBLISHED = 4;
const int FUNCTION_TUBE = 5;
const int FUNCTION_LOBE = 6;

#define AREALIGHT_TWO_SIDED 1
#define AREALIGHT_SURFACE_HORIZON CHOICE
#include "arealight/lights/disk.glsl"
#include "arealight/lights/sphere.glsl"
#include "arealight/lights/tube.glsl"
#include "published_disk.glsl"

struct ShapeArguments {
    vec4 a;
    vec4 b;
    vec4 c;
    vec4 d;
};

layout(set = 0, binding = 0, std430) readonly buffer Arguments {
    ShapeArguments arguments[];
};
// How tubes end
layout(set = 0, binding = 1, std430) readonly buffer Ends {
    int ends[];
};
layout(set = 0, binding = 2, std430) writeonly buffer Results {
    vec4 results[];
};

layout(push_constant, std430) uniform ShapeConstants {
    uint count;
} constants;

vec4 silhouette_of(vec3 center, float radius, mat3 transform, bool two_sided) {
    ArealightSilhouette silhouette = arealight_sphere_silhouette(center, radius);
    float form_factor = arealight_ellipse_form_factor(transform * silhouette.center, transform
                                                      * silhouette.axis_u,
                                                      transform * silhouette.axis_v, two_sided);
    return vec4(silhouette.inside ? 0.0 : form_factor, silhouette.center);
}

// What a white lobe reflects of a disk or sphere, the surface's normal being z. The lobe's matrix has the
// rows (a.w, b.w, c.w), d and a third one across them, of the length d.w.
float lobe_of(ShapeArguments given, bool sphere) {
    vec3 first = vec3(given.a.w, given.b.w, given.c.w);
    vec3 third = given.d.w * arealight_normalize_or(cross(first, given.d.xyz), vec3(0.0, 0.0, 1.0));
    mat3 space = transpose(mat3(first, given.d.xyz, third));
    ArealightPoint point;
    point.position = vec3(0.0);
    point.to_frame = mat3(1.0);
    vec3 vector = vec3(0.0);
    if (sphere) {
        ArealightLocalSphere local;
        if (arealight_to_local(point, ArealightSphereLight(vec3(1.0), given.a.xyz, given.b.x, true), local)) {
            vector = arealight_vector_form_factor(space, local);
        }
    } else {
        ArealightDiskLight light = ArealightDiskLight(vec3(1.0), given.a.xyz, given.b.xyz, given.c.xyz, true);
        ArealightLocalDisk local;
        if (arealight_to_local(point, light, local)) {
            vector = arealight_vector_form_factor(space, local);
        }
    }
    return arealight_form_factor(vector);
}

vec4 evaluate(ShapeArguments given, int tube_ends) {
    bool two_sided = given.d.w != 0.0;
    vec4 result = vec4(0.0);
    if (FUNCTION == FUNCTION_ELLIPSE) {
        result.x = arealight_ellipse_form_factor(given.a.xyz, given.b.xyz, given.c.xyz, two_sided);
    } else if (FUNCTION == FUNCTION_SPHERE) {
        result.x = arealight_sphere_form_factor(given.a.xyz, given.a.w, two_sided);
    } else if (FUNCTION == FUNCTION_SILHOUETTE) {
        mat3 transform = mat3(given.b.xyz, given.c.xyz, given.d.xyz);
        result = silhouette_of(given.a.xyz, given.a.w, transform, two_sided);
    } else if (FUNCTION == FUNCTION_ARCTANGENT) {
        result.x = arealight_arctangent(given.a.y, given.a.x);
    } else if (FUNCTION == FUNCTION_TUBE) {
        ArealightTube tube = arealight_tube(given.a.xyz, given.b.xyz, given.a.w, tube_ends);
        // The matrix's rows, of which the last one is of unit length
        vec3 row = vec3(given.c.w, given.d.w, given.b.w);
        mat3 transform = transpose(mat3(given.c.xyz, given.d.xyz, row));
        result.x = !tube.seen ? 0.0
                 : CHOICE == 0
                 ? arealight_tube_form_factor(tube, transform, AREALIGHT_HORIZON_WIDTH)
                 : arealight_tube_both_horizons(tube, vec3(0.0, 0.0, 1.0), transform,
                                                AREALIGHT_HORIZON_WIDTH);
    } else if (FUNCTION == FUNCTION_LOBE) {
        result.xy = vec2(lobe_of(given, false), lobe_of(given, true));
    } else if (FUNCTION == FUNCTION_PUBLISHED) {
        result.xy = published_disk(given.a.xyz, given.b.xyz, given.c.xyz);
    }
    return result;
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    ShapeArguments given = arguments[index];
    results[index] = evaluate(given, ends[index]);
}
