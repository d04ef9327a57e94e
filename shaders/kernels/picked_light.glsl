#ifndef PICKED_LIGHT_GLSL
#define PICKED_LIGHT_GLSL

// A light that a shadow ray was picked for, as the outlines that its shading point sees. The including kernel
// defines LIGHTS_BINDING and SHAPES_BINDING, and has effects.glsl: what the frame's lights do not need is not
// in the pipeline.

#include "light_records.glsl"
#include "light_vertices.glsl"
#include "arealight/form_factor/tube_outline.glsl"
#include "arealight/lights/face_cluster.glsl"
#include "arealight/shadows/outline_sampling.glsl"
#include "arealight/shadows/ray_origin.glsl"

struct PickedLight {
    ArealightShadowOutline outline; // of a mesh each face's in turn
    float size;                     // the root of its area
    vec3 center;                    // from the shading point
    uint row;                       // of a mesh: that of the next face, and the last one's end
    uint end;
    bool is_mesh;
    // Of a mesh: the outline stands for a cluster, its rows and its form factor; and whether those in it are
    // whole ones, too
    bool is_cluster;
    uint cluster_row;
    uint cluster_end;
    float cluster_weight;
    bool in_cluster;
    bool two_sided;
    vec3 cap;      // of a tube, the center of the flat end that is seen beside its side, from the point
    vec3 cap_axis; // along the tube, as long as its radius; zero where there is no such end
    vec3 tube_axis; // of a tube, unit
    float tube_radius;
    float error; // arealight_position_error
};

// What of the way to a round light at `far` is before its own geometry, which is as wide as that; least where
// that is at the point.
float part_before(float wide, float far) {
    return max(1.0 - wide / far, 1e-3);
}

// The silhouette of a sphere, as a disk before it. A point inside of it has none.
ArealightShadowOutline sphere_outline(vec3 center, float radius) {
    float square = max(dot(center, center), 1e-37);
    float inverse = inversesqrt(square);
    float part = 1.0 - radius * radius / square;
    float before = part_before(AREALIGHT_ROUND_MARGIN * radius * inverse, 1.0);
    vec3 axis_u, axis_v;
    arealight_perpendiculars(center * inverse, axis_u, axis_v);
    float rim = part > 0.0 ? radius * before * inversesqrt(part) : 0.0;
    return arealight_ellipse_outline(before * center, rim * axis_u, rim * axis_v);
}

// The silhouette of a tube, before it: between its two tangent planes, and as long as it is; round ends as a
// straight edge of the same area. From within an end's disk extended along the axis: that disk.
ArealightShadowOutline tube_outline(vec3 center, vec3 half_axis, float radius, int ends) {
    float half_length = max(length(half_axis), 1e-37);
    vec3 axis = half_axis / half_length;
    float along = dot(center, axis);
    vec3 across = center - along * axis;
    float distance = length(across);
    float wide = AREALIGHT_ROUND_MARGIN * radius;
    float beyond = max(abs(along) - half_length, 1e-37); // an end
    if (distance <= radius) {
        vec3 axis_u, axis_v;
        arealight_perpendiculars(axis, axis_u, axis_v);
        vec3 end = center + (along > 0.0 ? -half_axis : half_axis);
        float before = part_before(wide, beyond);
        return arealight_ellipse_outline(before * end, before * radius * axis_u, before * radius * axis_v);
    }
    vec3 toward = across / distance;
    float sine = radius / distance;
    float reach = half_length + (ends == AREALIGHT_TUBE_ROUND ? 0.78539816 * radius : 0.0);
    // Before all of the endless tube, or before its nearer end, if that is farther
    float seen = 1.0 - sine * sine;
    float before = max(part_before(wide, distance) / seen, (beyond - wide) / (abs(along) + reach));
    vec3 side = radius * sqrt(seen) * cross(axis, toward);
    return arealight_rectangle_outline(before * (center - radius * sine * toward), before * reach * axis,
                                       before * side);
}

