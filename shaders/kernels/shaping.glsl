#ifndef SHAPING_GLSL
#define SHAPING_GLSL

// Profiles, openings and images of polygon lights, by their records.

#include "arealight/lights/opening.glsl"
#include "arealight/textures/footprint.glsl"
#include "light_records.glsl"
#include "light_vertices.glsl"

// The first rows of a light's profile and of its opening.
uvec2 shaping_rows(ArealightGpuLight record) {
    bool has_opening = AREALIGHT_HAS_OPENINGS && (record.flags & LIGHT_OPENING) != 0u;
    uint profile = record.shaping + (has_opening ? AREALIGHT_OPENING_ROWS : 0u);
    bool has_profile = AREALIGHT_HAS_PROFILES
        && (!AREALIGHT_HAS_OPENINGS || (record.flags & LIGHT_PROFILE) != 0u);
    return uvec2(has_profile ? profile : AREALIGHT_NO_ROW, has_opening ? record.shaping : AREALIGHT_NO_ROW);
}

// The factor of the radiance that a shaped light's point sends to a position that it is `offset` from.
float shaping_factor(ArealightGpuLight record, vec3 normal, vec3 position, vec3 offset) {
    uvec2 rows = shaping_rows(record);
    float factor = 1.0;
    if (AREALIGHT_HAS_OPENINGS && rows.y != AREALIGHT_NO_ROW) {
        factor = arealight_opening_factor(rows.y, position, offset);
    }
    if (AREALIGHT_HAS_PROFILES && rows.x != AREALIGHT_NO_ROW) {
        factor *= arealight_profile_factor(rows.x, normal, offset);
    }
    return factor;
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

// Whether a place in a light's plane, from its center, is within its outline.
bool is_in_light(ArealightGpuLight record, vec3 place) {
    vec3 normal = abs(record.normal);
    bool drops_x = normal.x >= max(normal.y, normal.z);
    bool drops_y = !drops_x && normal.y >= normal.z;
    bool is_in = false;
    vec3 a = arealight_bridge_vertex(record.first_vertex + record.vertex_count - 1u) - place;
    for (uint index = 0u; index < record.vertex_count; index++) {
        vec3 b = arealight_bridge_vertex(record.first_vertex + index) - place;
        vec2 from = drops_x ? a.yz : drops_y ? a.xz : a.xy;
        vec2 to = drops_x ? b.yz : drops_y ? b.xz : b.xy;
        // The edges that a ray along the first axis crosses
        bool crosses = (from.y > 0.0) != (to.y > 0.0);
        is_in = crosses && (from.x * to.y > to.x * from.y) == (to.y > from.y) ? !is_in : is_in;
        a = b;
    }
    return is_in;
}

#endif
