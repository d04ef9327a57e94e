#ifndef SCATTERED_LIGHT_GLSL
#define SCATTERED_LIGHT_GLSL

// What a point in a medium scatters of a light of a record, of any kind that is compiled.

vec3 in_scattered(ArealightMediumPoint medium, ArealightGpuLight record) {
    if (HAS_SHAPED && (record.flags & LIGHT_SHAPED) != 0u) {
        return arealight_in_scattered(medium, load_shaped(record));
    }
    if (HAS_MESHES && (record.flags & LIGHT_MESH) != 0u) {
        return arealight_in_scattered(medium, load_mesh(record));
    }
    if (HAS_POLYGONS) {
        return arealight_in_scattered(medium, load_polygon(record));
    }
    return arealight_in_scattered(medium, load_quad(record));
}

vec3 in_scattered(ArealightMediumPoint medium, ArealightGpuShape record) {
    if (HAS_TUBES && record.kind == SHAPE_TUBE) {
        return arealight_in_scattered(medium, load_tube(record));
    }
    if (HAS_SPHERES && record.kind == SHAPE_SPHERE) {
        return arealight_in_scattered(medium, load_sphere(record));
    }
    return HAS_DISKS ? arealight_in_scattered(medium, load_disk(record)) : vec3(0.0);
}

// By how much the mean of what is seen of a light from afar is nearer than its center.
float seen_depth(ArealightGpuShape record) {
    float part = record.kind == SHAPE_SPHERE ? 2.0 / 3.0
        : record.kind == SHAPE_TUBE ? 0.25 * AREALIGHT_PI : 0.0;
    return part * record.radius;
}

#endif
