#version 450
#extension GL_GOOGLE_include_directive : require

// The form factors of a list of polygons, each by one method, as floats whose bits the CPU judges.

layout(local_size_x = 64) in;

#include "arealight/form_factor.glsl"

// AREALIGHT_FORM_FACTOR_*, plus one of the shapes; or a yardstick. See benches/src/method.rs.
layout(constant_id = 0) const int METHOD = 0;

const int METHOD_RUNG = 1;
const int METHOD_WALK = 0;
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
float polygon_scale;

// `precise`: a compiler that multiplies the scale with another factor first loses an offset near float32's largest
// number, because that product is denormal.
vec3 polygon_offset(uint index) {
    precise vec3 offset = offsets[polygon_first + index].xyz * polygon_scale;
    return offset;
}

vec3 yardstick_vertex(uint index) {
    return polygon_anchor + polygon_offset(index);
}

#include "outline_yardsticks.glsl"

// A convex polygon of up to four vertices; the last one of a triangle comes twice.
ArealightQuad polygon_quad(uint count) {
    uint last = min(count, 4u) - 1u;
    return ArealightQuad(polygon_offset(0u), polygon_offset(1u), polygon_offset(min(2u, last)), polygon_offset(last));
}

// The library's form factor of a convex polygon of up to four vertices.
float library_quad(ArealightAnchor anchor, uint count, int rung) {
    return arealight_form_factor(arealight_quad_clipped(anchor, polygon_quad(count), rung), true);
}

// The library's form factor of any polygon.
float library_walk(ArealightAnchor anchor, uint count, int rung) {
    ArealightWalk walk = arealight_walk_begin();
    ArealightVertex from = arealight_vertex(anchor, polygon_offset(count - 1u), rung);
    for (uint index = 0u; index < count; index++) {
        ArealightVertex to = arealight_vertex(anchor, polygon_offset(index), rung);
        arealight_walk_edge(walk, anchor, from, to, rung);
        from = to;
    }
    return arealight_form_factor(arealight_walk_end(walk, anchor, rung), true);
}

// The library's form factor.
float library_form_factor(vec3 anchor, uint count, float extent, int shape, int rung) {
    ArealightAnchor at = arealight_anchor(anchor, extent, rung);
    return shape == METHOD_QUAD ? library_quad(at, count, rung) : library_walk(at, count, rung);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= constants.polygon_count) {
        return;
    }
    HardPolygon polygon = polygons[index];
    polygon_first = polygon.first_offset;
    uint count = polygon.offset_count;

    // Scale by a power of two taken from the largest component, as the library's callers do
    float largest = 0.0;
    for (uint i = 0u; i < count; i++) {
        largest = max(largest, arealight_max_component(offsets[polygon_first + i].xyz));
    }
    polygon_scale = arealight_power_of_two_scale(arealight_max_component(polygon.anchor) + largest);
    polygon_anchor = polygon.anchor * polygon_scale;
    float square = 0.0;
    for (uint i = 0u; i < count; i++) {
        vec3 offset = polygon_offset(i);
        square = max(square, dot(offset, offset));
    }

    float form_factor;
    if (METHOD == METHOD_CLIP_AND_ACOS) {
        form_factor = yardstick_clip_and_acos(count);
    } else if (METHOD == METHOD_YARDSTICK + YARDSTICK_CLIP_BY_CASES) {
        form_factor = yardstick_cases(count);
    } else if (METHOD >= METHOD_YARDSTICK) {
        form_factor = yardstick_outline(METHOD - METHOD_YARDSTICK, count);
    } else {
        form_factor = library_form_factor(polygon_anchor, count, sqrt(square), METHOD & ~METHOD_RUNG,
                                          METHOD & METHOD_RUNG);
    }
    results[index] = form_factor;
}
