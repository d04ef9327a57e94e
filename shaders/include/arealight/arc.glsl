#ifndef AREALIGHT_ARC_GLSL
#define AREALIGHT_ARC_GLSL

#include "arealight/common.glsl"
#include "arealight/effects.glsl"

// One edge of a polygon, seen from the shading point: an arc of a great circle between two directions.
//
// The form factor is a sum over the edges of (angle between the ends) x (z of the unit normal of the edge's plane)
// (Baum et al. 1989). For unit vectors a and b at the angle theta, that is (a x b).z theta / sin(theta). Here it is
// taken at the half angle: with m = a + b and y = |m| = 2 cos(theta / 2),
//
//     (a x b).z = (a x m).z,    theta / sin(theta) = 2 G(y / 2) / y,    G(c) = acos(c) / sqrt(1 - c^2),
//
// G is smooth on [0, 1], so one rational function serves every angle up to pi, and rounding costs a few 2^-24 at
// every angle: both (a x m).z and y are as small as each other where a and b are nearly opposite. Nothing branches.
//
// Arcs are vectors, of which the form factor takes z; all of it points to where the light comes from (Arvo 1995). What a
// caller does not read costs nothing: compilers take vectors apart.

// A vertex as the arcs see it.
struct ArealightVertex {
    vec3 unit;    // its direction; z is exactly zero within the anchor's `horizon`
    vec3 chord;   // its direction less the anchor's, to float32's relative precision (difference form alone)
    vec3 offset;  // from the anchor's base (difference form alone)
    float square; // its squared distance; not finite where a coordinate is not
};

// Where a polygon is: a point near it, from which its vertices are given as offsets.
struct ArealightAnchor {
    vec3 position;    // from the shading point
    float distance;   // its distance
    float reciprocal; // of that
    bool distant;     // the polygon lies within half its distance of it: chords are from its direction
    float horizon;    // sine of the elevation below which a vertex counts as on the horizon
};

// What a vertex's offset is from: the anchor, or where that is not distant the shading point, so that no vertex near to
// that is the difference of two that are not.
vec3 arealight_base(ArealightAnchor anchor) {
    return anchor.distant ? anchor.position : vec3(0.0);
}

// The anchor of a polygon whose vertices are at most `extent` from `position`, both in the same space.
ArealightAnchor arealight_anchor(vec3 position, float extent, int rung) {
    if (rung != AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        return ArealightAnchor(position, 0.0, 0.0, false, AREALIGHT_HORIZON_WIDTH);
    }
    float square = dot(position, position);
    float reciprocal = inversesqrt(square + AREALIGHT_TINY);
    bool distant = 4.0 * extent * extent <= square;
    return ArealightAnchor(position, square * reciprocal, reciprocal, distant, AREALIGHT_HORIZON_WIDTH);
}

// The vertex at `offset` from the anchor.
//
// With the difference form, the direction's distance from the anchor's direction keeps the relative precision of the
// offset o: with the anchor a, v = a + o and e = o.(a + v) = |v|^2 - |a|^2,
//
//     v / |v| - a / |a| = (o - a e / (|a| (|a| + |v|))) / |v|
ArealightVertex arealight_vertex(ArealightAnchor anchor, vec3 offset, int rung) {
    ArealightVertex vertex;
    vec3 position = anchor.position + offset;
    vertex.offset = anchor.distant ? offset : position;
    vertex.square = dot(position, position);
    float reciprocal = inversesqrt(vertex.square + AREALIGHT_TINY);
    vertex.unit = position * reciprocal;
    // A vertex so near to the horizon lies in it: whether a light in the plane of the surface is above or below
    // must not hang on the last bit
    vertex.unit.z = abs(vertex.unit.z) > anchor.horizon ? vertex.unit.z : 0.0;
    vertex.chord = vertex.unit;
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        float excess = dot(offset, anchor.position + position);
        float shortening = excess * anchor.reciprocal / (anchor.distance + vertex.square * reciprocal + AREALIGHT_TINY);
        vec3 chord = (offset - anchor.position * shortening) * reciprocal;
        vertex.chord = anchor.distant ? chord : vertex.unit;
    }
    return vertex;
}

// s theta / sin(theta) of an arc with y = 2 cos(theta / 2): relative error 7e-8 before rounding. For y from
// sqrt(AREALIGHT_TINY) to 2.
vec3 arealight_arc_weight(vec3 s, float y) {
    return s * (3.1415925 + y * (1.1001613 + y * (0.028413607 - y * 0.00084628159)))
         / (y + y * y * (0.66850024 + y * 0.096849829));
}

// s (theta / sin(theta) - 1) of an arc whose chord has the squared length `square`: relative error 1.5e-7.
vec3 arealight_arc_excess(vec3 s, float y, float square) {
    vec3 scaled = 0.25 * square * s;
    return scaled * (3.14159298 + y * (0.806142926 + y * (-0.00320804934 + y * 0.000173867855)))
         / (y + y * y * (0.893227518 + y * 0.192593366));
}

