#ifndef ROUND_LIGHTS_GLSL
#define ROUND_LIGHTS_GLSL

// The buffer of disks, spheres and tubes as the library's lights. The including kernel defines SHAPES_BINDING
// and the options of the library.

#include "light_records.glsl"
#include "light_textures.glsl"
#include "arealight/arealight.glsl"

ArealightDiskLight load_disk(ArealightGpuShape record) {
    return ArealightDiskLight(record.radiance, record.center, record.axis_u, record.axis_v,
                              (record.flags & SHAPE_TWO_SIDED) != 0u, AREALIGHT_HAS_TEXTURED_DISKS
                                  ? record.detail : AREALIGHT_NO_IMAGE);
}

ArealightSphereLight load_sphere(ArealightGpuShape record) {
    return ArealightSphereLight(record.radiance, record.center, record.radius,
                                (record.flags & SHAPE_TWO_SIDED) != 0u);
}

ArealightTubeLight load_tube(ArealightGpuShape record) {
    return ArealightTubeLight(record.radiance, record.center, record.axis_u, record.radius,
                              int(record.detail));
}

#endif
