#ifndef AREALIGHT_TUBE_SMALL_GLSL
#define AREALIGHT_TUBE_SMALL_GLSL

#include "arealight/form_factor/difference.glsl"
#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/tube_outline.glsl"

// The form factor of a tube whose ends are small before their distance, with relative precision: the
// difference form of a tube.
//
// Its outline is a polygon, of the ends of the two arcs, and the segments of ellipses between the arcs and
// their chords. The polygon is integrated in the difference form (difference.glsl). A segment is flat: what
// it sends is (n.p) z / |p|^4 integrated over it, n.p being the same for all its points, and z / |p|^4 an
// expansion about its centroid. Nothing cancels in either, and what is cut at the horizon is cut as it always
// is.
//
// A line takes the polygon's place where the tube is so thin that the polygon would lose digits.

// An end is small where the sum of the squares of its half axes is less than this part of its squared
// distance: where its radius is a 45th of that, or less.
const float AREALIGHT_TUBE_SMALL = 1.0 / 1024.0;

// A tube with small ends is a line between them where its width in cosine space is less than
// AREALIGHT_TUBE_THIN of the axis's distance and less than AREALIGHT_TUBE_SLIM of its length; and where the
// horizon cuts an end, if what a line is cut otherwise is less than AREALIGHT_TUBE_CUT of what the whole tube
// sends from the zenith.
const float AREALIGHT_TUBE_THIN = 3e-3;
const float AREALIGHT_TUBE_SLIM = 1.0 / 64.0;
const float AREALIGHT_TUBE_CUT = 2e-6;

// The contour integral p x dp / |p|^2 around a segment of a small ellipse, its z: -2 pi times its form factor
// if its front is seen. The segment lies between an arc of center + cos(t) middle + sin(t) side and its
// chord; what is below the horizon counts as negative. Error: 8 (size / distance)^4 + .2 (size / distance)^3
// of the whole ellipse's at the zenith, and rounding of it.
float arealight_small_segment(vec3 center, vec3 middle, vec3 side, ArealightArcSpan arc) {
    float cosine = arc.half_width.x;
    float sine = arc.half_width.y;
    vec3 along = arc.middle.x * middle + arc.middle.y * side;
    vec3 across = arc.middle.x * side - arc.middle.y * middle;
    // The segment of the unit disk: its area, where its centroid is, and its second moments about that
    float angle = arealight_arctangent(sine, cosine);
    float area = max(angle - sine * cosine, 0.0);
    float mean = clamp(0.66666667 * sine * sine * sine / max(area, 1e-37), cosine, 1.0);
    float moment = 0.25 * (angle - sine * cosine * (2.0 * cosine * cosine - 1.0)) - mean * mean * area;
    float moment_across = 0.25 * (angle - sine * cosine * (1.0 + 0.66666667 * sine * sine));
    // z / |p|^4 over it, to the second order
    vec3 balance = center + mean * along;
    float reciprocal = 1.0 / (dot(balance, balance) + AREALIGHT_TINY);
    float slope = dot(balance, along) * reciprocal;
    float slope_across = dot(balance, across) * reciprocal;
    float bend = moment * (12.0 * slope * slope - 2.0 * dot(along, along) * reciprocal)
               + moment_across * (12.0 * slope_across * slope_across - 2.0 * dot(across, across)
                                  * reciprocal);
    float tilt = 4.0 * (along.z * moment * slope + across.z * moment_across * slope_across);
    float weighted = balance.z * (area + bend) - tilt;
    return 2.0 * dot(cross(along, across), center) * reciprocal * (weighted * reciprocal);
}

// An end of a tube in cosine space: the vertices that it adds to the polygon, and its segments.
struct ArealightSmallEnd {
    ArealightVertex begin;
    ArealightVertex crossing; // where the arc crosses the horizon between its ends; else its end
    ArealightVertex end;
    float slant;              // half the difference of the heights of begin and end
    float segments;           // their contour integrals' z, in the direction of the rim's parameter
    bool cut;                 // the arc crosses the horizon
    bool small;
};

