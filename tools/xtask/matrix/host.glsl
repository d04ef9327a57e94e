#version 450
#extension GL_GOOGLE_include_directive : require

// A host of the GLSL library, in every way that the matrix asks for by macros:
//   COMPUTE            a compute shader, else a fragment shader
//   COMBINED           combined image samplers, else images and samplers apart
//   SPECIALIZED        the library's options are specialisation constants, else what the command line says
//   WITHOUT_<bridge>   the host forgot that bridge

#if SPECIALIZED
layout(constant_id = 0) const bool DIFFUSE = true;
layout(constant_id = 1) const bool SPECULAR = true;
layout(constant_id = 2) const bool TWO_SIDED = false;
layout(constant_id = 3) const bool SURFACE_HORIZON = false;
layout(constant_id = 4) const bool TWO_SPECULAR_LOBES = false;
layout(constant_id = 5) const bool FORMULA = false;
layout(constant_id = 7) const int FOOTPRINT = 0;
layout(constant_id = 8) const bool COAT = false;
layout(constant_id = 9) const bool COAT_NORMAL = false;
layout(constant_id = 10) const bool ANISOTROPY = false;
layout(constant_id = 11) const bool SHEEN = false;
layout(constant_id = 12) const bool HALF_VECTORS = false;
layout(constant_id = 13) const bool THIN_FILM = false;
#define AREALIGHT_DIFFUSE DIFFUSE
#define AREALIGHT_SPECULAR SPECULAR
#define AREALIGHT_TWO_SIDED TWO_SIDED
#define AREALIGHT_SURFACE_HORIZON SURFACE_HORIZON
#define AREALIGHT_TWO_SPECULAR_LOBES TWO_SPECULAR_LOBES
#define AREALIGHT_FORMULA FORMULA
#define AREALIGHT_FOOTPRINT FOOTPRINT
#define AREALIGHT_COAT COAT
#define AREALIGHT_COAT_NORMAL COAT_NORMAL
#define AREALIGHT_ANISOTROPY ANISOTROPY
#define AREALIGHT_SHEEN SHEEN
#define AREALIGHT_HALF_VECTORS HALF_VECTORS
#define AREALIGHT_THIN_FILM THIN_FILM
#endif

#include "arealight/arealight.glsl"

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

#ifndef WITHOUT_arealight_bridge_face
vec4 arealight_bridge_face(uint index) {
    return numbers[index];
}
#endif

#ifndef WITHOUT_arealight_bridge_profile
vec4 arealight_bridge_profile(uint row) {
    return numbers[row];
}
#endif

#ifndef WITHOUT_arealight_bridge_light_texture
vec4 arealight_bridge_light_texture(uint layer, uint part, vec2 coordinate, float level) {
    return textureLod(LIGHT_TEXTURES, vec3(coordinate, float(4u * layer + part)), level);
}
#endif

#ifndef WITHOUT_arealight_bridge_light_texture_side
int arealight_bridge_light_texture_side() {
    return textureSize(LIGHT_TEXTURES, 0).x;
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

// A surface and lights of whatever numbers the buffer holds: none may be a literal, or the compiler leaves
// code out.
vec3 shade(int first) {
    ArealightSurface surface;
    surface.position = numbers[first].xyz;
    surface.normal = numbers[first + 1].xyz;
    surface.view = numbers[first + 2].xyz;
    surface.roughness = numbers[first + 3].x;
    arealight_surface_from_metalness(surface, numbers[first + 4].rgb, numbers[first + 4].a,
                                     numbers[first + 5].rgb,
                                     numbers[first + 5].a);
    surface.coat = ArealightCoat(numbers[first + 14].xyz, numbers[first + 14].w, numbers[first + 3].y);
    surface.anisotropy = ArealightAnisotropy(numbers[first + 14].xyz, numbers[first + 3].z);
    surface.sheen = ArealightSheen(numbers[first + 15].rgb, numbers[first + 15].a);
    surface.film = ArealightThinFilm(numbers[first + 16].r, numbers[first + 16].g, numbers[first + 16].b);
    ArealightPoint point = arealight_point(surface);

    uvec4 counts = floatBitsToUint(numbers[first + 6]);
    vec3 radiance = numbers[first + 7].rgb;
    vec3 center = numbers[first + 8].xyz;
    float radius = numbers[first + 8].w;
    vec3 axis_u = numbers[first + 9].xyz;
    vec3 axis_v = numbers[first + 10].xyz;
    bool two_sided = counts.z != 0u;
    vec3 sum = vec3(0.0);
#if AREALIGHT_QUADS
    ArealightQuad quad = ArealightQuad(numbers[first + 9].xyz, numbers[first + 10].xyz,
                                       numbers[first + 11].xyz,
                                       numbers[first + 12].xyz);
    sum += arealight_radiance(point, ArealightQuadLight(radiance, center, numbers[first + 13].xyz, quad,
                                                        two_sided));
#endif
#if AREALIGHT_POLYGONS
    ArealightPolygonLight polygon;
    polygon.radiance = radiance;
    polygon.center = center;
    polygon.normal = axis_u;
    polygon.first_vertex = counts.x;
    polygon.vertex_count = counts.y;
    polygon.two_sided = two_sided;
#if AREALIGHT_LIGHT_TEXTURES
    polygon.image = ArealightImage(counts.w, numbers[first + 10].xyz, numbers[first + 11].xyz,
                                   numbers[first + 12].xyz,
                                   numbers[first + 13].xy, numbers[first + 13].zw, numbers[first + 12].w);
#endif
    sum += arealight_radiance(point, polygon);
#endif
#if AREALIGHT_MESHES
    sum += arealight_radiance(point, ArealightMeshLight(radiance, center, counts.x, counts.y, two_sided));
#endif
#if AREALIGHT_SHAPED
    ArealightShapedLight shaped;
    shaped.polygon.radiance = radiance;
    shaped.polygon.center = center;
    shaped.polygon.normal = axis_u;
    shaped.polygon.first_vertex = counts.x;
    shaped.polygon.vertex_count = counts.y;
    shaped.polygon.two_sided = two_sided;
#if AREALIGHT_LIGHT_TEXTURES
    shaped.polygon.image.layer = counts.w;
#endif
    shaped.radiance = radiance;
    shaped.profile = counts.w;
    shaped.opening = counts.x;
    sum += arealight_radiance(point, shaped);
#endif
#if AREALIGHT_DISKS
    ArealightDiskLight disk;
    disk.radiance = radiance;
    disk.center = center;
    disk.axis_u = axis_u;
    disk.axis_v = axis_v;
    disk.two_sided = two_sided;
#if AREALIGHT_LIGHT_TEXTURES
    disk.image = counts.w;
#endif
    sum += arealight_radiance(point, disk);
#endif
#if AREALIGHT_SPHERES
    sum += arealight_radiance(point, ArealightSphereLight(radiance, center, radius, two_sided));
#endif
#if AREALIGHT_TUBES
    sum += arealight_radiance(point, ArealightTubeLight(radiance, center, axis_u, radius, int(counts.w)));
#endif
    return sum;
}

void main() {
#if COMPUTE
    int item = int(gl_GlobalInvocationID.x);
    results[item] = vec4(shade(14 * item), 1.0);
#else
    result = vec4(shade(14 * item), 1.0);
#endif
}
