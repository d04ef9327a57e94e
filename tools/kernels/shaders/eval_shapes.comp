#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// eval.comp's twin for disks, spheres and tubes. The shapes' centers are relative to the shading point that
// they belong to.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 10) const int SHAPE = 3;

#define SHAPES_BINDING 1
#define CASES_BINDING 2
#define LIGHT_TEXTURES_BINDING 4
#include "effects.glsl"
#undef AREALIGHT_QUADS
#define AREALIGHT_QUADS 0
#undef AREALIGHT_POLYGONS
#undef AREALIGHT_MESHES
#include "table_image.glsl"
#include "round_lights.glsl"
#include "cases.glsl"

// Each shape is what its record says
const int SHAPE_ANY = 3;

vec3 radiance_of(ArealightPoint point, ArealightGpuShape record) {
    uint kind = SHAPE == SHAPE_ANY ? record.kind : uint(SHAPE);
    if (kind == SHAPE_TUBE) {
        return arealight_radiance(point, load_tube(record));
    }
    if (kind == SHAPE_SPHERE) {
        return arealight_radiance(point, load_sphere(record));
    }
    return arealight_radiance(point, load_disk(record));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightPoint point = arealight_point(case_surface(cases[index]));
    results[index] = vec4(radiance_of(point, shapes[cases[index].light]), 0.0);
}