// Turns a ray over the rectangle that stands for a tube's side to the side itself: the tangents' plane is
// behind it, farthest in the middle. It ends as far before the axis as before, or before the nearer end.
void turn_to_side(PickedLight light, ArealightShadowOutline outline, inout ArealightShadowRay ray) {
    if (!HAS_TUBES || light.tube_radius <= 0.0 || outline.count != 4u) {
        return;
    }
    vec3 way = ray.distance * ray.direction;
    vec3 across = way - dot(way, light.tube_axis) * light.tube_axis;
    vec3 toward = light.center - dot(light.center, light.tube_axis) * light.tube_axis;
    float distance = max(length(toward), 1e-37);
    float reach = dot(across, toward) / distance;
    float sine = min(light.tube_radius / distance, 0.999999);
    float cosine = min(reach * inversesqrt(max(dot(across, across), 1e-37)), 1.0);
    float chord = sqrt(max(sine * sine - 1.0 + cosine * cosine, 0.0));
    float part = max(cosine * (cosine - chord) / (1.0 - sine * sine), 0.5);
    way -= (1.0 - part) * across;
    float end = distance * part_before(AREALIGHT_ROUND_MARGIN * light.tube_radius, distance);
    float length_before = length(way);
    ray.direction = way / max(length_before, 1e-37);
    ray.distance = length_before * clamp(end / max(part * reach, 1e-37), 1.0, 1.0 / part);
}

// Finds the flat end of a tube that a point sees beside its side. Error: where the two meet, the half of the
// end's outline that is before the side.
void find_end(inout PickedLight light, vec3 half_axis, float radius) {
    float half_length = max(length(half_axis), 1e-37);
    vec3 axis = half_axis / half_length;
    float along = dot(light.center, axis);
    if (abs(along) > half_length && length(light.center - along * axis) > radius) {
        light.cap = light.center + (along > 0.0 ? -half_axis : half_axis);
        light.cap_axis = radius * axis;
    }
}

PickedLight picked_light(uint pick, vec3 position) {
    PickedLight light;
    light.error = arealight_position_error(position);
    light.is_mesh = false;
    light.is_cluster = false;
    light.in_cluster = false;
    light.cap_axis = vec3(0.0);
    light.tube_radius = 0.0;
    light.row = 0u;
    light.end = 0u;
    uint index = pick & PICK_INDEX;
    if (!HAS_SHAPES || (pick & PICK_SHAPE) == 0u) {
        ArealightGpuLight record = lights[index];
        light.center = record.center - position;
        light.size = record.radius * sqrt(record.area);
        light.is_mesh = HAS_MESHES && (record.flags & LIGHT_MESH) != 0u;
        light.two_sided = (record.flags & LIGHT_TWO_SIDED) != 0u;
        light.row = record.first_vertex;
        light.end = record.first_vertex + record.vertex_count;
        light.outline = arealight_vertex_outline(light.center, record.first_vertex, record.vertex_count,
                                                 !HAS_POLYGONS || (record.flags & LIGHT_QUAD) != 0u);
        return light;
    }
    ArealightGpuShape record = shapes[index];
    light.center = record.center - position;
    light.two_sided = (record.flags & SHAPE_TWO_SIDED) != 0u;
    if (HAS_TUBES && record.kind == SHAPE_TUBE) {
        light.outline = tube_outline(light.center, record.axis_u, record.radius, int(record.detail));
        light.size = 2.0 * sqrt(record.radius * length(record.axis_u));
        light.tube_axis = arealight_normalize_or(record.axis_u, vec3(0.0, 0.0, 1.0));
        light.tube_radius = record.radius;
        if (int(record.detail) == AREALIGHT_TUBE_FLAT) {
            find_end(light, record.axis_u, record.radius);
        }
    } else if (HAS_SPHERES && record.kind == SHAPE_SPHERE) {
        light.outline = sphere_outline(light.center, record.radius);
        light.size = 1.7724539 * record.radius;
    } else {
        light.outline = arealight_ellipse_outline(light.center, record.axis_u, record.axis_v);
        light.size = 1.7724539 * sqrt(length(record.axis_u) * length(record.axis_v));
    }
    return light;
}

