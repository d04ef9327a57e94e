#ifndef QUAD_POINT_GLSL
#define QUAD_POINT_GLSL

// Points of quad lights. The including kernel has light_records.glsl before.

layout(set = 0, binding = 1, std430) readonly buffer LightVertices {
    vec4 light_vertices[];
};

// A point of a quad relative to its center; `area` is what a density of 1 over the random numbers is one
// over, in area: the quad's, where it is a parallelogram.
vec3 point_of(ArealightGpuLight light, vec2 random, out float area) {
    vec3 a = light_vertices[light.first_vertex].xyz;
    vec3 b = light_vertices[light.first_vertex + 1u].xyz;
    vec3 c = light_vertices[light.first_vertex + 2u].xyz;
    vec3 d = light_vertices[light.first_vertex + min(3u, light.vertex_count - 1u)].xyz;
    vec3 along = mix(b - a, c - d, random.y);
    vec3 across = mix(d - a, c - b, random.x);
    area = length(cross(along, across));
    return a + random.x * (b - a) + random.y * across;
}

#endif
