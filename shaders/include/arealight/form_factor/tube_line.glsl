#ifndef AREALIGHT_TUBE_LINE_GLSL
#define AREALIGHT_TUBE_LINE_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/tube_outline.glsl"

// The form factor of a tube that looks thin, with relative precision: the two arcs of its outline would
// cancel.
//
// It is a line of the tube's width as it is seen, and at each end the segment of an ellipse between the rim's
// arc and its chord. All of their middles lie in the plane of axis and point, which is worked in: nothing
// cancels.

// A tube is a line where its radius, and its ends in cosine space, are less than this part of its distance.
const float AREALIGHT_TUBE_THIN = 1e-2;

// The plane of a tube's axis and the point, in cosine space, with coordinates along the axis and across it.
struct ArealightTubePlane {
    float stretch; // the length there of a unit along the axis
    float lean;    // of a unit towards the point: along the axis, and across it
    float spread;
    vec3 heights;  // of units along the axis, towards the point and across the plane
    float volume;
};

ArealightTubePlane arealight_tube_plane(mat3 space) {
    ArealightTubePlane plane;
    vec3 normal = cross(space[0], space[1]);
    plane.stretch = sqrt(max(dot(space[0], space[0]), 1e-37));
    plane.lean = dot(space[0], space[1]) / plane.stretch;
    plane.spread = sqrt(max(dot(normal, normal), 1e-37)) / plane.stretch;
    plane.heights = vec3(space[0].z, space[1].z, space[2].z);
    plane.volume = abs(dot(normal, space[2]));
    return plane;
}

// A point of the plane, given in the tube's own space.
vec2 arealight_in_plane(ArealightTubePlane plane, vec2 place) {
    return vec2(place.x * plane.stretch + place.y * plane.lean, place.y * plane.spread);
}

// What the segment at the end of a thin tube sends, above the horizon: the integral of z / |p|^4 over it, as
// a part of the volume. Error: (size / distance)^2 of the whole ellipse's at the zenith.
float arealight_end_segment(ArealightRim rim, ArealightTubePlane plane) {
    float cosine = rim.half_width.x;
    float sine = rim.half_width.y;
    // The segment of the unit disk: its area, where its centroid is, and its second moments about that
    float angle = arealight_arctangent(sine, cosine);
    float area = max(angle - sine * cosine, 0.0);
    float mean = clamp(0.66666667 * sine * sine * sine / max(area, 1e-37), cosine, 1.0);
    float moment = 0.25 * (angle - sine * cosine * (2.0 * cosine * cosine - 1.0)) - mean * mean * area;
    float moment_across = 0.25 * (angle - sine * cosine * (1.0 + 0.66666667 * sine * sine));
    // Its heights are taken to be even between two that have the same mean and variance
    vec2 place = rim.center.xy + mean * rim.middle.xy;
    float middle = dot(place, plane.heights.xy);
    float rise = dot(rim.middle.xy, plane.heights.xy);
    float rise_across = rim.side.z * plane.heights.z;
    float square = 3.0 * (moment * rise * rise + moment_across * rise_across * rise_across);
    float spread = sqrt(max(square, 0.0) / max(area, 1e-37));
    float above = max(middle + spread, 0.0);
    float height = middle < spread ? 0.25 * above * above / max(spread, 1e-37) : middle;
    vec2 balance = arealight_in_plane(plane, place);
    float reciprocal = 1.0 / (dot(balance, balance) + AREALIGHT_TINY);
    float facing = rim.side.z * (rim.center.x * rim.middle.y - rim.center.y * rim.middle.x);
    return facing * reciprocal * (area * height * reciprocal);
}

// How much larger the mean height above the horizon is of a strip than of the line in its middle, whose ends
// have the heights a and b; `slant` is half the difference of heights across it, from 0 on.
float arealight_slanted_height(float a, float b, float slant) {
    vec2 inside = max(slant - abs(vec2(a, b)), vec2(0.0));
    float middle = max(slant - 0.5 * abs(a + b), 0.0);
    vec2 cubes = sign(vec2(a, b)) * (slant * slant * slant - inside * inside * inside);
    float mean = 8.0 * abs(b - a) < slant ? middle * middle : (cubes.y - cubes.x) / (3.0 * (b - a));
    return 0.25 * mean / max(slant, 1e-37);
}