// The angle from a to b times the unit normal of their plane, radians.
//
// Error: 3.6e-7 of one radian or of the angle, whichever is larger. In the difference form, what a x b has from the anchor is left out: it cancels in the sum over a
// closed outline, and with it what would be the error of a small one. There the sum's error is relative to the square
// of the outline's angular size.
vec3 arealight_arc(ArealightVertex a, ArealightVertex b, int rung) {
    vec3 middle = a.unit + b.unit;
    float y = sqrt(dot(middle, middle) + AREALIGHT_TINY);
    vec3 s = cross(a.unit, middle);
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        vec3 chord = b.chord - a.chord;
        return cross(a.chord, chord) + arealight_arc_excess(s, y, dot(chord, chord));
    }
    return arealight_arc_weight(s, y);
}

// s theta / sin(theta) of an angle of at most a right one with the cosine x: errors as arealight_arc_weight's.
vec3 arealight_acute_weight(vec3 s, float x) {
    return s * (1.5707963 + x * (1.1001613 + x * (0.056827213 - x * 0.0033851264)))
         / (1.0 + x * (1.3370004 + x * 0.38739931));
}

// The arc along the horizon from a to b, both on it: its z is the angle between them, in (-pi, pi].
//
// An obtuse angle is pi less the one to the opposite direction. arealight_arc would have the rounding of their lengths in
// the y of nearly opposite ends, which for an edge is as if a vertex had moved, but not here.
vec3 arealight_horizon_arc(ArealightAnchor anchor, ArealightVertex a, ArealightVertex b, int rung) {
    // Seen from a distance no angle is obtuse; else chords are the directions themselves
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE && anchor.distant) {
        return arealight_arc(a, b, rung);
    }
    float x = dot(a.unit.xy, b.unit.xy);
    float s = a.unit.x * b.unit.y - a.unit.y * b.unit.x;
    float acute = arealight_acute_weight(vec3(0.0, 0.0, s), abs(x)).z;
    return vec3(0.0, 0.0, x < 0.0 ? (s < 0.0 ? -AREALIGHT_PI : AREALIGHT_PI) - acute : acute);
}

// Where an edge meets the horizon, as a multiple of the point: for the difference form of its offset from the
// anchor's base, else of its direction.
struct ArealightCrossing {
    vec2 point;
    float height;
};

// The crossing of the edge from a to b, one end being above the horizon and the other not: a sum of two vectors, which
// cancel only where the ends are opposite. There rounding is as if an end had moved by 2^-24 of its distance.
ArealightCrossing arealight_crossing(ArealightAnchor anchor, ArealightVertex a, ArealightVertex b, int rung) {
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        float base = arealight_base(anchor).z;
        float a_height = a.unit.z == 0.0 ? 0.0 : base + a.offset.z;
        float b_height = b.unit.z == 0.0 ? 0.0 : base + b.offset.z;
        return ArealightCrossing(b.offset.xy * a_height - a.offset.xy * b_height, a_height - b_height);
    }
    return ArealightCrossing(b.unit.xy * a.unit.z - a.unit.xy * b.unit.z, 1.0);
}

// The vertex at a crossing. `direction` is +1 for an edge that goes down, -1 for one that comes up.
ArealightVertex arealight_horizon_vertex(ArealightAnchor anchor, ArealightCrossing crossing, float direction,
                                         int rung) {
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        vec2 along = crossing.point / (crossing.height == 0.0 ? 1.0 : crossing.height);
        anchor.position = arealight_base(anchor);
        return arealight_vertex(anchor, vec3(along, -anchor.position.z), rung);
    }
    vec2 point = crossing.point;
    float reciprocal = direction * inversesqrt(dot(point, point) + AREALIGHT_TINY);
    vec3 unit = vec3(point * reciprocal, 0.0);
    return ArealightVertex(unit, unit, unit, 1.0);
}

// a where `condition` holds, else b.
ArealightVertex arealight_select(bool condition, ArealightVertex a, ArealightVertex b) {
    return ArealightVertex(condition ? a.unit : b.unit, condition ? a.chord : b.chord,
                           condition ? a.offset : b.offset, condition ? a.square : b.square);
}

// The arcs around a closed outline.
struct ArealightArcs {
    vec3 sum;      // of the arcs: -2 pi times the vector form factor of a light seen from its front
    float squares; // of the vertices' distances, summed: not finite where a vertex is not
};

// The form factor of the arcs around an outline, in [0, 1]: 0 for a light seen from its back, and where a vertex is not
// finite.
float arealight_form_factor(ArealightArcs arcs, bool two_sided) {
    // Counter-clockwise from the front is clockwise about the direction to the light
    float form_factor = -arcs.sum.z * AREALIGHT_INVERSE_TWO_PI;
    return arealight_guarded_form_factor(two_sided ? abs(form_factor) : form_factor, arcs.squares);
}

#endif
