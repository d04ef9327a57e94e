#ifndef LIGHT_VERTICES_GLSL
#define LIGHT_VERTICES_GLSL

// The vertices of polygon and mesh lights, for the library. The including kernel defines LIGHTS_BINDING: they
// are at the binding after it.

// Of each light its vertices in xyz, from its center. A mesh has before each face's vertices its unit normal
// in xyz and their count in w. A light with an image has after its vertices the image's place: (corner, low
// u), (axis u, low v), (axis v, width), (height). What an opening
// and a profile have after that: arealight_bridge_profile.
layout(set = 0, binding = LIGHTS_BINDING + 1, std430) readonly buffer LightVertices {
    vec4 light_vertices[];
};

vec3 arealight_bridge_vertex(uint index) {
    return light_vertices[index].xyz;
}

vec4 arealight_bridge_face(uint index) {
    return light_vertices[index];
}

vec4 arealight_bridge_profile(uint index) {
    return light_vertices[index];
}

#endif
