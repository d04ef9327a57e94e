#version 450
#extension GL_GOOGLE_include_directive : require

// Finds the surface that each pixel sees and writes a G-buffer: for our own tools and tests.

layout(local_size_x = 8, local_size_y = 8) in;

#define SCENE_BINDING 0
#include "scene.glsl"

layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D out_position;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D out_normal;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D out_base_color;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D out_specular;
layout(set = 0, binding = 9, rgba32f) uniform writeonly image2D out_radiance;
layout(set = 0, binding = 10, rgba32f) uniform writeonly image2D out_coat;
layout(set = 0, binding = 11, rgba32f) uniform writeonly image2D out_sheen;
layout(set = 0, binding = 12, rgba32f) uniform writeonly image2D out_anisotropy;
layout(set = 0, binding = 13, rgba32f) uniform writeonly image2D out_film;
layout(set = 0, binding = 14, rgba16f) uniform writeonly image2D out_transmitted;
layout(set = 0, binding = 15, r32ui) uniform writeonly uimage2D out_stencil;

layout(push_constant, std430) uniform VisibilityConstants {
    vec3 camera;
    uint orthographic; // 1: lines of sight are parallel
    vec3 right;
    uint supersample; // lines of sight of a pixel along each axis; 0 is 1
    vec3 up;
    uint first_row;   // of the picture that the image is a band of
    vec3 forward;
    uint reserved3;
    vec3 background;
    uint reserved4;
} constants;

// Back faces are met only where the material has two sides, and nothing less than half of which is there.
void bvh_meet_triangle(uint index, vec3 origin, vec3 direction, inout BvhHit hit) {
    ArealightGpuTriangle triangle = triangles[index];
    bool double_sided = (materials[triangle.material].flags & MATERIAL_DOUBLE_SIDED) != 0u;
    BvhHit met;
    if (bvh_intersect(triangle.p0, triangle.p1, triangle.p2, index, origin, direction, hit.distance, met)
        && (double_sided || !met.back) && surface_alpha(triangle, met.barycentric) >= 0.5) {
        hit = met;
    }
}

// The part of the light that sheen keeps from neither reflection nor transmission below it.
float below_sheen(ScenePoint point, vec3 view) {
    return arealight_sheen_layer(arealight_surface_frame(point.normal, view), point.sheen).base;
}

// The derivatives, by pixels to the right and downwards, of where the view ray meets the hit's plane; `line`
// is the ray's direction, as long as the camera's `forward` plus the pixel's offset.
vec3[2] pixel_steps(BvhHit hit, vec3 line, vec2 size, bool parallel) {
    ArealightGpuTriangle triangle = triangles[hit.triangle];
    vec3 normal = cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0);
    float scale = parallel ? 1.0 : hit.distance * inversesqrt(dot(line, line));
    vec3 steps[2] = vec3[2](2.0 / size.x * constants.right, -2.0 / size.y * constants.up);
    for (int i = 0; i < 2; i++) {
        steps[i] = scale * (steps[i] - line * (dot(normal, steps[i]) / dot(normal, line)));
    }
    return steps;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(out_radiance);
    if (any(greaterThanEqual(pixel, size))) {
        return;
    }
    // Send a ray; those of a supersampled pixel each in a row and a column of its own
    int n = int(max(constants.supersample, 1u));
    vec2 place = (vec2((pixel.y + int(constants.first_row)) % n, n - 1 - pixel.x % n) + 0.5) / float(n);
    vec2 plane = (vec2(pixel) + place) / vec2(size) * 2.0 - 1.0;
    vec3 across = plane.x * constants.right - plane.y * constants.up;
    bool parallel = constants.orthographic != 0u;
    vec3 direction = arealight_normalize_or(parallel ? constants.forward : constants.forward + across,
                                            vec3(0.0, 0.0, -1.0));
    BvhHit hit = bvh_trace(parallel ? constants.camera + across : constants.camera, direction, 3e38, false);

    if (hit.triangle == BVH_NO_TRIANGLE) {
        imageStore(out_position, pixel, vec4(0.0));
        imageStore(out_normal, pixel, vec4(0.0));
        imageStore(out_base_color, pixel, vec4(0.0));
        imageStore(out_specular, pixel, vec4(0.0));
        imageStore(out_radiance, pixel, vec4(constants.background, 0.0));
        imageStore(out_coat, pixel, vec4(0.0));
        imageStore(out_sheen, pixel, vec4(0.0));
        imageStore(out_anisotropy, pixel, vec4(0.0));
        imageStore(out_film, pixel, vec4(0.0));
        imageStore(out_transmitted, pixel, vec4(0.0));
        imageStore(out_stencil, pixel, uvec4(0u));
        return;
    }
    ScenePoint point = scene_point(hit, pixel_steps(hit, constants.forward + (parallel ? vec3(0.0) : across),
                                                    vec2(size), parallel));
    imageStore(out_position, pixel, vec4(point.position, float(hit.triangle + 1u)));
    imageStore(out_normal, pixel, vec4(point.normal, point.roughness));
    imageStore(out_stencil, pixel, uvec4(triangles[hit.triangle].flags >> TRIANGLE_GROUPS_SHIFT));
    imageStore(out_base_color, pixel, vec4(point.base_color, point.metalness));
    imageStore(out_specular, pixel, vec4(point.dielectric_f0, point.dielectric_f90));
    float below_coat = 1.0 - arealight_coat_share(point.coat, dot(point.coat.normal, direction));
    imageStore(out_radiance, pixel, vec4(point.emission * below_coat, 1.0));
    imageStore(out_coat, pixel, vec4(point.coat.weight, point.coat.roughness,
                                     to_octahedron(point.coat.normal)));
    imageStore(out_sheen, pixel, vec4(point.sheen.color, point.sheen.roughness));
    imageStore(out_anisotropy, pixel, vec4(to_octahedron(point.anisotropy.tangent),
                                           point.anisotropy.roughness, 0.0));
    imageStore(out_film, pixel, vec4(point.film.weight, point.film.ior, point.film.thickness, 0.0));
    imageStore(out_transmitted, pixel, vec4(point.transmitted * (below_coat * below_sheen(point, -direction)),
                                            point.pane));
}
