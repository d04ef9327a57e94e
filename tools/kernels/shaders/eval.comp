#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// The shade kernel's functions over a list of shading points: what a port can be checked against. The lights'
// centers are relative to the shading point that they belong to.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 4) const int HORIZON = 0;
layout(constant_id = 5) const int SPECULAR_LOBES = 0;
layout(constant_id = 6) const int LOBES = 0;
layout(constant_id = 7) const int FOOTPRINT = 0;

#define LIGHTS_BINDING 1
#define CASES_BINDING 3
#define LIGHT_TEXTURES_BINDING 5
#include "effects.glsl"
#include "table_image.glsl"
#include "polygon_lights.glsl"
#include "cases.glsl"


vec3 radiance_of(ArealightPoint point, ArealightGpuLight record) {
    if (HAS_SHAPED && (record.flags & LIGHT_SHAPED) != 0u) {
        return arealight_radiance(point, load_shaped(record));
    }
    if ((EFFECTS & EFFECT_MESH) != 0u && (record.flags & LIGHT_MESH) != 0u) {
        return arealight_radiance(point, load_mesh(record));
    }
    if (HAS_POLYGONS) {
        return arealight_radiance(point, load_polygon(record));
    }
    return arealight_radiance(point, load_quad(record));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightPoint point = arealight_point(case_surface(cases[index]));
    results[index] = vec4(radiance_of(point, lights[cases[index].light]), 0.0);
}
