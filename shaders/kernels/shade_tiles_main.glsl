#ifndef SHADE_TILES_MAIN_GLSL
#define SHADE_TILES_MAIN_GLSL

// Shades the tiles of one class, that the kernel classify found, with the lights of their lists; or all tiles of a frame that
// was not classified, with all lights. A group a tile. Radiance is that of the kernel shade, light by light and arc by arc.

#include "shade_resources.glsl"

layout(constant_id = 12) const uint CLASS = 2u;

#define TILE_LISTS_BINDING 11
#define TILE_LISTS_ACCESS readonly
#include "tiles.glsl"

const bool HAS_LIGHTS = CLASS != CLASS_EMPTY;
const bool HAS_QUADS = true;
const bool HAS_OTHERS = (EFFECTS & BEYOND_QUADS) != 0u
                     && (CLASS == CLASS_ANY || CLASS == TILE_NOT_CLASSIFIED);

// The lights of a tile, or those of the buffer.
struct LightList {
    uint quad_count;
    uint light_count;
    bool is_listed;
    uint first; // where a tile's are
};
uint light_at(LightList list, uint place) {
    return list.is_listed ? tile_lists[list.first + place] : place;
}
LightList lights_of(uvec2 tile) {
    uint record = tile_record(tile);
    LightList list = LightList(constants.quad_count, constants.light_count, false, record + TILE_RECORD_HEADER);
    if (CLASS != TILE_NOT_CLASSIFIED && tile_lists[record + 1u] != TILE_ALL_LIGHTS) {
        list = LightList(tile_lists[record], tile_lists[record + 1u], true, record + TILE_RECORD_HEADER);
    }
    return list;
}

#include "shade_pixel.glsl"

void main() {
    // Find the group's tile
    uvec2 tile = gl_WorkGroupID.xy;
    if (CLASS != TILE_NOT_CLASSIFIED) {
        uint place = gl_WorkGroupID.y * TILE_ROW + gl_WorkGroupID.x;
        if (place >= tile_lists[CLASS * TILE_CLASS_WORDS + 3u]) {
            return;
        }
        tile = unpack_tile(tile_lists[class_list(CLASS) + place]);
    }
    ivec2 pixel = ivec2(tile) * TILE_SIDE + ivec2(gl_LocalInvocationID.xy);
    shade_pixel(pixel, ivec2(constants.size), lights_of(tile));
}

#endif
