#ifndef AREALIGHT_FORM_FACTOR_GLSL
#define AREALIGHT_FORM_FACTOR_GLSL

#include "arealight/arc.glsl"
#include "arealight/quad.glsl"
#include "arealight/surface_horizon.glsl"
#include "arealight/walk.glsl"

// The form factor of a polygon: the integral of the clamped cosine max(0, z) / pi over the directions that it covers, in
// [0, 1]. Vertices are offsets from an anchor, which is itself an offset from the shading point, in a space whose z
// axis is the normal (Lambert) or in cosine space (a fitted lobe), in any unit whose squares stay within float32.
//
// Two ways in: quad.glsl for convex outlines of up to four vertices, walk.glsl for any other. What they promise, and the
// tests hold them to (docs/stability.md), whatever the rung:
//
//   1. Any bits in, a finite number in [0, 1] out; 0 where a coordinate is NaN or infinite.
//   2. The result is within 6e-7 of the interval of values that the polygons have whose vertices differ by at most
//      4 x 2^-24 of their distance.
//   3. Its error is at most 1e-6 + 1e-7 / rho, rho being the distance to the polygon over that to its farthest vertex.
//   4. With the difference form, for a light within a fifth of its distance d of its anchor, the error is at most
//      1e-6 A / (pi d^2), out to any distance; A is its area, or for a sliver .24 of its extent times its perimeter.
//
// They are tested for up to 64 vertices; the rounding of a longer sum grows with its length (1024: 1.4e-6). They assume
// square roots and divisions that round to the last place or nearly: on a device that takes all that Vulkan allows, 2 to
// 4.5 units, count on as many times the error. `arealight bench stability` tells.
//
// The fast rungs add 2.7e-5 of each edge's angle over 2 pi; with the difference form 7e-5 of that times the angle's square.

// Whether the bare rung is enough for a light within `extent` of `center` (an offset from the shading point, in the
// space of the form factor): it is wholly above the horizon, and no edge can subtend more than a right angle.
// Conservative: true only where that is so.
bool arealight_is_bare(vec3 center, float extent) {
    // A little more than that, for the rounding of both
    float rounded = 1.000002 * extent;
    return center.z > rounded && dot(center, center) > 2.0 * rounded * rounded;
}

// Whether the one-point form of a light within `extent` of `center` is within 1e-4 of the exact form factor, relative, for
// a convex outline (2e-4 for a concave one), and 2e-7 A / (pi d^2) as a light is seen along its plane. The form's error
// is of second order in e = extent: at most 10/3 (e / d)^2 in the distance d, and .7 e^2 / (d z) where the height z
// varies with it.
bool arealight_is_far(vec3 center, float extent) {
    return center.z > 45.0 * extent && dot(center, center) > 8e4 * extent * extent;
}

// The arcs around a far light, from its centre alone. `facing` is the negative product of the light's area
// vector (normal of the front times area) and its centre, times the determinant of the transform into this space.
// Error: see arealight_is_far.
ArealightArcs arealight_one_point(vec3 center, float facing) {
    float square = dot(center, center) + AREALIGHT_TINY;
    // The form factor is facing z / (pi d^4), and the light comes from the centre
    return ArealightArcs(-2.0 * (facing / square) * (center / square), square);
}

#endif
