#ifndef AREALIGHT_QUAD_LIGHT_GLSL
#define AREALIGHT_QUAD_LIGHT_GLSL

#include "arealight/form_factor/quad.glsl"
#include "arealight/options.glsl"
#if AREALIGHT_SOLID_ANGLES
#include "arealight/form_factor/solid_angle.glsl"
#endif
#include "arealight/light_kind.glsl"

// A convex, flat quad of constant radiance (a triangle has a vertex twice), counter-clockwise seen from its
// front.
struct ArealightQuadLight {
    vec3 radiance;      // of the front, W/(m^2 sr)
    vec3 center;        // near the middle, relative to the origin of ArealightSurface.position
    vec3 normal;        // of the front, unit; zero for a quad without area, which gives no light
    ArealightQuad quad; // from the center
    bool two_sided;     // the back emits too (with AREALIGHT_TWO_SIDED)
};

// A quad in the shading frame, cut at the surface's horizon with AREALIGHT_SURFACE_HORIZON.
struct ArealightLocalQuad {
    ArealightQuad quad;     // from the shading point
    // What the cut leaves beside a quad where three vertices are above, its last vertex twice
    ArealightQuad triangle;
    bool has_triangle;
    float side;             // arealight_lit_side
};

// A quad in the shading frame, whose vertices are offsets from `center`.
ArealightQuad arealight_quad_in_frame(mat3 to_frame, vec3 center, ArealightQuad quad) {
    return ArealightQuad(center + to_frame * quad.a, center + to_frame * quad.b, center + to_frame * quad.c,
                         center + to_frame * quad.d);
}

// Whether every coordinate is finite.
bool arealight_is_finite(ArealightQuad quad) {
    uvec3 sign_bit = uvec3(0x7fffffffu);
    uvec3 ab = max(floatBitsToUint(quad.a) & sign_bit, floatBitsToUint(quad.b) & sign_bit);
    uvec3 cd = max(floatBitsToUint(quad.c) & sign_bit, floatBitsToUint(quad.d) & sign_bit);
    uvec3 largest = max(ab, cd);
    return max(largest.x, max(largest.y, largest.z)) < 0x7f800000u;
}

// Cuts a quad at the surface's horizon. False where nothing is left.
bool arealight_cut_local(inout ArealightLocalQuad local) {
    if (arealight_highest(local.quad) <= 0.0) {
        return false;
    }
    if (arealight_lowest(local.quad) < 0.0) {
        ArealightCutQuad cut = arealight_cut_at_horizon(local.quad);
        local.quad = ArealightQuad(cut.entry, cut.a, cut.b, cut.c);
        local.triangle = ArealightQuad(cut.entry, cut.c, cut.exit, cut.exit);
        local.has_triangle = cut.has_c;
    }
    return true;
}

bool arealight_to_local(ArealightPoint point, ArealightQuadLight light, out ArealightLocalQuad local) {
    vec3 offset = light.center - point.position;
    local.side = arealight_lit_side(offset, light.normal, AREALIGHT_HAS_TWO_SIDED && light.two_sided,
                                    arealight_position_error(point.position));
    bool lit = local.side != 0.0 && arealight_is_finite(light.quad);
    if (lit) {
        local.quad = arealight_quad_in_frame(point.to_frame, point.to_frame * offset, light.quad);
        local.has_triangle = false;
        if (AREALIGHT_CLIPS_AT_SURFACE) {
            lit = arealight_cut_local(local);
        }
    }
    return lit;
}

vec3 arealight_vector_form_factor(mat3 space, ArealightLocalQuad local) {
    float front = AREALIGHT_HAS_TWO_SIDED ? local.side : 1.0;
    vec3 vector = arealight_quad_vector(arealight_transformed(space, local.quad), front);
    if (AREALIGHT_CLIPS_AT_SURFACE && local.has_triangle) {
        vector += arealight_quad_vector(arealight_transformed(space, local.triangle), front);
    }
    return front * vector;
}

bool arealight_has_facet_form_factor(ArealightLocalQuad local) {
    return true;
}

vec3 arealight_facet_form_factor(ArealightFacets facets, ArealightLocalQuad local) {
    vec3 vector = arealight_facet_quad(facets, local.quad);
    if (AREALIGHT_CLIPS_AT_SURFACE && local.has_triangle) {
        vector += arealight_facet_quad(facets, local.triangle);
    }
    return AREALIGHT_HAS_TWO_SIDED ? local.side * vector : vector;
}

vec3 arealight_image_average(mat3 space, ArealightLocalQuad local, vec3 vector) {
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
float arealight_solid_angle(ArealightLocalQuad local) {
    return arealight_quad_solid_angle(local.quad);
}
#endif

AREALIGHT_LIGHT_KIND(ArealightQuadLight, ArealightLocalQuad, AREALIGHT_UNROLLED_LOBES)

#endif
