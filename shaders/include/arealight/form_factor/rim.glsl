#ifndef AREALIGHT_RIM_GLSL
#define AREALIGHT_RIM_GLSL

#include "arealight/form_factor/elliptic_arc.glsl"
#include "arealight/form_factor/outline.glsl"

// Arcs of ellipses as parts of an outline (outline.glsl): the ends of tubes, and disks that are cut by the
// surface's horizon. Where an arc ends and an edge begins, both have the same direction to the bit, so that
// an outline is closed whatever the rounding.

// A part of an ellipse's outline: center + cos(t) middle + sin(t) side for t from -half to half.
struct ArealightRim {
    vec3 center;
    vec3 middle;
    vec3 side;
    vec2 half_width; // cosine and sine
    bool reflex;     // more than half of the outline: the cosine is negative
};

// A rim in cosine space, as its cone's outline.
struct ArealightRimArc {
    ArealightCone cone;   // its frame from the ellipse's into cosine space, right-handed
    float way;            // 1 where the cone's parameter grows with the rim's, else -1
    // Cosine and sine of the ends in the cone's parameter, which grows from begin to end
    vec2 begin;
    vec2 end;
    bool reflex;          // more than half of the cone's outline
};

// The direction of a cone's outline, not unit.
vec3 arealight_cone_direction(ArealightCone cone, vec2 point) {
    return cone.frame * vec3(cone.a * point.x, cone.b * point.y, cone.c);
}

