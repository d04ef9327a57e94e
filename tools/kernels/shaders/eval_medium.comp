#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// eval.comp's twin for points in a medium, under lights of any kind, whose centers are relative to their
// point.

layout(local_size_x = 64) in;

layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 7) const int FOOTPRINT = 0;
const int HORIZON = 0;
const int SPECULAR_LOBES = 0;
const int LOBES = 0;

#define LIGHTS_BINDING 0
#define SHAPES_BINDING 2
#define LIGHT_TEXTURES_BINDING 5
#define AREALIGHT_MEDIA 1
#include "effects.glsl"
#include "polygon_lights.glsl"
#include "round_lights.glsl"
#include "scattered_light.glsl"

struct ArealightGpuMediumCase {
    vec3 view;
    float anisotropy;
};

layout(set = 0, binding = 3, std430) readonly buffer Cases {
    ArealightGpuMediumCase cases[];
};
layout(set = 0, binding = 4, std430) writeonly buffer Results {
    vec4 results[];
};

layout(push_constant, std430) uniform EvalConstants {
    uint case_count;
} constants;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.case_count) {
        return;
    }
    ArealightGpuMediumCase given = cases[index];
    ArealightMediumPoint medium = arealight_medium_point(vec3(0.0), given.view, given.anisotropy);
    vec3 radiance = HAS_SHAPES ? in_scattered(medium, shapes[index]) : in_scattered(medium, lights[index]);
    results[index] = vec4(radiance, 0.0);
}
