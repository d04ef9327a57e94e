#ifndef AREALIGHT_OUTLINE_GLSL
#define AREALIGHT_OUTLINE_GLSL

#include "arealight/form_factor/arc.glsl"

// The vector form factor of any simple polygon, convex or concave, of any number of vertices, clipped at the
// horizon z = 0 of its space: edge by edge as they pass, without a vertex array, a limit to the number of
// vertices, or a table of cases.
//
//     ArealightOutline outline = arealight_outline_begin(center);
//     for each edge: arealight_outline_edge(outline, from, to);   // unit vectors
//     vec3 vector = arealight_outline_vector(outline);
//
// Promises: as form_factor/quad.glsl states; tested for up to 64 vertices, the rounding of a longer sum grows
// with its length (1024: 1.4e-6).
struct ArealightOutline {
    vec3 arcs;  // the sum so far
    vec3 about; // the direction from which crossings are taken, of any length
    vec2 turn;  // how far the outline has to turn along the horizon to be closed, as a complex number
};

// For outlines whose error need not be as small as they are: arealight_outline_begin.
const vec3 AREALIGHT_ANYWHERE = vec3(1.0, 0.0, 0.0);

// Begins an outline about a direction, of any length. Where that is amid a small outline, crossings keep
// their digits, and the error is as small as the outline; elsewhere it is that of one as large as a unit.
ArealightOutline arealight_outline_begin(vec3 about) {
    return ArealightOutline(vec3(0.0), about, vec2(1.0, 0.0));
}

// Tells an outline of a crossing more, a unit vector; `exits`: there the outline goes down.
//
// The crossings of a flat, simple polygon lie on one line, and the angles between them, seen from beside that
// line, add up to less than pi: so it is enough to know their sum's direction, as a product of complex
// numbers.
void arealight_outline_crossing(inout ArealightOutline outline, vec2 crossing, bool exits) {
    float square = dot(outline.about.xy, outline.about.xy);
    vec2 zero = square > 0.0 ? outline.about.xy * inversesqrt(square) : vec2(1.0, 0.0);
    vec2 along = crossing - zero;
    float y = zero.x * along.y - zero.y * along.x;
    vec2 by = vec2(dot(zero, crossing), exits ? -y : y);
    vec2 turn = outline.turn;
    outline.turn = vec2(turn.x * by.x - turn.y * by.y, turn.x * by.y + turn.y * by.x);
}

// The arc along the horizon that closes an outline, from how far it has to turn; `half_turn` and `front` as
// in arealight_horizon_arc.
vec3 arealight_closing_arc(vec2 turn, float half_turn, float front) {
    vec2 unit = turn * inversesqrt(dot(turn, turn) + AREALIGHT_LEAST_SQUARE);
    return arealight_horizon_arc(vec2(1.0, 0.0), unit, half_turn, front);
}

// Adds the edge between two directions, unit vectors, as far as it is above the horizon.
void arealight_outline_edge(inout ArealightOutline outline, vec3 from, vec3 to) {
    bool from_above = from.z > 0.0;
    bool to_above = to.z > 0.0;
    if (from_above || to_above) {
        if (from_above != to_above) {
            vec2 crossing = (from_above ? 1.0 : -1.0) * arealight_crossing(from, to);
            arealight_outline_crossing(outline, crossing, from_above);
            from.xy = from_above ? from.xy : crossing;
            to.xy = to_above ? to.xy : crossing;
        }
        // Of an end below the horizon the crossing is left
        from.z = max(from.z, 0.0);
        to.z = max(to.z, 0.0);
        outline.arcs += arealight_arc(from, to);
    }
}

// The vector form factor of all edges. Seen from the front z is positive; `front` as in
// arealight_quad_vector.
vec3 arealight_outline_vector(ArealightOutline outline, float front) {
    return AREALIGHT_PER_ARC * (outline.arcs + arealight_closing_arc(outline.turn, -outline.arcs.z, front));
}

// The same where the side is not known.
vec3 arealight_outline_vector(ArealightOutline outline) {
    return arealight_outline_vector(outline, 0.0);
}

// A polygon clipped at the surface's horizon first, vertex by vertex: they come in the shading frame, whose
// horizon is the surface's, and what is left of the outline goes on into a lobe's space.
struct ArealightClippedOutline {
    ArealightOutline outline;
    vec3 previous; // the vertex before, in the shading frame
    vec3 first;    // of what is left, unit vectors in the lobe's space
    vec3 last;
    bool begun;
};

// Begins at the polygon's last vertex; `about` as arealight_outline_begin's, in the lobe's space.
ArealightClippedOutline arealight_clipped_begin(vec3 last, vec3 about) {
    return ArealightClippedOutline(arealight_outline_begin(about), last, vec3(0.0), vec3(0.0), false);
}

// Goes on to a vertex of what is left, in the shading frame.
void arealight_clipped_add(inout ArealightClippedOutline clipped, mat3 space, vec3 vertex) {
    vec3 unit = arealight_unit(space * vertex);
    if (clipped.begun) {
        arealight_outline_edge(clipped.outline, clipped.last, unit);
    } else {
        clipped.first = unit;
        clipped.begun = true;
    }
    clipped.last = unit;
}

// Goes on to the polygon's next vertex.
void arealight_clipped_vertex(inout ArealightClippedOutline clipped, mat3 space, vec3 vertex) {
    bool is_above = vertex.z > 0.0;
    if (is_above != (clipped.previous.z > 0.0)) {
        arealight_clipped_add(clipped, space, is_above ? arealight_cut(vertex, clipped.previous)
                                                       : arealight_cut(clipped.previous, vertex));
    }
    if (is_above) {
        arealight_clipped_add(clipped, space, vertex);
    }
    clipped.previous = vertex;
}

// Its vector form factor, when all vertices have come; `front` as in arealight_quad_vector.
vec3 arealight_clipped_vector(ArealightClippedOutline clipped, float front) {
    if (!clipped.begun) {
        return vec3(0.0);
    }
    arealight_outline_edge(clipped.outline, clipped.last, clipped.first);
    return arealight_outline_vector(clipped.outline, front);
}

#endif
