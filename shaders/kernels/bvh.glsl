#ifndef BVH_GLSL
#define BVH_GLSL

// Rays through a binary hierarchy of boxes around triangles, as arealight::Blockers builds it. The including
// kernel defines BVH_NODES_BINDING and the function bvh_meet_triangle.
//
// Nodes lie in the order in which rays come to them, an inner node's first child after it; `first` of an
// inner node is the one to go on with for a ray that misses it. So a traversal needs no stack, which would
// take 32 registers.

struct ArealightGpuBvhNode {
    vec3 min_corner;
    uint first;
    vec3 max_corner;
    uint count;
};

layout(set = 0, binding = BVH_NODES_BINDING, std430) readonly buffer Nodes {
    ArealightGpuBvhNode nodes[];
};

const uint BVH_NO_TRIANGLE = 0xffffffffu;

// Where a ray meets a triangle.
struct BvhHit {
    float distance;   // in lengths of the ray's direction
    uint triangle;    // in the order of the leaves
    vec2 barycentric; // weights of the second and the third vertex
    bool back;        // the back face was met
};

// Of the including kernel: makes `hit` that of triangle `index`, where the ray meets it nearer than
// hit.distance and is to meet it.
void bvh_meet_triangle(uint index, vec3 origin, vec3 direction, inout BvhHit hit);

// How much wider a triangle is to rays, of its edges: of two that share one a ray meets one or both, however
// a compiler rounds, and no light comes through between them.
const float BVH_SEAM = 1e-6;

// Whether a ray meets triangle `index` of these vertices, on either face, at a distance above 0 and below
// `limit`; and where. What is seen edge-on is not met. Error of the distance: 1e-6 of the largest coordinate
// over the cosine of incidence; a ray within as much of an edge may pass on either side of it. Source:
// Moeller and Trumbore 1997.
bool bvh_intersect(vec3 p0, vec3 p1, vec3 p2, uint index, vec3 origin, vec3 direction, float limit,
                   out BvhHit met) {
    vec3 edge1 = p1 - p0;
    vec3 edge2 = p2 - p0;
    vec3 p = cross(direction, edge2);
    float determinant = dot(edge1, p);
    float inverse = 1.0 / determinant;
    vec3 s = origin - p0;
    float u = dot(s, p) * inverse;
    vec3 q = cross(s, edge1);
    float v = dot(direction, q) * inverse;
    float distance = dot(edge2, q) * inverse;
    met = BvhHit(distance, index, vec2(u, v), determinant < 0.0);
    return determinant != 0.0 && min(u, v) >= -BVH_SEAM && u + v <= 1.0 + BVH_SEAM && distance > 0.0
        && distance < limit;
}

// Whether a ray enters a node's box before `limit`.
bool bvh_enters(ArealightGpuBvhNode node, vec3 origin, vec3 inverse_direction, float limit) {
    vec3 a = (node.min_corner - origin) * inverse_direction;
    vec3 b = (node.max_corner - origin) * inverse_direction;
    vec3 first = min(a, b);
    vec3 last = max(a, b);
    float enter = max(max(first.x, first.y), max(first.z, 0.0));
    // Widened by two roundings, so that a ray along a flat box is not lost
    float leave = min(min(last.x, last.y), min(last.z, limit)) * 1.0000004;
    return enter <= leave;
}

// What a ray meets before `limit`, both in lengths of its direction: the closest triangle, or with `any_hit`
// the first one that is found, which costs less. Its triangle is BVH_NO_TRIANGLE, and its distance `limit`,
// where there is none.
BvhHit bvh_trace(vec3 origin, vec3 direction, float limit, bool any_hit) {
    BvhHit hit = BvhHit(limit, BVH_NO_TRIANGLE, vec2(0.0), false);
    // A direction along an axis would divide by zero: 1e-30 reaches no box that it should not
    vec3 safe = mix(direction, vec3(1e-30), lessThan(abs(direction), vec3(1e-30)));
    vec3 inverse_direction = 1.0 / safe;
    // A root of zeros is nothing
    uint end = nodes[0].count > 0u ? 1u : nodes[0].first;
    uint index = 0u;
    while (index < end && !(any_hit && hit.triangle != BVH_NO_TRIANGLE)) {
        // On to the next leaf that is entered, so that rays side by side come to their triangles together
        uint first = 0u;
        uint count = 0u;
        while (index < end && count == 0u) {
            ArealightGpuBvhNode node = nodes[index];
            bool is_entered = bvh_enters(node, origin, inverse_direction, hit.distance);
            first = node.first;
            count = is_entered ? node.count : 0u;
            index = node.count > 0u || is_entered ? index + 1u : max(node.first, index + 1u);
        }
        for (uint i = 0u; i < count; i++) {
            bvh_meet_triangle(first + i, origin, direction, hit);
        }
    }
    return hit;
}

#endif
