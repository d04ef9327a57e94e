#ifndef AREALIGHT_TUBE_HORIZONS_GLSL
#define AREALIGHT_TUBE_HORIZONS_GLSL

#include "arealight/tube.glsl"

// The form factor of a tube clipped at two horizons: at the surface's, before the lobe's transform, and at that of
// cosine space. The outline is cut at the surface first; what is left are at most two arcs an end, and edges between them,
// which are walked as they come.

// An outline as it is drawn: pieces, and edges from each to the next.
struct ArealightDrawnOutline {
    ArealightWalk walk;
    ArealightVertex first;
    ArealightVertex last;
    bool begun;
};

// Draws an edge to a vertex.
void arealight_draw_to(inout ArealightDrawnOutline outline, ArealightAnchor anchor, ArealightVertex vertex, int rung) {
    if (outline.begun) {
        arealight_walk_edge(outline.walk, anchor, outline.last, vertex, rung);
    } else {
        outline.first = vertex;
    }
    outline.last = vertex;
    outline.begun = true;
}

// The part of a rim between two points of its circle, of which `begin` and `end` are cosines and sines.
ArealightRim arealight_rim_part(ArealightRim rim, vec2 begin, vec2 end, bool reflex) {
    ArealightArcSpan span = arealight_arc_between(begin, end, reflex);
    return ArealightRim(rim.center, span.middle.x * rim.middle + span.middle.y * rim.side,
                        span.middle.x * rim.side - span.middle.y * rim.middle, span.half_width);
}

// Draws an edge to an arc, and the arc, clipped at the horizon of cosine space. `backward`: from the rim's end to its begin.
void arealight_draw_arc(inout ArealightDrawnOutline outline, ArealightAnchor anchor, ArealightRim rim, mat3 transform,
                        bool backward, int rung) {
    ArealightRimArc arc = arealight_rim_arc(rim, transform, rung);
    ArealightVertex begin = arealight_cone_vertex(arc.cone, arc.begin, anchor.horizon);
    ArealightVertex end = arealight_cone_vertex(arc.cone, arc.end, anchor.horizon);
    bool swapped = (arc.way < 0.0) != backward;
    arealight_draw_to(outline, anchor, arealight_select(swapped, end, begin), rung);
    arealight_walk_rim(outline.walk, anchor, arc, begin, end, backward ? -1.0 : 1.0, rung);
    outline.walk.squares += arc.square;
    outline.last = arealight_select(swapped, begin, end);
}

// Draws what of a rim is above the surface, whose unit normal is in the space of the rim.
void arealight_draw_rim(inout ArealightDrawnOutline outline, ArealightAnchor anchor, ArealightRim rim, vec3 normal,
                        mat3 transform, bool backward, int rung) {
    vec3 heights = vec3(dot(normal, rim.center), dot(normal, rim.middle), dot(normal, rim.side));
    vec2 ends = heights.x + heights.y * rim.half_width.x + vec2(-1.0, 1.0) * (heights.z * rim.half_width.y);
    // Where the circle crosses the surface's plane
    float steepness = sqrt(dot(heights.yz, heights.yz));
    vec2 top = heights.yz / max(steepness, 1e-37);
    float cosine = clamp(-heights.x / max(steepness, 1e-37), -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    vec2 rise = vec2(top.x * cosine + top.y * sine, top.y * cosine - top.x * sine);
    vec2 fall = vec2(top.x * cosine - top.y * sine, top.y * cosine + top.x * sine);
    bool crosses = abs(heights.x) < steepness;
    bool bump = max(ends.x, ends.y) <= 0.0 && crosses && top.x > rim.half_width.x;
    bool dip = min(ends.x, ends.y) > 0.0 && crosses && -top.x > rim.half_width.x;
    if (max(ends.x, ends.y) <= 0.0 && !bump) {
        return;
    }
    vec2 begin = vec2(rim.half_width.x, -rim.half_width.y);
    vec2 end = rim.half_width;
    vec2 from = ends.x > 0.0 ? begin : rise;
    vec2 to = ends.y > 0.0 ? end : fall;
    bool whole = min(ends.x, ends.y) > 0.0;
    for (int piece = 0; piece < 2; piece++) {
        ArealightRim part = rim;
        bool last = (piece == 1) != backward;
        if (dip) {
            vec2 a = last ? rise : begin;
            vec2 b = last ? end : fall;
            part = arealight_rim_part(rim, a, b, a.x * b.y - a.y * b.x < 0.0);
        } else if (piece == 1) {
            break;
        } else if (!whole) {
            part = arealight_rim_part(rim, from, to, from.x * to.y - from.y * to.x < 0.0);
        }
        arealight_draw_arc(outline, anchor, part, transform, backward, rung);
    }
}

// Draws to where the edge between two points crosses the surface's plane, if it does.
void arealight_draw_crossing(inout ArealightDrawnOutline outline, ArealightAnchor anchor, vec3 from, vec3 to, vec3 normal,
                             mat3 transform, int rung) {
    float from_height = dot(normal, from);
    float to_height = dot(normal, to);
    if ((from_height > 0.0) != (to_height > 0.0)) {
        vec3 crossing = from + (to - from) * clamp(from_height / (from_height - to_height), 0.0, 1.0);
        arealight_draw_to(outline, anchor, arealight_vertex(anchor, transform * crossing, rung), rung);
    }
}

// An end of a rim: `side` is -1 for its begin, 1 for its end.
vec3 arealight_rim_end(ArealightRim rim, float side) {
    return rim.center + rim.half_width.x * rim.middle + side * rim.half_width.y * rim.side;
}

// As arealight_tube_form_factor, clipped at the surface's horizon too: `normal` is the surface's, in the space of the tube.
// Error of the exact rung: 3e-6. A thin tube is not taken for a line: its error is that of its outline.
float arealight_tube_both_horizons(ArealightTube tube, vec3 normal, mat3 transform, float horizon, int rung) {
    if (!tube.seen) {
        return 0.0;
    }
    rung = AREALIGHT_FORM_FACTOR_EXACT;
    if (!tube.outside) {
        ArealightRim rim = tube.rims[0];
        vec3 heights = vec3(dot(normal, rim.center), dot(normal, rim.middle), dot(normal, rim.side));
        return arealight_ellipse_both_horizons(transform * rim.center, transform * rim.middle, transform * rim.side,
                                               heights, true, horizon, rung);
    }
    ArealightAnchor anchor = arealight_anchor(vec3(0.0), 0.0, rung);
    anchor.horizon = horizon;
    ArealightVertex nowhere = ArealightVertex(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    ArealightDrawnOutline outline = ArealightDrawnOutline(arealight_walk_begin(), nowhere, nowhere, false);
    arealight_draw_rim(outline, anchor, tube.rims[0], normal, transform, false, rung);
    arealight_draw_crossing(outline, anchor, arealight_rim_end(tube.rims[0], 1.0), arealight_rim_end(tube.rims[1], 1.0),
                            normal, transform, rung);
    arealight_draw_rim(outline, anchor, tube.rims[1], normal, transform, true, rung);
    arealight_draw_crossing(outline, anchor, arealight_rim_end(tube.rims[1], -1.0),
                            arealight_rim_end(tube.rims[0], -1.0), normal, transform, rung);
    if (!outline.begun) {
        return 0.0;
    }
    arealight_walk_edge(outline.walk, anchor, outline.last, outline.first, rung);
    return arealight_form_factor(arealight_walk_end(outline.walk, anchor, rung), true);
}

#endif
