#ifndef SHAPING_GLSL
#define SHAPING_GLSL

// Profiles and openings of polygon lights, by their records.

#include "arealight/lights/opening.glsl"
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

#endif
