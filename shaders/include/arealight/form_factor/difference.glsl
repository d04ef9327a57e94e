#ifndef AREALIGHT_DIFFERENCE_GLSL
#define AREALIGHT_DIFFERENCE_GLSL

#include "arealight/form_factor/outline.glsl"
#include "arealight/form_factor/quad.glsl"

// The difference form: form factors of small and distant polygons with relative precision. It keeps the
// promises of form_factor/quad.glsl, and
//
//   5. For a light within a fifth of its distance d of its anchor, the error is at most 1e-6 A / (pi d^2),
//      out to any distance; A is its area, or for a sliver .24 of its extent times its perimeter.
//
// A polygon is given by an anchor near it and its vertices' offsets from that. What the arcs of a small
// outline have in common is left out: it cancels in the sum around the outline, and with it what would be its
// error.

// A vertex as the arcs need it.
struct ArealightVertex {
    vec3 unit;    // its direction; z is exactly zero within the anchor's `horizon`
    vec3 chord;   // its direction less the anchor's, to float32's relative precision
    vec3 offset;  // from the anchor, or where that is not distant from the shading point
    float square; // its squared distance
};

// A point near the polygon.
struct ArealightAnchor {
    vec3 position;    // from the shading point
    float distance;
    float reciprocal; // of the distance
    bool distant;     // the polygon lies within half its distance of it: chords are from its direction
    float horizon;    // sine of the elevation below which a vertex counts as on the horizon
    float front;      // as in arealight_quad_vector
};

// The origin of vertices' offsets: the anchor, or where that is not distant the shading point, so that no
// vertex near to that is the difference of two that are not.
vec3 arealight_base(ArealightAnchor anchor) {
    return anchor.distant ? anchor.position : vec3(0.0);
}

// The anchor of a polygon whose vertices are at most `extent` from `position`, both in the same space;
// `front` as in arealight_quad_vector. Of a polygon that is not distant a vertex is above the horizon or
// below by its own height: of a ceiling far larger than its height over the point, none is on it.
ArealightAnchor arealight_anchor(vec3 position, float extent, float horizon, float front) {
    float square = dot(position, position);
    float reciprocal = inversesqrt(max(square, AREALIGHT_LEAST_SQUARE));
    bool distant = 4.0 * extent * extent <= square;
    return ArealightAnchor(position, square * reciprocal, reciprocal, distant, distant ? horizon : 0.0,
                           front);
}

// The vertex at `offset` from the anchor. Its direction's distance from the anchor's direction keeps the
// relative precision of the offset o: with the anchor a, v = a + o and e = o.(a + v) = |v|^2 - |a|^2,
//
//     v / |v| - a / |a| = (o - a e / (|a| (|a| + |v|))) / |v|
ArealightVertex arealight_vertex(ArealightAnchor anchor, vec3 offset) {
    ArealightVertex vertex;
    vec3 position = anchor.position + offset;
    vertex.offset = anchor.distant ? offset : position;
    vertex.square = dot(position, position);
    float reciprocal = inversesqrt(max(vertex.square, AREALIGHT_LEAST_SQUARE));
    vertex.unit = position * reciprocal;
    // Whether a light in the plane of the surface is above or below must not depend on the last bit
    vertex.unit.z = abs(vertex.unit.z) > anchor.horizon ? vertex.unit.z : 0.0;
    float excess = dot(offset, anchor.position + position);
    float shortening =
        excess * anchor.reciprocal / (anchor.distance + vertex.square * reciprocal + AREALIGHT_LEAST_SQUARE);
    vec3 chord = (offset - anchor.position * shortening) * reciprocal;
    vertex.chord = anchor.distant ? chord : vertex.unit;
    return vertex;
}

// s (theta / sin(theta) - 1) of an arc whose chord has the squared length `square`: relative error 1.5e-7.
vec3 arealight_arc_excess(vec3 s, float y, float square) {
    vec3 scaled = 0.25 * square * s;
    return scaled * (3.14159298 + y * (0.806142926 + y * (-0.00320804934 + y * 0.000173867855)))
         / (y + y * y * (0.893227518 + y * 0.192593366));
}

// arealight_arc without what a x b has from the anchor. In the sum around a closed outline the error is
// relative to the square of the outline's angular size.
vec3 arealight_difference_arc(ArealightVertex a, ArealightVertex b) {
    vec3 middle = a.unit + b.unit;
    float y = sqrt(dot(middle, middle) + AREALIGHT_LEAST_SQUARE);
    vec3 chord = b.chord - a.chord;
    return cross(a.chord, chord) + arealight_arc_excess(cross(a.unit, middle), y, dot(chord, chord));
}

// The vertex at `place` on the horizon, from the anchor's base.
ArealightVertex arealight_horizon_vertex(ArealightAnchor anchor, vec2 place) {
    anchor.position = arealight_base(anchor);
    return arealight_vertex(anchor, vec3(place, -anchor.position.z));
}

