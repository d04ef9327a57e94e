#ifndef AREALIGHT_TUBE_GLSL
#define AREALIGHT_TUBE_GLSL

#include "arealight/elliptic_arc.glsl"
#include "arealight/tube_outline.glsl"
#include "arealight/walk.glsl"

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

// A rim in cosine space, as its cone's outline.
struct ArealightTubeArc {
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

ArealightTubeArc arealight_tube_arc(ArealightTubeRim rim, mat3 transform, int rung) {
    ArealightTubeArc arc;
    vec3 center = transform * rim.center;
    vec3 middle = transform * rim.middle;
    vec3 side = transform * rim.side;
    ArealightEllipse ellipse = arealight_ellipse(center, middle, side);
    arc.square = ellipse.square;
    arc.cone = arealight_ellipse_cone(ellipse, arealight_confocal_root(ellipse, rung));
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
void arealight_walk_rim(inout ArealightWalk walk, ArealightAnchor anchor, ArealightTubeArc arc, ArealightVertex first,
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
    walk.sum += (forward ? 1.0 : -1.0) * dot(arc.up, integral);
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
        ArealightTubeRim rim = tube.rims[i];
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
        ArealightTubeRim rim = tube.rims[0];
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
        ArealightTubeArc arc = arealight_tube_arc(tube.rims[i], transform, rung);
        ArealightVertex begin = arealight_cone_vertex(arc.cone, arc.begin, horizon);
        ArealightVertex end = arealight_cone_vertex(arc.cone, arc.end, horizon);
        arealight_walk_rim(walk, anchor, arc, begin, end, i == 0 ? 1.0 : -1.0, rung);
        walk.squares += arc.square;
        ends[2 * i] = arealight_select(arc.way > 0.0, begin, end);
        ends[2 * i + 1] = arealight_select(arc.way > 0.0, end, begin);
    }
    arealight_walk_edge(walk, anchor, ends[1], ends[3], rung);
    arealight_walk_edge(walk, anchor, ends[2], ends[0], rung);
    return arealight_walk_form_factor(walk, anchor, true, rung);
}

#endif
