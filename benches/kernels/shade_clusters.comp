#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The shade kernel over the lights of a host's clusters: parts of the view by columns, rows and slices of
// depth, whose lists the CPU made (benches/src/clusters.rs). The same reads and the same shading of a pixel
// as shade.comp; the lists are where that has those of tiles.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 11) const bool HAS_QUADS = true;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 15) const int SHADOW_RAYS = 0;
layout(constant_id = 19) const uint VIEW = 0u;

#define LIGHTS_BINDING 1
#define G_BUFFER_BINDING 3
#define G_BUFFER_LAYOUT LAYOUT
#define RADIANCE_BINDING 7
#define LIGHT_TEXTURES_BINDING 8
#define SHAPES_BINDING 9
#define GLOSSY_BINDING 10
#define COAT_BINDING 11
#define SHEEN_BINDING 12
#define ANISOTROPY_BINDING 13
#define FILM_BINDING 14
#define PICKS_BINDING 15
#include "effects.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "g_buffer.glsl"
#include "output.glsl"
#include "shade_constants.glsl"

// In front: columns, rows and slices; where the first slice begins; slices over ln(far / near); the unit view
// direction. From CLUSTERS on two words a cluster, where its lights are and how many. Then the lights of all:
// indices of records.
const uint CLUSTERS = 8u;
layout(set = 0, binding = 18, std430) readonly buffer ClusterLists {
    uint cluster_lists[];
};

// Where the words of the cluster of a pixel at a position are.
uint cluster_at(ivec2 pixel, vec3 position) {
    uvec3 counts = uvec3(cluster_lists[0], cluster_lists[1], cluster_lists[2]);
    vec3 forward = uintBitsToFloat(uvec3(cluster_lists[5], cluster_lists[6], cluster_lists[7]));
    float depth = dot(position - constants.camera, forward);
    float slice = log(max(depth, 1e-30) / uintBitsToFloat(cluster_lists[3]))
        * uintBitsToFloat(cluster_lists[4]);
    uvec2 cell = uvec2(pixel) * counts.xy / constants.size;
    uint layer = uint(clamp(slice, 0.0, float(counts.z - 1u)));
    return CLUSTERS + 2u * ((layer * counts.y + cell.y) * counts.x + cell.x);
}

const bool HAS_LIGHTS = true;
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
    uint first;
};
uint light_at(LightList list, uint index) {
    return cluster_lists[list.first + index];
}
uint shape_at(LightList list, uint index) {
    return index;
}

#include "shade_pixel.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = ivec2(constants.size);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec3 position;
    LightList list = LightList(0u, 0u, 0u, 0u);
    if (load_position_of(g_buffer_texel(pixel), pixel, size, position)) {
        uint cluster = cluster_at(pixel, position);
        uint count = cluster_lists[cluster + 1u];
        list = LightList(count, count, 0u, cluster_lists[cluster]);
    }
    shade_pixel(pixel, list);
}
