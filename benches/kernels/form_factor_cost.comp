#version 450
#extension GL_GOOGLE_include_directive : require

// What a form factor of a quad costs: each invocation computes those of one quad at many places, by one
// method. Its memory traffic, one quad and one result per invocation, is lost in that.

layout(local_size_x = 64) in;


layout(constant_id = 0) const int METHOD = 0;
layout(constant_id = 1) const int REPEATS = 1;

#define AREALIGHT_SURFACE_HORIZON ((METHOD & 12) == 8)
#define AREALIGHT_DIFFERENCE (METHOD & 1)
#include "arealight/form_factor/outline.glsl"
#include "arealight/lights/quad.glsl"

// AREALIGHT_FORM_FACTOR_*, plus one of these; or a yardstick. See benches/src/cost.rs.
const int METHOD_LEVEL = 1;
const int METHOD_QUAD = 0;
const int METHOD_BOTH = 8;
const int METHOD_POLYGON = 12;
const int METHOD_NOTHING = 16;
const int METHOD_YARDSTICK = 17; // plus a school of yardsticks.glsl

layout(set = 0, binding = 0, std430) readonly buffer Vertices {
    vec4 vertices[]; // four per invocation, in a box above the horizon
};
layout(set = 0, binding = 1, std430) writeonly buffer Results {
    float results[];
};

ArealightQuad moved(ArealightQuad quad, vec3 shift) {
    return ArealightQuad(quad.a + shift, quad.b + shift, quad.c + shift, quad.d + shift);
}

void add_edge(inout ArealightOutline outline, vec3 from, vec3 to) {
    arealight_outline_edge(outline, arealight_unit(from), arealight_unit(to));
}

vec3 outline_vector(ArealightQuad quad) {
    ArealightOutline outline = arealight_outline_begin();
    add_edge(outline, quad.a, quad.b);
    add_edge(outline, quad.b, quad.c);
    add_edge(outline, quad.c, quad.d);
    add_edge(outline, quad.d, quad.a);
    return arealight_outline_vector(outline);
}

// The library's form factor of a quad given as offsets from `center`, in a space; where both horizons clip, a
// tilted one.
float library(vec3 center, ArealightQuad quad) {
    if ((METHOD & ~METHOD_LEVEL) == METHOD_POLYGON) {
        return arealight_form_factor(outline_vector(moved(quad, center)));
    }
    mat3 space = (METHOD & ~METHOD_LEVEL) == METHOD_BOTH ? mat3(0.8, 0.0, -0.6, 0.0, 1.0, 0.0, 0.6, 0.0, 0.8)
        : mat3(1.0);
    ArealightPoint point;
    point.position = vec3(0.0);
    point.to_frame = mat3(1.0);
    vec3 normal = arealight_normalize_or(cross(quad.b - quad.a, quad.c - quad.a), vec3(0.0, 0.0, 1.0));
    ArealightLocalQuad local;
    vec3 vector = vec3(0.0);
    if (arealight_to_local(point, ArealightQuadLight(vec3(1.0), center, normal, quad, false), local)) {
        vector = arealight_vector_form_factor(space, local);
    }
    return arealight_form_factor(vector);
}

#include "yardsticks.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint first = 4u * index;
    ArealightQuad quad = ArealightQuad(vertices[first].xyz, vertices[first + 1u].xyz,
                                       vertices[first + 2u].xyz,
                                       vertices[first + 3u].xyz);
    vec3 center = 0.25 * (quad.a + quad.b + quad.c + quad.d);
    ArealightQuad offsets = moved(quad, -center);
    float sum = 0.0;
    for (int i = 0; i < REPEATS; i++) {
        // Moving the quad costs three additions a vertex; the library's adds its center to its offsets anyway
        vec3 shift = vec3(1.0, 1.0, 0.5) * (float(i) / 512.0);
        if (METHOD >= METHOD_YARDSTICK) {
            ArealightQuad there = moved(quad, shift);
            sum += yardstick_quad(METHOD - METHOD_YARDSTICK, there.a, there.b, there.c, there.d);
        } else if (METHOD == METHOD_NOTHING) {
            ArealightQuad there = moved(quad, shift);
            sum += dot(there.a + there.b, there.c + there.d);
        } else {
            sum += library(center + shift, offsets);
        }
    }
    results[index] = sum / float(REPEATS);
}
