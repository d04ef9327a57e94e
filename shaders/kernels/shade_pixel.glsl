#ifndef SHADE_PIXEL_GLSL
#define SHADE_PIXEL_GLSL

// How a pixel is shaded with a list of polygons, and all shapes. The including kernel has shade_resources.glsl, push constants with
// camera and shape_count, a struct LightList with quad_count and light_count, and
// - uint light_at(LightList list, uint place): a light of the list, of which the first quad_count are convex quads without an image;
// - HAS_LIGHTS, HAS_QUADS, HAS_OTHERS: whether a pixel may have any light, such quads, other polygons;
// - IS_ABOVE: whether no light has to be clipped.

#include "position.glsl"

PixelRadiance shade_surface(ivec2 pixel, vec3 position, LightList list) {
    ArealightSurface surface = load_surface(pixel, position, constants.camera, EFFECTS);
    ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);
    int of_polygons = IS_ABOVE ? AREALIGHT_HORIZON_ABOVE : HORIZON;
    int of_shapes = IS_ABOVE ? AREALIGHT_HORIZON_BARE : HORIZON;
    ArealightQuality polygon_quality = ArealightQuality(FORM_FACTOR, of_polygons, FRESNEL, LOBES, FOOTPRINT);
    ArealightQuality shape_quality = ArealightQuality(FORM_FACTOR, of_shapes, FRESNEL, LOBES, FOOTPRINT);
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));

    // Every loop ends with its condition: devices that run masked passes have none to run then
    if (HAS_QUADS && list.quad_count != 0u) {
        uint place = 0u;
        do {
            ArealightPolygonLight light = load_light(light_at(list, place));
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS & ~BEYOND_QUADS, polygon_quality));
            place++;
        } while (place < list.quad_count);
    }
    if (HAS_OTHERS && list.quad_count < list.light_count) {
        uint place = list.quad_count;
        do {
            ArealightPolygonLight light = load_light(light_at(list, place));
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS, polygon_quality));
            place++;
        } while (place < list.light_count);
    }
    if ((EFFECTS & ANY_SHAPE) != 0u && constants.shape_count != 0u) {
        uint index = 0u;
        do {
            ArealightShape shape = load_shape(index, SHAPE_ANY);
            add_light(sum, shape.radiance, arealight_shape_reflected(point, shape, EFFECTS, shape_quality));
            index++;
        } while (index < constants.shape_count);
    }
    return sum;
}

// Shades a pixel of an image of that size, if it is one, and stores it.
void shade_pixel(ivec2 pixel, ivec2 size, LightList list) {
    // Items go on, though they have no pixel or no surface, where others of their subgroup need them to read
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
    if (HAS_LIGHTS && any_together(hit)) {
        sum = shade_surface(pixel, position, list);
    }
    if (is_inside) {
        store_radiance(pixel, hit, sum);
    }
}

#endif
