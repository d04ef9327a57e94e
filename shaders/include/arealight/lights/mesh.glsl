#ifndef AREALIGHT_MESH_LIGHT_GLSL
#define AREALIGHT_MESH_LIGHT_GLSL

#include "arealight/lights/face_cluster.glsl"
#include "arealight/lights/polygon.glsl"

// Flat, simple polygons, one after another, of one constant radiance. The sum is of what each emits: where
// one hides another, both count.
struct ArealightMeshLight {
    vec3 radiance;     // of the fronts, W/(m^2 sr)
    vec3 center;       // relative to the origin of ArealightSurface.position
    uint first_row;    // for arealight_bridge_face: that of the first face
    uint row_count;    // of all faces and vertices
    bool two_sided;    // the backs emit too (with AREALIGHT_TWO_SIDED)
};

struct ArealightLocalMesh {
    vec3 offset;   // from the shading point to the center
    mat3 to_frame; // into the shading frame
    uint first;    // rows
    uint end;
    bool two_sided;
    float error;   // arealight_position_error
};

bool arealight_to_local(ArealightPoint point, ArealightMeshLight light, out ArealightLocalMesh local) {
    local.offset = light.center - point.position;
    local.to_frame = point.to_frame;
    local.first = light.first_row;
    local.end = light.first_row + light.row_count;
    local.two_sided = AREALIGHT_HAS_TWO_SIDED && light.two_sided;
    local.error = arealight_position_error(point.position);
    return true;
}

// A face of a mesh: its vertices, whose last one is before the next face's row, and the side that the point
// sees of it.
struct ArealightMeshFace {
    uint first;
    uint end;
    float side; // arealight_lit_side
};

// The face of a row. The rows of a cluster are a face of no side: so all that is in it is looked at.
ArealightMeshFace arealight_mesh_face(ArealightLocalMesh local, uint row) {
    vec4 face = arealight_bridge_face(row);
    bool is_cluster = face.w < 0.0;
    uint first = row + 1u;
    uint count = is_cluster ? AREALIGHT_CLUSTER_ROWS - 1u : uint(face.w);
    uint end = first + clamp(count, 1u, local.end - first);
    vec3 offset = local.offset + arealight_bridge_vertex(first);
    float side = is_cluster ? 0.0 : arealight_lit_side(offset, face.xyz, local.two_sided, local.error);
    return ArealightMeshFace(first, end, side);
}

// Each face is clipped and closed by itself, if the point is on its bright side; clusters that are one from
// there are not looked into.
vec3 arealight_vector_form_factor(mat3 space, ArealightLocalMesh local) {
    vec3 center = local.to_frame * local.offset;
    ArealightSpaceSize size = arealight_space_size(space);
    vec3 sum = vec3(0.0);
    for (uint row = local.first; row + 1u < local.end;) {
        vec4 head = arealight_bridge_face(row);
        if (head.w < 0.0) {
            vec3 to_center = local.offset + head.xyz;
            vec3 in_frame = local.to_frame * to_center;
            vec3 in_space = space * in_frame;
            float over = in_space.z * size.lower;
            over = AREALIGHT_CLIPS_AT_SURFACE ? min(over, in_frame.z) : over;
            int choice = arealight_cluster_choice(row, in_space, size, over);
            if (choice == AREALIGHT_CLUSTER_WHOLE) {
                sum += arealight_cluster_form_factor(row, to_center, in_space, size, local.two_sided);
            }
            row = arealight_after_cluster(row, local.end, head, choice);
        } else {
            ArealightMeshFace face = arealight_mesh_face(local, row);
            if (face.side != 0.0) {
                // Seen from the back an outline goes around the other way
                sum += face.side * arealight_outline_form_factor(space, center, local.to_frame, face.first,
                                                                 face.end, face.side);
            }
            row = face.end;
        }
    }
    return sum;
}

bool arealight_has_facet_form_factor(ArealightLocalMesh local) {
    return true;
}

// Face by face.
vec3 arealight_facet_form_factor(ArealightFacets facets, ArealightLocalMesh local) {
    vec3 center = local.to_frame * local.offset;
    vec3 sum = vec3(0.0);
    for (uint row = local.first; row + 1u < local.end;) {
        ArealightMeshFace face = arealight_mesh_face(local, row);
        if (face.side != 0.0) {
            sum += face.side * arealight_facet_outline(facets, center, local.to_frame, face.first, face.end);
        }
        row = face.end;
    }
    return sum;
}

vec3 arealight_image_average(mat3 space, ArealightLocalMesh local, vec3 vector) {
    return vec3(1.0);
}

#if AREALIGHT_SOLID_ANGLES
float arealight_solid_angle(ArealightLocalMesh local) {
    vec3 center = local.to_frame * local.offset;
    float sum = 0.0;
    for (uint row = local.first; row + 1u < local.end;) {
        ArealightMeshFace face = arealight_mesh_face(local, row);
        if (face.side != 0.0) {
            sum += arealight_outline_solid_angle(center, local.to_frame, face.first, face.end);
        }
        row = face.end;
    }
    return min(sum, 4.0 * AREALIGHT_PI);
}
#endif

AREALIGHT_LIGHT_KIND(ArealightMeshLight, ArealightLocalMesh, AREALIGHT_LOOPED_LOBES)

#endif
