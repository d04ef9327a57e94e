#ifndef AREALIGHT_FACE_CLUSTER_GLSL
#define AREALIGHT_FACE_CLUSTER_GLSL

#include "arealight/form_factor/arc.glsl"

// Faces of a mesh that are one from afar. Source: crates/arealight/src/face_clusters.rs, which has the error.

// The host's bridge to the rows of meshes. A face's: the unit normal of its front in xyz, and in w how many
// vertices it has, whose rows follow. A cluster's, four before those of its faces and of the clusters within:
// its center and minus how many rows it has, these four with them; the sum of its area vectors over its area,
// and how far away it serves; the diagonal of its form, of area 1, and its radius; twice the form's xy, xz
// and yz, and its area.
vec4 arealight_bridge_face(uint index);

const uint AREALIGHT_CLUSTER_ROWS = 4u;

// What clusters need to know of a linear space.
struct ArealightSpaceSize {
    float stretch; // the square of the most that it makes a length; 2 to 3 times that for some shears
    float lower;   // one over the height that the unit ball has in it
    float volume;  // what volume, over pi
};

ArealightSpaceSize arealight_space_size(mat3 space) {
    mat3 squares = transpose(space) * space;
    vec3 rows = abs(squares[0]) + abs(squares[1]) + abs(squares[2]);
    vec3 up = vec3(space[0].z, space[1].z, space[2].z);
    return ArealightSpaceSize(max(rows.x, max(rows.y, rows.z)),
                              inversesqrt(max(dot(up, up), AREALIGHT_LEAST_SQUARE)),
                              abs(determinant(space)) / AREALIGHT_PI);
}

// What part of its area a cluster shows along the vector from the point to its center, times that vector's
// length.
float arealight_cluster_shown(uint row, vec3 products, vec3 to_center, bool two_sided) {
    vec3 vector = arealight_bridge_face(row + 1u).xyz;
    vec3 squares = arealight_bridge_face(row + 2u).xyz;
    float form = dot(squares, to_center * to_center) + dot(products, to_center.xxy * to_center.yzz);
    float both = sqrt(max(form, 0.0));
    return max(two_sided ? both : 0.5 * (both - dot(vector, to_center)), 0.0);
}

// What to do with a cluster.
const int AREALIGHT_CLUSTER_OPEN = 0;   // look at what is in it
const int AREALIGHT_CLUSTER_BELOW = 1;  // the horizon hides it
const int AREALIGHT_CLUSTER_WHOLE = 2;  // it is one

// Of a cluster whose center is at `in_space`, and as far over the lowest horizon as `over`.
int arealight_cluster_choice(uint row, vec3 in_space, ArealightSpaceSize size, float over) {
    float radius = arealight_bridge_face(row + 2u).w;
    float distance = arealight_bridge_face(row + 1u).w;
    bool apart = dot(in_space, in_space) > distance * distance * size.stretch;
    int choice = apart && over >= radius ? AREALIGHT_CLUSTER_WHOLE : AREALIGHT_CLUSTER_OPEN;
    // By one return: where there are two, naga loses the place of the rows read before them
    return over <= -radius ? AREALIGHT_CLUSTER_BELOW : choice;
}

// The row after it, or the first one in it; at most `end`.
uint arealight_after_cluster(uint row, uint end, vec4 head, int choice) {
    uint rows = choice == AREALIGHT_CLUSTER_OPEN ? AREALIGHT_CLUSTER_ROWS
                                                 : max(uint(-head.w), AREALIGHT_CLUSTER_ROWS);
    return row + min(rows, end - row);
}

// The vector form factor of a whole cluster.
vec3 arealight_cluster_form_factor(uint row, vec3 to_center, vec3 in_space, ArealightSpaceSize size,
                                   bool two_sided) {
    float inverse = inversesqrt(max(dot(in_space, in_space), AREALIGHT_LEAST_SQUARE));
    vec4 products = arealight_bridge_face(row + 3u);
    float shown = arealight_cluster_shown(row, products.xyz, to_center, two_sided);
    vec3 vector = (shown * inverse) * (products.w * inverse * inverse * size.volume) * (in_space * inverse);
    return arealight_is_finite(dot(vector, vector)) ? vector : vec3(0.0);
}

#endif
