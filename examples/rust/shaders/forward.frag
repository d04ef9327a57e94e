#version 450
#extension GL_GOOGLE_include_directive : require

// The forward engine's shading: the library, and bridges to what this engine binds.

// doc: bridges
#define AREALIGHT_QUADS 0
#define AREALIGHT_POLYGONS 1 // outlines of any number of vertices
#include "arealight/arealight.glsl"

layout(set = 0, binding = 0) uniform sampler2DArray table;

struct Lamp {
    vec3 radiance;
    uint first_vertex;
    vec3 center;
    uint vertex_count;
    vec3 normal;
    float reserved;
};

layout(set = 0, binding = 1, std140) uniform Lamps {
    Lamp lamps[16];
    vec4 vertices[64];
    uint lamp_count;
};

vec4 arealight_bridge_table(int layer, ivec2 texel) {
    return texelFetch(table, ivec3(texel, layer), 0);
}

int arealight_bridge_table_size() {
    return textureSize(table, 0).x;
}

vec3 arealight_bridge_vertex(uint index) {
    return vertices[index].xyz;
}
// doc end

layout(location = 0) in vec3 position;
layout(location = 1) flat in vec3 normal;
layout(location = 2) flat in vec4 base_color_metalness;
layout(location = 3) flat in vec4 emission_roughness;

layout(location = 0) out vec4 out_radiance;

// doc: shade
void main() {
    ArealightSurface surface;
    surface.position = position;
    surface.normal = normal;
    surface.view = -position; // the camera is the origin
    surface.roughness = emission_roughness.w;
    arealight_surface_from_metalness(surface, base_color_metalness.rgb, base_color_metalness.a, vec3(0.04),
                                     1.0);

    ArealightPoint point = arealight_point(surface);
    vec3 radiance = emission_roughness.rgb;
    for (uint i = 0u; i < lamp_count; i++) {
        ArealightPolygonLight light;
        light.radiance = lamps[i].radiance;
        light.center = lamps[i].center;
        light.normal = lamps[i].normal;
        light.first_vertex = lamps[i].first_vertex;
        light.vertex_count = lamps[i].vertex_count;
        light.two_sided = false;
        radiance += arealight_radiance(point, light);
    }
    out_radiance = vec4(radiance, 1.0);
}
// doc end
