#ifndef AREALIGHT_FORM_FACTOR_HALF_VECTORS_GLSL
#define AREALIGHT_FORM_FACTOR_HALF_VECTORS_GLSL

#include "arealight/form_factor/quad.glsl"

// The vector form factor, of facets, of a polygon that they mirror to the viewer: the polygon's directions,
// turned into half vectors and stretched so that GGX's alpha is 1. There the visible normals are a clamped
// cosine about the stretched view (Heitz 2018, Sampling the GGX Distribution of Visible Normals), so that an
// outline of theirs is integrated by arcs as that of any polygon is.
//
// An edge of the light is an arc of a great circle, e(t) = (1 - t)^2 a + 2 t (1 - t) m + t^2 b up to its
// length, m being the middle direction over the cosine of half the angle. Its half vectors e(t) + |e(t)| v
// are quadratic in t as well: an arc of a conic, whose control points are a + v, (a + b) / |a + b| + v |a +
// b| / 2 and b + v. No linear map leads there; chords do, from the ends to the shoulder of the conic, with
// what they lack added by the triangle that they make: two of an edge, more of the parts of one that bends
// far. Where chords meet is fixed by the edge alone, so that a light cut in two sends what it did, up to the
// chords' error: an edge has an error of at most 3e-4 of a form factor, on average 1e-4 if it bends far.

// What the facets of a surface are and who sees them.
struct ArealightFacets {
    // A rotation, from the shading frame into the axes of the distribution: x along the first alpha, z the
    // normal
    mat3 to_axes;
    vec2 alpha;   // along x and along y, from AREALIGHT_MIN_ALPHA
    vec3 view;    // the direction to the viewer in these axes, unit, not below the surface
};

// An arc of a conic about the origin, by its control points: rational and quadratic, of the points'
// directions.
struct ArealightConic {
    vec3 first;
    vec3 control;
    vec3 last;
};

// An edge, or a part of one, is halved where the middle of its half vectors is farther from an end than an
// angle of this cosine.
const float AREALIGHT_BENT = 0.7;
// Parts of an edge from this one on are not: after five halvings.
const uint AREALIGHT_LAST_PARTS = 32u;

// What two chords of a conic lack, over the triangle that they make with the third: 1/3 of a parabola, 0.57
// of a half circle.
const float AREALIGHT_CONIC_SEGMENT = 0.4;

// The shoulder of a conic, and what its halves have for control points: x control, y shoulder, z control.
// Both halves are alike there.
mat3 arealight_conic_shoulder(ArealightConic conic) {
    float first = inversesqrt(max(dot(conic.first, conic.first), AREALIGHT_LEAST_SQUARE));
    float last = inversesqrt(max(dot(conic.last, conic.last), AREALIGHT_LEAST_SQUARE));
    float part = 1.0 / (1.0 + sqrt(first / last));
    vec3 left = mix(conic.first, conic.control, part);
    vec3 right = mix(conic.control, conic.last, part);
    return mat3(left, mix(left, right, part), right);
}

// The first half of a conic, or the second.
ArealightConic arealight_conic_half(ArealightConic conic, bool second) {
    mat3 at = arealight_conic_shoulder(conic);
    return second ? ArealightConic(at[1], at[2], conic.last) : ArealightConic(conic.first, at[0], at[1]);
}

// Part `part` of a conic: 1 is all of it, 2 n and 2 n + 1 are the halves of n.
ArealightConic arealight_conic_part(ArealightConic conic, uint part) {
    // Of an int: naga takes findMSB of a uint for a uint
    for (int bit = findMSB(int(part)) - 1; bit >= 0; bit--) {
        conic = arealight_conic_half(conic, ((part >> bit) & 1u) != 0u);
    }
    return conic;
}

// The arcs of a conic, by two chords of each of its parts and what they lack.
vec3 arealight_conic_arcs(ArealightConic conic) {
    vec3 arcs = vec3(0.0);
    uint part = 1u;
    do {
        ArealightConic piece = arealight_conic_part(conic, part);
        vec3 first = arealight_unit(piece.first);
        vec3 middle = arealight_unit(arealight_conic_shoulder(piece)[1]);
        vec3 last = arealight_unit(piece.last);
        bool is_bent = min(dot(first, middle), dot(last, middle)) < AREALIGHT_BENT;
        if (is_bent && part < AREALIGHT_LAST_PARTS) {
            part *= 2u;
        } else {
            float lacking = dot(middle, cross(middle - first, last - first));
            arcs += arealight_arc(first, middle) + arealight_arc(middle, last)
                + (AREALIGHT_CONIC_SEGMENT * lacking) * middle;
            // On to the next, up from second halves
            part += 1u;
            part >>= findLSB(part);
        }
    } while (part != 1u);
    return arcs;
}

