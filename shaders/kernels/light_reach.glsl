#ifndef LIGHT_REACH_GLSL
#define LIGHT_REACH_GLSL

// How far the lights of records are of any matter (arealight/reach.glsl), for kernels of a host that fill
// clusters of their own with them.

#include "arealight/reach.glsl"
#include "light_records.glsl"

struct LightReach {
    float radius; // about record.center
    vec3 low;     // the box's corners
    vec3 high;
};

LightReach light_reach(vec3 center, vec3 radiance, ArealightExtent extent, vec3 front, float threshold,
                       float density) {
    LightReach reach;
    reach.radius = arealight_reach(radiance, extent, threshold, density);
    arealight_reach_box(center, reach.radius, extent.size, front, reach.low, reach.high);
    return reach;
}

// A polygon or mesh. What is not flat is bounded by its sphere, which covers what it adds up to.
LightReach reach_of(ArealightGpuLight light, float threshold, float density) {
    bool is_flat = (light.flags & LIGHT_FLAT) != 0u;
    ArealightExtent extent = arealight_sphere_extent(light.radius);
    if (is_flat) {
        extent = arealight_polygon_extent(light.radius, light.area * (light.radius * light.radius));
    }
    vec3 front = is_flat && (light.flags & LIGHT_TWO_SIDED) == 0u ? light.normal : vec3(0.0);
    // What an image shows may be of any brightness
    threshold = light.texture_layer == NO_LIGHT_TEXTURE ? threshold : 0.0;
    return light_reach(light.center, light.radiance, extent, front, threshold, density);
}

// A disk, sphere or tube.
LightReach reach_of(ArealightGpuShape shape, float threshold, float density) {
    ArealightExtent extent = arealight_sphere_extent(shape.radius);
    vec3 front = vec3(0.0);
    if (shape.kind == SHAPE_DISK) {
        extent = arealight_disk_extent(shape.axis_u, shape.axis_v);
        bool is_two_sided = (shape.flags & SHAPE_TWO_SIDED) != 0u;
        front = is_two_sided ? front : arealight_normalize_or(cross(shape.axis_u, shape.axis_v), front);
        threshold = shape.detail == NO_LIGHT_TEXTURE ? threshold : 0.0;
    } else if (shape.kind == SHAPE_TUBE) {
        extent = arealight_tube_extent(shape.axis_u, shape.radius);
    }
    return light_reach(shape.center, shape.radiance, extent, front, threshold, density);
}

#endif
