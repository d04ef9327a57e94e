#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// What a medium scatters towards the camera once, of every light: an invocation per froxel, at a distance that
// is drawn within it from frame to frame or in its middle. What blocks light is asked by rays, each over a
// light: one for the light that scatters most, drawn by how much each does; or one for each.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 11) const bool HAS_QUADS = true;
layout(constant_id = 22) const int MEDIUM_RAYS = 0;
layout(constant_id = 23) const bool MEDIUM_IMAGE = false;
layout(constant_id = 24) const bool MEDIUM_JITTER = false;
const int HORIZON = 0;
const int SPECULAR_LOBES = 0;
const int LOBES = 0;

// arealight::plan::MediumRays
const int RAY_A_FROXEL = 1;
const int RAY_A_LIGHT = 2;

#define AREALIGHT_MEDIA 1
#include "froxels.glsl"
#include "effects.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "arealight/shadows/sequence.glsl"
#include "pick_bits.glsl"
#include "picked_light.glsl"
#include "visibility_bridge.glsl"
#include "blocker_bridge.glsl"

// By froxel, as the constants have it for all: scattering in rgb, extinction in a.
layout(set = 0, binding = MEDIUM_BINDING) uniform texture3D medium_image;

struct Scattered {
    float extinction; // at the froxel
    vec3 sum;
    uint pick;     // the light of the froxel's ray
    float weights; // of those that came
    float random;
};

// What part of a light arrives by one ray, which is drawn over it as a cosine towards its center sees it.
float ray_arrives(uint pick, ArealightPoint point, vec2 random) {
    PickedLight light = picked_light(pick, point.position);
    mat3 to_light = arealight_frame_matrix(arealight_surface_frame(light.center, light.center));
    ArealightShadowOutline outline = chosen_outline(light, to_light, random.x);
    ArealightShadowRay ray;
    if (!arealight_draw_ray(outline, to_light, mat3(1.0), random, ray)) {
        return 1.0;
    }
    float end = ray.distance * AREALIGHT_RAY_PART;
    return arealight_bridge_blocker(point.position, ray.direction, end) < end ? 0.0 : 1.0;
}

// Adds what is scattered of the light of an index, of PICK_SHAPE or 0.
//
// On its way to the froxel it is dimmed as on that from its center, by a medium that is as here.
void add_scattered(inout Scattered scattered, ArealightMediumPoint medium, ivec3 froxel, uint index, vec3 center,
                   vec3 light) {
    light *= exp(-scattered.extinction * distance(center, medium.point.position));
    float weight = arealight_luminance(light);
    if (!(weight > 0.0)) {
        return;
    }
#if AREALIGHT_HOST_VISIBILITY
    light *= arealight_bridge_visibility(froxel.xy, medium.point.position, index & PICK_INDEX,
                                         (index & PICK_SHAPE) != 0u);
#endif
    if (MEDIUM_RAYS == RAY_A_LIGHT) {
        uint ray = constants.seed * constants.slices + uint(froxel.z);
        light *= ray_arrives(index, medium.point, arealight_sequence_2d(uvec2(froxel.xy), ray + 7919u * index));
    }
    if (MEDIUM_RAYS == RAY_A_FROXEL) {
        scattered.pick = arealight_choose(scattered.random, scattered.weights, weight) ? index : scattered.pick;
    }
    scattered.sum += light;
}

vec3 of_polygon(ArealightMediumPoint medium, ArealightGpuLight record) {
    if (HAS_PROFILES && (record.flags & LIGHT_PROFILE) != 0u) {
        return arealight_in_scattered(medium, load_shaped(record));
    }
    if (HAS_MESHES && (record.flags & LIGHT_MESH) != 0u) {
        return arealight_in_scattered(medium, load_mesh(record));
    }
    return arealight_in_scattered(medium, load_polygon(record));
}

vec3 of_shape(ArealightMediumPoint medium, ArealightGpuShape record) {
    if (HAS_TUBES && record.kind == SHAPE_TUBE) {
        return arealight_in_scattered(medium, load_tube(record));
    }
    if (HAS_SPHERES && record.kind == SHAPE_SPHERE) {
        return arealight_in_scattered(medium, load_sphere(record));
    }
    return HAS_DISKS ? arealight_in_scattered(medium, load_disk(record)) : vec3(0.0);
}

// The position in the middle of a column, at some depth before the camera: all of them are on its ray.
vec3 column_position(ivec3 froxel, ivec3 counts) {
    vec2 clip = (vec2(froxel.xy) + 0.5) / vec2(counts.xy) * 2.0 - 1.0;
    vec4 homogeneous = constants.position_from_clip * vec4(clip, 0.5, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

void main() {
    ivec3 froxel = ivec3(gl_GlobalInvocationID);
    ivec3 counts = froxel_counts();
    if (any(greaterThanEqual(froxel, counts))) {
        return;
    }
    vec4 here = vec4(constants.scattering, constants.extinction);
    if (MEDIUM_IMAGE) {
        here = texelFetch(medium_image, froxel, 0);
    }
    uint ray = constants.seed * constants.slices + uint(froxel.z);
    float within = MEDIUM_JITTER ? arealight_sequence(uvec2(froxel.xy), constants.seed) : 0.5;
    vec3 away = arealight_normalize_or(column_position(froxel, counts) - constants.camera, vec3(0.0, 0.0, 1.0));
    vec3 position = constants.camera + slice_distance(float(froxel.z) + within) * away;
    Scattered scattered = Scattered(here.a, vec3(0.0), NO_PICK, 0.0, arealight_sequence(uvec2(froxel.yx), ray));
    if (here.rgb != vec3(0.0)) {
        ArealightMediumPoint medium = arealight_medium_point(position, -away, constants.anisotropy);
        if (HAS_QUADS) {
            for (uint index = 0u; index < constants.quad_count; index++) {
                ArealightGpuLight record = lights[index];
                add_scattered(scattered, medium, froxel, index, record.center,
                              arealight_in_scattered(medium, load_quad(record)));
            }
        }
        if (HAS_POLYGONS) {
            for (uint index = constants.quad_count; index < constants.light_count; index++) {
                ArealightGpuLight record = lights[index];
                add_scattered(scattered, medium, froxel, index, record.center, of_polygon(medium, record));
            }
        }
        if (HAS_SHAPES) {
            for (uint index = 0u; index < constants.shape_count; index++) {
                ArealightGpuShape record = shapes[index];
                add_scattered(scattered, medium, froxel, PICK_SHAPE | index, record.center,
                              of_shape(medium, record));
            }
        }
        if (MEDIUM_RAYS == RAY_A_FROXEL && scattered.pick != NO_PICK) {
            scattered.sum *= ray_arrives(scattered.pick, medium.point, arealight_sequence_2d(uvec2(froxel.xy), ray));
        }
    }
    vec3 sum = min(here.rgb * scattered.sum, vec3(65504.0));
    imageStore(froxels, froxel, vec4(sum, clamp(here.a, 0.0, 65504.0)));
}
