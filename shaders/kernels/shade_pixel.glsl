#ifndef SHADE_PIXEL_GLSL
#define SHADE_PIXEL_GLSL

// How a pixel is shaded with a list of polygons and one of shapes. The including kernel has shade_resources.glsl, push constants with
// camera, a struct LightList with quad_count, light_count and shape_count, and
// - uint light_at(LightList list, uint place): a polygon of the list, of which the first quad_count are convex quads without an image;
// - uint shape_at(LightList list, uint place): a shape of the list;
// - HAS_LIGHTS, HAS_QUADS, HAS_OTHERS, HAS_SHAPES: whether a pixel may have any light, such quads, other polygons, shapes.

#include "position.glsl"

PixelRadiance shade_surface(ivec2 pixel, vec3 position, LightList list) {
    ArealightSurface surface = load_surface(pixel, position, constants.camera, EFFECTS);
    ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));

    if (HAS_QUADS) {
        for (uint place = 0u; place < list.quad_count; place++) {
            ArealightPolygonLight light = load_light(light_at(list, place));
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS & ~BEYOND_QUADS, quality));
        }
    }
    if (HAS_OTHERS) {
        for (uint place = list.quad_count; place < list.light_count; place++) {
            ArealightPolygonLight light = load_light(light_at(list, place));
            add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS, quality));
        }
    }
    if (HAS_SHAPES) {
        for (uint place = 0u; place < list.shape_count; place++) {
            ArealightShape shape = load_shape(shape_at(list, place), SHAPE_ANY);
            add_light(sum, shape.radiance, arealight_shape_reflected(point, shape, EFFECTS, quality));
        }
    }
    return sum;
}

// Shades a pixel of an image of that size, if it is one, and stores it.
void shade_pixel(ivec2 pixel, ivec2 size, LightList list) {
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    vec3 position;
    bool hit = load_position(pixel, size, position);
    PixelRadiance sum = PixelRadiance(vec3(0.0), vec3(0.0));
    if (HAS_LIGHTS && hit) {
        sum = shade_surface(pixel, position, list);
    }
    store_radiance(pixel, hit, sum);
}

#endif
