#ifndef TILES_GLSL
#define TILES_GLSL

// What the kernel classify finds of each tile of 8 x 8 pixels, and shade reads. crates/arealight/src/tiles.rs
// has the same numbers, and a test compares them. The including kernel defines TILE_LISTS_BINDING and
// TILE_LISTS_ACCESS.

#include "shade_constants.glsl"

const int TILE_SIDE = 8;

// The classes of tiles; crates/arealight/src/tiles.rs defines them.
const uint CLASS_EMPTY = 0u;
const uint CLASS_QUADS = 1u;
const uint CLASS_ANY = 2u;
// No class: of whole frames, which have no tiles.
const uint CLASS_FRAME = 3u;

// The words of the lists:
// - for each class VkDispatchIndirectCommand, and how many tiles it has;
// - from TILE_FIRST_LIST on, for each class its tiles, in as many words as there are tiles: column and row,
//   16 bits each;
// - for each tile a record: how many convex quads without an image it has, how many polygons in all, and how
//   many shapes (or TILE_ALL_LIGHTS thrice, for the lights of the frame); then the indices of its polygons
//   and of its shapes, in the order of their buffers, in as many words as the capacity.
const uint TILE_CLASS_WORDS = 4u;
const uint TILE_FIRST_LIST = 12u;
const uint TILE_RECORD_HEADER = 3u;
const uint TILE_ALL_LIGHTS = 0xffffffffu;

// Workgroups of a class's dispatch in x. Vulkan promises 65535.
const uint TILE_ROW = 32768u;

layout(set = 0, binding = TILE_LISTS_BINDING, std430) TILE_LISTS_ACCESS buffer TileLists {
    uint tile_lists[];
};

uvec2 tile_counts() {
    return (constants.size + uint(TILE_SIDE - 1)) / uint(TILE_SIDE);
}

// Where the tiles of a class are.
uint class_list(uint tile_class) {
    uvec2 counts = tile_counts();
    return TILE_FIRST_LIST + tile_class * (counts.x * counts.y);
}

// Where a tile's record is.
uint tile_record(uvec2 tile) {
    return class_list(CLASS_ANY + 1u) + (tile.y * tile_counts().x + tile.x)
        * (TILE_RECORD_HEADER + constants.capacity);
}

// A tile's column and row in a word, and out of it.
uint pack_tile(uvec2 tile) {
    return tile.y << 16 | tile.x;
}
uvec2 unpack_tile(uint tile) {
    return uvec2(tile & 0xffffu, tile >> 16);
}

#endif
