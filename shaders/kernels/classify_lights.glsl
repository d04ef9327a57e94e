#ifndef CLASSIFY_LIGHTS_GLSL
#define CLASSIFY_LIGHTS_GLSL

// Tests lights against the bounds of a tile. What is found holds for every pixel:
//
// - A light is left out where it contributes to no lobe: it is wholly below the lobe's horizon, or the pixel
//   is behind a flat light of one side.
// - With CULL its contribution has bounds (tile_contribution.glsl).
//
// Margins: 1e-5 of the distances, which is a hundred times what positions and planes are rounded by, and 1e-3
// of the radius for lights that are flat to 1e-4 of it. Comparisons are such that NaN leaves nothing out.

#include "classify_pixels.glsl"

const float MARGIN = 1e-5;

// The lights of a frame, polygons and then shapes.
uint light_total() {
    return light_count() + (HAS_SHAPES ? shape_count() : 0u);
}

float sum_of(vec3 radiance) {
    return radiance.x + radiance.y + radiance.z;
}

TileLight polygon_light(uint index) {
    ArealightGpuLight record = lights[index];
    bool is_flat = (record.flags & LIGHT_FLAT) != 0u;
    TileLight light;
    light.center = record.center;
    light.radius = record.radius;
    light.normal = is_flat ? record.normal : vec3(0.0);
    light.two_sided = (EFFECTS & EFFECT_TWO_SIDED) != 0u && (record.flags & LIGHT_TWO_SIDED) != 0u;
    light.radiance = sum_of(record.radiance);
    light.area = record.area * (record.radius * record.radius);
    light.least = light.area;
    if (HAS_PROFILES && (record.flags & LIGHT_PROFILE) != 0u) {
        light.least = 0.0;
    }
    // What an image shows may be brighter than the light, or black
    bool has_image = (EFFECTS & EFFECT_TEXTURED) != 0u && record.texture_layer != NO_LIGHT_TEXTURE;
    light.over_half_vectors = AREALIGHT_HAS_HALF_VECTORS && !has_image;
    light.is_bounded = light.normal != vec3(0.0) && !has_image && !light.over_half_vectors;
    return light;
}

TileLight shape_light(uint index) {
    ArealightGpuShape shape = shapes[index];
    TileLight light;
    light.center = shape.center;
    light.radius = shape.radius;
    light.normal = vec3(0.0);
    light.two_sided = (shape.flags & SHAPE_TWO_SIDED) != 0u;
    light.radiance = sum_of(shape.radiance);
    light.area = TILE_PI * (shape.radius * shape.radius);
    light.least = light.area;
    light.over_half_vectors = false;
    light.is_bounded = true;
    if (shape.kind == SHAPE_DISK) {
        vec3 area = cross(shape.axis_u, shape.axis_v);
        light.normal = arealight_normalize_or(area, vec3(0.0));
        light.area = TILE_PI * sqrt(dot(area, area));
        light.least = light.area;
        bool has_image = (EFFECTS & EFFECT_TEXTURED_ELLIPSE) != 0u && shape.detail != NO_LIGHT_TEXTURE;
        light.is_bounded = light.normal != vec3(0.0) && !has_image;
    } else if (shape.kind == SHAPE_TUBE) {
        // Half of a capsule's surface; those with flat ends or none have less
        float half_length = sqrt(dot(shape.axis_u, shape.axis_u));
        light.radius += half_length;
        light.area = 2.0 * TILE_PI * shape.radius * light.radius;
        light.least = 0.0;
    }
    return light;
}

// Whether all of a tile is outside of the cone of a light with a profile, within an angle of its normal;
// `before`: how far its farthest pixel is before the light's center.
bool is_outside_cone(uint index, TileLight light, float before) {
    uint flags = lights[index].flags;
    if ((flags & LIGHT_PROFILE) == 0u || light.two_sided || light.normal == vec3(0.0)) {
        return false;
    }
    TileBox position = tile_position();
    vec3 side = max(max(position.low - light.center, light.center - position.high), vec3(0.0));
    float nearest = sqrt(dot(side, side)) - light.radius - light.margin;
    float highest = before + TILE_FLATNESS * light.radius + light.margin;
    return nearest > 0.0 && highest < float(flags >> 16) * (1.0 / 65535.0) * nearest;
}

