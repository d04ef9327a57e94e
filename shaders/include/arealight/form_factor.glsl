#ifndef AREALIGHT_FORM_FACTOR_GLSL
#define AREALIGHT_FORM_FACTOR_GLSL

#include "arealight/common.glsl"
#include "arealight/effects.glsl"

// The form factor of a polygon: the integral of the clamped cosine max(0, z) / pi over the directions that it
// covers, in [0, 1]. Baum et al. 1989: the sum over the edges of (angle between the ends) x (z of the unit
// normal of the edge's plane) / 2 pi, after clipping at the horizon z = 0.
//
// The walk below takes the vertices one after another and clips each edge as it passes, so there is no vertex
// array, no limit to the number of vertices, and no case table; concave outlines need nothing special.
//
//     ArealightWalk walk = arealight_walk_begin(vertex[count - 1]);
//     for (i = 0; i < count; i++) arealight_walk_to(walk, vertex[i], rung);
//     float f = arealight_walk_form_factor(walk, two_sided, rung);
//
// Vertices are offsets from the shading point in a space whose z axis is the normal (Lambert) or in cosine
// space (a fitted lobe), in any unit whose squares stay within float32.
//
// Error of the exact rung, for vertices taken as exact: at most 1e-6 + 1e-7 / rho, rho being the distance to
// the polygon over that to its farthest vertex. The fast rung adds 1.2e-4 of each edge's share.
struct ArealightWalk {
    vec3 previous;    // the vertex that came last
    vec3 exit_point;  // where the outline last went below the horizon
    vec3 entry_point; // where it first came up, if that was before it ever went down
    float sum;        // 2 pi times the form factor of a light seen from its back
    bool exited;
    bool entered;
};

// Begins at the outline's last vertex.
ArealightWalk arealight_walk_begin(vec3 last_vertex) {
    return ArealightWalk(last_vertex, vec3(0.0), vec3(0.0), 0.0, false, false);
}

// theta / sin(theta) - 1 as a function of u = 1 - cos(theta), theta from 0 to pi / 2: minimax polynomials of
// relative error 5e-7 (exact) and 1.2e-4 (fast).
float arealight_arc_excess(float u, int rung) {
    if (rung == AREALIGHT_FORM_FACTOR_FAST) {
        return u * (0.3297787011 + u * (0.1655122936 + u * (-0.0284819529 + u * 0.1038046489)));
    }
    return u * (0.3333697617 + u * (0.1324360520 + u * (0.0645029768 + u * (-0.0025982983
         + u * (0.0664617047 + u * (-0.0498754047 + u * 0.0264988448))))));
}

// The angle from a to b times the z component of the unit normal of their plane. a and b of any length.
float arealight_arc(vec3 a, vec3 b, int rung) {
    float a_square = dot(a, a);
    float b_square = dot(b, b);
    float reciprocal = inversesqrt(max(a_square, AREALIGHT_TINY)) * inversesqrt(max(b_square, AREALIGHT_TINY));
    float cosine = dot(a, b) * reciprocal;

    // Pivot the cross product on the nearer end: its error is then eps |near| |edge|, not eps |far|^2
    vec3 near = a_square < b_square ? a : b;
    vec3 sine = cross(near, b - a) * reciprocal;

    // theta / sin(theta): by the polynomial up to a right angle, by reflection above it. |sine| comes from the
    // cross product, never from 1 - cosine^2
    float weight = 1.0 + arealight_arc_excess(1.0 - abs(cosine), rung);
    if (cosine < 0.0) {
        weight = AREALIGHT_PI * inversesqrt(max(dot(sine, sine), AREALIGHT_TINY)) - weight;
    }
    return weight * sine.z;
}

// Where the edge from a to b meets the horizon, one end being above it and the other not. Measured from the
// end nearer to the horizon; z is exactly zero.
vec3 arealight_horizon_point(vec3 a, vec3 b) {
    bool from_a = abs(a.z) < abs(b.z);
    vec3 near = from_a ? a : b;
    vec3 far = from_a ? b : a;
    vec2 point = near.xy + (near.z / (near.z - far.z)) * (far.xy - near.xy);
    return vec3(point, 0.0);
}

// Walks from the last vertex to `vertex`.
void arealight_walk_to(inout ArealightWalk walk, vec3 vertex, int rung) {
    vec3 from = walk.previous;
    vec3 to = vertex;
    walk.previous = vertex;
    bool from_above = from.z > 0.0;
    bool to_above = to.z > 0.0;
    if (!from_above && !to_above) {
        return;
    }
    if (from_above != to_above) {
        vec3 crossing = arealight_horizon_point(from, to);
        if (from_above) {
            to = crossing;
            walk.exit_point = crossing;
            walk.exited = true;
        } else {
            from = crossing;
            // Close the outline along the horizon, from where it went down to where it comes up
            if (walk.exited) {
                walk.sum += arealight_arc(walk.exit_point, crossing, rung);
            } else {
                walk.entry_point = crossing;
                walk.entered = true;
            }
        }
    }
    walk.sum += arealight_arc(from, to, rung);
}

// Ends the walk. One-sided: 0 for a light seen from its back. The result is in [0, 1], also where the sum is
// NaN.
float arealight_walk_form_factor(ArealightWalk walk, bool two_sided, int rung) {
    float sum = walk.sum;
    if (walk.entered && walk.exited) {
        sum += arealight_arc(walk.exit_point, walk.entry_point, rung);
    }
    // Counter-clockwise from the front is clockwise about the direction to the light
    float form_factor = -sum * AREALIGHT_INVERSE_TWO_PI;
    form_factor = two_sided ? abs(form_factor) : form_factor;
    return form_factor > 0.0 ? min(form_factor, 1.0) : 0.0;
}

#endif