// Where a direction, given by its parts along the columns of a cone's frame, lies on its outline, which it is
// on but for rounding.
vec2 arealight_cone_parameter(ArealightCone cone, vec3 along) {
    vec2 point = vec2(along.x * cone.b, along.y * cone.a);
    point *= inversesqrt(max(dot(point, point), 1e-37));
    // Seen along its plane a rim is a line, on which its longer axis alone tells the place
    float cosine = clamp(along.x * cone.c / max(cone.a * along.z, 1e-37), -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    return cone.b > 1e-3 * cone.a ? point : vec2(cosine, along.y < 0.0 ? -sine : sine);
}

// a b, row by row: each row of the product takes the place of one of `a`, so that a GPU needs registers for
// two matrices, not for three.
mat3 arealight_product_by_rows(mat3 a, mat3 b) {
    vec3 x = vec3(a[0].x, a[1].x, a[2].x) * b;
    vec3 y = vec3(a[0].y, a[1].y, a[2].y) * b;
    vec3 z = vec3(a[0].z, a[1].z, a[2].z) * b;
    return mat3(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z);
}

// `finite` becomes false where a coordinate is infinite or NaN.
ArealightRimArc arealight_rim_arc(ArealightRim rim, mat3 transform, inout bool finite) {
    ArealightRimArc arc;
    vec3 middle = transform * rim.middle;
    vec3 side = transform * rim.side;
    ArealightEllipse ellipse = arealight_ellipse(transform * rim.center, middle, side);
    finite = finite && arealight_is_finite(ellipse.square);
    // The point is behind the front: seen from it the rim's parameter runs as the cone's does
    arc.way = ellipse.front ? -1.0 : 1.0;
    // The middle of the chord between the ends, and half of it, in the ellipse's frame: of its plane the
    // center's distance is known
    vec2 width = ellipse.scale * rim.half_width;
    vec2 chord = ellipse.center.xy + width.x
        * vec2(dot(middle, ellipse.longer), dot(middle, ellipse.shorter));
    vec2 half_chord = arc.way * width.y * vec2(dot(side, ellipse.longer), dot(side, ellipse.shorter));
    arc.cone = arealight_ellipse_cone(ellipse, arealight_confocal_root(ellipse));
    // And in the cone's
    vec3 along = vec3(chord, ellipse.center.z) * arc.cone.frame;
    vec3 half_along = half_chord * mat3x2(arc.cone.frame);
    arc.cone.frame = arealight_product_by_rows(arealight_ellipse_frame(ellipse), arc.cone.frame);
    arc.begin = arealight_cone_parameter(arc.cone, along - half_along);
    arc.end = arealight_cone_parameter(arc.cone, along + half_along);
    // Where the ends meet, the rim tells whether that is none of it or all
    vec2 between = arc.end - arc.begin;
    bool turned = arc.begin.x * arc.end.y - arc.begin.y * arc.end.x < 0.0;
    arc.reflex = dot(between, between) < 1e-6 ? rim.reflex : turned;
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

// The direction of a point of a cone's outline, unit: where an arc ends and an edge begins.
vec3 arealight_cone_unit(ArealightCone cone, vec2 point, float horizon) {
    vec3 direction = arealight_cone_direction(cone, point);
    vec3 unit = direction * inversesqrt(max(dot(direction, direction), 1e-37));
    unit.z = abs(unit.z) > horizon ? unit.z : 0.0;
    return unit;
}

// Where a cone's outline crosses the horizon, unit.
vec2 arealight_cone_crossing(ArealightCone cone, vec2 point) {
    vec2 direction = arealight_cone_unit(cone, point, 0.0).xy;
    return direction * inversesqrt(max(dot(direction, direction), 1e-37));
}

// Whether a point of a cone's outline is on the arc between two others, t growing; `reflex`: the arc is more
// than half of it.
bool arealight_arc_has(vec2 point, vec2 begin, vec2 end, bool reflex) {
    bool after_begin = begin.x * point.y - begin.y * point.x > 0.0;
    bool before_end = point.x * end.y - point.y * end.x > 0.0;
    return reflex ? after_begin || before_end : after_begin && before_end;
}

// Adds an arc to an outline, clipped at the horizon; `way` is 1 in the direction of the rim's own parameter,
// else -1. `first_above` and `last_above`: the ends in the order of the cone's parameter are above the
// horizon.
void arealight_outline_rim(inout ArealightOutline outline, ArealightRimArc arc, bool first_above,
                           bool last_above, float way) {
    ArealightCone cone = arc.cone;
    way *= arc.way;
    // Where the cone's whole outline crosses the horizon
    vec3 up = vec3(cone.a * cone.frame[0].z, cone.b * cone.frame[1].z, cone.c * cone.frame[2].z);
    float steepness = sqrt(dot(up.xy, up.xy));
    float reciprocal = 1.0 / max(steepness, 1e-37);
    vec2 top = up.xy * reciprocal;
    float cosine = clamp(-up.z * reciprocal, -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    bool crosses = abs(up.z) < steepness;
    // Which part of the arc is above
    bool neither = !first_above && !last_above;
    bool both = first_above && last_above;
    bool bump = neither && crosses && arealight_arc_has(top, arc.begin, arc.end, arc.reflex);
    bool dip = both && crosses && arealight_arc_has(-top, arc.begin, arc.end, arc.reflex);
    if (neither && !bump) {
        return;
    }
    // The crossings close the outline
    vec2 begin = arc.begin;
    vec2 end = arc.end;
    if (!first_above || dip) {
        vec2 rise = vec2(top.x * cosine + top.y * sine, top.y * cosine - top.x * sine);
        arealight_outline_crossing(outline, arealight_cone_crossing(cone, rise), !(way > 0.0));
        begin = first_above ? begin : rise;
    }
    if (!last_above || dip) {
        vec2 fall = vec2(top.x * cosine - top.y * sine, top.y * cosine + top.x * sine);
        arealight_outline_crossing(outline, arealight_cone_crossing(cone, fall), way > 0.0);
        end = last_above ? end : fall;
    }
    // What is left is more than half of the outline by its ends' turn. Where they meet it is none of it, or
    // all where nearly all of the outline is above and the arc is more than half of it
    vec2 chord = end - begin;
    bool turned = begin.x * end.y - begin.y * end.x < 0.0;
    bool all = arc.reflex && cosine < -0.999;
    bool reflex = both ? arc.reflex : bump ? cosine < 0.0 : dot(chord, chord) < 1e-6 ? all : turned;
    vec3 integral = arealight_elliptic_arc(cone, arealight_arc_between(begin, end, reflex));
    if (dip) {
        integral -= arealight_elliptic_arc(cone, ArealightArcSpan(-top, vec2(-cosine, sine)));
    }
    outline.arcs += way * (cone.frame * integral);
}

// The form factor of an ellipse clipped at two horizons, in [0, 1]: that of cosine space, and the surface's,
// above which a vector's height is known before it is transformed: `heights` are those of center, axis_u and
// axis_v. All else is as in arealight_ellipse_form_factor, error 2e-6; `horizon` is the sine of the elevation
// below which a corner counts as on the horizon of cosine space.
float arealight_ellipse_both_horizons(vec3 center, vec3 axis_u, vec3 axis_v, vec3 heights, bool two_sided,
                                      float horizon) {
    float rise = sqrt(heights.y * heights.y + heights.z * heights.z);
    if (heights.x >= rise && heights.x > 0.0) {
        return arealight_ellipse_form_factor(center, axis_u, axis_v, two_sided);
    }
    if (!(heights.x > -rise)) {
        return 0.0;
    }
    bool front = dot(cross(axis_u, axis_v), center) < 0.0;
    if (!two_sided && !front) {
        return 0.0;
    }
    // The rim above the surface, about its highest point, and the edge between its ends
    vec2 top = heights.yz / rise;
    float cosine = clamp(-heights.x / rise, -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    ArealightRim rim = ArealightRim(center, top.x * axis_u + top.y * axis_v, top.x * axis_v - top.y * axis_u,
                                    vec2(cosine, sine), cosine < 0.0);
    bool finite = true;
    ArealightRimArc arc = arealight_rim_arc(rim, mat3(1.0), finite);
    vec3 begin = arealight_cone_unit(arc.cone, arc.begin, horizon);
    vec3 end = arealight_cone_unit(arc.cone, arc.end, horizon);
    ArealightOutline outline = arealight_outline_begin(AREALIGHT_ANYWHERE);
    bool grows = arc.way > 0.0;
    arealight_outline_edge(outline, grows ? end : begin, grows ? begin : end);
    arealight_outline_rim(outline, arc, begin.z > 0.0, end.z > 0.0, 1.0);
    return arealight_guarded_form_factor(abs(arealight_outline_vector(outline).z), finite);
}

#endif
