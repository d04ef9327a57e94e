#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// eval.comp's twin for disks, spheres and tubes. The shapes' centers are relative to the shading point that they belong
// to.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int FRESNEL = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 10) const int SHAPE = 3;

#define SHAPES_BINDING 1
#define CASES_BINDING 2
#define LIGHT_TEXTURES_BINDING 4
#include "table_image.glsl"
#include "light_textures.glsl"
#include "shape_buffer.glsl"
#include "cases.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightGpuCase given = cases[index];
    ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(case_surface(given), EFFECTS, quality);
    vec3 radiance = arealight_shape_radiance(point, load_shape(given.light, SHAPE), EFFECTS, quality);
    results[index] = vec4(radiance, 0.0);
}
