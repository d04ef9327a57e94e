#ifndef AREALIGHT_SOLID_ANGLE_GLSL
#define AREALIGHT_SOLID_ANGLE_GLSL

#include "arealight/form_factor/arc.glsl"
#include "arealight/form_factor/arctangent.glsl"
#include "arealight/form_factor/quad.glsl"

// Solid angles of polygons: a fan of triangles about a point of the plane, whose half angles are turns of the
// plane. Their product is one turn, and one arctangent gives all of it; a flat outline covers at most 2 pi,
// so that nothing is ambiguous. Source: Van Oosterom and Strackee 1983.
//
// Error: 1e-6, and as that of a form factor where the point is near the plane or the outline.

// A vertex of a fan, from the shading point.
struct ArealightFanVertex {
    vec3 unit;
    vec3 offset; // from the fan's point, over the vertex's distance: it keeps what is small
};

ArealightFanVertex arealight_fan_vertex(vec3 vertex, vec3 offset) {
    float reciprocal = inversesqrt(max(dot(vertex, vertex), AREALIGHT_LEAST_SQUARE));
    return ArealightFanVertex(vertex * reciprocal, offset * reciprocal);
}

// `turn` (a unit vector, (1, 0) at first) with the half angle of a triangle; `apex` is the direction of the
// fan's point, unit.
vec2 arealight_fan_turned(vec2 turn, vec3 apex, ArealightFanVertex a, ArealightFanVertex b) {
    float sine = dot(apex, cross(a.offset, b.offset));
    float cosine = 1.0 + dot(apex, a.unit) + dot(apex, b.unit) + dot(a.unit, b.unit);
    vec2 product = vec2(turn.x * cosine - turn.y * sine, turn.x * sine + turn.y * cosine);
    return product * inversesqrt(max(dot(product, product), AREALIGHT_LEAST_SQUARE));
}

// The solid angle of a whole fan: in [0, 2 pi], 0 for NaN.
float arealight_fan_solid_angle(vec2 turn) {
    float half_angle = abs(arealight_arctangent(turn.y, turn.x));
    return half_angle < 4.0 ? 2.0 * half_angle : 0.0;
}

// The solid angle of a convex quad from the shading point, of either side.
float arealight_quad_solid_angle(ArealightQuad quad) {
    vec3 apex = arealight_unit(quad.a);
    ArealightFanVertex b = arealight_fan_vertex(quad.b, quad.b - quad.a);
    ArealightFanVertex c = arealight_fan_vertex(quad.c, quad.c - quad.a);
    ArealightFanVertex d = arealight_fan_vertex(quad.d, quad.d - quad.a);
    vec2 turn = arealight_fan_turned(vec2(1.0, 0.0), apex, b, c);
    return arealight_fan_solid_angle(arealight_fan_turned(turn, apex, c, d));
}

#endif
