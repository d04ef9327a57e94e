#ifndef AREALIGHT_DISK_PART_GLSL
#define AREALIGHT_DISK_PART_GLSL

#include "arealight/form_factor/outline.glsl"

// What is within a disk of a convex outline in the disk's plane: its edges as far as they are within, and
// arcs of the disk's rim between them, as chords that have the arc's area together. All points here are from
// the disk's center. Whether a vertex is within is decided by one comparison, so that edges that meet agree.

// The part of the edge from a to b that is within a disk of this squared radius, in [0, 1] along it; false
// where none is.
bool arealight_edge_in_disk(vec3 a, vec3 b, float square, out vec2 part) {
    bool a_within = dot(a, a) < square;
    bool b_within = dot(b, b) < square;
    vec3 along = b - a;
    float length_square = max(dot(along, along), AREALIGHT_LEAST_SQUARE);
    float middle = -dot(a, along) / length_square;
    vec3 nearest = a + middle * along;
    float room = square - dot(nearest, nearest);
    float reach = sqrt(max(room, 0.0) / length_square);
    part = vec2(a_within ? 0.0 : clamp(middle - reach, 0.0, 1.0), b_within ? 1.0 : clamp(middle + reach, 0.0,
                                                                                         1.0));
    return a_within || b_within || (room > 0.0 && middle > 0.0 && middle < 1.0);
}

// An arc of a disk's rim, as equal chords.
struct ArealightDiskArc {
    vec2 turn;   // of one chord, cosine and sine
    float scale; // of the corners between the arc's ends, over the radius
    int chords;
};

// The least cosine of a chord's angle: 37 degrees.
const float AREALIGHT_LEAST_CHORD = 0.8;

// The scale of an arc's corners between its ends: what its chords span is the arc's sector.
float arealight_disk_arc_scale(float cosine, float chords) {
    float arc = chords * arealight_acute_weight(cosine);
    return arc / (1.0 + sqrt(1.0 + (chords - 2.0) * arc));
}

// The arc of a rim of this squared radius from one point of it to another, counter-clockwise about a unit
// normal. Where both are one point to rounding, it is all of the rim if the outline holds the disk's center
// and `outside`, how far it was from the rim between them as a part of the squared radius, is no rounding.
ArealightDiskArc arealight_disk_arc(vec3 from, vec3 to, vec3 normal, float square, float outside) {
    vec2 turn = vec2(dot(from, to), dot(normal, cross(from, to))) / square;
    if (turn.x > 0.0 && abs(turn.y) < 2e-6) {
        turn.y = outside > 1e-4 ? -2e-6 : 2e-6;
    }
    // Half of the angle, in (0, pi): of the two half angles the one with a positive sine
    turn = turn.x < 0.0 ? vec2(turn.y, 1.0 - turn.x)
        : vec2(turn.y < 0.0 ? -1.0 - turn.x : 1.0 + turn.x, abs(turn.y));
    turn *= inversesqrt(max(dot(turn, turn), AREALIGHT_LEAST_SQUARE));
    int chords = 2;
    while (turn.x < AREALIGHT_LEAST_CHORD && chords < 16) {
        turn += vec2(1.0, 0.0);
        turn *= inversesqrt(max(dot(turn, turn), AREALIGHT_LEAST_SQUARE));
        chords *= 2;
    }
    return ArealightDiskArc(turn, arealight_disk_arc_scale(turn.x, float(chords)), chords);
}

// All of a rim, as a regular outline of twelve corners and the disk's area.
ArealightDiskArc arealight_whole_disk() {
    return ArealightDiskArc(vec2(0.8660254, 0.5), 1.0233267, 13);
}

// The next corner's direction, from the one before.
vec3 arealight_disk_arc_turned(ArealightDiskArc arc, vec3 normal, vec3 corner) {
    return arc.turn.x * corner + arc.turn.y * cross(normal, corner);
}

#endif
