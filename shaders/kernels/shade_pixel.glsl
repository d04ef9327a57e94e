#ifndef SHADE_PIXEL_GLSL
#define SHADE_PIXEL_GLSL

// How a pixel is shaded with a list of polygons, and all shapes. The including kernel has shade_resources.glsl, push constants with
// camera and shape_count, a struct LightList with quad_count and light_count, and
// - uint light_at(LightList list, uint place): a light of the list, of which the first quad_count are convex quads without an image;
// - HAS_LIGHTS, HAS_QUADS, HAS_OTHERS: whether a pixel may have any light, such quads, other polygons.

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
    if ((EFFECTS & ANY_SHAPE) != 0u) {
        for (uint index = 0u; index < constants.shape_count; index++) {
            ArealightShape shape = load_shape(index, SHAPE_ANY);
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
