#ifndef AREALIGHT_TUBE_HORIZONS_GLSL
#define AREALIGHT_TUBE_HORIZONS_GLSL

#include "arealight/form_factor/tube.glsl"

// The form factor of a tube clipped at two horizons: at the surface's, before the lobe's transform, and at
// that of cosine space. The outline is cut at the surface first; what is left are at most two arcs at each
// end, and edges between them.

// An outline as it is drawn: pieces, and edges from each to the next.
struct ArealightDrawnOutline {
    ArealightOutline outline;
    bool finite;   // no coordinate of a piece is infinite or NaN
    vec3 first;    // ends of pieces, unit vectors in cosine space
    vec3 last;
    bool begun;
};

// Draws an edge to a direction, unit.
void arealight_draw_to(inout ArealightDrawnOutline drawn, vec3 unit) {
    if (drawn.begun) {
        arealight_outline_edge(drawn.outline, drawn.last, unit);
    } else {
        drawn.first = unit;
    }
    drawn.last = unit;
    drawn.begun = true;
}

// The part of a rim that an arc of its circle covers.
ArealightRim arealight_rim_part(ArealightRim rim, ArealightArcSpan span) {
    return ArealightRim(rim.center, span.middle.x * rim.middle + span.middle.y * rim.side,
                        span.middle.x * rim.side - span.middle.y * rim.middle, span.half_width,
                            span.half_width.x < 0.0);
}

// Draws an edge to an arc, and the arc, clipped at the horizon of cosine space. `backward`: from the rim's
// end to its begin; `horizon` is the sine of the elevation below which its ends count as on the horizon.
void arealight_draw_arc(inout ArealightDrawnOutline drawn, ArealightRim rim, mat3 transform, float horizon,
                        bool backward) {
    ArealightRimArc arc = arealight_rim_arc(rim, transform, drawn.finite);
    vec3 begin = arealight_cone_unit(arc.cone, arc.begin, horizon);
    vec3 end = arealight_cone_unit(arc.cone, arc.end, horizon);
    bool swapped = (arc.way < 0.0) != backward;
    arealight_draw_to(drawn, swapped ? end : begin);
    arealight_outline_rim(drawn.outline, arc, begin.z > 0.0, end.z > 0.0, backward ? -1.0 : 1.0);
    drawn.last = swapped ? begin : end;
}

// Draws one of at most two pieces of a rim that are above the surface, whose unit normal is in the space of
// the rim: the `second` in the direction of drawing, or the first.
void arealight_draw_rim(inout ArealightDrawnOutline drawn, ArealightRim rim, vec3 normal, mat3 transform,
                        float horizon,
                        bool backward, bool second) {
    vec3 heights = vec3(dot(normal, rim.center), dot(normal, rim.middle), dot(normal, rim.side));
    vec2 ends = heights.x + heights.y * rim.half_width.x + vec2(-1.0, 1.0) * (heights.z * rim.half_width.y);
    // Where the circle crosses the surface's plane
    float steepness = sqrt(dot(heights.yz, heights.yz));
    vec2 top = heights.yz / max(steepness, 1e-37);
    float cosine = clamp(-heights.x / max(steepness, 1e-37), -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    bool crosses = abs(heights.x) < steepness;
    bool bump = max(ends.x, ends.y) <= 0.0 && crosses && top.x > rim.half_width.x;
    bool dip = min(ends.x, ends.y) > 0.0 && crosses && -top.x > rim.half_width.x;
    if (second ? !dip : max(ends.x, ends.y) <= 0.0 && !bump) {
        return;
    }
    // The pieces beside a dip: from the rim's begin to where the circle falls, and from where it rises to the
    // rim's end
    bool last = second != backward;
    bool rises = dip ? last : ends.x <= 0.0;
    bool falls = dip ? !last : ends.y <= 0.0;
    ArealightArcSpan span = ArealightArcSpan(vec2(1.0, 0.0), rim.half_width);
    if (rises || falls) {
        vec2 begin = vec2(rim.half_width.x, -rim.half_width.y);
        vec2 end = rim.half_width;
        begin = rises ? vec2(top.x * cosine + top.y * sine, top.y * cosine - top.x * sine) : begin;
        end = falls ? vec2(top.x * cosine - top.y * sine, top.y * cosine + top.x * sine) : end;
        bool turned = begin.x * end.y - begin.y * end.x < 0.0;
        span = arealight_arc_between(begin, end, turned && rim.reflex && cosine < 0.0);
    }
    arealight_draw_arc(drawn, arealight_rim_part(rim, span), transform, horizon, backward);
}

// Draws to where the edge between two points crosses the surface's plane, if it does.
void arealight_draw_crossing(inout ArealightDrawnOutline drawn, vec3 from, vec3 to, vec3 normal,
                             mat3 transform) {
    float from_height = dot(normal, from);
    float to_height = dot(normal, to);
    if ((from_height > 0.0) != (to_height > 0.0)) {
        vec3 crossing = from + (to - from) * clamp(from_height / (from_height - to_height), 0.0, 1.0);
        arealight_draw_to(drawn, arealight_unit(transform * crossing));
    }
}

// An end of a rim: `side` is -1 for its begin, 1 for its end.
vec3 arealight_rim_end(ArealightRim rim, float side) {
    return rim.center + rim.half_width.x * rim.middle + side * rim.half_width.y * rim.side;
}

// As arealight_tube_form_factor, clipped at the surface's horizon too: `normal` is the surface's, in the
// space of the tube. Error: 3e-6. A thin tube is not taken for a line: its error is that of its outline.
float arealight_tube_both_horizons(ArealightTube tube, vec3 normal, mat3 transform, float horizon) {
    mat3 frame = arealight_tube_frame(tube);
    transform = transform * frame;
    normal = normal * frame;
    if (!tube.outside) {
        ArealightSilhouette disk = arealight_tube_disk(tube);
        vec3 heights = vec3(dot(normal, disk.center), dot(normal, disk.axis_u), dot(normal, disk.axis_v));
        return arealight_ellipse_both_horizons(transform * disk.center, transform * disk.axis_u, transform
                                               * disk.axis_v,
                                               heights, true, horizon);
    }
    ArealightDrawnOutline drawn = ArealightDrawnOutline(arealight_outline_begin(AREALIGHT_ANYWHERE), true,
                                                        vec3(0.0), vec3(0.0), false);
    // Along an edge to the start's rim and that rim, piece by piece; along the other edge to the end's, and
    // back
    for (int i = 0; i < 4; i++) {
        bool backward = i >= 2;
        bool second = (i & 1) == 1;
        float outwards = backward ? 1.0 : -1.0;
        ArealightRim rim = arealight_tube_rim(tube, outwards);
        if (!second) {
            ArealightRim other = arealight_tube_rim(tube, -outwards);
            arealight_draw_crossing(drawn, arealight_rim_end(other, outwards),
                                    arealight_rim_end(rim, outwards), normal,
                                    transform);
        }
        arealight_draw_rim(drawn, rim, normal, transform, horizon, backward, second);
    }
    if (!drawn.begun) {
        return 0.0;
    }
    arealight_outline_edge(drawn.outline, drawn.last, drawn.first);
    return arealight_guarded_form_factor(abs(arealight_outline_vector(drawn.outline).z), drawn.finite);
}

#endif
