#ifndef LIGHTS_GLSL
#define LIGHTS_GLSL

// The light buffers as the library sees them. The including kernel defines LIGHTS_BINDING (the vertices are at
// the binding after it).

#include "arealight/polygon_light.glsl"
#include "buffers.glsl"

layout(set = 0, binding = LIGHTS_BINDING, std430) readonly buffer Lights {
    ArealightGpuLight lights[];
};
layout(set = 0, binding = LIGHTS_BINDING + 1, std430) readonly buffer LightVertices {
    vec4 light_vertices[];
};

vec3 arealight_bridge_vertex(uint index) {
    return light_vertices[index].xyz;
}

ArealightPolygonLight load_light(uint index) {
    ArealightGpuLight record = lights[index];
    return ArealightPolygonLight(record.radiance, record.first_vertex, record.vertex_count, record.center,
                                 record.radius, record.area, (record.flags & LIGHT_TWO_SIDED) != 0u);
}

#endif
