#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

// Single functions of the library over a list of arguments, so that tests can hold them to what their
// comments say.

layout(local_size_x = 64) in;

layout(constant_id = 0) const int FUNCTION = 0;

const int FUNCTION_FRAME = 0;
const int FUNCTION_COMMON = 1;
const int FUNCTION_TABLE = 2;
const int FUNCTION_GGX = 3;
const int FUNCTION_ARC = 4;
const int FUNCTION_RAY_ORIGIN = 5;
const int FUNCTION_RAY_POINT = 6;

#include "arealight/form_factor/arc.glsl"
#include "arealight/ggx.glsl"
#include "arealight/ray_points.glsl"
#include "arealight/shadows/ray_origin.glsl"
#include "table_image.glsl"

struct ProbeArguments {
    vec4 a;
    vec4 b;
    vec4 c;
};
struct ProbeResults {
    vec4 a;
    vec4 b;
    vec4 c;
    vec4 d;
};

layout(set = 0, binding = 1, std430) readonly buffer Arguments {
    ProbeArguments arguments[];
};
layout(set = 0, binding = 2, std430) writeonly buffer Results {
    ProbeResults results[];
};

layout(push_constant, std430) uniform ProbeConstants {
    uint count;
} constants;

ProbeResults frame_of(vec3 normal, vec3 view) {
    ArealightFrame frame = arealight_surface_frame(normal, view);
    return ProbeResults(vec4(frame.tangent, frame.cos_view), vec4(frame.bitangent, frame.sin_view),
                        vec4(frame.normal, 0.0), vec4(0.0));
}

ProbeResults common_of(vec3 vector, vec3 fallback, float number) {
    vec3 unit = arealight_normalize_or(vector, fallback);
    return ProbeResults(vec4(unit, arealight_power_of_two_scale(number)), vec4(0.0), vec4(0.0), vec4(0.0));
}

// The columns of the lobe's transform from the world, and what the table holds of the lobe.
ProbeResults table_of(vec3 normal, vec3 view, float roughness) {
    ArealightFrame frame = arealight_surface_frame(normal, view);
    ArealightTableSample table = arealight_table_lookup(frame, roughness, false);
    mat3 transform = arealight_table_space(frame, table.matrix, table.alpha) * arealight_frame_matrix(frame);
    return ProbeResults(vec4(transform[0], table.albedo), vec4(transform[1], table.schlick),
                        vec4(transform[2], table.alpha), table.schlick_matrix);
}

ProbeResults ggx_of(vec3 view, vec3 light, vec2 alpha, vec2 u) {
    vec3 half_vector = arealight_normalize_or(view + light, vec3(0.0, 0.0, 1.0));
    return ProbeResults(vec4(arealight_ggx_evaluate(view, light, alpha, vec3(0.04, 0.5, 1.0), 0.9),
                             arealight_ggx_density(view, light, alpha)),
                        vec4(half_vector, arealight_ggx_distribution(half_vector, alpha)),
                        vec4(arealight_ggx_sample(view, alpha, u),
                             arealight_ggx_visibility(view, light, alpha)),
                        vec4(0.0));
}

// The arc between two directions, and where it crosses the horizon.
ProbeResults arc_of(vec3 from, vec3 to) {
    vec3 a = arealight_unit(from);
    vec3 b = arealight_unit(to);
    vec2 crossing = a.z > 0.0 ? arealight_crossing(a, b) : arealight_crossing(b, a);
    return ProbeResults(vec4(a, arealight_arc(a, b).z), vec4(b, 0.0),
                        vec4(crossing, 0.0, 0.0), vec4(0.0));
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.count) {
        return;
    }
    ProbeArguments given = arguments[index];
    ProbeResults result;
    if (FUNCTION == FUNCTION_FRAME) {
        result = frame_of(given.a.xyz, given.b.xyz);
    } else if (FUNCTION == FUNCTION_COMMON) {
        result = common_of(given.a.xyz, given.b.xyz, given.a.w);
    } else if (FUNCTION == FUNCTION_TABLE) {
        result = table_of(given.a.xyz, given.b.xyz, given.a.w);
    } else if (FUNCTION == FUNCTION_GGX) {
        result = ggx_of(given.a.xyz, given.b.xyz, vec2(given.a.w), given.c.xy);
    } else if (FUNCTION == FUNCTION_ARC) {
        result = arc_of(given.a.xyz, given.b.xyz);
    } else if (FUNCTION == FUNCTION_RAY_POINT) {
        vec4 distances, weights;
        for (int i = 0; i < AREALIGHT_RAY_POINTS; i++) {
            ArealightRayPoint at = arealight_ray_point(given.a.xyz, given.a.w, given.b.xyz, given.b.w, i);
            distances[i] = at.distance;
            weights[i] = at.weight;
        }
        result = ProbeResults(distances, weights, vec4(0.0), vec4(0.0));
    } else {
        vec3 origin = arealight_ray_origin(given.a.xyz, given.b.xyz, given.b.w);
        result = ProbeResults(vec4(origin, 0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    }
    results[index] = result;
}
