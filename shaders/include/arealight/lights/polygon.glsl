#ifndef AREALIGHT_POLYGON_LIGHT_GLSL
#define AREALIGHT_POLYGON_LIGHT_GLSL

#include "arealight/form_factor/difference.glsl"
#include "arealight/form_factor/outline.glsl"
#include "arealight/light_kind.glsl"
#include "arealight/textures/footprint.glsl"

// The host's bridge to the outlines of polygon and mesh lights: the position of vertex `index`, from its light's center.
vec3 arealight_bridge_vertex(uint index);

// A flat, simple polygon of any number of vertices, convex or not, counter-clockwise seen from its front; of constant radiance,
// or with an image that multiplies it.
struct ArealightPolygonLight {
    vec3 radiance;     // of the front, W/(m^2 sr)
    vec3 center;       // relative to the origin of ArealightSurface.position
    vec3 normal;       // of the front, unit; zero for a polygon without area, which gives no light
    uint first_vertex; // for arealight_bridge_vertex
    uint vertex_count; // from 3 on
    bool two_sided;    // the back emits too (with AREALIGHT_TWO_SIDED)
#if AREALIGHT_LIGHT_TEXTURES
    ArealightImage image;
#endif
};

// A polygon about to be taken into lobes' spaces.
struct ArealightLocalPolygon {
    vec3 center;   // in the shading frame, from the shading point
    mat3 to_frame; // offsets from the center into that frame
    uint first;    // vertices
    uint end;
#if AREALIGHT_LIGHT_TEXTURES
    ArealightImage image;
#endif
};

bool arealight_to_local(ArealightPoint point, ArealightPolygonLight light, out ArealightLocalPolygon local) {
    vec3 offset = light.center - point.position;
    local.center = point.to_frame * offset;
    local.to_frame = point.to_frame;
    local.first = light.first_vertex;
    local.end = light.first_vertex + light.vertex_count;
#if AREALIGHT_LIGHT_TEXTURES
    local.image = light.image;
#endif
    return light.vertex_count != 0u && arealight_is_lit(offset, light.normal, AREALIGHT_HAS_TWO_SIDED && light.two_sided);
}

// The vector form factor of the outline of vertices `first` to `end` - 1, not empty, in a space, clipped at its horizon.
vec3 arealight_outline_in_space(mat3 space, vec3 center, mat3 to_frame, uint first, uint end) {
    vec3 in_space = space * center;
    mat3 to_space = space * to_frame;
    ArealightOutline outline = arealight_outline_begin();
    vec3 from = arealight_unit(in_space + to_space * arealight_bridge_vertex(end - 1u));
    float heights = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 vertex = in_space + to_space * arealight_bridge_vertex(index);
        vec3 to = arealight_unit(vertex);
        arealight_outline_edge(outline, from, to);
        heights += vertex.z;
        from = to;
    }
    // Every coordinate is in some height
    return arealight_is_finite(heights) ? arealight_outline_vector(outline) : vec3(0.0);
}

// The same, clipped at the surface's horizon first.
vec3 arealight_outline_above_surface(mat3 space, vec3 center, mat3 to_frame, uint first, uint end) {
    ArealightClippedOutline clipped = arealight_clipped_begin(center + to_frame * arealight_bridge_vertex(end - 1u));
    float heights = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 vertex = center + to_frame * arealight_bridge_vertex(index);
        arealight_clipped_vertex(clipped, space, vertex);
        heights += vertex.z;
    }
    return arealight_is_finite(heights) ? arealight_clipped_vector(clipped) : vec3(0.0);
}

// The same as the two above in the difference form, with relative precision for small outlines.
vec3 arealight_outline_by_difference(mat3 space, vec3 center, mat3 to_frame, uint first, uint end) {
    mat3 to_space = space * to_frame;
    float extent = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 offset = to_space * arealight_bridge_vertex(index);
        extent = max(extent, dot(offset, offset));
    }
    ArealightAnchor anchor = arealight_anchor(space * center, sqrt(extent), arealight_horizon_width(space));
    ArealightDifferenceOutline outline = arealight_difference_begin();
    vec3 previous = to_frame * arealight_bridge_vertex(end - 1u);
    for (uint index = first; index < end; index++) {
        vec3 offset = to_frame * arealight_bridge_vertex(index);
        // Heights above the surface's horizon
        float height = center.z + offset.z;
        float previous_height = center.z + previous.z;
        if (AREALIGHT_CLIPS_AT_SURFACE && (height > 0.0) != (previous_height > 0.0)) {
            vec3 cut = (offset * previous_height - previous * height) / (previous_height - height);
            arealight_difference_to(outline, anchor, arealight_vertex(anchor, space * cut));
        }
        if (!AREALIGHT_CLIPS_AT_SURFACE || height > 0.0) {
            arealight_difference_to(outline, anchor, arealight_vertex(anchor, space * offset));
        }
        outline.squares += dot(offset, offset);
        previous = offset;
    }
    return arealight_difference_vector(outline, anchor);
}

// The vector form factor of an outline, as the options have it.
vec3 arealight_outline_form_factor(mat3 space, vec3 center, mat3 to_frame, uint first, uint end) {
    if (AREALIGHT_USES_DIFFERENCE) {
        return arealight_outline_by_difference(space, center, to_frame, first, end);
    }
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        return arealight_outline_above_surface(space, center, to_frame, first, end);
    }
    return arealight_outline_in_space(space, center, to_frame, first, end);
}

vec3 arealight_vector_form_factor(mat3 space, ArealightLocalPolygon local) {
    return arealight_outline_form_factor(space, local.center, local.to_frame, local.first, local.end);
}

vec3 arealight_image_seen(mat3 space, ArealightLocalPolygon local, vec3 vector) {
#if AREALIGHT_LIGHT_TEXTURES
    if (local.image.layer != AREALIGHT_NO_IMAGE) {
        return arealight_footprint(arealight_lobe_image(local.image, space * local.center, space * local.to_frame), vector);
    }
#endif
    return vec3(1.0);
}

AREALIGHT_LIGHT_KIND(ArealightPolygonLight, ArealightLocalPolygon)

#endif
