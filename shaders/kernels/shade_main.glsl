#ifndef SHADE_MAIN_GLSL
#define SHADE_MAIN_GLSL

// Shades a G-buffer with every light of two buffers: polygons, and shapes.

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 2) const int POSITION_SOURCE = 0;
layout(constant_id = 3) const int OUTPUT = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
// Some polygon light is a convex quad without an image
layout(constant_id = 11) const bool QUADS = true;
layout(constant_id = 13) const int LAYOUT = 0;

#define LIGHTS_BINDING 1
#define G_BUFFER_BINDING 3
#define G_BUFFER_LAYOUT LAYOUT
#define RADIANCE_BINDING 7
#define LIGHT_TEXTURES_BINDING 8
#define SHAPES_BINDING 9
#define GLOSSY_BINDING 10
// The lights are the frame's
#define AREALIGHT_UNIFORM_LIGHTS 1
#include "table_image.glsl"
#include "lights.glsl"
#include "g_buffer.glsl"
#include "shape_buffer.glsl"
#include "output.glsl"

layout(push_constant, std430) uniform ShadeConstants {
    mat4 position_from_clip;
    vec3 camera;
    uint light_count;
    uint shape_count;
    uint quad_count; // of the first lights: convex quads without an image
} constants;

#include "position.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(radiance_image);
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
    if (any_together(hit)) {
        ArealightSurface surface = load_surface(pixel, position, constants.camera, EFFECTS);
        ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
        ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);
        // Every loop ends with its condition: devices that run masked passes have none to run then. Not by functions: so
        // compilers drop what is not called for before they inline it
        uint quad_count = (EFFECTS & BEYOND_QUADS) != 0u ? constants.quad_count : constants.light_count;
        if (QUADS && quad_count != 0u) {
            uint index = 0u;
            do {
                ArealightPolygonLight light = load_light(index);
                add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS & ~BEYOND_QUADS, quality));
                index++;
            } while (index < quad_count);
        }
        if ((EFFECTS & BEYOND_QUADS) != 0u && quad_count < constants.light_count) {
            uint index = quad_count;
            do {
                ArealightPolygonLight light = load_light(index);
                add_light(sum, light.radiance, arealight_polygon_reflected(point, light, EFFECTS, quality));
                index++;
            } while (index < constants.light_count);
        }
        if ((EFFECTS & ANY_SHAPE) != 0u && constants.shape_count != 0u) {
            uint index = 0u;
            do {
                ArealightShape shape = load_shape(index, SHAPE_ANY);
                add_light(sum, shape.radiance, arealight_shape_reflected(point, shape, EFFECTS, quality));
                index++;
            } while (index < constants.shape_count);
        }
    }

    if (is_inside) {
        store_radiance(pixel, hit, sum);
    }
}

#endif