// A light of the frame, as the pixels of the tile have it before them.
TileLight tile_light(uint index) {
    TileLight light;
    if (!HAS_SHAPES || index < light_count()) {
        light = polygon_light(index);
    } else {
        light = shape_light(index - light_count());
    }
    light.center -= IS_ORTHOGRAPHIC ? vec3(0.0) : constants.camera;
    light.distance = sqrt(dot(light.center, light.center)) + tile_distance();
    light.margin = MARGIN * (light.distance + light.radius);
    return light;
}

// The least and the most that a light contributes. Without bounds, or without CULL, the most is TILE_FAR;
// where the light contributes nothing, it is negative.
vec2 contribution(uint index) {
    if (index >= light_total()) {
        return vec2(0.0, -1.0);
    }
    TileLight light = tile_light(index);
    vec2 behind = vec2(dot(light.normal, light.center)) - box_dot(tile_position(), light.normal).yx;
    bool is_behind = light.normal != vec3(0.0) && !light.two_sided
                  && behind.x > TILE_FLATNESS * light.radius + light.margin;
    if (HAS_PROFILES && index < light_count()) {
        is_behind = is_behind || is_outside_cone(index, light, -behind.x);
    }

    TileLightHeights heights;
    heights.surface = tile_heights(tile_planes(SURFACE_PAIR), light);
    heights.lobe = HAS_HORIZON ? tile_heights(tile_planes(LOBE_PAIR), light).y : 0.0;
    // A rough diffuse lobe leans, and its horizon with it
    bool is_below = !tile_is_diffuse() || (heights.surface.y < 0.0 && (!AREALIGHT_HAS_ROUGH_DIFFUSE
        || AREALIGHT_CLIPS_AT_SURFACE));
    // Horizons of fitted lobes lean; GGX over half vectors ends where the surface does, and a coat where its
    // own does
    bool ends_at_surface = AREALIGHT_CLIPS_AT_SURFACE || light.over_half_vectors;
    if (HAS_GLOSSY) {
        bool is_below_lobe = HAS_HORIZON && heights.lobe < 0.0 && tile_has_lobe() && !light.over_half_vectors;
        is_below = is_below && (is_below_lobe || (ends_at_surface && heights.surface.y < 0.0));
    }
    if (AREALIGHT_HAS_SHEEN) {
        is_below = is_below && (tile_has_lobe() || (AREALIGHT_CLIPS_AT_SURFACE && heights.surface.y < 0.0));
    }
    if (tile_coat_spread() >= 0.0) {
        heights.coat.x = tile_heights(tile_planes(COAT_PAIR), light).y;
        bool is_below_coat = heights.coat.x < 0.0 && tile_has_coat_horizon() && !light.over_half_vectors;
        bool coat_ends_at_surface = AREALIGHT_HAS_COAT_NORMAL ? AREALIGHT_CLIPS_AT_SURFACE : ends_at_surface;
        is_below = is_below && (is_below_coat || (coat_ends_at_surface && heights.surface.y < 0.0));
    }
    bool is_dark = light.radiance == 0.0;
    if (tile_is_known() && (is_behind || is_below || is_dark)) {
        return vec2(0.0, -1.0);
    }

    vec2 sent = vec2(0.0, TILE_FAR);
    if (CULL != 0u) {
        heights.mirror = HAS_HORIZON ? tile_heights(tile_planes(MIRROR_PAIR), light).y : 0.0;
        heights.coat.y = tile_coat_spread() >= 0.0 ? tile_heights(tile_planes(COAT_MIRROR_PAIR), light).y
            : 0.0;
        vec2 bounds = tile_contribution(tile_reflection(), tile_position(), light, heights, behind);
        // NaN is neither little nor much
        bool is_known = tile_is_known() && !AREALIGHT_HAS_ROUGH_DIFFUSE && !AREALIGHT_RESCATTERS
            && tile_has_lobe() && tile_has_coat_horizon();
        bool is_sure = light.is_bounded && is_known && bounds.x >= 0.0 && bounds.y < TILE_FAR;
        sent = is_sure ? bounds : sent;
    }
    return sent;
}

#endif
