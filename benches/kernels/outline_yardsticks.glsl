#ifndef OUTLINE_YARDSTICKS_GLSL
#define OUTLINE_YARDSTICKS_GLSL

// Yardsticks of polygons with any number of vertices, which they take from `yardstick_vertex`, seen from
// either side: the schools of yardsticks.glsl that clip nothing; and clip + acos, for the stability battery
// alone, which shows what is left of hard cases where everything is clipped but edges are as in the first
// listings of Heitz et al. 2016.

#include "yardsticks.glsl"

// The position of a vertex, 0 to count - 1. Defined by the kernel.
vec3 yardstick_vertex(uint index);

// As many vertices as a clipped polygon of 64 may have.
const uint YARDSTICK_CAPACITY = 130u;

// The polygon is clipped into an array (Sutherland and Hodgman 1974), its vertices are normalised, and an
// edge has the angle acos(a.b), kept off its ends, times z of the normalised a x b (Baum et al. 1989).
float yardstick_clip_and_acos(uint count) {
    // Clip
    vec3 clipped[YARDSTICK_CAPACITY];
    uint clipped_count = 0u;
    vec3 a = yardstick_vertex(count - 1u);
    for (uint index = 0u; index < count && clipped_count + 2u <= YARDSTICK_CAPACITY; index++) {
        vec3 b = yardstick_vertex(index);
        if ((a.z > 0.0) != (b.z > 0.0)) {
            clipped[clipped_count++] = mix(a, b, a.z / (a.z - b.z));
        }
        if (b.z > 0.0) {
            clipped[clipped_count++] = b;
        }
        a = b;
    }
    if (clipped_count < 3u) {
        return 0.0;
    }
    // Sum
    float sum = 0.0;
    a = normalize(clipped[clipped_count - 1u]);
    for (uint index = 0u; index < clipped_count; index++) {
        vec3 b = normalize(clipped[index]);
        float angle = acos(clamp(dot(a, b), -0.9999, 0.9999));
        sum += angle * normalize(cross(a, b)).z;
        a = b;
    }
    return abs(sum) * 0.15915494;
}

// Whether a polygon is seen from its front.
bool yardstick_is_front(uint count) {
    vec3 first = yardstick_vertex(0u);
    vec3 area = vec3(0.0);
    vec3 previous = first;
    for (uint index = 1u; index < count; index++) {
        vec3 vertex = yardstick_vertex(index);
        area += cross(previous - first, vertex - first);
        previous = vertex;
    }
    return dot(area, first) < 0.0;
}

// The two schools that clip nothing.
float yardstick_outline(int method, uint count) {
    vec3 sum = vec3(0.0);
    vec3 a = normalize(yardstick_vertex(count - 1u));
    for (uint index = 0u; index < count; index++) {
        vec3 b = normalize(yardstick_vertex(index));
        sum += yardstick_edge(a, b);
        a = b;
    }
    return yardstick_unclipped(method, yardstick_is_front(count) ? sum : -sum);
}

// The school that clips by cases, of up to four vertices; the last one of a triangle comes twice.
float yardstick_cases(uint count) {
    uint last = min(count, 4u) - 1u;
    vec3 v0 = yardstick_vertex(0u);
    vec3 v1 = yardstick_vertex(1u);
    vec3 v2 = yardstick_vertex(min(2u, last));
    vec3 v3 = yardstick_vertex(last);
    return yardstick_is_front(count) ? yardstick_clipped(v0, v1, v2, v3) : yardstick_clipped(v0, v3, v2, v1);
}

#endif
