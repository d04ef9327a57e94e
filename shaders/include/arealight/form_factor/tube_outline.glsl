#ifndef AREALIGHT_TUBE_OUTLINE_GLSL
#define AREALIGHT_TUBE_OUTLINE_GLSL

#include "arealight/form_factor/rim.glsl"
#include "arealight/form_factor/sphere.glsl"

// A tube as it is seen: a cylinder without or with flat caps, or a capsule. Its outline is two arcs of
// circles and two edges between their ends.

// How a tube ends: as a literal or a specialisation constant, or as a value.
const int AREALIGHT_TUBE_OPEN = 0;  // the lateral surface alone shines
const int AREALIGHT_TUBE_FLAT = 1;  // flat caps shine too
const int AREALIGHT_TUBE_ROUND = 2; // half spheres: a capsule

// A tube as seen from the shading point, in any unit. All of its outline follows from this little, rim by
// rim, so that no lobe's work holds more than one rim. Its own space has x along its axis, y from that
// towards the point and z across both.
struct ArealightTube {
    vec3 axis;         // unit, from start to end
    vec3 towards;      // unit, from the axis to the point; any one across the axis for a point on it
    float distance;    // from the axis
    float start;       // where it begins along the axis, from the point's foot on it
    float half_length;
    float radius;
    int ends;
    bool outside;      // the point is outside the infinite cylinder. Else a disk is all that is seen
    bool seen;         // there is something to see
};

// From a tube's own space into that of its arguments.
mat3 arealight_tube_frame(ArealightTube tube) {
    return mat3(tube.axis, tube.towards, cross(tube.axis, tube.towards));
}

// Where it ends along the axis.
float arealight_tube_end(ArealightTube tube) {
    return tube.start + 2.0 * tube.half_length;
}

// A point of the axis, from the shading point, in the tube's own space.
vec3 arealight_on_axis(ArealightTube tube, float place) {
    return vec3(place, -tube.distance, 0.0);
}

// An end's rim, of a tube seen from outside, in its own space. `outwards` is -1 at the start, 1 at the end.
ArealightRim arealight_tube_rim(ArealightTube tube, float outwards) {
    float place = outwards < 0.0 ? tube.start : arealight_tube_end(tube);
    // Half the angle under which the circle of the tube sees its own contacts
    float contact = tube.radius / tube.distance;
    float sine = sqrt(max((tube.distance - tube.radius) * (tube.distance + tube.radius),
                          0.0)) / tube.distance;
    ArealightRim rim;
    // The outer part of a half sphere's circle, the far half of a rim where the cap behind it is seen
    rim.reflex = tube.ends != AREALIGHT_TUBE_OPEN && outwards * place < 0.0;
    if (tube.ends == AREALIGHT_TUBE_ROUND) {
        // The circle where the cone of tangents meets the sphere, and of that the outer part
        float square = place * place + tube.distance * tube.distance;
        float reciprocal = inversesqrt(max(square, AREALIGHT_TINY));
        float share = tube.radius * tube.radius * (reciprocal * reciprocal);
        float ring = tube.radius * sqrt(max(1.0 - share, 0.0));
        rim.center = arealight_on_axis(tube, place) * (1.0 - share);
        rim.middle = (outwards * ring * reciprocal) * vec3(tube.distance, place, 0.0);
        rim.side = vec3(0.0, 0.0, ring);
        vec2 half_width = vec2(outwards * contact * place * reciprocal, sine);
        rim.half_width = half_width * inversesqrt(dot(half_width, half_width) + AREALIGHT_TINY);
        return rim;
    }
    rim.center = arealight_on_axis(tube, place);
    rim.middle = vec3(0.0, rim.reflex ? -tube.radius : tube.radius, 0.0);
    rim.side = vec3(0.0, 0.0, tube.radius);
    rim.half_width = vec2(rim.reflex ? -contact : contact, sine);
    return rim;
}

// All that is seen of a tube from within the infinite cylinder, in its own space: an end's whole disk.
ArealightSilhouette arealight_tube_disk(ArealightTube tube) {
    vec3 center = arealight_on_axis(tube, tube.start > 0.0 ? tube.start : arealight_tube_end(tube));
    if (tube.ends == AREALIGHT_TUBE_ROUND) {
        return arealight_sphere_silhouette(center, tube.radius);
    }
    return ArealightSilhouette(center, vec3(0.0, tube.radius, 0.0), vec3(0.0, 0.0, tube.radius), false);
}

// What is seen of a tube. Its `center` is from the shading point, its axis from center - half_axis to center
// + half_axis, in a space that keeps lengths, in any unit; lengths from 1e-14 to 1e18.
ArealightTube arealight_tube(vec3 center, vec3 half_axis, float radius, int ends) {
    ArealightTube tube;
    // A line takes fourth powers of distances
    float largest = max(max(arealight_max_component(center), arealight_max_component(half_axis)), radius);
    float scale = arealight_power_of_two_scale(largest);
    center *= scale;
    half_axis *= scale;
    vec3 start = center - half_axis;
    vec3 end = center + half_axis;
    tube.radius = radius * scale;
    tube.ends = ends;
    tube.axis = arealight_normalize_or(half_axis, vec3(1.0, 0.0, 0.0));
    tube.start = dot(start, tube.axis);
    tube.half_length = dot(half_axis, tube.axis);
    // From the axis to the point, by the nearer end, or the center where that is nearer: its error is a part
    // of this distance
    vec3 nearer = dot(start, start) < dot(end, end) ? start : end;
    nearer = dot(center, center) < dot(nearer, nearer) ? center : nearer;
    vec3 foot = nearer - tube.axis * dot(nearer, tube.axis);
    foot -= tube.axis * dot(foot, tube.axis);
    float square = dot(foot, foot);
    float reciprocal = inversesqrt(max(square, AREALIGHT_TINY));
    tube.distance = square * reciprocal;
    vec3 beside, across;
    arealight_perpendiculars(tube.axis, beside, across);
    tube.towards = square > AREALIGHT_TINY ? -foot * reciprocal : beside;
    tube.outside = tube.distance > tube.radius;
    tube.seen = true;
    if (!tube.outside) {
        bool beyond = tube.start > 0.0 || arealight_tube_end(tube) < 0.0;
        tube.seen = ends != AREALIGHT_TUBE_OPEN && beyond && !arealight_tube_disk(tube).inside;
    }
    return tube;
}

#endif
