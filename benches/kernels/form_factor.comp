#version 450
#extension GL_GOOGLE_include_directive : require

// The form factors of a list of polygons, each by one method, as floats whose bits the CPU judges.

layout(local_size_x = 64) in;

#include "arealight/form_factor/outline.glsl"
#include "arealight/form_factor/quad.glsl"

// See benches/src/method.rs.
layout(constant_id = 0) const int METHOD = 0;

const int METHOD_OUTLINE = 0;
const int METHOD_QUAD = 8;
const int METHOD_YARDSTICK = 32; // plus a school of yardsticks.glsl
const int METHOD_CLIP_AND_ACOS = 35;

struct HardPolygon {
    vec3 anchor;
    uint first_offset;
    uint offset_count;
    uint reserved0;
    uint reserved1;
    uint reserved2;
};

layout(set = 0, binding = 0, std430) readonly buffer Polygons {
    HardPolygon polygons[];
};
layout(set = 0, binding = 1, std430) readonly buffer Offsets {
    vec4 offsets[];
};
layout(set = 0, binding = 2, std430) writeonly buffer Results {
    float results[];
};

layout(push_constant, std430) uniform FormFactorConstants {
    uint polygon_count;
} constants;

// The polygon at hand, scaled by a power of two.
vec3 polygon_anchor;
uint polygon_first;
int polygon_scale; // its exponent

// x times that, by its bits; denormal numbers are 0. Of a product a driver may multiply the scale with
// another factor first, as NVIDIA's does, and a number near float32's largest is lost because that is
// denormal.
float scaled(float x) {
    uint bits = floatBitsToUint(x);
    int exponent = int(bits >> 23 & 0xffu);
    int other = exponent + polygon_scale;
    return exponent == 255 || other >= 255 ? x : exponent > 0 && other > 0
        ? uintBitsToFloat((bits & 0x807fffffu) | uint(other) << 23) : 0.0;
}

vec3 scaled(vec3 v) {
    return vec3(scaled(v.x), scaled(v.y), scaled(v.z));
}

vec3 polygon_offset(uint index) {
    return scaled(offsets[polygon_first + index].xyz);
}

vec3 yardstick_vertex(uint index) {
    return polygon_anchor + polygon_offset(index);
}

#include "outline_yardsticks.glsl"

// A convex polygon of up to four vertices, from the anchor; the last one of a triangle comes twice.
ArealightQuad polygon_quad(uint count) {
    uint last = min(count, 4u) - 1u;
    return ArealightQuad(polygon_offset(0u), polygon_offset(1u), polygon_offset(min(2u, last)),
                         polygon_offset(last));
}

vec3 quad_vector(uint count) {
    ArealightQuad quad = polygon_quad(count);
    vec3 anchor = polygon_anchor;
    return arealight_quad_vector(ArealightQuad(anchor + quad.a, anchor + quad.b, anchor + quad.c, anchor
                                               + quad.d));
}

vec3 outline_vector(uint count) {
    ArealightOutline outline = arealight_outline_begin(polygon_anchor);
    vec3 from = arealight_unit(polygon_anchor + polygon_offset(count - 1u));
    for (uint index = 0u; index < count; index++) {
        vec3 to = arealight_unit(polygon_anchor + polygon_offset(index));
        arealight_outline_edge(outline, from, to);
        from = to;
    }
    return arealight_outline_vector(outline);
}

// The library's form factor, of either side; 0 where a coordinate is not finite, as for the library's lights.
float library_form_factor(uint count, float sizes) {
    vec3 vector = METHOD == METHOD_QUAD ? quad_vector(count) : outline_vector(count);
    return arealight_guarded_form_factor(abs(vector.z), sizes);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.polygon_count) {
        return;
    }
    HardPolygon polygon = polygons[index];
    polygon_first = polygon.first_offset;
    uint count = polygon.offset_count;

    // Scale by a power of two taken from the largest component, so that squares are within float32's range
    float largest = 0.0;
    for (uint i = 0u; i < count; i++) {
        largest = max(largest, arealight_max_component(offsets[polygon_first + i].xyz));
    }
    float extent = arealight_max_component(polygon.anchor) + largest;
    polygon_scale = int(floatBitsToUint(arealight_power_of_two_scale(extent)) >> 23) - 127;
    polygon_anchor = scaled(polygon.anchor);
    float sizes = dot(abs(polygon_anchor), vec3(1.0));
    for (uint i = 0u; i < count; i++) {
        sizes += dot(abs(polygon_offset(i)), vec3(1.0));
    }

    float form_factor;
    if (METHOD == METHOD_CLIP_AND_ACOS) {
        form_factor = yardstick_clip_and_acos(count);
    } else if (METHOD == METHOD_YARDSTICK + YARDSTICK_CLIP_BY_CASES) {
        form_factor = yardstick_cases(count);
    } else if (METHOD >= METHOD_YARDSTICK) {
        form_factor = yardstick_outline(METHOD - METHOD_YARDSTICK, count);
    } else {
        form_factor = library_form_factor(count, sizes);
    }
    results[index] = form_factor;
}
