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
// tests hold them to (docs/stability.md):
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
#endif
