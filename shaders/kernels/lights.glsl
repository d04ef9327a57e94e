#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL

// The light buffers as the library sees them. The including kernel defines LIGHTS_BINDING (the vertices are at
// the binding after it) and LIGHT_TEXTURES_BINDING.

#include "light_textures.glsl"
#include "light_records.glsl"
#define AREALIGHT_LIGHT_MESHES 1
#include "arealight/polygon_light.glsl"

// What a convex quad without an image never calls for: Effects::BEYOND_QUADS in Rust.
const uint BEYOND_QUADS = AREALIGHT_EFFECT_POLYGON | AREALIGHT_EFFECT_TEXTURED | AREALIGHT_EFFECT_MESH;

layout(set = 0, binding = LIGHTS_BINDING + 1, std430) readonly buffer LightVertices {
    vec4 light_vertices[];
};

vec3 arealight_bridge_vertex(uint index) {
    return light_vertices[index].xyz;
}

uint arealight_bridge_face_size(uint index) {
    return uint(light_vertices[index].w);
}

ArealightPolygonLight load_light(uint index) {
    ArealightGpuLight record = light_record(index);
    ArealightImage image = ArealightImage(record.texture_layer, record.texture_corner, record.texture_axis_u,
                                          record.texture_axis_v, record.texture_low, record.texture_size);
    return ArealightPolygonLight(record.radiance, record.first_vertex, record.vertex_count, record.center,
                                 record.radius, record.area, (record.flags & LIGHT_TWO_SIDED) != 0u, image);
}

#endif
