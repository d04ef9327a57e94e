#ifndef AREALIGHT_TUBE_OUTLINE_GLSL
#define AREALIGHT_TUBE_OUTLINE_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/sphere.glsl"

// A tube as it is seen: a cylinder without or with flat caps, or a capsule. Its outline is two arcs of circles and two edges
// between their ends.

// How a tube ends: as a literal or a specialisation constant, or as a value.
const int AREALIGHT_TUBE_OPEN = 0;  // the lateral surface alone shines
const int AREALIGHT_TUBE_FLAT = 1;  // flat caps shine too
const int AREALIGHT_TUBE_ROUND = 2; // half spheres: a capsule

// A tube as seen from the shading point, in the space of its arguments, scaled by a power of two.
struct ArealightTube {
    vec3 center;
    vec3 start;
    vec3 end;
    vec3 half_axis;
    vec3 axis;      // unit, from start to end
    vec3 towards;   // unit, from the axis to the point
    float distance; // from the axis
    vec3 side;      // unit: normal of the plane of axis and point
    float radius;
    int ends;
    bool outside;   // the point is outside the infinite cylinder. Else the first rim is all that is seen: a disk
    bool seen;      // there is something to see
    bool before;    // the point is before the start, along the axis
    bool past;      // or past the end
    ArealightRim rims[2];
};

// An end's rim. `outwards` is -1 at the start, 1 at the end; `cosine` and `sine` of half the angle under which the
// circle of the tube sees its own contacts.
ArealightRim arealight_tube_rim(ArealightTube tube, vec3 center, float outwards, float cosine, float sine) {
    vec3 towards = tube.towards;
    ArealightRim rim;
    if (tube.ends == AREALIGHT_TUBE_ROUND) {
        // The circle where the cone of tangents meets the sphere, and of that the outer part
        float place = dot(center, tube.axis);
        float square = place * place + tube.distance * tube.distance;
        float reciprocal = inversesqrt(max(square, AREALIGHT_TINY));
        float share = tube.radius * tube.radius * (reciprocal * reciprocal);
        float ring = tube.radius * sqrt(max(1.0 - share, 0.0));
        rim.center = center * (1.0 - share);
        rim.middle = (outwards * ring * reciprocal) * (tube.distance * tube.axis + place * towards);
        rim.side = tube.side * ring;
        vec2 half_width = vec2(outwards * cosine * place * reciprocal, sine);
        rim.half_width = half_width * inversesqrt(dot(half_width, half_width) + AREALIGHT_TINY);
        return rim;
    }
    // The far half of the rim where the cap behind it is seen
    bool far = tube.ends == AREALIGHT_TUBE_FLAT && outwards * dot(center, tube.axis) < 0.0;
    rim.center = center;
    rim.middle = towards * (far ? -tube.radius : tube.radius);
    rim.side = tube.side * tube.radius;
    rim.half_width = vec2(far ? -cosine : cosine, sine);
    return rim;
}

// What is seen of a tube. Its `center` is from the shading point, its axis from center - half_axis to center + half_axis, in
// a space that keeps lengths. A tube keeps its shape however far it is.
ArealightTube arealight_tube(vec3 center, vec3 half_axis, float radius, int ends) {
    ArealightTube tube;
    float largest = max(max(arealight_max_component(center), arealight_max_component(half_axis)), radius);
    float scale = arealight_power_of_two_scale(largest);
    tube.center = center * scale;
    tube.half_axis = half_axis * scale;
    tube.start = tube.center - tube.half_axis;
    tube.end = tube.center + tube.half_axis;
    tube.radius = radius * scale;
    tube.ends = ends;
    tube.axis = arealight_normalize_or(tube.half_axis, vec3(1.0, 0.0, 0.0));
    // From the axis to the point, by the nearer end
    vec3 near = dot(tube.start, tube.start) < dot(tube.end, tube.end) ? tube.start : tube.end;
    vec3 foot = near - tube.axis * dot(near, tube.axis);
    foot -= tube.axis * dot(foot, tube.axis);
    float square = dot(foot, foot);
    float reciprocal = inversesqrt(max(square, AREALIGHT_TINY));
    tube.distance = square * reciprocal;
    tube.towards = -foot * reciprocal;
    tube.side = cross(tube.axis, tube.towards);
    tube.before = dot(tube.start, tube.axis) > 0.0;
    tube.past = dot(tube.end, tube.axis) < 0.0;
    tube.outside = tube.distance > tube.radius;
    tube.seen = tube.outside || (ends != AREALIGHT_TUBE_OPEN && (tube.before || tube.past));
    float cosine = tube.radius * reciprocal;
    float sine = sqrt(max((tube.distance - tube.radius) * (tube.distance + tube.radius), 0.0)) * reciprocal;
    tube.rims[0] = arealight_tube_rim(tube, tube.start, -1.0, cosine, sine);
    tube.rims[1] = arealight_tube_rim(tube, tube.end, 1.0, cosine, sine);
    if (!tube.outside) {
        // One end is all that is seen: its whole disk
        vec3 center = tube.before ? tube.start : tube.end;
        if (ends == AREALIGHT_TUBE_ROUND) {
            ArealightSilhouette disk = arealight_sphere_silhouette(center, tube.radius);
            tube.seen = tube.seen && !disk.inside;
            tube.rims[0] = ArealightRim(disk.center, disk.axis_u, disk.axis_v, vec2(-1.0, 0.0));
        } else {
            vec3 axis_u, axis_v;
            arealight_perpendiculars(tube.axis, axis_u, axis_v);
            tube.rims[0] = ArealightRim(center, axis_u * tube.radius, axis_v * tube.radius, vec2(-1.0, 0.0));
        }
    }
    return tube;
}

#endif
