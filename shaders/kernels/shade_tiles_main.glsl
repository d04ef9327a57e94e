#ifndef SHADE_TILES_MAIN_GLSL
#define SHADE_TILES_MAIN_GLSL

// Shades the tiles of one class, that the kernel classify found, with the lights of their lists; or all tiles of a frame that
// was not classified, with all lights. A group a tile. Radiance is that of the kernel shade, light by light and arc by arc.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 12) const uint CLASS = 4u;
layout(constant_id = 13) const int LAYOUT = 0;

#define LIGHTS_BINDING 1
#define G_BUFFER_BINDING 3
#define G_BUFFER_LAYOUT LAYOUT
#define RADIANCE_BINDING 7
#define LIGHT_TEXTURES_BINDING 8
#define SHAPES_BINDING 9
#define GLOSSY_BINDING 10
#define TILE_LISTS_BINDING 11
#define TILE_LISTS_ACCESS readonly
// The lights are the frame's, or the tile's, which is the group's
#define AREALIGHT_UNIFORM_LIGHTS 1
#include "table_image.glsl"
#include "lights.glsl"
#include "g_buffer.glsl"
#include "shape_buffer.glsl"
#include "output.glsl"
#include "tiles.glsl"
#include "position.glsl"

// Whether the tiles' lights may be other than convex quads without an image.
const bool HAS_OTHERS = (EFFECTS & BEYOND_QUADS) != 0u
                     && (CLASS == CLASS_ABOVE || CLASS == CLASS_ANY || CLASS == TILE_NOT_CLASSIFIED);
// Whether no light has to be clipped.
const bool IS_ABOVE = CLASS == CLASS_QUADS_ABOVE || CLASS == CLASS_ABOVE;

PixelRadiance shade(ivec2 pixel, uvec2 tile, vec3 position) {
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));
    ArealightSurface surface = load_surface(pixel, position, constants.camera, EFFECTS);
    ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);
    quality.horizon = IS_ABOVE ? AREALIGHT_HORIZON_ABOVE : HORIZON;

    // Take the tile's lights, or the buffer's
    uint first = tile_record(tile);
    uint quads = constants.quad_count;
    uint total = constants.light_count;
    bool is_listed = CLASS != TILE_NOT_CLASSIFIED && tile_lists[first + 1u] != TILE_ALL_LIGHTS;
    if (is_listed) {
        quads = tile_lists[first];
        total = tile_lists[first + 1u];
    }
    first += TILE_RECORD_HEADER;

    // Every loop ends with its condition, as in the kernel shade
    if (quads != 0u) {
        uint index = 0u;
        do {
            ArealightPolygonLight light = load_light(is_listed ? tile_lists[first + index] : index);
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS & ~BEYOND_QUADS, quality));
            index++;
        } while (index < quads);
    }
    if (HAS_OTHERS && quads < total) {
        uint index = quads;
        do {
            ArealightPolygonLight light = load_light(is_listed ? tile_lists[first + index] : index);
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS, quality));
            index++;
        } while (index < total);
    }
    if ((EFFECTS & ANY_SHAPE) != 0u && constants.shape_count != 0u) {
        quality.horizon = IS_ABOVE ? AREALIGHT_HORIZON_BARE : HORIZON;
        uint index = 0u;
        do {
            ArealightShape shape = load_shape(index, SHAPE_ANY);
            add_light(sum, shape.radiance, arealight_shape_reflected(point, shape, EFFECTS, quality));
            index++;
        } while (index < constants.shape_count);
    }
    return sum;
}

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
    ivec2 size = ivec2(constants.size);
    bool is_inside = all(lessThan(pixel, size));
    if (!any_together(is_inside)) {
        return;
    }
    if (IS_TOGETHER) {
        pixel = min(pixel, size - 1);
    } else {
        is_inside = true;
    }

    vec3 position;
    bool hit = load_position(pixel, size, position) && is_inside;
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));
    if (CLASS != CLASS_EMPTY && any_together(hit)) {
        sum = shade(pixel, tile, position);
    }
    if (is_inside) {
        store_radiance(pixel, hit, sum);
    }
}

#endif
