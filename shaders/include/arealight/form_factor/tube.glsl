#ifndef AREALIGHT_TUBE_GLSL
#define AREALIGHT_TUBE_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/tube_outline.glsl"
#include "arealight/form_factor/tube_line.glsl"

// The form factor of a tube: a cylinder without or with flat caps, or a capsule. A tube shines outwards; from
// inside it gives 0.
//
// A convex body of constant radiance sends what its silhouette does. A tube's outline is two arcs of circles,
// which elliptic_arc.glsl integrates in closed form under any linear transform, and two edges between their
// ends. So the outline is exact, whatever the tube's thickness, and is clipped exactly at the horizon.
//
//     ArealightTube tube = arealight_tube(center, half_axis, radius, ends); once a shading point
//     float f = arealight_tube_form_factor(tube, to_cosine, horizon); for each lobe

// The form factor of a tube, clipped at the horizon z = 0 of a lobe's cosine space: in [0, 1]. `transform`
// takes the space of arealight_tube's arguments into cosine space; `horizon` is the sine of the elevation
// below which an end of a rim counts as on the horizon: arealight_horizon_width. For any bits the result is a
// finite number.
//
// Error: 2e-6, or of long thin ones 4e-8 of length over radius, where the point is a tenth of the radius away
// or more; of a tube as thin as AREALIGHT_TUBE_THIN at most 5e-4 of what the whole tube sends from the
// zenith, out to any distance, however it is turned and cut.
float arealight_tube_form_factor(ArealightTube tube, mat3 transform, float horizon) {
    mat3 space = transform * arealight_tube_frame(tube);
    if (!tube.outside) {
        ArealightSilhouette disk = arealight_tube_disk(tube);
        return arealight_ellipse_form_factor(space * disk.center, space * disk.axis_u, space * disk.axis_v,
                                             true);
    }
    bool is_line;
    float line = arealight_tube_line(tube, space, is_line);
    if (is_line) {
        return line;
    }
    // From the start's rim along one edge to the end's, and back. A loop: one rim after the other, each made
    // where it is used
    ArealightOutline outline = arealight_outline_begin(AREALIGHT_ANYWHERE);
    bool finite = true;
    vec3 first = vec3(0.0);
    vec3 last = vec3(0.0);
    for (int i = 0; i < 2; i++) {
        float way = i == 0 ? 1.0 : -1.0;
        ArealightRimArc arc = arealight_rim_arc(arealight_tube_rim(tube, -way), space, finite);
        vec3 begin = arealight_cone_unit(arc.cone, arc.begin, horizon);
        vec3 end = arealight_cone_unit(arc.cone, arc.end, horizon);
        bool swapped = way * arc.way < 0.0;
        vec3 from = swapped ? end : begin;
        vec3 to = swapped ? begin : end;
        if (i == 0) {
            first = from;
            last = to;
        } else {
            arealight_outline_edge(outline, last, from);
            arealight_outline_edge(outline, to, first);
        }
        arealight_outline_rim(outline, arc, begin.z > 0.0, end.z > 0.0, way);
    }
    return arealight_guarded_form_factor(abs(arealight_outline_vector(outline).z), finite);
}

#endif
