#ifndef AREALIGHT_OUTLINES_GLSL
#define AREALIGHT_OUTLINES_GLSL

#include "arealight/effects.glsl"
#include "arealight/light_view.glsl"

// Walks around outlines of any number of vertices: in the cosine spaces of all lobes at once, four vertices a pass. Reading a
// vertex and going round a loop cost more than an edge's arithmetic, so both are shared.

// How each lobe sees a light. What `effects` and the quality do without is not looked at.
struct ArealightLobeViews {
    ArealightLobeView glossy;
    ArealightLobeView schlick;
    ArealightLobeView diffuse;
};

// The arcs around a light in each lobe's cosine space.
struct ArealightLobeArcs {
    ArealightArcs glossy;
    ArealightArcs schlick;
    ArealightArcs diffuse;
};

ArealightLobeArcs arealight_no_arcs() {
    ArealightArcs none = ArealightArcs(vec3(0.0), 0.0);
    return ArealightLobeArcs(none, none, none);
}

// Whether a surface has the lobe of AREALIGHT_FRESNEL_SPLIT.
bool arealight_has_schlick(uint effects, ArealightQuality quality) {
    return (effects & AREALIGHT_EFFECT_GLOSSY) != 0u && quality.fresnel == AREALIGHT_FRESNEL_SPLIT;
}

ArealightLobeViews arealight_lobe_views(ArealightShadingPoint point, ArealightSeenLight seen, int rung) {
    ArealightLobeViews views;
    views.glossy = arealight_lobe_view(point.glossy.space, point.normal, seen, rung);
    views.schlick = arealight_lobe_view(point.schlick.space, point.normal, seen, rung);
    views.diffuse = arealight_lobe_view(point.diffuse.space, point.normal, seen, rung);
    return views;
}

// Begins a walk at the outline's last vertex, an offset from the light's center. Where the surface's horizon does not clip by
// itself, `walk` and `last` are all of the state.
ArealightSurfaceWalk arealight_outline_begin(ArealightLobeView view, vec3 last, ArealightQuality quality) {
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        return arealight_surface_walk_begin(view.transform * last, arealight_vertex_height(view, last));
    }
    ArealightSurfaceWalk outline = arealight_surface_walk_begin(vec3(0.0), 0.0);
    outline.last = arealight_vertex(view.anchor, view.transform * last, quality.form_factor);
    return outline;
}

// Walks on to a vertex. To the same one again is an arc of no length.
void arealight_outline_to(inout ArealightSurfaceWalk outline, ArealightLobeView view, vec3 vertex, ArealightQuality quality) {
    int rung = quality.form_factor;
    vec3 offset = view.transform * vertex;
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        arealight_surface_walk_to(outline, view.anchor, offset, arealight_vertex_height(view, vertex), rung);
        return;
    }
    ArealightVertex to = arealight_vertex(view.anchor, offset, rung);
    arealight_walk_edge(outline.walk, view.anchor, outline.last, to, rung);
    outline.last = to;
}

// Walks on around four vertices: by a loop, since the registers of all lobes' edges at once are more than there are.
void arealight_outline_pass(inout ArealightSurfaceWalk outline, ArealightLobeView view, ArealightQuad part,
                            ArealightQuality quality) {
    for (int place = 0; place < 4; place++) {
        vec3 vertex = place == 0 ? part.v0 : place == 1 ? part.v1 : place == 2 ? part.v2 : part.v3;
        arealight_outline_to(outline, view, vertex, quality);
    }
}

ArealightArcs arealight_outline_end(ArealightSurfaceWalk outline, ArealightLobeView view, ArealightQuality quality) {
    if (quality.horizon == AREALIGHT_HORIZON_BOTH) {
        return arealight_surface_walk_end(outline, view.anchor, quality.form_factor);
    }
    return arealight_walk_end(outline.walk, view.anchor, quality.form_factor);
}

