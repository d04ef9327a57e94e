#ifndef AREALIGHT_LIGHT_VIEW_GLSL
#define AREALIGHT_LIGHT_VIEW_GLSL

#include "arealight/footprint.glsl"
#include "arealight/form_factor.glsl"
#include "arealight/shading_point.glsl"

// A polygon light, and how a shading point and its lobes see it.

// The host's bridge to the lights' vertices: the position of vertex `index`, relative to its light's `center`. So a
// light keeps its shape however far from the origin it is.
vec3 arealight_bridge_vertex(uint index);

// Four vertices of a light, from `first` on; beyond `last` that again.
ArealightQuad arealight_four_vertices(uint first, uint last) {
    return ArealightQuad(arealight_bridge_vertex(min(first, last)), arealight_bridge_vertex(min(first + 1u, last)),
                         arealight_bridge_vertex(min(first + 2u, last)), arealight_bridge_vertex(min(first + 3u, last)));
}

// Whether lights may be meshes of several faces. A host that says so defines the bridge below, and sets
// AREALIGHT_EFFECT_MESH where a light is one.
#ifndef AREALIGHT_LIGHT_MESHES
#define AREALIGHT_LIGHT_MESHES 0
#endif

#if AREALIGHT_LIGHT_MESHES
// The host's bridge to the faces of meshes: how many vertices the face has whose first vertex is `index`. 0 for a light that
// is one polygon.
uint arealight_bridge_face_size(uint index);
#endif

// A flat, simple polygon of constant radiance, or that shows an image; or a mesh of several, one after another, of constant
// radiance.
struct ArealightPolygonLight {
    vec3 radiance;     // of the front, W/(m^2 sr)
    uint first_vertex; // for arealight_bridge_vertex
    uint vertex_count; // from 3 on; the outline is flat, convex and has at most 4 without AREALIGHT_EFFECT_POLYGON
    vec3 center;       // of the area, relative to the origin of ArealightSurface.position
    float radius;      // of a sphere about the center that holds every vertex; may be generous
    vec3 area;         // area times the normal of the front, over radius^2 (one-point form, and split footprints of any outline)
    bool two_sided;    // the back emits too
    ArealightImage image; // multiplies the radiance (AREALIGHT_EFFECT_TEXTURED alone)
};

// A light before a shading point: scaled by a power of two, so that squares neither overflow nor vanish. That rounds
// nothing.
struct ArealightSeenLight {
    vec3 center;  // from the shading point
    float radius;
    float scale;  // what offsets are still to be multiplied with
    float facing; // minus the product of area vector and center
};

ArealightSeenLight arealight_see(vec3 position, ArealightPolygonLight light) {
    ArealightSeenLight seen;
    vec3 center = light.center - position;
    seen.scale = arealight_power_of_two_scale(arealight_max_component(center) + light.radius);
    seen.center = center * seen.scale;
    seen.radius = light.radius * seen.scale;
    seen.facing = -dot(light.area, seen.center) * seen.radius * seen.radius;
    return seen;
}

// What the form factor of a light in a lobe's cosine space begins with.
struct ArealightLobeView {
    vec3 center;            // of the light, from the shading point
    float extent;           // of the light about it; may be generous
    ArealightAnchor anchor; // at its center
    mat3 transform;         // offsets from the light's center into cosine space
    vec3 normal;            // product with an offset: the vertex's height above the center's, before the transform
    float normal_height;    // the center's height above the surface's horizon
    float height_width;     // heights below this count as zero
};

ArealightLobeView arealight_lobe_view(ArealightCosineSpace space, vec3 normal, ArealightSeenLight seen, int rung) {
    ArealightLobeView view;
    view.center = space.to_cosine * seen.center;
    view.extent = space.stretch * seen.radius;
    view.anchor = arealight_anchor(view.center, view.extent, rung);
    view.anchor.horizon = AREALIGHT_HORIZON_WIDTH * space.flatness;
    view.transform = space.to_cosine * seen.scale;
    view.normal = normal * seen.scale;
    view.normal_height = dot(normal, seen.center);
    view.height_width = 2.0 * AREALIGHT_HORIZON_WIDTH * (abs(view.normal_height) + seen.radius);
    return view;
}

// The height of the vertex at `offset` from the light's center above the surface's horizon. A light in the surface's
// plane has none, whatever the last bit says.
float arealight_vertex_height(ArealightLobeView view, vec3 offset) {
    return arealight_settled_height(view.normal_height + dot(view.normal, offset), view.height_width);
}

#endif
