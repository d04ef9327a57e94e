#ifndef AREALIGHT_OUTLINE_SAMPLING_GLSL
#define AREALIGHT_OUTLINE_SAMPLING_GLSL

#include "arealight/options.glsl"
#include "arealight/shadows/sequence.glsl"
#include "arealight/shadows/shadow_sampling.glsl"

// Shadow rays drawn over outlines of any number of vertices, as shading points see lights of every kind: a
// polygon's or a face's vertices, or a ring of them for what is round. An outline is cut into a fan of convex
// pieces; one is chosen by its form factor.

// The host's bridge to vertices, from their light's center.
vec3 arealight_bridge_vertex(uint index);

struct ArealightShadowOutline {
    bool is_ring;   // the vertices are a ring's, not the host's
    bool is_convex; // else its pieces are triangles, and may overlap
    uint first;     // for arealight_bridge_vertex
    uint count;     // vertices, from 3 on
    vec3 center;    // from the shading point: what vertices are relative to
    // Of a ring: vertex i is at center + cos(t) axis_u + sin(t) axis_v, t = 2 pi (i + 1/2) / count
    vec3 axis_u;
    vec3 axis_v;
};

// A ray to a light.
struct ArealightShadowRay {
    vec3 direction; // unit
    float distance; // to the light
};

// Vertices of a ring that stands for an ellipse, and what makes its area the ellipse's.
const uint AREALIGHT_RING_VERTICES = 16u;
const float AREALIGHT_RING_SCALE = 1.0129962;

// The outline of an ellipse. Error of shadows: the area between it and sixteen chords, at most 1.3 % of its
// size at its rim.
ArealightShadowOutline arealight_ellipse_outline(vec3 center, vec3 axis_u, vec3 axis_v) {
    return ArealightShadowOutline(true, true, 0u, AREALIGHT_RING_VERTICES, center, AREALIGHT_RING_SCALE
                                  * axis_u,
                            AREALIGHT_RING_SCALE * axis_v);
}

// The outline of a parallelogram.
ArealightShadowOutline arealight_rectangle_outline(vec3 center, vec3 axis_u, vec3 axis_v) {
    return ArealightShadowOutline(true, true, 0u, 4u, center, 1.4142135 * axis_u, 1.4142135 * axis_v);
}

// The outline of vertices of the host's.
ArealightShadowOutline arealight_vertex_outline(vec3 center, uint first, uint count, bool is_convex) {
    return ArealightShadowOutline(false, is_convex, first, count, center, vec3(0.0), vec3(0.0));
}

vec3 arealight_outline_vertex(ArealightShadowOutline outline, uint index) {
    if (!outline.is_ring) {
        return outline.center + arealight_bridge_vertex(outline.first + index);
    }
    float angle = (6.2831853 * (float(index) + 0.5)) / float(outline.count);
    return outline.center + cos(angle) * outline.axis_u + sin(angle) * outline.axis_v;
}

// How many pieces an outline has: quads of a convex one, triangles of another.
uint arealight_outline_pieces(ArealightShadowOutline outline) {
    return outline.is_convex ? (outline.count - 1u) / 2u : outline.count - 2u;
}

// A piece, from the shading point.
ArealightQuad arealight_outline_piece(ArealightShadowOutline outline, uint piece) {
    uint first = outline.is_convex ? 2u * piece + 1u : piece + 1u;
    uint last = min(first + (outline.is_convex ? 2u : 1u), outline.count - 1u);
    return ArealightQuad(arealight_outline_vertex(outline, 0u), arealight_outline_vertex(outline, first),
                         arealight_outline_vertex(outline, first + 1u),
                             arealight_outline_vertex(outline, last));
}

// The size of an outline's form factor in the space that `to_space` leads to.
float arealight_outline_weight(ArealightShadowOutline outline, mat3 to_space) {
    float sum = 0.0;
    for (uint i = 0u; i < arealight_outline_pieces(outline); i++) {
        sum += arealight_quad_vector(arealight_transformed(to_space, arealight_outline_piece(outline, i))).z;
    }
    return abs(sum);
}

// Chooses a piece by the size of its form factor; false where none has any.
bool arealight_choose_piece(ArealightShadowOutline outline, mat3 to_space, inout float random,
                            out ArealightQuad chosen) {
    float sum = 0.0;
    for (uint i = 0u; i < arealight_outline_pieces(outline); i++) {
        ArealightQuad piece = arealight_outline_piece(outline, i);
        float weight = abs(arealight_quad_vector(arealight_transformed(to_space, piece)).z);
        if (weight > 0.0 && arealight_choose(random, sum, weight)) {
            chosen = piece;
        }
    }
    return sum > 0.0;
}

// How many triangles of an outline that is not convex a direction is in: (each counted once, each by its
// orientation).
ivec2 arealight_outline_coverage(ArealightShadowOutline outline, vec3 direction) {
    ivec2 coverage = ivec2(0);
    for (uint i = 0u; i < arealight_outline_pieces(outline); i++) {
        ArealightQuad piece = arealight_outline_piece(outline, i);
        vec3 sides = vec3(dot(direction, cross(piece.a, piece.b)), dot(direction, cross(piece.b, piece.c)),
                          dot(direction, cross(piece.c, piece.a)));
        coverage += all(greaterThan(sides, vec3(0.0))) ? ivec2(1, 1) : all(lessThan(sides, vec3(0.0)))
            ? ivec2(1, -1) : ivec2(0);
    }
    return coverage;
}

// How often a direction is drawn, until one is inside of an outline that is not convex, and above the
// surface.
const int AREALIGHT_OUTLINE_TRIES = 32;

// Draws a ray over an outline from a lobe whose cosine space `space` leads to from the shading frame.
// `random` in [0, 1)^2, uniform. False where the outline has no form factor in that space, or no draw was
// inside of it and above the surface: there is next to no light.
bool arealight_draw_ray(ArealightShadowOutline outline, mat3 to_frame, mat3 space, vec2 random,
                        out ArealightShadowRay ray) {
    mat3 to_space = space * to_frame;
    int tries = outline.is_convex && !AREALIGHT_CLIPS_AT_SURFACE ? 1 : AREALIGHT_OUTLINE_TRIES;
    for (int i = 0; i < tries; i++) {
        // Draw in a piece
        vec2 rest = random;
        random = arealight_other_random(random); // a shift of what is refused would not be uniform
        ArealightQuad piece;
        if (!arealight_choose_piece(outline, to_space, rest.x, piece)) {
            return false;
        }
        vec3 drawn = arealight_draw_quad(arealight_transformed(to_space, piece), rest);
        ray.direction = arealight_from_cosine_space(to_frame, space, drawn);
        vec3 normal = cross(piece.c - piece.a, piece.d - piece.b);
        ray.distance = clamp(dot(piece.a, normal) / dot(ray.direction, normal), 0.0, 1e30);

        // What is clipped at the surface's horizon is not drawn
        if (AREALIGHT_CLIPS_AT_SURFACE && (to_frame * ray.direction).z <= 0.0) {
            continue;
        }
        // Pieces that overlap cancel, or count as often as they overlap
        if (outline.is_convex) {
            return true;
        }
        ivec2 coverage = arealight_outline_coverage(outline, ray.direction);
        float chance = fract(rest.x * 4096.0);
        if (coverage.x == 0 || (coverage.y != 0 && chance * float(coverage.x) < 1.0)) {
            return true;
        }
    }
    return false;
}

#endif