// The arcs of the half vectors of an edge between two directions in the axes, unit vectors.
vec3 arealight_facet_edge(ArealightFacets facets, vec3 from, vec3 to) {
    vec3 sum = from + to;
    float square = max(dot(sum, sum), AREALIGHT_LEAST_SQUARE);
    float per_length = inversesqrt(square);
    vec3 shrink = vec3(1.0 / facets.alpha, 1.0);
    return arealight_conic_arcs(ArealightConic(shrink * (from + facets.view), shrink
                                               * (per_length * (sum + (0.5 * square) * facets.view)),
                                               shrink * (to + facets.view)));
}

// The vector form factor of light from everywhere above the horizon of the axes.
vec3 arealight_facet_sky(ArealightFacets facets) {
    vec3 arcs = vec3(0.0);
    vec3 from = vec3(1.0, 0.0, 0.0);
    for (int quarter = 0; quarter < 4; quarter++) {
        vec3 to = vec3(from.y, -from.x, 0.0);
        arcs += arealight_facet_edge(facets, from, to);
        from = to;
    }
    return AREALIGHT_PER_ARC * arcs;
}

// The vector form factor of a convex quad in the shading frame, clipped at the horizon of the axes. Of a
// light seen from its front its product with arealight_facet_pole is not negative.
vec3 arealight_facet_quad(ArealightFacets facets, ArealightQuad quad) {
    quad = arealight_transformed(facets.to_axes, quad);
    if (arealight_highest(quad) <= 0.0) {
        return vec3(0.0);
    }
    vec3 fifth = quad.d;
    int count = 4;
    if (arealight_lowest(quad) < 0.0) {
        ArealightCutQuad cut = arealight_cut_at_horizon(quad);
        quad = ArealightQuad(cut.entry, cut.a, cut.b, cut.c);
        fifth = cut.exit;
        count = 5;
    }
    vec3 arcs = vec3(0.0);
    vec3 from = arealight_unit(fifth);
    for (int index = 0; index < count; index++) {
        vec3 vertex = index == 0 ? quad.a : index == 1 ? quad.b : index == 2 ? quad.c : index == 3 ? quad.d
            : fifth;
        vec3 to = arealight_unit(vertex);
        arcs += arealight_facet_edge(facets, from, to);
        from = to;
    }
    return AREALIGHT_PER_ARC * arcs;
}

// Any simple polygon, vertex by vertex in the axes, clipped at their horizon.
struct ArealightFacetOutline {
    vec3 arcs;
    vec3 previous; // the vertex before
    vec3 first;    // of what is left, unit vectors
    vec3 last;
    bool begun;
};

// Begins at the polygon's last vertex.
ArealightFacetOutline arealight_facet_begin(vec3 last) {
    return ArealightFacetOutline(vec3(0.0), last, vec3(0.0), vec3(0.0), false);
}

// Goes on to a vertex of what is left.
void arealight_facet_add(inout ArealightFacetOutline outline, ArealightFacets facets, vec3 vertex) {
    vec3 unit = arealight_unit(vertex);
    if (outline.begun) {
        outline.arcs += arealight_facet_edge(facets, outline.last, unit);
    } else {
        outline.first = unit;
        outline.begun = true;
    }
    outline.last = unit;
}

// Goes on to the polygon's next vertex.
void arealight_facet_vertex(inout ArealightFacetOutline outline, ArealightFacets facets, vec3 vertex) {
    bool is_above = vertex.z > 0.0;
    if (is_above != (outline.previous.z > 0.0)) {
        arealight_facet_add(outline, facets, is_above ? arealight_cut(vertex, outline.previous)
                            : arealight_cut(outline.previous, vertex));
    }
    if (is_above) {
        arealight_facet_add(outline, facets, vertex);
    }
    outline.previous = vertex;
}

// Its vector form factor, when all vertices have come.
vec3 arealight_facet_vector(ArealightFacetOutline outline, ArealightFacets facets) {
    if (outline.begun) {
        outline.arcs += arealight_facet_edge(facets, outline.last, outline.first);
    }
    return AREALIGHT_PER_ARC * outline.arcs;
}

// The same where the last vertex is not known before the others.
struct ArealightFacetLoop {
    ArealightFacetOutline outline;
    vec3 start; // the first vertex, which comes again at the end
    bool begun;
};

ArealightFacetLoop arealight_facet_loop() {
    return ArealightFacetLoop(arealight_facet_begin(vec3(0.0)), vec3(0.0), false);
}

// Goes on to the polygon's next vertex, in the axes.
void arealight_facet_loop_vertex(inout ArealightFacetLoop polygon, ArealightFacets facets, vec3 vertex) {
    if (polygon.begun) {
        arealight_facet_vertex(polygon.outline, facets, vertex);
    } else {
        polygon.start = vertex;
        polygon.outline.previous = vertex;
        polygon.begun = true;
    }
}

// Its vector form factor, when all vertices have come.
vec3 arealight_facet_loop_vector(ArealightFacetLoop polygon, ArealightFacets facets) {
    if (polygon.begun) {
        arealight_facet_vertex(polygon.outline, facets, polygon.start);
    }
    return arealight_facet_vector(polygon.outline, facets);
}

#endif
