#ifndef AREALIGHT_SURFACE_HORIZON_GLSL
#define AREALIGHT_SURFACE_HORIZON_GLSL

#include "arealight/quad.glsl"
#include "arealight/walk.glsl"

// Clipping at the surface's own horizon, before the horizon of a fitted lobe's cosine space. A fitted lobe reaches below
// the surface, with 2 % of its energy on average and 17 % at grazing angles: without this, lights shine in from
// behind. In cosine space the surface's horizon is another plane through the shading point; `height` is a vertex's
// distance above it, in any unit, taken before the transform.

// The point at which the edge from a to b meets the surface's horizon, as an offset; one end is above it and the other
// not.
vec3 arealight_surface_crossing(vec3 a, float a_height, vec3 b, float b_height) {
    return (b * a_height - a * b_height) / (a_height - b_height);
}

// Notes where the edge from a to b crosses the surface's horizon.
void arealight_surface_note(inout vec3 exit, inout vec3 entry, vec3 a, float a_height, vec3 b, float b_height) {
    bool a_above = a_height > 0.0;
    bool b_above = b_height > 0.0;
    if (a_above != b_above) {
        vec3 crossing = arealight_surface_crossing(a, a_height, b, b_height);
        exit = a_above ? crossing : exit;
        entry = a_above ? entry : crossing;
    }
}

// A convex quad clipped at the surface's horizon and at that of its space. The first clip leaves
// up to five edges.
ArealightArcs arealight_quad_both_horizons(ArealightAnchor anchor, ArealightQuad quad, vec4 height, int rung) {
    vec3 exit = vec3(0.0);
    vec3 entry = vec3(0.0);
    arealight_surface_note(exit, entry, quad.v0, height.x, quad.v1, height.y);
    arealight_surface_note(exit, entry, quad.v1, height.y, quad.v2, height.z);
    arealight_surface_note(exit, entry, quad.v2, height.z, quad.v3, height.w);
    arealight_surface_note(exit, entry, quad.v3, height.w, quad.v0, height.x);

    // An edge runs from its own vertex, or from the entry, to the next such, or to the exit
    bvec4 above = greaterThan(height, vec4(0.0));
    ArealightVertex v0 = arealight_vertex(anchor, above.x ? quad.v0 : entry, rung);
    ArealightVertex v1 = arealight_vertex(anchor, above.y ? quad.v1 : entry, rung);
    ArealightVertex v2 = arealight_vertex(anchor, above.z ? quad.v2 : entry, rung);
    ArealightVertex v3 = arealight_vertex(anchor, above.w ? quad.v3 : entry, rung);
    ArealightVertex leave = arealight_vertex(anchor, exit, rung);
    ArealightVertex come = arealight_vertex(anchor, entry, rung);
    ArealightWalk walk = arealight_walk_begin();
    arealight_walk_edge(walk, anchor, v0, arealight_select(above.x && !above.y, leave, v1), rung);
    arealight_walk_edge(walk, anchor, v1, arealight_select(above.y && !above.z, leave, v2), rung);
    arealight_walk_edge(walk, anchor, v2, arealight_select(above.z && !above.w, leave, v3), rung);
    arealight_walk_edge(walk, anchor, v3, arealight_select(above.w && !above.x, leave, v0), rung);
    arealight_walk_edge(walk, anchor, leave, come, rung);

    // What is wholly below is not there, nor what lies in the horizon
    walk.squares += dot(quad.v0, quad.v0) + dot(quad.v1, quad.v1) + dot(quad.v2, quad.v2) + dot(quad.v3, quad.v3);
    ArealightArcs arcs = arealight_walk_end(walk, anchor, rung);
    bool visible = any(above) && !arealight_alternates(above.x, above.y, above.z, above.w);
    arcs.sum = visible ? arcs.sum : vec3(0.0);
    return arcs;
}

// A walk (walk.glsl) behind a clip at the surface's horizon: vertices go in with their height.
struct ArealightSurfaceWalk {
    ArealightWalk walk;
    vec3 offset;           // of the vertex that came last
    float height;
    ArealightVertex first; // that is above the surface's horizon, or on it
    ArealightVertex last;
    bool begun;
};

// Begins at the outline's last vertex.
ArealightSurfaceWalk arealight_surface_walk_begin(vec3 last_offset, float last_height) {
    ArealightWalk walk = arealight_walk_begin();
    return ArealightSurfaceWalk(walk, last_offset, last_height, walk.exit, walk.exit, false);
}

// Walks on to a vertex of the clipped outline.
void arealight_surface_walk_on(inout ArealightSurfaceWalk clip, ArealightAnchor anchor, vec3 offset, int rung) {
    ArealightVertex vertex = arealight_vertex(anchor, offset, rung);
    if (clip.begun) {
        arealight_walk_edge(clip.walk, anchor, clip.last, vertex, rung);
    } else {
        clip.first = vertex;
        clip.begun = true;
    }
    clip.last = vertex;
}

// Walks from the last vertex to the one at `offset`, `height` above the surface's horizon.
void arealight_surface_walk_to(inout ArealightSurfaceWalk clip, ArealightAnchor anchor, vec3 offset, float height,
                               int rung) {
    clip.walk.squares += dot(offset, offset);
    if ((height > 0.0) != (clip.height > 0.0)) {
        vec3 crossing = arealight_surface_crossing(clip.offset, clip.height, offset, height);
        arealight_surface_walk_on(clip, anchor, crossing, rung);
    }
    if (height > 0.0) {
        arealight_surface_walk_on(clip, anchor, offset, rung);
    }
    clip.offset = offset;
    clip.height = height;
}

// Ends the walk, as arealight_walk_end.
ArealightArcs arealight_surface_walk_end(ArealightSurfaceWalk clip, ArealightAnchor anchor, int rung) {
    if (clip.begun) {
        arealight_walk_edge(clip.walk, anchor, clip.last, clip.first, rung);
    }
    return arealight_walk_end(clip.walk, anchor, rung);
}

#endif