// The end whose rim has its center at `offset` from the anchor; `axes` are its middle and side.
ArealightSmallEnd arealight_small_end(ArealightAnchor anchor, vec3 offset, vec3 middle, vec3 side,
                                      vec2 half_width) {
    ArealightSmallEnd end;
    vec3 center = anchor.position + offset;
    end.small = dot(middle, middle) + dot(side, side) < AREALIGHT_TUBE_SMALL * dot(center, center);
    vec3 chord = offset + half_width.x * middle;
    end.begin = arealight_vertex(anchor, chord - half_width.y * side);
    end.end = arealight_vertex(anchor, chord + half_width.y * side);
    end.slant = abs(half_width.y * side.z);
    // Where the whole rim crosses the horizon
    vec2 slope = vec2(middle.z, side.z);
    float steepness = sqrt(dot(slope, slope));
    vec2 top = slope / max(steepness, 1e-37);
    float cosine = clamp(-center.z / max(steepness, 1e-37), -1.0, 1.0);
    float sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    bool crosses = abs(center.z) < steepness;
    // Which part of the arc is above
    bool begins = end.begin.unit.z > 0.0;
    bool ends = end.end.unit.z > 0.0;
    bool bump = !begins && !ends && crosses && top.x > half_width.x;
    bool dip = begins && ends && crosses && -top.x > half_width.x;
    end.cut = begins != ends || bump || dip;
    // The crossing between the ends: up, or down
    float turn = begins ? sine : -sine;
    vec2 point = vec2(top.x * cosine - top.y * turn, top.y * cosine + top.x * turn);
    vec2 place = anchor.distant ? offset.xy : center.xy;
    place += point.x * middle.xy + point.y * side.xy;
    end.crossing = end.end;
    if (begins != ends) {
        end.crossing = arealight_horizon_vertex(anchor, place);
    }
    // The arc from there to the end that is above. It is more than half of the rim only if it has the rim's
    // middle
    vec2 from = begins ? vec2(half_width.x, -half_width.y) : point;
    vec2 to = begins ? point : half_width;
    bool turned = from.x * to.y - from.y * to.x < 0.0 || dot(to - from, to - from) < 1e-6;
    bool reflex = half_width.x < 0.0 && center.z + middle.z > 0.0 && turned;
    ArealightArcSpan arc = ArealightArcSpan(vec2(1.0, 0.0), half_width);
    if (begins != ends) {
        arc = arealight_arc_between(from, to, reflex);
    } else if (bump) {
        arc = ArealightArcSpan(top, vec2(cosine, sine));
    }
    end.segments = 0.0;
    if (begins || ends || bump) {
        end.segments = arealight_small_segment(center, middle, side, arc);
    }
    if (dip) {
        // Both ends being above, what is below is a segment of its own
        arc = ArealightArcSpan(-top, vec2(-cosine, sine));
        end.segments -= arealight_small_segment(center, middle, side, arc);
    }
    return end;
}

// The form factor of a thin tube's lateral surface, clipped at the horizon, with relative precision: a line
// of the tube's width as it is seen. It goes from `start` to `start` + `along`; `width` is half of the tube's
// in cosine space, `slant` half the difference of heights across it, which counts where the horizon cuts it
// between its ends. Relative error: (width / distance)^2 and 4e-6.
float arealight_line_form_factor(vec3 start, vec3 along, float width, float slant) {
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
    float turn = arealight_arctangent(distance * extent, square + begin * finish);
    float across = 0.5 * foot.z * (extent * (square - begin * finish) * both * reciprocal + turn / square);
    float slope = 0.5 * axis.z * distance * extent * (begin + finish) * both;
    // Cut at a slant, the height over the horizon has a larger integral than cut across, by slant^2 / (6
    // slope)
    float cut = start.z < 0.0 ? begin : finish;
    float cut_square = square + cut * cut;
    float slanted = part < 1.0 ? slant * slant
        * distance / (6.0 * max(abs(axis.z), 1e-37) * cut_square * cut_square) : 0.0;
    return 2.0 * width * AREALIGHT_INVERSE_PI * (across + slope + slanted);
}

