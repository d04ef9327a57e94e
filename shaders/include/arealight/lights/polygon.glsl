#ifndef AREALIGHT_POLYGON_LIGHT_GLSL
#define AREALIGHT_POLYGON_LIGHT_GLSL

#include "arealight/form_factor/outline.glsl"
#include "arealight/lights/quad.glsl"
#include "arealight/textures/footprint.glsl"

// The host's bridge to the outlines of polygon and mesh lights: the position of vertex `index`, from its
// light's center.
vec3 arealight_bridge_vertex(uint index);

// A flat, simple polygon of any number of vertices, convex or not, counter-clockwise seen from its front; of
// constant radiance, or with an image that multiplies it.
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
    float side;    // arealight_lit_side
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
    local.side = arealight_lit_side(offset, light.normal, AREALIGHT_HAS_TWO_SIDED && light.two_sided,
                                    arealight_position_error(point.position));
#if AREALIGHT_LIGHT_TEXTURES
    local.image = light.image;
#endif
    return light.vertex_count != 0u && local.side != 0.0;
}

// The vector form factor of the outline of vertices `first` to `end` - 1, not empty, in a space, clipped at
// its horizon.
vec3 arealight_outline_in_space(mat3 space, vec3 center, mat3 to_frame, uint first, uint end, float front) {
    vec3 in_space = space * center;
    mat3 to_space = space * to_frame;
    ArealightOutline outline = arealight_outline_begin(in_space);
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
    return arealight_is_finite(heights) ? arealight_outline_vector(outline, front) : vec3(0.0);
}

// The same, clipped at the surface's horizon first.
vec3 arealight_outline_above_surface(mat3 space, vec3 center, mat3 to_frame, uint first, uint end,
                                     float front) {
    ArealightClippedOutline clipped = arealight_clipped_begin(
        center + to_frame * arealight_bridge_vertex(end - 1u), space * center);
    float heights = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 vertex = center + to_frame * arealight_bridge_vertex(index);
        arealight_clipped_vertex(clipped, space, vertex);
        heights += vertex.z;
    }
    return arealight_is_finite(heights) ? arealight_clipped_vector(clipped, front) : vec3(0.0);
}

// The vector form factor of an outline that is seen from its front (1) or its back (-1), as the options have
// it.
vec3 arealight_outline_form_factor(mat3 space, vec3 center, mat3 to_frame, uint first, uint end,
                                   float front) {
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        return arealight_outline_above_surface(space, center, to_frame, first, end, front);
    }
    return arealight_outline_in_space(space, center, to_frame, first, end, front);
}

// The vector form factor of facets of the outline of vertices `first` to `end` - 1, not empty, clipped at the
// horizon of their axes.
vec3 arealight_facet_outline_in_axes(ArealightFacets facets, vec3 center, mat3 to_frame, uint first,
                                     uint end) {
    vec3 in_axes = facets.to_axes * center;
    mat3 to_axes = facets.to_axes * to_frame;
    ArealightFacetOutline outline = arealight_facet_begin(in_axes + to_axes
                                                          * arealight_bridge_vertex(end - 1u));
    float heights = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 vertex = in_axes + to_axes * arealight_bridge_vertex(index);
        arealight_facet_vertex(outline, facets, vertex);
        heights += vertex.z;
    }
    return arealight_is_finite(heights) ? arealight_facet_vector(outline, facets) : vec3(0.0);
}

// The same, clipped at the surface's horizon first: that of a coat's axes is another one.
vec3 arealight_facet_outline_above_surface(ArealightFacets facets, vec3 center, mat3 to_frame, uint first,
                                           uint end) {
    ArealightFacetLoop outline = arealight_facet_loop();
    vec3 previous = center + to_frame * arealight_bridge_vertex(end - 1u);
    float heights = 0.0;
    for (uint index = first; index < end; index++) {
        vec3 vertex = center + to_frame * arealight_bridge_vertex(index);
        bool is_above = vertex.z > 0.0;
        if (is_above != (previous.z > 0.0)) {
            vec3 cut = is_above ? arealight_cut(vertex, previous) : arealight_cut(previous, vertex);
            arealight_facet_loop_vertex(outline, facets, facets.to_axes * cut);
        }
        if (is_above) {
            arealight_facet_loop_vertex(outline, facets, facets.to_axes * vertex);
        }
        heights += vertex.z;
        previous = vertex;
    }
    return arealight_is_finite(heights) ? arealight_facet_loop_vector(outline, facets) : vec3(0.0);
}

// The vector form factor of facets of an outline, as the options have it.
vec3 arealight_facet_outline(ArealightFacets facets, vec3 center, mat3 to_frame, uint first, uint end) {
    if (AREALIGHT_CLIPS_AT_SURFACE) {
        if (AREALIGHT_HAS_COAT_NORMAL) {
            return arealight_facet_outline_above_surface(facets, center, to_frame, first, end);
        }
    }
    return arealight_facet_outline_in_axes(facets, center, to_frame, first, end);
}

bool arealight_has_facet_form_factor(ArealightLocalPolygon local) {
#if AREALIGHT_LIGHT_TEXTURES
    return !AREALIGHT_HAS_TEXTURED_POLYGONS || local.image.layer == AREALIGHT_NO_IMAGE;
#else
    return true;
#endif
}

vec3 arealight_facet_form_factor(ArealightFacets facets, ArealightLocalPolygon local) {
    float front = AREALIGHT_HAS_TWO_SIDED ? local.side : 1.0;
    return front * arealight_facet_outline(facets, local.center, local.to_frame, local.first, local.end);
}

vec3 arealight_vector_form_factor(mat3 space, ArealightLocalPolygon local) {
    float front = AREALIGHT_HAS_TWO_SIDED ? local.side : 1.0;
    return front * arealight_outline_form_factor(space, local.center, local.to_frame, local.first, local.end,
                                                 front);
}

vec3 arealight_image_average(mat3 space, ArealightLocalPolygon local, vec3 vector) {
#if AREALIGHT_LIGHT_TEXTURES
    if (AREALIGHT_HAS_TEXTURED_POLYGONS && local.image.layer != AREALIGHT_NO_IMAGE) {
        return arealight_footprint(arealight_lobe_image(local.image, space * local.center, space
                                                        * local.to_frame), vector);
    }
#endif
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
// The solid angle of the outline of vertices `first` to `end` - 1, not empty, as a fan about the first.
float arealight_outline_solid_angle(vec3 center, mat3 to_frame, uint first, uint end) {
    vec3 origin = arealight_bridge_vertex(first);
    center += to_frame * origin;
    vec3 apex = arealight_unit(center);
    ArealightFanVertex from = arealight_fan_vertex(center, vec3(0.0));
    vec2 turn = vec2(1.0, 0.0);
    for (uint index = first + 1u; index < end; index++) {
        vec3 offset = to_frame * (arealight_bridge_vertex(index) - origin);
        ArealightFanVertex to = arealight_fan_vertex(center + offset, offset);
        turn = arealight_fan_turned(turn, apex, from, to);
        from = to;
    }
    return arealight_fan_solid_angle(turn);
}

float arealight_solid_angle(ArealightLocalPolygon local) {
    return arealight_outline_solid_angle(local.center, local.to_frame, local.first, local.end);
}
#endif

AREALIGHT_LIGHT_KIND(ArealightPolygonLight, ArealightLocalPolygon, AREALIGHT_LOOPED_LOBES)

#endif
