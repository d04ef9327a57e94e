#ifndef AREALIGHT_QUAD_GLSL
#define AREALIGHT_QUAD_GLSL

#include "arealight/arc.glsl"
#include "arealight/walk.glsl"

// The arcs around a convex polygon with four vertices (or three: repeat one), clipped at the horizon without a
// branch, an array or a table of cases. Five arcs: one an edge, shortened to its part above the horizon, and one
// along the horizon from where the outline goes down to where it comes up.

// The vertices of a quad in the order of its outline, as offsets from an anchor.
struct ArealightQuad {
    vec3 v0;
    vec3 v1;
    vec3 v2;
    vec3 v3;
};

// Where a convex outline crosses the horizon.
struct ArealightCrossings {
    ArealightCrossing exit;  // where it goes down
    ArealightCrossing entry; // where it comes up
};

// Whether every second vertex of a quad is above the horizon: of a flat convex quad only where rounding decides, since it
// lies in the horizon.
bool arealight_alternates(bool v0, bool v1, bool v2, bool v3) {
    return v0 == v2 && v1 == v3 && v0 != v1;
}

// Notes where the edge from a to b crosses the horizon.
void arealight_quad_note(inout ArealightCrossings crossings, ArealightAnchor anchor, ArealightVertex a,
                         ArealightVertex b, int rung) {
    bool exits = a.unit.z > 0.0 && !(b.unit.z > 0.0);
    bool enters = b.unit.z > 0.0 && !(a.unit.z > 0.0);
    ArealightCrossing crossing = arealight_crossing(anchor, a, b, rung);
    crossings.exit.point = exits ? crossing.point : crossings.exit.point;
    crossings.exit.height = exits ? crossing.height : crossings.exit.height;
    crossings.entry.point = enters ? crossing.point : crossings.entry.point;
    crossings.entry.height = enters ? crossing.height : crossings.entry.height;
}

// The arc of the edge from a to b, as far as it is above the horizon. An edge below it becomes an arc of no length
// at the entry.
vec3 arealight_quad_edge(ArealightVertex a, ArealightVertex b, ArealightVertex exit, ArealightVertex entry,
                         int rung) {
    bool a_above = a.unit.z > 0.0;
    bool b_above = b.unit.z > 0.0;
    ArealightVertex from = arealight_select(a_above, a, entry);
    ArealightVertex to = arealight_select(b_above, b, arealight_select(a_above, exit, entry));
    return arealight_arc(from, to, rung);
}

// A convex quad clipped at the horizon of its space.
ArealightArcs arealight_quad_clipped(ArealightAnchor anchor, ArealightQuad quad, int rung) {
    ArealightVertex v0 = arealight_vertex(anchor, quad.v0, rung);
    ArealightVertex v1 = arealight_vertex(anchor, quad.v1, rung);
    ArealightVertex v2 = arealight_vertex(anchor, quad.v2, rung);
    ArealightVertex v3 = arealight_vertex(anchor, quad.v3, rung);

    // Find where the outline crosses the horizon
    ArealightCrossing nowhere = ArealightCrossing(vec2(0.0), 0.0);
    ArealightCrossings crossings = ArealightCrossings(nowhere, nowhere);
    arealight_quad_note(crossings, anchor, v0, v1, rung);
    arealight_quad_note(crossings, anchor, v1, v2, rung);
    arealight_quad_note(crossings, anchor, v2, v3, rung);
    arealight_quad_note(crossings, anchor, v3, v0, rung);
    ArealightVertex exit = arealight_horizon_vertex(anchor, crossings.exit, 1.0, rung);
    ArealightVertex entry = arealight_horizon_vertex(anchor, crossings.entry, -1.0, rung);

    // Sum the edges, and close the outline along the horizon
    vec3 sum = arealight_quad_edge(v0, v1, exit, entry, rung)
             + arealight_quad_edge(v1, v2, exit, entry, rung)
             + arealight_quad_edge(v2, v3, exit, entry, rung)
             + arealight_quad_edge(v3, v0, exit, entry, rung)
             + arealight_horizon_arc(anchor, exit, entry, rung);

    // What goes down twice lies in the horizon: nothing of it is above
    sum = arealight_alternates(v0.unit.z > 0.0, v1.unit.z > 0.0, v2.unit.z > 0.0, v3.unit.z > 0.0) ? vec3(0.0) : sum;
    float squares = v0.square + v1.square + v2.square + v3.square;
    return ArealightArcs(sum, squares);
}

#endif