// The form factor of a tube seen from outside. If an end is not small, `is_small` becomes false and the
// result means nothing. Clipped at the horizon; arguments as arealight_tube_form_factor's.
float arealight_small_tube(ArealightTube tube, mat3 transform, float horizon, out bool is_small) {
    // The anchor is the tube's center
    vec3 half_axis = transform * (tube.half_length * tube.axis);
    float extent = sqrt(dot(half_axis, half_axis));
    ArealightAnchor anchor = arealight_anchor(transform
                                              * arealight_on_axis(tube, 0.5 * (tube.start + tube.end)),
        extent, horizon, 0.0);
    // Both ends. A half sphere has its outline on a disk about its center
    ArealightSmallEnd ends[2];
    for (int i = 0; i < 2; i++) {
        ArealightRim rim = arealight_tube_rim(tube, i == 0 ? -1.0 : 1.0);
        float place = i == 0 ? tube.start : tube.end;
        float square = place * place + tube.distance * tube.distance;
        float grow = square / max(square - tube.radius * tube.radius, 1e-37);
        mat3 into = transform * (tube.ends == AREALIGHT_TUBE_ROUND ? grow : 1.0);
        ends[i] = arealight_small_end(anchor, i == 0 ? -half_axis : half_axis, into * rim.middle, into
                                      * rim.side,
                                      rim.half_width);
    }
    is_small = ends[0].small && ends[1].small;
    float segments = ends[0].segments - ends[1].segments;
    // The width across the plane of axis and point, and the axis's distance
    vec3 axis = transform * tube.axis;
    vec3 plane = cross(axis, transform * tube.towards);
    float area = sqrt(max(dot(plane, plane), 1e-37));
    float volume = determinant(transform);
    float width = tube.radius * abs(volume) / area;
    float distance = tube.distance * area * inversesqrt(max(dot(axis, axis), 1e-37));
    bool thin = width < AREALIGHT_TUBE_THIN * distance && tube.radius < AREALIGHT_TUBE_THIN * tube.distance;
    // Where the horizon cuts an end at a slant, a line is cut across
    bool cut = ends[0].cut || ends[1].cut;
    float slant = max(ends[0].slant, ends[1].slant);
    float away = anchor.distant ? anchor.distance : distance;
    bool straight = !cut || slant * slant <= 2.0 * AREALIGHT_TUBE_CUT * away
        * max(2.0 * abs(half_axis.z), slant);
    bool slim = width < 2.0 * AREALIGHT_TUBE_SLIM * extent;
    if (thin && slim && straight) {
        float line = arealight_line_form_factor(transform * arealight_on_axis(tube, tube.start), 2.0
                                                * half_axis, width,
                                                cut ? 0.0 : slant);
        float sides = segments * AREALIGHT_INVERSE_TWO_PI;
        float squares = tube.start * tube.start + tube.end * tube.end + tube.distance * tube.distance;
        return arealight_guarded_form_factor(volume < 0.0 ? line + sides : line - sides, squares);
    }
    // From the start's rim along one edge to the end's, and back
    ArealightDifferenceOutline outline = arealight_difference_begin();
    arealight_difference_to(outline, anchor, ends[0].begin);
    arealight_difference_to(outline, anchor, ends[0].crossing);
    arealight_difference_to(outline, anchor, ends[0].end);
    arealight_difference_to(outline, anchor, ends[1].end);
    arealight_difference_to(outline, anchor, ends[1].crossing);
    arealight_difference_to(outline, anchor, ends[1].begin);
    outline.arcs.z += segments;
    vec3 vector = arealight_difference_vector(outline, anchor);
    return arealight_guarded_form_factor(abs(vector.z), outline.squares);
}

#endif
