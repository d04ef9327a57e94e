#ifndef LIGHT_SAMPLING_GLSL
#define LIGHT_SAMPLING_GLSL

// Points of polygons and meshes, drawn by area: for the Monte Carlo references. The including kernel has
// polygon_lights.glsl; what is drawn with is at bindings 2 and 3.

#include "random.glsl"

struct ArealightGpuLightSampling {
    vec3 normal;
    float area;
    uint first_triangle;
    uint triangle_count;
    uint reserved0;
    uint reserved1;
};

struct ArealightGpuLightTriangle {
    uint vertex0;
    uint vertex1;
    uint vertex2;
    float cumulative;
};

layout(set = 0, binding = 2, std430) readonly buffer LightSampling {
    ArealightGpuLightSampling light_sampling[];
};
layout(set = 0, binding = 3, std430) readonly buffer LightTriangles {
    ArealightGpuLightTriangle light_triangles[];
};

// A point of a light relative to its center, and the unit normal of the front there.
struct LightPoint {
    vec3 offset;
    vec3 normal;
};

// The normal of a triangle of a light: the light's, or of a mesh its own.
vec3 triangle_normal(ArealightGpuLightSampling sampling, vec3 a, vec3 b, vec3 c) {
    return sampling.normal == vec3(0.0) ? arealight_normalize_or(cross(b - a, c - a), vec3(0.0))
        : sampling.normal;
}

// Uniform by area.
LightPoint sample_point(ArealightGpuLightSampling sampling, inout RandomState random) {
    float choice = random_float(random);
    uint first = sampling.first_triangle;
    uint last = first + sampling.triangle_count - 1u;
    while (first < last) {
        uint middle = (first + last) / 2u;
        bool is_after = choice >= light_triangles[middle].cumulative;
        first = is_after ? middle + 1u : first;
        last = is_after ? last : middle;
    }
    ArealightGpuLightTriangle triangle = light_triangles[first];
    vec3 a = arealight_bridge_vertex(triangle.vertex0);
    vec3 b = arealight_bridge_vertex(triangle.vertex1);
    vec3 c = arealight_bridge_vertex(triangle.vertex2);
    float root = sqrt(random_float(random));
    float v = random_float(random) * root;
    return LightPoint(a * (1.0 - root) + b * (root - v) + c * v, triangle_normal(sampling, a, b, c));
}

// The radiance that a light's point sends to a place that it is `offset` from.
vec3 light_radiance(uint index, ArealightPolygonLight light, LightPoint point, vec3 offset) {
    vec3 radiance = light.radiance;
    if (light.image.layer != AREALIGHT_NO_IMAGE) {
        radiance *= arealight_image_color(light.image, point.offset);
    }
    if ((lights[index].flags & LIGHT_SHAPED) != 0u) {
        vec3 position = lights[index].center + point.offset - offset;
        radiance *= shaping_factor(lights[index], point.normal, position, offset);
    }
    return radiance;
}

// The light's density in solid angle at a point of it, `offset` from the surface: distance^2 / (area
// |cosine|); 0 where it does not emit towards the surface at `position`.
float light_density(ArealightPolygonLight light, float area, vec3 normal, vec3 offset, vec3 position) {
    float square = dot(offset, offset);
    float cosine = -dot(normal, offset) * inversesqrt(max(square, AREALIGHT_TINY));
    float side = arealight_lit_side(offset, normal, light.two_sided, arealight_position_error(position));
    return side != 0.0 ? square / (area * abs(cosine)) : 0.0;
}

#endif
