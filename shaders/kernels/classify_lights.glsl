#ifndef CLASSIFY_LIGHTS_GLSL
#define CLASSIFY_LIGHTS_GLSL

// Tests lights against the bounds of a tile. What is found holds for every pixel:
//
// - A light is left out where it contributes to no lobe: it is wholly below the lobe's horizon, the pixel is
//   behind a flat light of one side, or in none of the light's groups.
// - With CULL its contribution has bounds (tile_contribution.glsl).
//
// Comparisons are such that NaN leaves nothing out.

#include "classify_pixels.glsl"

// The least and the most that a light contributes. Without bounds, or without CULL, the most is TILE_FAR;
// where the light contributes nothing, it is negative.
vec2 contribution(uint index) {
    if (index >= light_total()) {
        return vec2(0.0, -1.0);
    }
    TileLight light = tile_light(index);
    vec2 behind = tile_behind(light);
    bool is_behind = is_turned_away(index, light, behind);

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
    bool is_dark = light.radiance == 0.0 || (light.links != 0u && (light.links & tile_groups()) == 0u);
    if (tile_is_known() && (is_behind || is_below || is_dark)) {
        return vec2(0.0, -1.0);
    }

    vec2 sent = vec2(0.0, TILE_FAR);
    if (CULL != 0u) {
        heights.mirror = HAS_HORIZON ? tile_heights(tile_planes(MIRROR_PAIR), light).y : 0.0;
        heights.coat.y = tile_coat_spread() >= 0.0 ? tile_heights(tile_planes(COAT_MIRROR_PAIR), light).y
            : 0.0;
        vec2 bounds = tile_contribution(tile_reflection(), light, heights, tile_span(light, behind));
        // NaN is neither little nor much
        bool is_known = tile_is_known() && !AREALIGHT_HAS_ROUGH_DIFFUSE && !AREALIGHT_RESCATTERS
            && tile_has_lobe() && tile_has_coat_horizon();
        bool is_sure = light.is_bounded && is_known && bounds.x >= 0.0 && bounds.y < TILE_FAR;
        sent = is_sure ? bounds : sent;
    }
    return sent;
}

#endif