// Where the edge from a to b meets the horizon, one end being above it and the other not.
ArealightVertex arealight_difference_crossing(ArealightAnchor anchor, ArealightVertex a, ArealightVertex b) {
    float base = arealight_base(anchor).z;
    float a_height = a.unit.z == 0.0 ? 0.0 : base + a.offset.z;
    float b_height = b.unit.z == 0.0 ? 0.0 : base + b.offset.z;
    float height = a_height - b_height;
    vec2 place = (b.offset.xy * a_height - a.offset.xy * b_height) / (height == 0.0 ? 1.0 : height);
    return arealight_horizon_vertex(anchor, place);
}

// An outline, vertex by vertex.
//
//     ArealightDifferenceOutline outline = arealight_difference_begin();
//     for each vertex: arealight_difference_to(outline, anchor, arealight_vertex(anchor, offset));
//     vec3 vector = arealight_difference_vector(outline, anchor);
struct ArealightDifferenceOutline {
    vec3 arcs;
    float squares;         // of the vertices' distances, summed: not finite where a vertex is not
    ArealightVertex first; // vertices
    ArealightVertex last;
    ArealightVertex exit;  // where the outline last went down
    ArealightVertex entry; // where it came up before it ever went down
    vec2 turn;             // as in ArealightOutline, where the anchor is not distant
    bool begun;
    bool exited;
    bool entered;
};

ArealightDifferenceOutline arealight_difference_begin() {
    ArealightVertex nowhere = ArealightVertex(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    return ArealightDifferenceOutline(vec3(0.0), 0.0, nowhere, nowhere, nowhere, nowhere, vec2(1.0, 0.0),
                                      false, false, false);
}

// Adds the edge from a to b, and what closes the outline along the horizon where it comes up again.
void arealight_difference_edge(inout ArealightDifferenceOutline outline, ArealightAnchor anchor,
                               ArealightVertex a,
                               ArealightVertex b) {
    bool a_above = a.unit.z > 0.0;
    bool b_above = b.unit.z > 0.0;
    outline.squares += b.square;
    if (a_above == b_above) {
        outline.arcs += a_above ? arealight_difference_arc(a, b) : vec3(0.0);
        return;
    }
    ArealightVertex crossing = arealight_difference_crossing(anchor, a, b);
    outline.turn = arealight_turned_by(outline.turn, crossing.unit.xy, a_above);
    if (a_above) {
        outline.arcs += arealight_difference_arc(a, crossing);
        outline.exit = crossing;
        outline.exited = true;
    } else {
        outline.arcs += arealight_difference_arc(crossing, b);
        if (outline.exited) {
            outline.arcs += anchor.distant ? arealight_difference_arc(outline.exit, crossing) : vec3(0.0);
        } else {
            outline.entry = crossing;
            outline.entered = true;
        }
    }
}

// Goes on to a vertex.
void arealight_difference_to(inout ArealightDifferenceOutline outline, ArealightAnchor anchor,
                             ArealightVertex vertex) {
    if (outline.begun) {
        arealight_difference_edge(outline, anchor, outline.last, vertex);
    } else {
        outline.first = vertex;
        outline.begun = true;
    }
    outline.last = vertex;
}

// The vector form factor, when all vertices have come; 0 where one is not finite, or there is none.
vec3 arealight_difference_vector(ArealightDifferenceOutline outline, ArealightAnchor anchor) {
    if (!outline.begun) {
        return vec3(0.0);
    }
    arealight_difference_edge(outline, anchor, outline.last, outline.first);
    // Seen from a distance no angle along the horizon is obtuse; else chords are the directions themselves
    if (!anchor.distant) {
        outline.arcs += arealight_closing_arc(outline.turn, -outline.arcs.z, anchor.front);
    } else if (outline.exited && outline.entered) {
        outline.arcs += arealight_difference_arc(outline.exit, outline.entry);
    }
    return arealight_is_finite(outline.squares) ? AREALIGHT_PER_ARC * outline.arcs : vec3(0.0);
}

// The vector form factor of a convex quad whose vertices are offsets from `center`, clipped at the horizon z
// = 0; `horizon` is the sine of the elevation below which a vertex counts as on it, `front` as in
// arealight_quad_vector.
vec3 arealight_difference_quad(vec3 center, ArealightQuad offsets, float horizon, float front) {
    float extent = max(max(dot(offsets.a, offsets.a), dot(offsets.b, offsets.b)),
                       max(dot(offsets.c, offsets.c), dot(offsets.d, offsets.d)));
    ArealightAnchor anchor = arealight_anchor(center, sqrt(extent), horizon, front);
    ArealightDifferenceOutline outline = arealight_difference_begin();
    arealight_difference_to(outline, anchor, arealight_vertex(anchor, offsets.a));
    arealight_difference_to(outline, anchor, arealight_vertex(anchor, offsets.b));
    arealight_difference_to(outline, anchor, arealight_vertex(anchor, offsets.c));
    arealight_difference_to(outline, anchor, arealight_vertex(anchor, offsets.d));
    return arealight_difference_vector(outline, anchor);
}

#endif
