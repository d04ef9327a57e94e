#ifndef AREALIGHT_REACH_GLSL
#define AREALIGHT_REACH_GLSL

#include "arealight/common.glsl"

// How far a light is of any matter: what forward and clustered hosts sort lights by, on the GPU. The same
// bounds as arealight::reach in Rust, a millionth wider for float32: no point outside of them reflects more
// than a threshold. Included by itself; it needs nothing of options.glsl.
//
//     // Of Lambert's lobe, and LightTable::lobe_density of the least roughness
//     float density = AREALIGHT_INVERSE_PI + lobe_density;
//     ArealightExtent extent = arealight_disk_extent(axis_u, axis_v);
//     float reach = arealight_reach(radiance, extent, threshold, density);

// The reach of what nothing bounds: a light with an image, or a threshold of zero.
const float AREALIGHT_UNBOUNDED = 3e38;

// What a reach is made of.
struct ArealightExtent {
    float size; // the radius of a sphere about the light's middle that holds it
    float area; // a solid angle of the light is at most that over the square of the distance to the sphere
};

// A flat polygon of this area, or faces of it together, whose vertices are at most `size` from the middle.
ArealightExtent arealight_polygon_extent(float size, float area) {
    return ArealightExtent(size, area);
}

// A disk or ellipse, by its half axes.
ArealightExtent arealight_disk_extent(vec3 axis_u, vec3 axis_v) {
    vec3 area = cross(axis_u, axis_v);
    return ArealightExtent(sqrt(dot(axis_u, axis_u) + dot(axis_v, axis_v)), AREALIGHT_PI
                           * sqrt(dot(area, area)));
}

ArealightExtent arealight_sphere_extent(float radius) {
    return ArealightExtent(radius, AREALIGHT_PI * (radius * radius));
}

// A tube with ends of any kind, by the vector from its middle to one of them.
ArealightExtent arealight_tube_extent(vec3 half_axis, float radius) {
    float size = sqrt(dot(half_axis, half_axis)) + radius;
    return ArealightExtent(size, 2.0 * AREALIGHT_PI * radius * size);
}

// How far from its middle a light of this radiance, in W/(m^2 sr), may reflect more than `threshold`, in
// W/(m^2 sr), in any channel, from surfaces whose lobes, times their albedos, are nowhere denser than
// `density` a steradian.
float arealight_reach(vec3 radiance, ArealightExtent extent, float threshold, float density) {
    float brightest = max(radiance.r, max(radiance.g, radiance.b));
    if (brightest <= 0.0) {
        return 0.0;
    }
    float reach = (extent.size + sqrt(brightest * density * extent.area / threshold)) * (1.0 + 1e-6);
    return reach < AREALIGHT_UNBOUNDED ? reach : AREALIGHT_UNBOUNDED;
}

// The box about a light of this reach, `size` and middle: of a flat light that shines to one side, towards
// the unit `front`, of the half before it. Else `front` is zero.
void arealight_reach_box(vec3 center, float reach, float size, vec3 front, out vec3 low, out vec3 high) {
    // In the plane of the light, which is flat to 1e-4 of its size
    vec3 beside = reach * sqrt(max(1.0 - front * front, vec3(0.0))) + 1e-4 * size + 1e-6 * reach;
    low = center - mix(beside, vec3(reach), lessThanEqual(front, vec3(0.0)));
    high = center + mix(beside, vec3(reach), greaterThanEqual(front, vec3(0.0)));
}

#endif