// Goes on to the next face of a mesh that is lit towards the point, or to the next cluster that is one from
// there; false after the last one.
bool next_face(inout PickedLight light, mat3 to_space, ArealightSpaceSize size) {
    while (light.row + 1u < light.end) {
        vec4 face = arealight_bridge_face(light.row);
        light.is_cluster = face.w < 0.0;
        if (light.is_cluster) {
            vec3 center = light.center + face.xyz;
            vec3 in_space = to_space * center;
            int choice = light.in_cluster
                             ? AREALIGHT_CLUSTER_WHOLE
                             : arealight_cluster_choice(light.row, in_space, size, in_space.z * size.lower);
            uint row = light.row;
            light.row = arealight_after_cluster(row, light.end, face, choice);
            if (choice == AREALIGHT_CLUSTER_WHOLE) {
                light.cluster_row = row + AREALIGHT_CLUSTER_ROWS;
                light.cluster_end = light.row;
                light.cluster_weight = max(arealight_cluster_form_factor(row, center, in_space, size,
                                                                         light.two_sided).z, 0.0);
                // Where no face in it is lit
                light.outline = sphere_outline(center, 0.5 * arealight_bridge_face(row + 2u).w);
                return true;
            }
            continue;
        }
        uint first = light.row + 1u;
        uint count = clamp(uint(face.w), 1u, light.end - first);
        light.row = first + count;
        if (count >= 3u && arealight_lit_side(light.center + arealight_bridge_vertex(first), face.xyz,
                                              light.two_sided, light.error) != 0.0) {
            light.outline = arealight_vertex_outline(light.center, first, count, count == 3u);
            return true;
        }
    }
    return false;
}

// Goes on from the side of a tube to the end that is seen beside it, if there is one.
bool next_end(inout PickedLight light) {
    if (!HAS_TUBES || light.cap_axis == vec3(0.0)) {
        return false;
    }
    vec3 axis_u, axis_v;
    arealight_perpendiculars(normalize(light.cap_axis), axis_u, axis_v);
    float radius = length(light.cap_axis);
    light.outline = arealight_ellipse_outline(light.cap, radius * axis_u, radius * axis_v);
    light.cap_axis = vec3(0.0);
    return true;
}

// Goes on to the next outline of a light of several.
bool next_outline(inout PickedLight light, mat3 to_space, ArealightSpaceSize size) {
    return light.is_mesh ? next_face(light, to_space, size) : next_end(light);
}

float outline_weight(PickedLight light, mat3 to_space) {
    return light.is_cluster ? light.cluster_weight : arealight_outline_weight(light.outline, to_space);
}

// The size of the form factor of a light in the space that `to_space` leads to: of several outlines their
// sum.
float picked_light_weight(PickedLight light, mat3 to_space) {
    ArealightSpaceSize size = arealight_space_size(to_space);
    float sum = light.is_mesh ? 0.0 : arealight_outline_weight(light.outline, to_space);
    while (next_outline(light, to_space, size)) {
        sum += outline_weight(light, to_space);
    }
    return sum;
}

// The outline to draw over: of several one, chosen by its form factor; of a cluster one in it.
ArealightShadowOutline chosen_outline(PickedLight light, mat3 to_space, inout float random) {
    if (!light.is_mesh && (!HAS_TUBES || light.cap_axis == vec3(0.0))) {
        return light.outline;
    }
    PickedLight chosen = light;
    ArealightSpaceSize size = arealight_space_size(to_space);
    float sum = light.is_mesh ? 0.0 : arealight_outline_weight(light.outline, to_space);
    do {
        chosen.is_cluster = false;
        while (next_outline(light, to_space, size)) {
            float weight = outline_weight(light, to_space);
            if (weight > 0.0 && arealight_choose(random, sum, weight)) {
                chosen = light;
            }
        }
        light.row = chosen.cluster_row;
        light.end = chosen.cluster_end;
        light.in_cluster = true;
        sum = 0.0;
    } while (HAS_MESHES && chosen.is_cluster);
    return chosen.outline;
}

#endif
