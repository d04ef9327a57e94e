#version 450
#extension GL_GOOGLE_include_directive : require

// What a form factor of a quad costs: each work item computes those of one quad at many places, by one method. Its memory
// traffic, one quad and one result a work item, is lost in that.

layout(local_size_x = 64) in;

#include "arealight/form_factor.glsl"

layout(constant_id = 0) const int METHOD = 0;
layout(constant_id = 1) const int REPEATS = 1;

// AREALIGHT_FORM_FACTOR_*, plus one of these; or a yardstick. See benches/src/cost.rs.
const int METHOD_RUNG = 1;
const int METHOD_QUAD = 0;
const int METHOD_BOTH = 8;
const int METHOD_WALK = 12;
const int METHOD_NOTHING = 16;
const int METHOD_YARDSTICK = 17; // plus a school of yardsticks.glsl

layout(set = 0, binding = 0, std430) readonly buffer Vertices {
    vec4 vertices[]; // four a work item, in a box above the horizon
};
layout(set = 0, binding = 1, std430) writeonly buffer Results {
    float results[];
};

ArealightQuad moved(ArealightQuad quad, vec3 shift) {
    return ArealightQuad(quad.v0 + shift, quad.v1 + shift, quad.v2 + shift, quad.v3 + shift);
}

ArealightArcs walk(ArealightAnchor anchor, ArealightQuad quad, int rung) {
    ArealightVertex v0 = arealight_vertex(anchor, quad.v0, rung);
    ArealightVertex v1 = arealight_vertex(anchor, quad.v1, rung);
    ArealightVertex v2 = arealight_vertex(anchor, quad.v2, rung);
    ArealightVertex v3 = arealight_vertex(anchor, quad.v3, rung);
    ArealightWalk walk = arealight_walk_begin();
    arealight_walk_edge(walk, anchor, v3, v0, rung);
    arealight_walk_edge(walk, anchor, v0, v1, rung);
    arealight_walk_edge(walk, anchor, v1, v2, rung);
    arealight_walk_edge(walk, anchor, v2, v3, rung);
    return arealight_walk_end(walk, anchor, rung);
}

// The library's arcs around a quad given as offsets from `center`.
ArealightArcs library_arcs(vec3 center, ArealightQuad quad) {
    int rung = METHOD & METHOD_RUNG;
    int shape = METHOD & ~METHOD_RUNG;
    ArealightAnchor anchor = arealight_anchor(center, 1.0, rung);
    if (shape == METHOD_BOTH) {
        vec3 normal = vec3(0.6, 0.0, 0.8);
        vec4 height = dot(normal, center)
                    + vec4(dot(normal, quad.v0), dot(normal, quad.v1), dot(normal, quad.v2), dot(normal, quad.v3));
        return arealight_quad_both_horizons(anchor, quad, height, rung);
    }
    if (shape == METHOD_WALK) {
        return walk(anchor, quad, rung);
    }
    return arealight_quad_clipped(anchor, quad, rung);
}

float library(vec3 center, ArealightQuad quad) {
    return arealight_form_factor(library_arcs(center, quad), false);
}

#include "yardsticks.glsl"

void main() {
    uint index = gl_GlobalInvocationID.x;
    uint first = 4u * index;
    ArealightQuad quad = ArealightQuad(vertices[first].xyz, vertices[first + 1u].xyz, vertices[first + 2u].xyz,
                                       vertices[first + 3u].xyz);
    vec3 center = 0.25 * (quad.v0 + quad.v1 + quad.v2 + quad.v3);
    ArealightQuad offsets = moved(quad, -center);
    float sum = 0.0;
    for (int i = 0; i < REPEATS; i++) {
        // Moving the quad costs three additions a vertex; the library's adds its center to its offsets anyway
        vec3 shift = vec3(1.0, 1.0, 0.5) * (float(i) / 512.0);
        if (METHOD >= METHOD_YARDSTICK) {
            ArealightQuad there = moved(quad, shift);
            sum += yardstick_quad(METHOD - METHOD_YARDSTICK, there.v0, there.v1, there.v2, there.v3);
        } else if (METHOD == METHOD_NOTHING) {
            ArealightQuad there = moved(quad, shift);
            sum += dot(there.v0 + there.v1, there.v2 + there.v3);
        } else {
            sum += library(center + shift, offsets);
        }
    }
    results[index] = sum / float(REPEATS);
}