// What a line sends, above the horizon: pi / 2 of its form factor for each unit of half its width. It is
// `distance` from the point in the tube's own space; in the plane it begins at `start`, as high as `height`,
// and is `size` long. `slant` is half the difference of heights across it. Relative error: (width /
// distance)^2 and 4e-6.
float arealight_line(ArealightTubePlane plane, float start, float distance, float height, float size,
                     float slant) {
    float slope = plane.heights.x / plane.stretch;
    float end_height = height + size * slope;
    // What is above the horizon
    float share = slope == 0.0 ? 0.5 : clamp(-height / (size * slope), 0.0, 1.0);
    float first = height < 0.0 ? share : 0.0;
    float part = max(height, end_height) > 0.0 ? (end_height < 0.0 ? share : 1.0) - first : 0.0;
    // From its foot
    float begin = start + size * first;
    float extent = size * part;
    float finish = begin + extent;
    float foot_height = distance * (slope * plane.lean - plane.heights.y);
    float away = distance * plane.spread;
    float square = max(away * away, AREALIGHT_TINY);
    // Differences of the antiderivative, as products
    float both = 1.0 / ((square + begin * begin) * (square + finish * finish));
    float turn = arealight_arctangent(away * extent, square + begin * finish);
    float across = 0.5 * foot_height * (extent * (square - begin * finish) * both / away + turn / square);
    float along = 0.5 * slope * away * extent * (begin + finish) * both;
    // Cut at a slant, the height over the horizon has a larger integral than cut across
    float cut = start + share * size;
    float cut_square = square + cut * cut;
    float slanted = arealight_slanted_height(height, end_height, slant) * size * away
        / (cut_square * cut_square);
    return across + along + slanted;
}

// The form factor of a tube seen from outside, clipped at the horizon, if a line stands for it; else
// `is_line` becomes false and the result means nothing. `space` takes the tube's own space into cosine space.
//
// Error: 5e-4 of what the whole tube sends from the zenith.
float arealight_tube_line(ArealightTube tube, mat3 space, out bool is_line) {
    ArealightTubePlane plane = arealight_tube_plane(space);
    vec2 middle = vec2(tube.start + tube.half_length, -tube.distance);
    vec2 center = arealight_in_plane(plane, middle);
    float half_size = tube.half_length * plane.stretch;
    float width = tube.radius * plane.volume / (plane.stretch * plane.spread);
    float nearest = max(tube.distance, sqrt(dot(middle, middle)) - tube.half_length);
    float nearest_in_plane = max(-center.y, sqrt(dot(center, center)) - half_size);
    float reach = tube.radius * length(vec3(plane.stretch, plane.lean, plane.spread));
    is_line = max(width, reach) < AREALIGHT_TUBE_THIN * nearest_in_plane
           && tube.radius < AREALIGHT_TUBE_THIN * nearest;
    if (!is_line) {
        return 0.0;
    }
    // The line is midway between the edges of what is seen, which run beside the axis
    float contact = tube.radius / tube.distance;
    float sine = sqrt((1.0 - contact) * (1.0 + contact));
    middle.y *= sine * sine;
    center = arealight_in_plane(plane, middle);
    float height = dot(middle, plane.heights.xy) - tube.half_length * plane.heights.x;
    float sum = 2.0 * sine * width
        * arealight_line(plane, center.x - half_size, -middle.y, height, 2.0 * half_size,
                         tube.radius * sine * abs(plane.heights.z));
    // A half sphere has its outline on a disk about its center
    for (int i = 0; i < 2; i++) {
        float outwards = i == 0 ? -1.0 : 1.0;
        ArealightRim rim = arealight_tube_rim(tube, outwards);
        if (tube.ends == AREALIGHT_TUBE_ROUND) {
            rim.center = arealight_on_axis(tube, i == 0 ? tube.start : arealight_tube_end(tube));
            float square = dot(rim.center, rim.center);
            float grow = square / max(square - tube.radius * tube.radius, 1e-37);
            rim.middle *= grow;
            rim.side *= grow;
        }
        sum += outwards * plane.volume * arealight_end_segment(rim, plane);
    }
    return arealight_guarded_form_factor(AREALIGHT_INVERSE_PI * sum, dot(center, center));
}

#endif
