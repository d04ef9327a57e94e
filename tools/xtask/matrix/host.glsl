#version 450
#extension GL_GOOGLE_include_directive : require

// A host of the GLSL library, in every way that the matrix asks for by macros:
//   COMPUTE            a compute shader, else a fragment shader
//   COMBINED           combined image samplers, else images and samplers apart
//   SHAPES             disks, spheres and tubes beside polygons
//   SPECIALIZED        effects and rungs are specialisation constants, else literals: EFFECTS, FORM_FACTOR and so on
//   WITHOUT_<bridge>   the host forgot that bridge

#include "arealight/arealight.glsl"
#if SHAPES
#include "arealight/shapes.glsl"
#endif

#if SPECIALIZED
layout(constant_id = 0) const uint EFFECTS = 0xffffffffu;
layout(constant_id = 1) const int FORM_FACTOR = 0;
layout(constant_id = 2) const int HORIZON = 0;
layout(constant_id = 3) const int FRESNEL = 0;
layout(constant_id = 4) const int LOBES = 0;
layout(constant_id = 5) const int FOOTPRINT = 0;
#endif

#if COMBINED
layout(set = 0, binding = 0) uniform sampler2DArray table;
layout(set = 0, binding = 1) uniform sampler2DArray light_textures;
#define TABLE table
#define LIGHT_TEXTURES light_textures
#else
layout(set = 0, binding = 0) uniform texture2DArray table;
layout(set = 0, binding = 1) uniform texture2DArray light_textures;
layout(set = 0, binding = 2) uniform sampler trilinear;
#define TABLE sampler2DArray(table, trilinear)
#define LIGHT_TEXTURES sampler2DArray(light_textures, trilinear)
#endif
layout(set = 0, binding = 3, std430) readonly buffer Numbers {
    vec4 numbers[];
};

#ifndef WITHOUT_arealight_bridge_table
vec4 arealight_bridge_table(int layer, ivec2 texel) {
    return texelFetch(TABLE, ivec3(texel, layer), 0);
}
#endif

#ifndef WITHOUT_arealight_bridge_table_size
int arealight_bridge_table_size() {
    return textureSize(TABLE, 0).x;
}
#endif

#ifndef WITHOUT_arealight_bridge_vertex
vec3 arealight_bridge_vertex(uint index) {
    return numbers[index].xyz;
}
#endif

#ifndef WITHOUT_arealight_bridge_face_size
uint arealight_bridge_face_size(uint index) {
    return index;
}
#endif

#ifndef WITHOUT_arealight_bridge_light_texture
vec3 arealight_bridge_light_texture(uint layer, vec2 coordinate, float level) {
    return textureLod(LIGHT_TEXTURES, vec3(coordinate, float(layer)), level).rgb;
}
#endif

#ifndef WITHOUT_arealight_bridge_light_texture_size
ivec2 arealight_bridge_light_texture_size() {
    return textureSize(LIGHT_TEXTURES, 0).xy;
}
#endif

#if COMPUTE
layout(local_size_x = 64) in;
layout(set = 0, binding = 4, std430) writeonly buffer Results {
    vec4 results[];
};
#else
layout(location = 0) flat in int item;
layout(location = 0) out vec4 result;
#endif

// A surface and lights of whatever numbers the buffer holds: none may be a literal, or the compiler leaves code out.
vec3 shade(int first) {
    ArealightSurface surface;
    surface.position = numbers[first].xyz;
    surface.normal = numbers[first + 1].xyz;
    surface.view = numbers[first + 2].xyz;
    surface.roughness = numbers[first + 3].x;
    arealight_surface_from_metalness(surface, numbers[first + 4].rgb, numbers[first + 4].a, numbers[first + 5].rgb,
                                     numbers[first + 5].a);
    const ArealightQuality quality = ArealightQuality(FORM_FACTOR, HORIZON, FRESNEL, LOBES, FOOTPRINT);
    ArealightShadingPoint point = arealight_shading_point(surface, EFFECTS, quality);

    uvec4 counts = floatBitsToUint(numbers[first + 6]);
    ArealightPolygonLight light;
    light.radiance = numbers[first + 7].rgb;
    light.first_vertex = counts.x;
    light.vertex_count = counts.y;
    light.center = numbers[first + 8].xyz;
    light.radius = numbers[first + 8].w;
    light.area = numbers[first + 9].xyz;
    light.two_sided = counts.z != 0u;
    light.image = ArealightImage(counts.w, numbers[first + 10].xyz, numbers[first + 11].xyz, numbers[first + 12].xyz,
                                 numbers[first + 13].xy, numbers[first + 13].zw);
    vec3 radiance = arealight_polygon_radiance(point, light, EFFECTS, quality);
#if SHAPES
    ArealightShape shape;
    shape.kind = int(counts.y);
    shape.radiance = light.radiance;
    shape.center = light.center;
    shape.axis_u = numbers[first + 11].xyz;
    shape.axis_v = numbers[first + 12].xyz;
    shape.radius = light.radius;
    shape.ends = int(counts.w);
    shape.two_sided = light.two_sided;
    radiance += arealight_shape_radiance(point, shape, EFFECTS, quality);
#endif
    return radiance;
}

void main() {
#if COMPUTE
    int item = int(gl_GlobalInvocationID.x);
    results[item] = vec4(shade(14 * item), 1.0);
#else
    result = vec4(shade(14 * item), 1.0);
#endif
}
