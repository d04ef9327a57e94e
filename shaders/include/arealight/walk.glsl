#ifndef AREALIGHT_WALK_GLSL
#define AREALIGHT_WALK_GLSL

#include "arealight/arc.glsl"

// The form factor of any simple polygon, convex or concave, of any number of vertices: its edges are taken one after
// another and clipped at the horizon as they pass. There is no vertex array, no limit to the number of vertices, and
// no table of cases.
//
//     ArealightWalk walk = arealight_walk_begin();
//     for each edge: arealight_walk_edge(walk, anchor, from, to, rung);
//     float f = arealight_form_factor(arealight_walk_end(walk, anchor, rung), two_sided);
struct ArealightWalk {
    vec3 sum;              // of the arcs so far
    float squares;         // of the vertices' distances
    vec2 turn;             // how far the outline has to turn along the horizon to be closed, as a unit complex number
    ArealightVertex exit;  // where it last went down (difference form alone, as the rest)
    ArealightVertex entry; // where it came up before it ever went down
    bool exited;
    bool entered;
};

ArealightWalk arealight_walk_begin() {
    ArealightVertex nowhere = ArealightVertex(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    return ArealightWalk(vec3(0.0), 0.0, vec2(1.0, 0.0), nowhere, nowhere, false, false);
}

// Closes the outline along the horizon, at a crossing.
//
// The crossings of a flat, simple polygon lie on one line, and the angles between them, seen from beside that line, add up to
// less than pi: so it is enough to know their sum's direction, as a product of complex numbers, whatever the number
// of crossings. The difference form needs each arc by itself.
void arealight_walk_close(inout ArealightWalk walk, ArealightAnchor anchor, ArealightVertex crossing, bool exits,
                          int rung) {
    if (rung != AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        vec2 turn = vec2(crossing.unit.x, exits ? -crossing.unit.y : crossing.unit.y);
        walk.turn = vec2(walk.turn.x * turn.x - walk.turn.y * turn.y, walk.turn.x * turn.y + walk.turn.y * turn.x);
    } else if (exits) {
        walk.exit = crossing;
        walk.exited = true;
    } else if (walk.exited) {
        walk.sum += arealight_horizon_arc(anchor, walk.exit, crossing, rung);
    } else {
        walk.entry = crossing;
        walk.entered = true;
    }
}

// Walks the edge from a to b.
void arealight_walk_edge(inout ArealightWalk walk, ArealightAnchor anchor, ArealightVertex a, ArealightVertex b,
                         int rung) {
    bool a_above = a.unit.z > 0.0;
    bool b_above = b.unit.z > 0.0;
    walk.squares += b.square;
    ArealightCrossing point = arealight_crossing(anchor, a, b, rung);
    ArealightVertex crossing = arealight_horizon_vertex(anchor, point, a_above ? 1.0 : -1.0, rung);
    if (a_above != b_above) {
        arealight_walk_close(walk, anchor, crossing, a_above, rung);
    }
    // An edge below the horizon becomes an arc of no length
    walk.sum += arealight_arc(arealight_select(a_above, a, crossing), arealight_select(b_above, b, crossing), rung);
}

// Ends the walk: the arcs around the whole outline.
ArealightArcs arealight_walk_end(ArealightWalk walk, ArealightAnchor anchor, int rung) {
    vec3 sum = walk.sum;
    if (rung != AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        ArealightVertex begin = walk.exit;
        ArealightVertex end = walk.exit;
        begin.unit = vec3(1.0, 0.0, 0.0);
        end.unit = vec3(walk.turn * inversesqrt(dot(walk.turn, walk.turn) + AREALIGHT_TINY), 0.0);
        sum += arealight_horizon_arc(anchor, begin, end, rung);
    } else if (walk.exited && walk.entered) {
        sum += arealight_horizon_arc(anchor, walk.exit, walk.entry, rung);
    }
    return ArealightArcs(sum, walk.squares);
}

#endif
