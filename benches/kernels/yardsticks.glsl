#ifndef YARDSTICKS_GLSL
#define YARDSTICKS_GLSL

// The form factors of quads as others compute them, a school each, for comparison only: the hard cases break
// all of them.
//
// | school         | who ships it             | how                                                                       |
// |----------------|--------------------------|---------------------------------------------------------------------------|
// | sphere horizon | EEVEE, LearnOpenGL       | nothing is clipped; the vector form factor is taken for a clipped sphere's |
// | clipless       | three.js, HDRP's default | the same, with a rational function in place of the clipped sphere         |
// | clip by cases  | Bevy, Godot, ltc_code    | one of 16 cases of vertices above the horizon gives up to five vertices   |
//
// Their edges are the same: Hill and Heitz 2016, "Real-Time Area Lighting: a Journey from Research to
// Production". Written anew from the published descriptions. Vertices are in a lobe's cosine space, clockwise
// about the way to the light, that is seen from its front. Form factors are in [0, 1], but for rounding.

#include "clipped_sphere.glsl"

// The values of METHOD; see YardstickSchool in benches/src/method.rs.
const int YARDSTICK_SPHERE_HORIZON = 0;
const int YARDSTICK_CLIPLESS = 1;
const int YARDSTICK_CLIP_BY_CASES = 2;

// An edge between unit vectors: theta / sin(theta) / 2 pi, as a rational function of the cosine that is
// guarded where the ends are opposite, times a x b.
vec3 yardstick_edge(vec3 a, vec3 b) {
    float x = dot(a, b);
    float y = abs(x);
    float numerator = 0.8543985 + (0.4965155 + 0.0145206 * y) * y;
    float denominator = 3.4175940 + (4.1616724 + y) * y;
    float weight = numerator / denominator;
    weight = x > 0.0 ? weight : 0.5 * inversesqrt(max(1.0 - x * x, 1e-7)) - weight;
    return cross(a, b) * weight;
}

// The form factor of a polygon by what its edges sum up to, for the two schools that clip nothing. `sum`
// points away from the light.
float yardstick_unclipped(int method, vec3 sum) {
    float form_factor = length(sum);
    if (method == YARDSTICK_CLIPLESS) {
        return max((form_factor * form_factor - sum.z) / (form_factor + 1.0), 0.0);
    }
    return clipped_sphere(min(form_factor, 1.0), -sum.z / form_factor);
}

// Where the edge from `above` to `below` meets the horizon, up to a positive factor.
vec3 yardstick_crossing(vec3 above, vec3 below) {
    return above.z * below - below.z * above;
}

// Clips a quad of v[0] to v[3] at the horizon into v[0] to v[4]: returns how many vertices are left, 0, 3, 4
// or 5.
int yardstick_clip(inout vec3 v[5]) {
    int above = (v[0].z > 0.0 ? 1 : 0) + (v[1].z > 0.0 ? 2 : 0) + (v[2].z > 0.0 ? 4 : 0)
        + (v[3].z > 0.0 ? 8 : 0);
    switch (above) {
    case 1: // v[0] is above
        v[2] = yardstick_crossing(v[0], v[3]);
        v[1] = yardstick_crossing(v[0], v[1]);
        return 3;
    case 2: // v[1]
        v[0] = yardstick_crossing(v[1], v[0]);
        v[2] = yardstick_crossing(v[1], v[2]);
        return 3;
    case 3: // v[0] and v[1]
        v[2] = yardstick_crossing(v[1], v[2]);
        v[3] = yardstick_crossing(v[0], v[3]);
        return 4;
    case 4: // v[2]
        v[0] = yardstick_crossing(v[2], v[3]);
        v[1] = yardstick_crossing(v[2], v[1]);
        return 3;
    case 6: // v[1] and v[2]
        v[0] = yardstick_crossing(v[1], v[0]);
        v[3] = yardstick_crossing(v[2], v[3]);
        return 4;
    case 7: // all but v[3]
        v[4] = yardstick_crossing(v[0], v[3]);
        v[3] = yardstick_crossing(v[2], v[3]);
        return 5;
    case 8: // v[3]
        v[0] = yardstick_crossing(v[3], v[0]);
        v[1] = yardstick_crossing(v[3], v[2]);
        v[2] = v[3];
        return 3;
    case 9: // v[3] and v[0]
        v[1] = yardstick_crossing(v[0], v[1]);
        v[2] = yardstick_crossing(v[3], v[2]);
        return 4;
    case 11: // all but v[2]
        v[4] = v[3];
        v[3] = yardstick_crossing(v[3], v[2]);
        v[2] = yardstick_crossing(v[1], v[2]);
        return 5;
    case 12: // v[2] and v[3]
        v[1] = yardstick_crossing(v[2], v[1]);
        v[0] = yardstick_crossing(v[3], v[0]);
        return 4;
    case 13: // all but v[1]
        v[4] = v[3];
        v[3] = v[2];
        v[2] = yardstick_crossing(v[2], v[1]);
        v[1] = yardstick_crossing(v[0], v[1]);
        return 5;
    case 14: // all but v[0]
        v[4] = yardstick_crossing(v[3], v[0]);
        v[0] = yardstick_crossing(v[1], v[0]);
        return 5;
    case 15:
        return 4;
    default: // None, or opposite ones alone, which a plane convex quad never has
        return 0;
    }
}

// The form factor of a quad that is clipped by cases.
float yardstick_clipped(vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    vec3 v[5] = vec3[](v0, v1, v2, v3, v3);
    int count = yardstick_clip(v);
    if (count == 0) {
        return 0.0;
    }
    vec3 first = normalize(v[0]);
    vec3 second = normalize(v[1]);
    vec3 third = normalize(v[2]);
    vec3 fourth = count > 3 ? normalize(v[3]) : first;
    float z = yardstick_edge(first, second).z + yardstick_edge(second, third).z
        + yardstick_edge(third, fourth).z;
    if (count == 4) {
        z += yardstick_edge(fourth, first).z;
    } else if (count == 5) {
        vec3 fifth = normalize(v[4]);
        z += yardstick_edge(fourth, fifth).z + yardstick_edge(fifth, first).z;
    }
    return max(-z, 0.0);
}

// The form factor of a quad.
float yardstick_quad(int method, vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    if (method == YARDSTICK_CLIP_BY_CASES) {
        return yardstick_clipped(v0, v1, v2, v3);
    }
    v0 = normalize(v0);
    v1 = normalize(v1);
    v2 = normalize(v2);
    v3 = normalize(v3);
    return yardstick_unclipped(method, yardstick_edge(v0, v1) + yardstick_edge(v1, v2)
                               + yardstick_edge(v2, v3)
                                           + yardstick_edge(v3, v0));
}

#endif
