#ifndef AREALIGHT_TUBE_GLSL
#define AREALIGHT_TUBE_GLSL

#include "arealight/rim.glsl"
#include "arealight/tube_outline.glsl"

// The form factor of a tube: a cylinder without or with flat caps, or a capsule. A tube shines outwards; from inside it
// gives 0.
//
// A convex body of constant radiance sends what its silhouette does. A tube's outline is two arcs of circles, which
// elliptic_arc.glsl integrates in closed form under any linear transform, and two edges between their ends. So the outline is
// exact, whatever the tube's thickness, and is clipped exactly at the horizon as it is walked.
//
//     ArealightTube tube = arealight_tube(center, half_axis, radius, ends); once a shading point
//     float f = arealight_tube_form_factor(tube, to_cosine, horizon, rung); for each lobe

// The thickness in cosine space, as a part of the axis's distance, below which the difference form takes a tube for a
// line: there its error and that of the outline's rounding are about equal.
const float AREALIGHT_TUBE_THIN = 3e-3;

// The form factor of a thin tube's lateral surface, clipped at the horizon, with relative precision: a line of the
// tube's width as it is seen. It goes from `start` to `start` + `along`; `width` is half of the tube's in cosine space.
// Relative error: (width / distance)^2 and 4e-6.
float arealight_line_form_factor(vec3 start, vec3 along, float width, int rung) {
    float end_height = start.z + along.z;
    if (max(start.z, end_height) <= 0.0) {
        return 0.0;
    }
    // What is above the horizon
    float share = clamp(-start.z / along.z, 0.0, 1.0);
    vec3 from = start.z < 0.0 ? start + along * share : start;
    float part = start.z < 0.0 ? 1.0 - share : end_height < 0.0 ? share : 1.0;
    float size = sqrt(dot(along, along));
    vec3 axis = along / max(size, 1e-37);
    float extent = size * part;
    // The line's foot, its distance, and where it begins and ends from there
    float begin = dot(from, axis);
    float finish = begin + extent;
    vec3 foot = from - axis * begin;
    foot -= axis * dot(axis, foot);
    float square = max(dot(foot, foot), AREALIGHT_TINY);
    float reciprocal = inversesqrt(square);
    float distance = square * reciprocal;
    // Differences of the antiderivative, as products
    float both = 1.0 / ((square + begin * begin) * (square + finish * finish));
    float turn = arealight_arctangent(distance * extent, square + begin * finish, rung);
    float across = 0.5 * foot.z * (extent * (square - begin * finish) * both * reciprocal + turn / square);
    float slope = 0.5 * axis.z * distance * extent * (begin + finish) * both;
    return 2.0 * width * AREALIGHT_INVERSE_PI * (across + slope);
}

// The form factor of a thin tube: the line's, and at each end half of the disk that the end is seen as. A round end adds
// its half sphere. A flat one is seen beyond the line's end as half a rim, or with the cap that is before it; where the cap
// is seen but does not shine, it is the half rim that is lacking.
// Relative error: 10 (radius / distance)^2, and that of the line's and the ellipses' rounding.
float arealight_thin_tube(ArealightTube tube, mat3 transform, float width, int rung) {
    float sum = arealight_line_form_factor(transform * tube.start, 2.0 * (transform * tube.half_axis), width, rung);
    for (int i = 0; i < 2; i++) {
        ArealightRim rim = tube.rims[i];
        float disk = arealight_ellipse_form_factor(transform * rim.center, transform * rim.middle,
                                                   transform * rim.side, true, rung);
        bool lacks = tube.ends == AREALIGHT_TUBE_OPEN && (i == 0 ? tube.before : tube.past);
        sum += lacks ? -0.5 * disk : 0.5 * disk;
    }
    return sum;
}

// The form factor of a tube, clipped at the horizon z = 0 of a lobe's cosine space: in [0, 1]. `transform` takes the tube's
// space into cosine space; `horizon` is the sine of the elevation below which an end of a rim counts as on the horizon:
// AREALIGHT_HORIZON_WIDTH times the flatness of the space. For any bits the result is a finite number.
//
// Exact rung: error 2e-6 where the point is a tenth of the radius away or more. With the difference form a tube that
// is thinner than AREALIGHT_TUBE_THIN of its distance is a line, with an error of 1e-4 of what the whole tube sends at that
// thickness, less by the square below. The fast rung adds 4e-5, and more in contact.
float arealight_tube_form_factor(ArealightTube tube, mat3 transform, float horizon, int rung) {
    if (!tube.seen) {
        return 0.0;
    }
    if (!tube.outside) {
        ArealightRim rim = tube.rims[0];
        return arealight_ellipse_form_factor(transform * rim.center, transform * rim.middle, transform * rim.side, true,
                                             rung);
    }
    if ((rung & AREALIGHT_FORM_FACTOR_DIFFERENCE) != 0) {
        // The width across the plane of axis and point, in cosine space, and the axis's distance there
        vec3 axis = transform * tube.axis;
        vec3 plane = cross(axis, transform * tube.towards);
        float area = sqrt(max(dot(plane, plane), 1e-37));
        float width = tube.radius * abs(determinant(transform)) / area;
        float distance = tube.distance * area * inversesqrt(max(dot(axis, axis), 1e-37));
        if (width < AREALIGHT_TUBE_THIN * distance && tube.radius < AREALIGHT_TUBE_THIN * tube.distance) {
            float square = dot(tube.start, tube.start) + dot(tube.end, tube.end);
            return arealight_guarded_form_factor(arealight_thin_tube(tube, transform, width, rung), square);
        }
        rung &= ~AREALIGHT_FORM_FACTOR_DIFFERENCE;
    }
    ArealightAnchor anchor = arealight_anchor(vec3(0.0), 0.0, rung);
    ArealightWalk walk = arealight_walk_begin();
    // From the start's rim along one edge to the end's, and back
    ArealightVertex ends[4];
    for (int i = 0; i < 2; i++) {
        ArealightRimArc arc = arealight_rim_arc(tube.rims[i], transform, rung);
        ArealightVertex begin = arealight_cone_vertex(arc.cone, arc.begin, horizon);
        ArealightVertex end = arealight_cone_vertex(arc.cone, arc.end, horizon);
        arealight_walk_rim(walk, anchor, arc, begin, end, i == 0 ? 1.0 : -1.0, rung);
        walk.squares += arc.square;
        ends[2 * i] = arealight_select(arc.way > 0.0, begin, end);
        ends[2 * i + 1] = arealight_select(arc.way > 0.0, end, begin);
    }
    arealight_walk_edge(walk, anchor, ends[1], ends[3], rung);
    arealight_walk_edge(walk, anchor, ends[2], ends[0], rung);
    return arealight_form_factor(arealight_walk_end(walk, anchor, rung), true);
}

#endif
