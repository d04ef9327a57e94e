#version 450
#extension GL_GOOGLE_include_directive : require

// Finds the surface that each pixel sees and writes a G-buffer: for our own tools and tests.

layout(local_size_x = 8, local_size_y = 8) in;

#include "arealight/surface.glsl"
#include "scene.glsl"

layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D out_position;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D out_normal;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D out_base_color;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D out_specular;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D out_radiance;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image2D out_coat;

layout(push_constant, std430) uniform VisibilityConstants {
    vec3 camera;
    uint node_count;
    vec3 right;
    uint reserved0;
    vec3 up;
    uint reserved1;
    vec3 forward;
    uint reserved2;
    vec3 background;
    uint reserved3;
} constants;

// arealight_scene builds no hierarchy deeper than 48.
const uint STACK_SIZE = 64u;

// The distance at which a ray enters a box before `nearest`, or -1.
float enter_box(vec3 low, vec3 high, vec3 origin, vec3 inverse_direction, float nearest) {
    vec3 a = (low - origin) * inverse_direction;
    vec3 b = (high - origin) * inverse_direction;
    vec3 first = min(a, b);
    vec3 last = max(a, b);
    float enter = max(max(first.x, first.y), max(first.z, 0.0));
    // Widened by two roundings, so that a ray along a flat box is not lost
    float leave = min(min(last.x, last.y), min(last.z, nearest)) * 1.0000004;
    return enter <= leave ? enter : -1.0;
}

// Moeller and Trumbore 1997; back faces are met only where the material has two sides.
void meet_triangle(uint index, vec3 origin, vec3 direction, inout Hit hit) {
    ArealightGpuTriangle triangle = triangles[index];
    vec3 edge1 = triangle.p1 - triangle.p0;
    vec3 edge2 = triangle.p2 - triangle.p0;
    vec3 p = cross(direction, edge2);
    float determinant = dot(edge1, p);
    bool double_sided = (materials[triangle.material].flags & MATERIAL_DOUBLE_SIDED) != 0u;
    if (!(double_sided ? determinant != 0.0 : determinant > 0.0)) {
        return;
    }
    float inverse = 1.0 / determinant;
    vec3 s = origin - triangle.p0;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, edge1);
    float v = dot(direction, q) * inverse;
    float distance = dot(edge2, q) * inverse;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || !(distance > 0.0 && distance < hit.distance)) {
        return;
    }
    Hit candidate = Hit(distance, index, vec2(u, v), determinant < 0.0);
    if (!masked_out(candidate)) {
        hit = candidate;
    }
}

Hit trace(vec3 origin, vec3 direction) {
    Hit hit = Hit(3e38, NO_TRIANGLE, vec2(0.0), false);
    // A direction along an axis would divide by zero: 1e-30 reaches no box that it should not
    vec3 safe = mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    vec3 inverse_direction = 1.0 / safe;
    uint stack[STACK_SIZE];
    uint depth = 0u;
    if (constants.node_count > 0u) {
        stack[depth++] = 0u;
    }
    while (depth > 0u) {
        ArealightGpuBvhNode node = nodes[stack[--depth]];
        if (enter_box(node.min_corner, node.max_corner, origin, inverse_direction, hit.distance) < 0.0) {
            continue;
        }
        for (uint i = 0u; i < node.count; i++) {
            meet_triangle(node.first + i, origin, direction, hit);
        }
        if (node.count == 0u && depth + 2u <= STACK_SIZE) {
            stack[depth++] = node.first;
            stack[depth++] = node.first + 1u;
        }
    }
    return hit;
}

// A unit direction's place in [-1, 1]^2 on an unfolded octahedron. Source: Cigolle et al. 2014.
vec2 to_octahedron(vec3 direction) {
    vec2 place = direction.xy / (abs(direction.x) + abs(direction.y) + abs(direction.z));
    vec2 sides = vec2(place.x >= 0.0 ? 1.0 : -1.0, place.y >= 0.0 ? 1.0 : -1.0);
    return direction.z >= 0.0 ? place : (1.0 - abs(place.yx)) * sides;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(out_radiance);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    // Send a ray through the pixel's centre
    vec2 plane = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 direction = arealight_normalize_or(
        constants.forward + plane.x * constants.right - plane.y * constants.up, vec3(0.0, 0.0, -1.0));
    Hit hit = trace(constants.camera, direction);

    if (hit.triangle == NO_TRIANGLE) {
        imageStore(out_position, pixel, vec4(0.0));
        imageStore(out_normal, pixel, vec4(0.0));
        imageStore(out_base_color, pixel, vec4(0.0));
        imageStore(out_specular, pixel, vec4(0.0));
        imageStore(out_radiance, pixel, vec4(constants.background, 0.0));
        imageStore(out_coat, pixel, vec4(0.0));
        return;
    }
    ScenePoint point = scene_point(hit);
    imageStore(out_position, pixel, vec4(point.position, 1.0));
    imageStore(out_normal, pixel, vec4(point.normal, point.roughness));
    imageStore(out_base_color, pixel, vec4(point.base_color, point.metalness));
    imageStore(out_specular, pixel, vec4(point.dielectric_f0, point.dielectric_f90));
    float below_coat = 1.0 - arealight_coat_share(point.coat, dot(point.coat.normal, direction));
    imageStore(out_radiance, pixel, vec4(point.emission * below_coat, 1.0));
    imageStore(out_coat, pixel, vec4(point.coat.weight, point.coat.roughness, to_octahedron(point.coat.normal)));
}
