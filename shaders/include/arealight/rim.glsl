#ifndef AREALIGHT_RIM_GLSL
#define AREALIGHT_RIM_GLSL

#include "arealight/elliptic_arc.glsl"
#include "arealight/walk.glsl"

// Arcs of ellipses as parts of an outline that is walked edge by edge (walk.glsl), without the difference form: the ends of
// tubes, and disks that are cut by the surface's horizon. Where an arc ends and an edge begins, both have the same
// direction to the bit, so that an outline is closed whatever the rounding.

// A part of an ellipse's outline: center + cos(t) middle + sin(t) side for t from -half to half.
struct ArealightRim {
    vec3 center;
    vec3 middle;
    vec3 side;
    vec2 half_width; // cosine and sine
};

// A rim in cosine space, as its cone's outline.
struct ArealightRimArc {
    ArealightCone cone;   // its frame from the ellipse's into cosine space, right-handed
    vec3 up;              // the horizon's normal in the cone's frame
    float way;            // 1 where the cone's parameter grows with the rim's, else -1
    vec2 begin;           // cosine and sine of the ends in the cone's parameter, which grows from begin to end
    vec2 end;
    bool reflex;          // more than half of the cone's outline
    float square;
};

// The direction of a cone's outline, not unit.
vec3 arealight_cone_direction(ArealightCone cone, vec2 point) {
    return cone.frame * vec3(cone.a * point.x, cone.b * point.y, cone.c);
}

