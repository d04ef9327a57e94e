#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Shades a G-buffer with lights of two buffers: polygons and meshes; disks, spheres and tubes. By CLASS
// either whole frames, with every light, an invocation per pixel; or the tiles of one class that the kernel
// classify found, with the lights of their lists, a workgroup per tile. A pixel's radiance is the same in
// both, light by light and arc by arc.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
// Whether the frame has convex quads without an image
layout(constant_id = 11) const bool HAS_QUADS = true;
// Of the tiles, or CLASS_FRAME
layout(constant_id = 12) const uint CLASS = 3u;
layout(constant_id = 13) const int LAYOUT = 0;
layout(constant_id = 15) const int SHADOW_RAYS = 0;
layout(constant_id = 19) const uint VIEW = 0u;
layout(constant_id = 20) const bool LIGHT_COUNTS = false;
layout(constant_id = 21) const int SAMPLES = 1;

#include "bindings.glsl"
#define G_BUFFER_LAYOUT LAYOUT
#define G_BUFFER_SAMPLES SAMPLES
#define TILE_LISTS_ACCESS readonly
#include "effects.glsl"
const bool HAS_SPECULAR_INPUT = (EFFECTS & EFFECT_SPECULAR_INPUT) != 0u;
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "g_buffer.glsl"
#include "output.glsl"
#include "tiles.glsl"
#include "light_counts.glsl"

const bool BY_TILES = CLASS != CLASS_FRAME;
const bool HAS_LIGHTS = CLASS != CLASS_EMPTY;
// EFFECTS of tiles of quads have none of these: TileClass::lights in Rust

// The lights of a pixel: those of its tile's list, or those of the frame.
struct LightList {
    uint quad_count;
    uint light_count;
    uint shape_count;
    bool is_listed;
    uint first; // where a tile's are
};
uint light_at(LightList list, uint index) {
    if (BY_TILES) {
        return list.is_listed ? tile_lists[list.first + index] : index;
    }
    return index;
}
uint shape_at(LightList list, uint index) {
    if (BY_TILES) {
        return list.is_listed ? tile_lists[list.first + list.light_count + index] : index;
    }
    return index;
}

#include "shade_pixel.glsl"

LightList lights_of_frame() {
    return LightList(HAS_POLYGONS ? quad_count() : light_count(), light_count(), shape_count(), false, 0u);
}

LightList lights_of_tile(uvec2 tile) {
    uint record = tile_record(tile);
    uvec3 counts = uvec3(tile_lists[record], tile_lists[record + 1u], tile_lists[record + 2u]);
    bool is_listed = counts.x != TILE_ALL_LIGHTS;
    counts = is_listed ? counts : uvec3(quad_count(), light_count(), shape_count());
    return LightList(counts.x, counts.y, counts.z, is_listed, record + TILE_RECORD_HEADER);
}

// The workgroup's tile, if the class has so many.
bool find_tile(out uvec2 tile) {
    uint index = gl_WorkGroupID.y * TILE_ROW + gl_WorkGroupID.x;
    tile = uvec2(0u);
    if (index >= tile_lists[CLASS * TILE_CLASS_WORDS + 3u]) {
        return false;
    }
    tile = unpack_tile(tile_lists[class_list(CLASS) + index]);
    return true;
}

// One call of shade_pixel: drivers that inline what they compile would have it twice.
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    LightList list;
    if (BY_TILES) {
        uvec2 tile;
        if (!find_tile(tile)) {
            return;
        }
        pixel = ivec2(tile) * TILE_SIDE + ivec2(gl_LocalInvocationID.xy);
        list = lights_of_tile(tile);
    } else {
        list = lights_of_frame();
    }
    shade_pixel(pixel, list);
}
