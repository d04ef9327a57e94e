#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Sorts tiles of 8 x 8 pixels into classes by the lights that contribute to them, and lists those lights: a
// workgroup per tile. Its invocations read a pixel each, and reduce what they found to bounds over the tile;
// then they test every 64th light each against the bounds. With CULL lights are left out too whose
// contributions add up to less than the fraction `cull_threshold` of those of the others, from each pixel, in
// the sum of the channels.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 14) const uint CULL = 0u;
layout(constant_id = 19) const uint VIEW = 0u;
layout(constant_id = 20) const bool LIGHT_COUNTS = false;
layout(constant_id = 21) const int SAMPLES = 1;

#include "bindings.glsl"
#define G_BUFFER_LAYOUT LAYOUT
#define G_BUFFER_SAMPLES SAMPLES
#define TILE_LISTS_ACCESS
#define AREALIGHT_FOOTPRINT 0
#include "effects.glsl"
#include "arealight/options.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "g_buffer.glsl"
#include "light_records.glsl"
#include "tiles.glsl"
#include "light_counts.glsl"
#include "position.glsl"
#include "view.glsl"

const bool HAS_DIFFUSE = AREALIGHT_HAS_DIFFUSE;
const bool HAS_GLOSSY = (EFFECTS & EFFECT_GLOSSY) != 0u;
// Whether the horizon of the glossy lobe can be known: the table's cells do not hold for the formula.
const bool HAS_HORIZON = HAS_GLOSSY && !AREALIGHT_USES_FORMULA;
// Likewise that of the coat's.
const bool HAS_COAT_HORIZON = AREALIGHT_HAS_COAT && !AREALIGHT_USES_FORMULA;

#include "classify_lights.glsl"

#define LISTED(place) tile_lists[tile_list + place]
#define LIST_CAPACITY constants.capacity
// Where the tile's list begins.
uint tile_list;

// What is left out is to be a fraction of what stays.
float cull_budget(float least) {
    tile_parts[gl_LocalInvocationIndex] = least;
    barrier();
    float sum = 0.0;
    for (uint part = 0u; part < TILE_PIXELS; part++) {
        sum += tile_parts[part];
    }
    return sum * constants.cull_threshold / (1.0 + constants.cull_threshold) / TILE_ROUNDING;
}
#include "list_lights.glsl"

// Writes the list of the lights that contribute to a tile. The cheapest class that shades it.
uint write_record(uvec2 tile) {
    uint record = tile_record(tile);
    tile_list = record + TILE_RECORD_HEADER;
    uvec3 counts = list_lights();
    bool is_listed = counts.z <= constants.capacity;
    if (gl_LocalInvocationIndex == 0u) {
        tile_lists[record] = is_listed ? counts.x : TILE_ALL_LIGHTS;
        tile_lists[record + 1u] = is_listed ? counts.y : TILE_ALL_LIGHTS;
        tile_lists[record + 2u] = is_listed ? counts.z - counts.y : TILE_ALL_LIGHTS;
    }
    if (!is_listed) {
        return quad_count() < light_total() ? CLASS_ANY : CLASS_QUADS;
    }
    return counts.z == 0u ? CLASS_EMPTY : (counts.x == counts.z ? CLASS_QUADS : CLASS_ANY);
}

// Adds the tile to the list of a class, and a workgroup to the class's dispatch.
void append(uvec2 tile, uint tile_class) {
    uint dispatch = tile_class * TILE_CLASS_WORDS;
    uint place = atomicAdd(tile_lists[dispatch + 3u], 1u);
    tile_lists[class_list(tile_class) + place] = pack_tile(tile);
    atomicMax(tile_lists[dispatch], min(place + 1u, TILE_ROW));
    if (place % TILE_ROW == 0u) {
        atomicAdd(tile_lists[dispatch + 1u], 1u);
    }
}

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    reduce_pixels(ivec2(gl_GlobalInvocationID.xy));
    barrier();

    uint tile_class = CLASS_EMPTY;
    if (tile_distance() >= 0.0) {
        tile_class = write_record(tile);
    }
    if (gl_LocalInvocationIndex == 0u) {
        append(tile, tile_class);
    }
}
