#ifndef YARDSTICKS_GLSL
#define YARDSTICKS_GLSL

// Form factors as they are published and widely used, for comparison only: the hard cases break both. Each takes
// the vertices of a polygon from `yardstick_vertex`, and gives what it sends from either side.

// The position of a vertex, 0 to count - 1. Defined by the kernel.
vec3 yardstick_vertex(uint index);

// As many vertices as a clipped polygon of 64 may have.
const uint YARDSTICK_CAPACITY = 130u;

// The textbook's: the polygon is clipped into an array (Sutherland and Hodgman 1974), its vertices are normalised, and
// an edge has the angle acos(a.b), kept off its ends, times z of the normalised a x b (Baum et al. 1989, as in the
// first listings of Heitz et al. 2016).
float yardstick_textbook(uint count) {
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

// An edge of the practice: theta / sin(theta) / 2 pi, times the product of the unit vectors to its ends.
vec3 yardstick_practice_edge(vec3 a, vec3 b) {
    float x = dot(a, b);
    float y = abs(x);
    float numerator = 0.8543985 + (0.4965155 + 0.0145206 * y) * y;
    float denominator = 3.4175940 + (4.1616724 + y) * y;
    float weight = numerator / denominator;
    weight = x > 0.0 ? weight : 0.5 * inversesqrt(max(1.0 - x * x, 1e-7)) - weight;
    return cross(a, b) * weight;
}

// The practice of real-time engines (Hill and Heitz 2016): nothing is clipped; theta / sin(theta) is a rational
// function of the cosine, guarded where the ends are opposite; and the sum's vector is taken for a sphere's, whose
// horizon is that of (l^2 + z) / (l + 1).
float yardstick_practice(uint count) {
    vec3 sum = vec3(0.0);
    vec3 area = vec3(0.0);
    vec3 first = yardstick_vertex(0u);
    vec3 previous = yardstick_vertex(count - 1u);
    for (uint index = 0u; index < count; index++) {
        vec3 vertex = yardstick_vertex(index);
        area += cross(previous - first, vertex - first);
        vec3 a = normalize(previous);
        vec3 b = normalize(vertex);
        sum += yardstick_practice_edge(a, b);
        previous = vertex;
    }
    // Seen from the front the vertices run clockwise about the way to the light
    float z = dot(area, first) < 0.0 ? -sum.z : sum.z;
    float l = length(sum);
    return max((l * l + z) / (l + 1.0), 0.0);
}

// The practice as its users write it for four vertices, seen from the front.
float yardstick_practice_quad(vec3 v0, vec3 v1, vec3 v2, vec3 v3) {
    v0 = normalize(v0);
    v1 = normalize(v1);
    v2 = normalize(v2);
    v3 = normalize(v3);
    vec3 sum = yardstick_practice_edge(v0, v1) + yardstick_practice_edge(v1, v2) + yardstick_practice_edge(v2, v3)
             + yardstick_practice_edge(v3, v0);
    float l = length(sum);
    return max((l * l - sum.z) / (l + 1.0), 0.0);
}

#endif
