#ifndef AREALIGHT_TUBE_GLSL
#define AREALIGHT_TUBE_GLSL

#include "arealight/rim.glsl"
#include "arealight/tube_outline.glsl"
#include "arealight/tube_small.glsl"

// The form factor of a tube: a cylinder without or with flat caps, or a capsule. A tube shines outwards; from inside it
// gives 0.
//
// A convex body of constant radiance sends what its silhouette does. A tube's outline is two arcs of circles, which
// elliptic_arc.glsl integrates in closed form under any linear transform, and two edges between their ends. So the outline is
// exact, whatever the tube's thickness, and is clipped exactly at the horizon as it is walked.
//
//     ArealightTube tube = arealight_tube(center, half_axis, radius, ends); once a shading point
//     float f = arealight_tube_form_factor(tube, to_cosine, horizon, rung); for each lobe

// The form factor of a tube, clipped at the horizon z = 0 of a lobe's cosine space: in [0, 1]. `transform` takes the tube's
// space into cosine space; `horizon` is the sine of the elevation below which an end of a rim counts as on the horizon:
// AREALIGHT_HORIZON_WIDTH times the flatness of the space. For any bits the result is a finite number.
//
// Exact rung: error 2e-6 where the point is a tenth of the radius away or more. The difference form makes the error relative
// where the ends are small (AREALIGHT_TUBE_SMALL): for a tube within a fifth of its distance it is at most 1e-5 of what the
// whole tube sends from the zenith, out to any distance, however it is turned and cut; for a longer one as thin as
// AREALIGHT_TUBE_THIN 1e-4 of that, unless it is seen along its axis. The fast rung adds 4e-5, and more in contact.
float arealight_tube_form_factor(ArealightTube tube, mat3 transform, float horizon, int rung) {
    if (!tube.seen) {
        return 0.0;
    }
    if (!tube.outside) {
        ArealightRim rim = tube.rims[0];
        return arealight_ellipse_form_factor(transform * rim.center, transform * rim.middle, transform * rim.side, true,
                                             rung);
    }
    if (rung == AREALIGHT_FORM_FACTOR_DIFFERENCE) {
        bool is_small;
        float form_factor = arealight_small_tube(tube, transform, horizon, rung, is_small);
        if (is_small) {
            return form_factor;
        }
        rung = AREALIGHT_FORM_FACTOR_EXACT;
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
