#ifndef AREALIGHT_TUBE_SOLID_ANGLE_GLSL
#define AREALIGHT_TUBE_SOLID_ANGLE_GLSL

#include "arealight/form_factor/tube_outline.glsl"

// The solid angle of a tube: the contour integral of (1 - cos) about the direction of its nearest part, which
// is within a quarter turn of all of its outline. Edges have a closed form, rims eight points each.

// Cosine and sine of an angle in [-pi, pi]: error 1e-6. The built-in functions may have 5e-4.
vec2 arealight_cos_sin(float angle) {
    float x = 0.25 * angle;
    float square = x * x;
    float high = 0.0416666667 - square * (0.00138888889 - square * 2.48e-5);
    vec2 turn = vec2(1.0 - square * (0.5 - square * high),
                     x * (1.0 - square * (0.166666667 - square * (0.00833333333 - square * 1.98412698e-4))));
    turn = vec2(1.0 - 2.0 * turn.y * turn.y, 2.0 * turn.x * turn.y);
    return vec2(1.0 - 2.0 * turn.y * turn.y, 2.0 * turn.x * turn.y);
}

// e . (p x dp) / (1 + e . p) of a rim, along it.
float arealight_rim_solid_angle(ArealightRim rim, vec3 e) {
    // Gauss and Legendre's rule
    const vec4 PLACES = vec4(0.183434642, 0.525532410, 0.796666477, 0.960289856);
    const vec4 WEIGHTS = vec4(0.362683783, 0.313706646, 0.222381034, 0.101228536);
    float half_angle = arealight_arctangent(rim.half_width.y, rim.half_width.x);
    float sum = 0.0;
    for (int i = 0; i < 8; i++) {
        float t = half_angle * ((i & 1) == 0 ? PLACES[i >> 1] : -PLACES[i >> 1]);
        vec2 turn = arealight_cos_sin(t);
        vec3 place = rim.center + turn.x * rim.middle + turn.y * rim.side;
        vec3 along = turn.x * rim.side - turn.y * rim.middle;
        float square = max(dot(place, place), AREALIGHT_TINY);
        float distance = sqrt(square);
        sum += WEIGHTS[i >> 1] * dot(e, cross(place, along)) / max(square + distance * dot(e, place), 1e-37);
    }
    return half_angle * sum;
}

// The same of an edge: the solid angle of its triangle with e.
float arealight_edge_solid_angle(vec3 from, vec3 to, vec3 e) {
    vec3 a = from * inversesqrt(max(dot(from, from), AREALIGHT_TINY));
    vec3 b = to * inversesqrt(max(dot(to, to), AREALIGHT_TINY));
    return 2.0 * arealight_arctangent(dot(e, cross(a, b)), 1.0 + dot(e, a) + dot(e, b) + dot(a, b));
}

// The solid angle of what is seen of a tube, in [0, 2 pi]. Error: 1e-5 where the point is half a radius from
// the rims or more, some 1e-2 of the part that is near where it is nearer than a twentieth.
float arealight_tube_solid_angle(ArealightTube tube) {
    if (!tube.outside) {
        ArealightSilhouette disk = arealight_tube_disk(tube);
        return arealight_ellipse_solid_angle(disk.center, disk.axis_u, disk.axis_v);
    }
    float nearest = clamp(0.0, tube.start, arealight_tube_end(tube));
    vec3 e = arealight_normalize_or(arealight_on_axis(tube, nearest), vec3(0.0));
    ArealightRim start = arealight_tube_rim(tube, -1.0);
    ArealightRim end = arealight_tube_rim(tube, 1.0);
    vec3 start_middle = start.center + start.half_width.x * start.middle;
    vec3 start_side = start.half_width.y * start.side;
    vec3 end_middle = end.center + end.half_width.x * end.middle;
    vec3 end_side = end.half_width.y * end.side;
    float sum = arealight_rim_solid_angle(start, e) - arealight_rim_solid_angle(end, e)
        + arealight_edge_solid_angle(start_middle + start_side, end_middle + end_side, e)
        + arealight_edge_solid_angle(end_middle - end_side, start_middle - start_side, e);
    float covered = abs(sum) * AREALIGHT_INVERSE_TWO_PI;
    return 2.0 * AREALIGHT_PI * arealight_guarded_form_factor(covered, tube.distance + abs(tube.start));
}

#endif
