#ifndef AREALIGHT_RAY_ORIGIN_GLSL
#define AREALIGHT_RAY_ORIGIN_GLSL

// Where a shadow ray starts, so that it does not meet the surface that it leaves: away along the surface's
// geometric normal by more than the position's rounding, in scenes of any size. After Waechter and Binder, A
// Fast and Robust Method for Avoiding Self-Intersection, Ray Tracing Gems 2019, chapter 6, who move
// coordinates near zero by a length of a scene in metres.

// Of the largest coordinate: 128 to 256 units in its last place.
const float AREALIGHT_ORIGIN_PART = 1.52587890625e-5;

// Where a shadow ray ends, as a part of the way to the light: 1 - 2^-12, before the light's own geometry,
// which may be there.
const float AREALIGHT_RAY_PART = 0.999755859375;

// How much wider than a sphere or a tube its own geometry may be: what is drawn of facets is not round.
const float AREALIGHT_ROUND_MARGIN = 1.125;

// The origin of a ray that leaves the surface at `position` on the side of `normal`, the unit normal of its
// geometry (not of its shading). `step`: by how much the position may be wrong along any axis beyond its own
// rounding, in its unit: by the rounding of the vertices that it is between, and for depth that is not
// reversed float the distance between the positions of two neighbouring values, along the view.
//
// It is away from the position by 2^-16 of its largest coordinate and 2 steps.
vec3 arealight_ray_origin(vec3 position, vec3 normal, float step) {
    vec3 size = abs(position);
    float largest = max(max(size.x, size.y), size.z);
    return position + (AREALIGHT_ORIGIN_PART * largest + 2.0 * step) * normal;
}

#endif
