#ifndef AREALIGHT_FORM_FACTOR_QUAD_GLSL
#define AREALIGHT_FORM_FACTOR_QUAD_GLSL

#include "arealight/form_factor/arc.glsl"

// The vector form factor of a convex quad, clipped at the horizon z = 0 of its space: by branches that the
// invocations of a wave mostly agree on (wholly below, wholly above, crossing with one, two or three vertices
// above), without an array or a table of cases. A vertex below the horizon is never normalised.
//
// What is promised of form factors, and tested (docs/stability.md), for vertices from the shading point in a
// space whose z axis is the normal (diffuse) or in a lobe's cosine space, at distances from 1e-14 to 1e18:
//
//   1. Any bits in, a finite number in [0, 1] out (arealight_form_factor).
//   2. The result is within 6e-7 of the interval of values that the polygons have whose vertices differ by at
//      most 4 x 2^-24 of their distance.
//   3. Its error is at most 1e-6 + 1e-7 / rho, rho being the distance to the polygon over that to its
//      farthest vertex.
//   4. Of a light of area A at n >= 5 times its extent, d, it is at most 8e-7 n A / (pi d^2); of one that
//      crosses the horizon 1e-5 n A / (pi d^2).
//
// They assume square roots and divisions that round to the last place or nearly: on a device that takes all
// that Vulkan allows, 2 to 4.5 units, count on as many times the error. `arealight bench stability` measures
// it.

// The vertices of a convex quad in the order of its outline; a triangle has one of them twice.
struct ArealightQuad {
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 d;
};

ArealightQuad arealight_transformed(mat3 space, ArealightQuad quad) {
    return ArealightQuad(space * quad.a, space * quad.b, space * quad.c, space * quad.d);
}

float arealight_lowest(ArealightQuad quad) {
    return min(min(quad.a.z, quad.b.z), min(quad.c.z, quad.d.z));
}

float arealight_highest(ArealightQuad quad) {
    return max(max(quad.a.z, quad.b.z), max(quad.c.z, quad.d.z));
}

// A quad that crosses the horizon, turned so that a is above it and d is not: of the vertices above a is the
// first.
ArealightQuad arealight_turned(ArealightQuad quad) {
    bvec4 above = greaterThan(vec4(quad.a.z, quad.b.z, quad.c.z, quad.d.z), vec4(0.0));
    if ((above.z && !above.y) || (above.w && !above.z)) {
        quad = ArealightQuad(quad.c, quad.d, quad.a, quad.b);
    }
    if ((above.y && !above.x) || (above.w && !above.z)) {
        quad = ArealightQuad(quad.b, quad.c, quad.d, quad.a);
    }
    return quad;
}

// What is above the horizon of a quad that crosses it, as five vertices in the order of the outline: from
// where it comes up to where it goes down. With fewer than three vertices above, the last ones are the same.
struct ArealightCutQuad {
    vec3 entry;
    vec3 a;
    vec3 b;
    vec3 c;
    vec3 exit;
    bool has_c; // three vertices are above
};

ArealightCutQuad arealight_cut_at_horizon(ArealightQuad quad) {
    ArealightQuad turned = arealight_turned(quad);
    bool b_above = turned.b.z > 0.0;
    bool c_above = b_above && turned.c.z > 0.0;
    vec3 entry = arealight_cut(turned.a, turned.d);
    vec3 exit = arealight_cut(c_above ? turned.c : b_above ? turned.b : turned.a,
                              c_above ? turned.d : b_above ? turned.c : turned.b);
    return ArealightCutQuad(entry, turned.a, b_above ? turned.b : exit, c_above ? turned.c : exit, exit,
                            c_above);
}

// The arcs around what is above the horizon of a quad that crosses it: from where the outline comes up to a,
// on to b and c as far as they are above, to where it goes down, and back along the horizon.
vec3 arealight_quad_crossing(ArealightQuad quad, float front) {
    ArealightQuad turned = arealight_turned(quad);
    vec3 last = arealight_unit(turned.a);
    vec3 next = turned.b;
    vec3 entry = vec3(arealight_crossing(last, turned.d), 0.0);
    vec3 arcs = arealight_arc(entry, last);
    if (turned.b.z > 0.0) {
        vec3 b = arealight_unit(turned.b);
        arcs += arealight_arc(last, b);
        last = b;
        next = turned.c;
        if (turned.c.z > 0.0) {
            vec3 c = arealight_unit(turned.c);
            arcs += arealight_arc(last, c);
            last = c;
            next = turned.d;
        }
    }
    vec3 exit = vec3(arealight_crossing(last, next), 0.0);
    arcs += arealight_arc(last, exit);
    return arcs + arealight_horizon_arc(exit.xy, entry.xy, -arcs.z, front);
}

// The arcs around a quad of unit vectors whose edges are all acute, from their cosines: the product of the
// diagonals by one edge's weight, and what the others' weights differ by. So what is alike of a small quad's
// edges does not have to cancel. Error of the form factor: 4e-7; promise 4.
vec3 arealight_acute_arcs(ArealightQuad unit, vec4 cosine) {
    vec4 weight = vec4(arealight_acute_weight(cosine.x), arealight_acute_weight(cosine.y),
                       arealight_acute_weight(cosine.z), arealight_acute_weight(cosine.w));
    return weight.x * cross(unit.c - unit.a, unit.d - unit.b)
         + (weight.y - weight.x) * cross(unit.b, unit.c)
         + (weight.z - weight.x) * cross(unit.c, unit.d)
         + (weight.w - weight.x) * cross(unit.d, unit.a);
}

// The vector form factor of a convex quad. Seen from its front z is positive. `front`: 1 where it is known to
// be seen from there, -1 from its back, 0 where that is not known (arealight_horizon_arc).
vec3 arealight_quad_vector(ArealightQuad quad, float front) {
    vec3 arcs = vec3(0.0);
    // First what most waves are: wholly above, with acute edges
    if (arealight_lowest(quad) > 0.0) {
        // No length is 0
        ArealightQuad unit = ArealightQuad(quad.a * inversesqrt(dot(quad.a, quad.a)),
                                           quad.b * inversesqrt(dot(quad.b, quad.b)),
                                           quad.c * inversesqrt(dot(quad.c, quad.c)),
                                           quad.d * inversesqrt(dot(quad.d, quad.d)));
        vec4 cosine = vec4(dot(unit.a, unit.b), dot(unit.b, unit.c), dot(unit.c, unit.d),
                           dot(unit.d, unit.a));
        if (min(min(cosine.x, cosine.y), min(cosine.z, cosine.w)) > 0.0) {
            arcs = arealight_acute_arcs(unit, cosine);
        } else {
            arcs = arealight_arc(unit.a, unit.b) + arealight_arc(unit.b, unit.c)
                 + arealight_arc(unit.c, unit.d) + arealight_arc(unit.d, unit.a);
        }
    } else if (arealight_highest(quad) > 0.0) {
        arcs = arealight_quad_crossing(quad, front);
    }
    return AREALIGHT_PER_ARC * arcs;
}

// The same where the side is not known.
vec3 arealight_quad_vector(ArealightQuad quad) {
    return arealight_quad_vector(quad, 0.0);
}

#endif
