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

// The place of a light's image; without one, of none.
ArealightImage load_image(ArealightGpuLight record) {
    ArealightImage image = ArealightImage(AREALIGHT_NO_IMAGE, vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0),
                                          vec2(0.0), 1.0);
    if (AREALIGHT_HAS_TEXTURED_POLYGONS && record.texture_layer != NO_LIGHT_TEXTURE) {
        uint row = record.first_vertex + record.vertex_count;
        vec4 corner = light_vertices[row];
        vec4 axis_u = light_vertices[row + 1u];
        vec4 axis_v = light_vertices[row + 2u];
        image = ArealightImage(record.texture_layer, corner.xyz, axis_u.xyz, axis_v.xyz,
                               vec2(corner.w, axis_u.w),
                               vec2(axis_v.w, light_vertices[row + 3u].x), light_vertices[row + 3u].y);
    }
    return image;
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