// Where a direction lies on a cone's outline, which it is on but for rounding.
vec2 arealight_cone_parameter(ArealightCone cone, vec3 direction) {
    vec3 along = direction * cone.frame;
    vec2 point = vec2(along.x * cone.b, along.y * cone.a);
    point *= inversesqrt(max(dot(point, point), 1e-37));
    // Seen along its plane a rim is a line, on which its longer axis alone tells the place
    float cosine = clamp(along.x * cone.c / max(cone.a * along.z, 1e-37), -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    return cone.b > 1e-3 * cone.a ? point : vec2(cosine, along.y < 0.0 ? -sine : sine);
}

ArealightRimArc arealight_rim_arc(ArealightRim rim, mat3 transform, int rung) {
    ArealightRimArc arc;
    vec3 center = transform * rim.center;
    vec3 middle = transform * rim.middle;
    vec3 side = transform * rim.side;
    ArealightEllipse ellipse = arealight_ellipse(center, middle, side);
    arc.square = ellipse.square;
    arc.cone = arealight_ellipse_cone(ellipse, arealight_confocal_root(ellipse));
    mat3 frame = ellipse.frame * arc.cone.frame;
    frame[1] = dot(cross(frame[0], frame[1]), frame[2]) < 0.0 ? -frame[1] : frame[1];
    arc.cone.frame = frame;
    arc.up = vec3(frame[0].z, frame[1].z, frame[2].z);
    // The point is behind the front: seen from it the rim's parameter runs as the cone's does
    arc.way = ellipse.front ? -1.0 : 1.0;
    vec3 ends = center + rim.half_width.x * middle;
    vec2 first = arealight_cone_parameter(arc.cone, ends - rim.half_width.y * side);
    vec2 last = arealight_cone_parameter(arc.cone, ends + rim.half_width.y * side);
    arc.begin = ellipse.front ? last : first;
    arc.end = ellipse.front ? first : last;
    // Where the ends meet, the rim tells whether that is none of it or all
    vec2 chord = arc.end - arc.begin;
    bool turned = arc.begin.x * arc.end.y - arc.begin.y * arc.end.x < 0.0;
    arc.reflex = dot(chord, chord) < 1e-6 ? rim.half_width.x < 0.0 : turned;
    return arc;
}

// The arc between two points of a cone's outline, t growing; `reflex`: more than half of it.
ArealightArcSpan arealight_arc_between(vec2 begin, vec2 end, bool reflex) {
    vec2 chord = end - begin;
    vec2 sum = begin + end;
    float sine = 0.5 * sqrt(dot(chord, chord));
    float cosine = 0.5 * sqrt(dot(sum, sum)) * (reflex ? -1.0 : 1.0);
    // The middle from the longer of both
    vec2 middle = sine > abs(cosine) ? vec2(chord.y, -chord.x) / sine : sum / (cosine == 0.0 ? 1.0 : cosine);
    float reciprocal = inversesqrt(max(sine * sine + cosine * cosine, 1e-37));
    return ArealightArcSpan(0.5 * middle, vec2(cosine, sine) * reciprocal);
}

// A point of a cone's outline as a vertex of the walk.
ArealightVertex arealight_cone_vertex(ArealightCone cone, vec2 point, float horizon) {
    vec3 direction = arealight_cone_direction(cone, point);
    vec3 unit = direction * inversesqrt(max(dot(direction, direction), 1e-37));
    unit.z = abs(unit.z) > horizon ? unit.z : 0.0;
    return ArealightVertex(unit, unit, unit, 1.0);
}

// Walks an arc, clipped at the horizon; `way` is 1 in the direction of the rim's own parameter, else -1. `first` and `last`
// are its ends in the cone's parameter.
void arealight_walk_rim(inout ArealightWalk walk, ArealightAnchor anchor, ArealightRimArc arc, ArealightVertex first,
                        ArealightVertex last, float way, int rung) {
    ArealightCone cone = arc.cone;
    bool forward = way * arc.way > 0.0;
    // Where the cone's whole outline crosses the horizon
    vec2 slope = vec2(cone.a * arc.up.x, cone.b * arc.up.y);
    float steepness = sqrt(dot(slope, slope));
    float reciprocal = 1.0 / max(steepness, 1e-37);
    vec2 top = slope * reciprocal;
    float cosine = clamp(-cone.c * arc.up.z * reciprocal, -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    bool crosses = cone.c * abs(arc.up.z) < steepness;
    vec2 rise = vec2(top.x * cosine + top.y * sine, top.y * cosine - top.x * sine);
    vec2 fall = vec2(top.x * cosine - top.y * sine, top.y * cosine + top.x * sine);
    // Which part of the arc is above
    ArealightArcSpan whole = arealight_arc_between(arc.begin, arc.end, arc.reflex);
    bool first_above = first.unit.z > 0.0;
    bool last_above = last.unit.z > 0.0;
    float along_top = dot(top, whole.middle);
    bool bump = !first_above && !last_above && crosses && along_top > whole.half_width.x;
    bool dip = first_above && last_above && crosses && -along_top > whole.half_width.x;
    if (!(first_above || last_above || bump)) {
        return;
    }
    vec2 begin = first_above ? arc.begin : rise;
    vec2 end = last_above ? arc.end : fall;
    vec2 chord = end - begin;
    bool turned = begin.x * end.y - begin.y * end.x < 0.0;
    bool same = first_above && last_above;
    bool reflex = same || (dot(chord, chord) < 1e-6 && !bump) ? arc.reflex : turned;
    vec3 integral = arealight_elliptic_arc(cone, arealight_arc_between(begin, end, reflex), rung);
    if (dip) {
        integral -= arealight_elliptic_arc(cone, ArealightArcSpan(-top, vec2(-cosine, sine)), rung);
    }
    walk.sum += (forward ? 1.0 : -1.0) * (cone.frame * integral);
    // The crossings close the outline
    if (!first_above || dip) {
        ArealightVertex up = arealight_cone_vertex(cone, rise, 0.0);
        up.unit = vec3(up.unit.xy * inversesqrt(max(dot(up.unit.xy, up.unit.xy), 1e-37)), 0.0);
        arealight_walk_close(walk, anchor, up, !forward, rung);
    }
    if (!last_above || dip) {
        ArealightVertex down = arealight_cone_vertex(cone, fall, 0.0);
        down.unit = vec3(down.unit.xy * inversesqrt(max(dot(down.unit.xy, down.unit.xy), 1e-37)), 0.0);
        arealight_walk_close(walk, anchor, down, forward, rung);
    }
}

// The form factor of an ellipse clipped at two horizons, in [0, 1]: that of cosine space, and the surface's, above which a
// vector's height is known before it is transformed: `heights` are those of center, axis_u and axis_v. All else is as in
// arealight_ellipse_form_factor, error 2e-6; `horizon` is the sine of the elevation below which a corner counts as on the
// horizon of cosine space.
float arealight_ellipse_both_horizons(vec3 center, vec3 axis_u, vec3 axis_v, vec3 heights, bool two_sided,
                                      float horizon, int rung) {
    float rise = sqrt(heights.y * heights.y + heights.z * heights.z);
    if (heights.x >= rise && heights.x > 0.0) {
        return arealight_ellipse_form_factor(center, axis_u, axis_v, two_sided, rung);
    }
    if (!(heights.x > -rise)) {
        return 0.0;
    }
    bool front = dot(cross(axis_u, axis_v), center) < 0.0;
    if (!two_sided && !front) {
        return 0.0;
    }
    // The rim above the surface, about its highest point, and the edge between its ends
    rung = AREALIGHT_FORM_FACTOR_EXACT;
    vec2 top = heights.yz / rise;
    float cosine = clamp(-heights.x / rise, -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    ArealightRim rim = ArealightRim(center, top.x * axis_u + top.y * axis_v, top.x * axis_v - top.y * axis_u,
                                    vec2(cosine, sine));
    ArealightRimArc arc = arealight_rim_arc(rim, mat3(1.0), rung);
    ArealightAnchor anchor = arealight_anchor(vec3(0.0), 0.0, rung);
    ArealightWalk walk = arealight_walk_begin();
    ArealightVertex begin = arealight_cone_vertex(arc.cone, arc.begin, horizon);
    ArealightVertex end = arealight_cone_vertex(arc.cone, arc.end, horizon);
    walk.squares = arc.square;
    arealight_walk_rim(walk, anchor, arc, begin, end, 1.0, rung);
    bool grows = arc.way > 0.0;
    arealight_walk_edge(walk, anchor, arealight_select(grows, end, begin), arealight_select(grows, begin, end), rung);
    return arealight_form_factor(arealight_walk_end(walk, anchor, rung), true);
}

#endif
