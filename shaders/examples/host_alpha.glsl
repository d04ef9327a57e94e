// What is there of triangles that are cut out, in an engine: here pickets of a fence, half of each unit, as a
// stand-in for its own textures. shaders/kernels/shadow_rays.comp includes it with AREALIGHT_HOST_ALPHA 1.

layout(set = 1, binding = 1, std430) readonly buffer HostAlpha {
    mat3x2 coordinates[]; // of the vertices of each triangle that has a number, by that less one
};

float arealight_bridge_alpha(uint instance, uint triangle, vec2 barycentric) {
    vec2 place = coordinates[triangle - 1u] * vec3(1.0 - barycentric.x - barycentric.y, barycentric);
    return fract(place.x) < 0.5 ? 1.0 : 0.0;
}
