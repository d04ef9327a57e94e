#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// What a medium scatters towards the camera once, of every light: an invocation per froxel, at a distance
// that is drawn within it from frame to frame or in its middle, or at several places. What blocks light is
// asked by rays: one over a light, drawn by how much of each is scattered, or one over each light. Lights of
// frames with many are listed first for the froxels of a workgroup. Without MEDIUM_HIDDEN, froxels that
// medium_hide has not marked hold nothing.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 11) const bool HAS_QUADS = true;
layout(constant_id = 22) const int MEDIUM_RAYS = 0;
layout(constant_id = 23) const bool MEDIUM_IMAGE = false;
layout(constant_id = 24) const bool MEDIUM_JITTER = false;
layout(constant_id = 25) const uint MEDIUM_SAMPLES = 1u;
layout(constant_id = 26) const bool MEDIUM_LISTS = false;
layout(constant_id = 27) const bool MEDIUM_HIDDEN = true;
const uint CULL = 1u;
const int HORIZON = 0;
const int SPECULAR_LOBES = 0;
const int LOBES = 0;

// Values of MEDIUM_RAYS
const int RAY_A_FROXEL = 1;
const int RAY_A_LIGHT = 2;

#define AREALIGHT_MEDIA 1
#include "froxels.glsl"
#include "effects.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "scattered_light.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "arealight/shadows/sequence.glsl"
#include "pick_bits.glsl"
#include "picked_light.glsl"
#include "visibility_bridge.glsl"
#include "blocker_bridge.glsl"
#include "cell_lights.glsl"

// By froxel, as the constants have it for all: scattering in rgb, extinction in a.
layout(set = 0, binding = MEDIUM_BINDING) uniform texture3D medium_image;

struct Scattered {
    float extinction; // at the froxel
    uvec2 column;
    uint ray; // of the column
    vec3 sum;
    uint pick;     // the light of the sample's ray
    float weights; // of those that came
    float random;
};

// What part of a light arrives by one ray, which is drawn over it as a cosine towards its center sees it.
float ray_arrives(uint pick, vec3 position, vec2 random) {
    PickedLight light = picked_light(pick, position);
    mat3 to_light = arealight_frame_matrix(arealight_surface_frame(light.center, light.center));
    ArealightShadowOutline outline = chosen_outline(light, to_light, random.x);
    ArealightShadowRay ray;
    if (!arealight_draw_ray(outline, to_light, mat3(1.0), random, ray)) {
        return 1.0;
    }
    turn_to_side(light, outline, ray);
    float end = ray.distance * AREALIGHT_RAY_PART;
    return arealight_bridge_blocker(position, ray.direction, end) < end ? 0.0 : 1.0;
}

// Adds what is scattered of the light of an index, of PICK_SHAPE or 0.
//
// On its way to the froxel it is dimmed as on that from its center, less `depth`, by what is here.
void add_scattered(inout Scattered scattered, ArealightMediumPoint medium, uint index, vec3 center,
                   float depth, vec3 light) {
    vec3 position = medium.point.position;
    light *= exp(-scattered.extinction * max(distance(center, position) - depth, 0.0));
    float weight = arealight_luminance(light);
    if (!(weight > 0.0)) {
        return;
    }
#if AREALIGHT_HOST_VISIBILITY
    light *= arealight_bridge_visibility(ivec2(scattered.column), position, index & PICK_INDEX,
                                         (index & PICK_SHAPE) != 0u);
#endif
    if (MEDIUM_RAYS == RAY_A_LIGHT) {
        vec2 random = arealight_sequence_2d(scattered.column, scattered.ray + 7919u * index);
        light *= ray_arrives(index, position, random);
    }
    if (MEDIUM_RAYS == RAY_A_FROXEL) {
        bool is_chosen = arealight_choose(scattered.random, scattered.weights, weight);
        scattered.pick = is_chosen ? index : scattered.pick;
    }
    scattered.sum += light;
}

// What a point of a medium scatters of every light of its cell's.
vec3 all_scattered(Scattered scattered, ArealightMediumPoint medium, CellList list) {
    if (HAS_QUADS) {
        for (uint place = 0u; place < list.quad_count; place++) {
            uint index = cell_light(list, place);
            ArealightGpuLight record = lights[index];
            vec3 light = arealight_in_scattered(medium, load_quad(record));
            add_scattered(scattered, medium, index, record.center, 0.0, light);
        }
    }
    if (HAS_POLYGONS) {
        for (uint place = list.quad_count; place < list.light_count; place++) {
            uint index = cell_light(list, place);
            ArealightGpuLight record = lights[index];
            add_scattered(scattered, medium, index, record.center, 0.0, in_scattered(medium, record));
        }
    }
    if (HAS_SHAPES) {
        for (uint place = 0u; place < list.shape_count; place++) {
            uint index = cell_light(list, list.light_count + place);
            ArealightGpuShape record = shapes[index];
            add_scattered(scattered, medium, PICK_SHAPE | index, record.center, seen_depth(record),
                          in_scattered(medium, record));
        }
    }
    if (MEDIUM_RAYS == RAY_A_FROXEL && scattered.pick != NO_PICK) {
        vec2 random = arealight_sequence_2d(scattered.column, scattered.ray);
        scattered.sum *= ray_arrives(scattered.pick, medium.point.position, random);
    }
    return scattered.sum;
}

// A sample of a froxel's: of every light, what the place of that index scatters.
vec3 sample_scattered(ivec3 froxel, ivec3 counts, uint index, float extinction, CellList list) {
    uvec2 column = uvec2(froxel.xy);
    uint ray = (constants.seed * uint(counts.z) + uint(froxel.z)) * MEDIUM_SAMPLES + index;
    // Across the column only where there are several
    vec2 across = MEDIUM_SAMPLES > 1u ? arealight_sequence_2d(column, ray) : vec2(0.5);
    float along = MEDIUM_JITTER ? arealight_sequence(column, constants.seed) : 0.5;
    float slice = float(froxel.z) + (float(index) + along) / float(MEDIUM_SAMPLES);
    vec3 away = column_direction(vec2(column) + across, counts);
    vec3 position = constants.camera + slice_distance(slice) * away;
    ArealightMediumPoint medium = arealight_medium_point(position, -away, constants.anisotropy);
    float random = arealight_sequence(column.yx, ray);
    return all_scattered(Scattered(extinction, column, ray, vec3(0.0), NO_PICK, 0.0, random), medium, list);
}

void main() {
    ivec3 froxel = ivec3(gl_GlobalInvocationID);
    ivec3 counts = froxel_counts();
    vec4 here = vec4(constants.scattering, constants.extinction);
    if (MEDIUM_IMAGE) {
        here = texelFetch(medium_image, min(froxel, counts - 1), 0);
    }
    CellList list = all_lights();
    if (MEDIUM_LISTS) {
        list = list_cell(counts, here.a);
    }
    if (any(greaterThanEqual(froxel, counts))) {
        return;
    }
    vec3 sum = vec3(0.0);
    bool is_shown = MEDIUM_HIDDEN || imageLoad(froxels, froxel).a != 0.0;
    if (is_shown && here.rgb != vec3(0.0)) {
        sum = sample_scattered(froxel, counts, 0u, here.a, list);
        for (uint index = 1u; MEDIUM_SAMPLES > 1u && index < MEDIUM_SAMPLES; index++) {
            sum += sample_scattered(froxel, counts, index, here.a, list);
        }
    }
    sum = min(here.rgb * sum / float(MEDIUM_SAMPLES), vec3(65504.0));
    imageStore(froxels, froxel, vec4(sum, clamp(here.a, 0.0, 65504.0)));
}
