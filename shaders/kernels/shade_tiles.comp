#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shades the tiles of one class, that the kernel classify found, with the lights of their lists. A workgroup per tile. Radiance is that
// of the kernel shade, light by light and arc by arc.

#include "shade_resources.glsl"

// Whether the frame has convex quads without an image
layout(constant_id = 11) const bool HAS_QUADS = true;
layout(constant_id = 12) const uint CLASS = 2u;

#define TILE_LISTS_BINDING 13
#define TILE_LISTS_ACCESS readonly
#include "tiles.glsl"

const bool HAS_LIGHTS = CLASS != CLASS_EMPTY;
const bool HAS_POLYGONS = CLASS == CLASS_ANY && (EFFECTS & EFFECTS_OF_POLYGONS) != 0u;
const bool HAS_SHAPES = CLASS == CLASS_ANY && (EFFECTS & EFFECTS_OF_SHAPES) != 0u;

// The lights of a tile: those of its list, or those of the frame.
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
    bool is_listed;
    uint first; // where a tile's are
};
uint light_at(LightList list, uint index) {
    return list.is_listed ? tile_lists[list.first + index] : index;
}
uint shape_at(LightList list, uint index) {
    return list.is_listed ? tile_lists[list.first + list.light_count + index] : index;
}
LightList lights_of(uvec2 tile) {
    uint record = tile_record(tile);
    uvec3 counts = uvec3(tile_lists[record], tile_lists[record + 1u], tile_lists[record + 2u]);
    bool is_listed = counts.x != TILE_ALL_LIGHTS;
    counts = is_listed ? counts : uvec3(constants.quad_count, constants.light_count, constants.shape_count);
    return LightList(counts.x, counts.y, counts.z, is_listed, record + TILE_RECORD_HEADER);
}

#include "shade_pixel.glsl"

void main() {
    // Find the workgroup's tile
    uint index = gl_WorkGroupID.y * TILE_ROW + gl_WorkGroupID.x;
    if (index >= tile_lists[CLASS * TILE_CLASS_WORDS + 3u]) {
        return;
    }
    uvec2 tile = unpack_tile(tile_lists[class_list(CLASS) + index]);
    ivec2 pixel = ivec2(tile) * TILE_SIDE + ivec2(gl_LocalInvocationID.xy);
    shade_pixel(pixel, ivec2(constants.size), lights_of(tile));
}