// The arcs around the outline of `count` vertices from `first` on.
ArealightLobeArcs arealight_walk_outline(ArealightLobeViews views, uint first, uint count, uint effects,
                                         ArealightQuality quality) {
    bool has_glossy = (effects & AREALIGHT_EFFECT_GLOSSY) != 0u;
    bool has_schlick = arealight_has_schlick(effects, quality);
    bool has_diffuse = (effects & AREALIGHT_EFFECT_DIFFUSE) != 0u;
    ArealightQuality diffuse_quality = arealight_diffuse_quality(quality);
    uint last = first + max(count, 1u) - 1u;
    vec3 from = arealight_bridge_vertex(last);
    ArealightSurfaceWalk glossy = arealight_outline_begin(views.glossy, from, quality);
    ArealightSurfaceWalk schlick = arealight_outline_begin(views.schlick, from, quality);
    ArealightSurfaceWalk diffuse = arealight_outline_begin(views.diffuse, from, diffuse_quality);

    // Past its end an outline stays at its last vertex, which changes nothing
    for (uint index = first; index <= last; index += 4u) {
        ArealightQuad part = arealight_four_vertices(index, last);
        if (has_glossy) {
            arealight_outline_pass(glossy, views.glossy, part, quality);
        }
        if (has_schlick) {
            arealight_outline_pass(schlick, views.schlick, part, quality);
        }
        if (has_diffuse) {
            arealight_outline_pass(diffuse, views.diffuse, part, diffuse_quality);
        }
    }
    return ArealightLobeArcs(arealight_outline_end(glossy, views.glossy, quality),
                             arealight_outline_end(schlick, views.schlick, quality),
                             arealight_outline_end(diffuse, views.diffuse, diffuse_quality));
}

#if AREALIGHT_LIGHT_MESHES

// Whether a light has several faces.
bool arealight_is_mesh(ArealightPolygonLight light, uint effects) {
    return (effects & AREALIGHT_EFFECT_MESH) != 0u && arealight_bridge_face_size(light.first_vertex) != 0u;
}

// Adds the arcs around a face of a mesh that faces the shading point; of a two-sided one around any, as if it did.
ArealightArcs arealight_add_face(ArealightArcs sum, ArealightArcs face, bool two_sided) {
    // Seen from the back an outline goes around the other way
    float side = face.sum.z <= 0.0 ? 1.0 : (two_sided ? -1.0 : 0.0);
    return ArealightArcs(sum.sum + side * face.sum, sum.squares + face.squares);
}

ArealightLobeArcs arealight_add_faces(ArealightLobeArcs sum, ArealightLobeArcs face, bool two_sided) {
    return ArealightLobeArcs(arealight_add_face(sum.glossy, face.glossy, two_sided),
                             arealight_add_face(sum.schlick, face.schlick, two_sided),
                             arealight_add_face(sum.diffuse, face.diffuse, two_sided));
}

#endif

// The arcs around a light: its outline, or the faces of a mesh. Each face is clipped and closed by itself; the sum is of what
// each sends: where one hides another, both count.
ArealightLobeArcs arealight_walk_light(ArealightLobeViews views, ArealightPolygonLight light, uint effects,
                                       ArealightQuality quality) {
#if AREALIGHT_LIGHT_MESHES
    if ((effects & AREALIGHT_EFFECT_MESH) != 0u) {
        bool is_mesh = arealight_is_mesh(light, effects);
        uint end = light.first_vertex + light.vertex_count;
        uint first = light.first_vertex;
        ArealightLobeArcs sum = arealight_no_arcs();
        while (first < end) {
            uint size = arealight_bridge_face_size(first);
            uint count = size == 0u ? end - first : min(size, end - first);
            ArealightLobeArcs face = arealight_walk_outline(views, first, count, effects, quality);
            if (is_mesh) {
                sum = arealight_add_faces(sum, face, light.two_sided);
            } else {
                sum = face;
            }
            first += count;
        }
        return sum;
    }
#endif
    return arealight_walk_outline(views, light.first_vertex, light.vertex_count, effects, quality);
}

#endif
