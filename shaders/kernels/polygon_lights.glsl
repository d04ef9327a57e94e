#ifndef POLYGON_LIGHTS_GLSL
#define POLYGON_LIGHTS_GLSL

// The buffers of polygon and mesh lights as the library's lights. The including kernel defines LIGHTS_BINDING
// (the vertices are at the binding after it), LIGHT_TEXTURES_BINDING and the options of the library.

#include "light_records.glsl"
#include "light_textures.glsl"
#include "arealight/arealight.glsl"
#include "shaping.glsl"

ArealightQuadLight load_quad(ArealightGpuLight record) {
    uint first = record.first_vertex;
    uint last = clamp(record.vertex_count, 1u, 4u) - 1u;
    ArealightQuad quad = ArealightQuad(light_vertices[first].xyz, light_vertices[first + 1u].xyz,
                                       light_vertices[first + min(2u, last)].xyz,
                                           light_vertices[first + last].xyz);
    return ArealightQuadLight(record.radiance, record.center, record.normal, quad,
                              (record.flags & LIGHT_TWO_SIDED) != 0u);
}

ArealightPolygonLight load_polygon(ArealightGpuLight record) {
    return ArealightPolygonLight(record.radiance, record.center, record.normal, record.first_vertex,
                                 record.vertex_count,
                                 (record.flags & LIGHT_TWO_SIDED) != 0u, load_image(record));
}

#if AREALIGHT_SHAPED
ArealightShapedLight load_shaped(ArealightGpuLight record) {
    uvec2 rows = shaping_rows(record);
    return ArealightShapedLight(load_polygon(record), record.radiance, rows.x, rows.y);
}
#endif

ArealightMeshLight load_mesh(ArealightGpuLight record) {
    return ArealightMeshLight(record.radiance, record.center, record.first_vertex, record.vertex_count,
                              (record.flags & LIGHT_TWO_SIDED) != 0u);
}

#endif
